# Pressure at the probes against time.
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/probes.gp     writes RESULT/probes.png
if (!exists("plots")) plots = 'utils/plots'
load plots.'/style.gp'
data = dir.'/probes.dat'

# Every column that is no time is a probe; its unit stands in the head's list of columns.
names = system("sed -n '/^[^#]/{p;q}' '".data."'")
unit = system("sed -n 's/^# *3  [^ ]* \\[\\(.*\\)\\]$/\\1/p' '".data."'")

set terminal pngcairo size 1200,700 font font
set output dir.'/probes.png'
set title head_text(data, 'title') noenhanced font 'DejaVu Sans,14'
set xlabel scaled_time_in(data)
set ylabel 'pressure ['.unit.']' noenhanced
set xrange [0:*]
set xzeroaxis linetype 1 linecolor rgb '#a0a0a0'
plot for [i=3:words(names)] data using (column('time_scaled')):(column(word(names, i))) with lines linetype i-2 title word(names, i) noenhanced
