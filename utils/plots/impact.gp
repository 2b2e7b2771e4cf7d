# Pressure at P1, the foot of the right wall, of several runs with what Lobovsky et al. measured (Fig. 29 of the paper).
#
# usage: gnuplot -e "runs='A B'; labels='a b'; png='FILE.png'" utils/plots/impact.gp
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
label(i) = system("echo '".word(labels, i)."' | tr _ ' '")
# Every step is noisy: mean over a tenth of sqrt(d/g), as a sensor would not see more.
smooth(run) = sprintf("< awk '/^#/ { next } !c { for (i = 1; i <= NF; i++) if ($i == \"P1\") c = i; next } " \
   ."{ b = int($2/0.05); if (b > last && n) { print 0.05*(last + 0.5), sum/n; sum = n = 0 } last = b; sum += $c; n++ }' '%s/probes.dat'", run)
measured = plots.'/../../input/reference/lobovsky2014_p1_H300.csv'
set terminal pngcairo size 1200,700 font font
set output png
unset datafile columnheaders
set xlabel 't √(g/d)'
set ylabel 'p / (ρ g d)'
set xrange [2:20]
set yrange [-0.2:2.6]
set key inside right top
plot for [i=1:words(runs)] smooth(word(runs, i)) using 1:2 with lines linetype i title label(i), \
   "< grep -v '^[#t]' '".measured."' | tr , ' ' | sort -n" using 1:2 with points pointtype 6 pointsize 0.8 linecolor rgb black title 'measured'
