# What probes and gauges measure against time: pressures in one panel, lengths in one below; only what there is.
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/probes.gp     writes RESULT/probes.png
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
data = dir.'/probes.dat'

# The head's list of columns says what each is: '#   3  P1 [pressure]'.
of_unit(unit) = system("sed -n -e '/^[^#]/q' -e 's/^# *[0-9]*  \\([^ ]*\\) \\[".unit."\\]$/\\1/p' '".data."'")
pressures = of_unit('pressure')
lengths = of_unit('length')
panels = (words(pressures) > 0) + (words(lengths) > 0)

# Legends as wide as the wider one, so that the panels stand below each other; long ones in columns.
rows = 14
longest(names) = words(names) == 0 ? 0 : strlen(word(names, 1)) > longest(rest(names)) ? strlen(word(names, 1)) : longest(rest(names))
rest(names) = words(names) > 1 ? names[strlen(word(names, 1)) + 2:] : ''
width(names) = (0.95*longest(names) + 7)*((words(names) + rows - 1)/rows)
set key maxrows rows
set lmargin 11
set rmargin (width(pressures) > width(lengths) ? width(pressures) : width(lengths))

# From the eighth on the same colours again, dashed.
colours = blue.' '.red.' '.green.' '.purple.' '.orange.' '.sky.' '.black
do for [i=8:28] {
   eval sprintf("set linetype %d linecolor rgb '%s' linewidth 1.8 dashtype %d", i, word(colours, (i - 1)%7 + 1), (i - 1)/7 + 1)
}

set terminal pngcairo size 1200,(panels == 1 ? 700 : 1000) font font
set output dir.'/probes.png'
set multiplot layout panels,1
set title head_text(data, 'title') noenhanced font 'DejaVu Sans,14'
set xrange [0:*]
set xzeroaxis linetype 1 linecolor rgb '#a0a0a0'
do for [unit in 'pressure length'] {
   names = unit eq 'pressure' ? pressures : lengths
   if (words(names) > 0) {
      set xlabel (unit eq 'pressure' && panels > 1) ? '' : scaled_time_in(data)
      set ylabel unit.' [input units]'
      plot for [i=1:words(names)] data using (column('time_scaled')):(column(word(names, i))) \
         with lines linetype i title word(names, i) noenhanced
      set title ''
   }
}
unset multiplot
unset output
