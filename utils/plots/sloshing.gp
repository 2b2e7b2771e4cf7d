# Pressure of the impacts in a rolling tank, SPHERIC benchmark 10, by utils/studies/experiments.
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/sloshing.gp
#
# Writes sloshing.png to RESULT, from the curves in RESULT/curves and input/reference/spheric10_peaks.csv.
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
curves = dir.'/curves/'
measured = curves.'roll_measured.dat'
computed = curves.'roll_computed.dat'
# Times of the single run, heights of the repeats.
repeats = "< sed -e '/^#/d' -e 's/,/ /g' ".plots."/../../input/reference/spheric10_peaks.csv"

set terminal pngcairo size 1200,950 font font
set output dir.'/sloshing.png'
set multiplot
set size 1,0.5
set origin 0,0.5
set key inside left top vertical Left reverse samplen 2.5 spacing 1.2
set title 'SPHERIC benchmark 10, sensor 1. Computed: means over 5 ms, pale: every step' font 'DejaVu Sans,13'
set ylabel 'p [kPa]'
set xrange [0:7.5]
set yrange [-0.5:14]
plot computed using 1:($2/1000) with lines linecolor rgb '#a9cfe8' linewidth 1 title '', \
     measured using 1:($2/1000) with lines linecolor rgb black linewidth 1.4 title 'measured, one run', \
     computed using 1:($3/1000) with lines linetype 1 linewidth 1.4 title 'computed', \
     repeats using 8:($3/1000):($4/1000) with yerrorbars linecolor rgb red pointtype 7 linewidth 1.8 title 'peaks of 102 repeats, mean ± standard deviation'
set origin 0,0
set size 0.5,0.5
set title 'first impact' font 'DejaVu Sans,13'
set xlabel 't [s]'
set key off
set yrange [-0.5:9]
set xrange [2.3:2.6]
replot
set origin 0.5,0
set title 'fourth impact'
set ylabel ''
set xrange [7.2:7.5]
replot
unset multiplot
unset output
