# Dam breaks against what was measured, by utils/studies/experiments.
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/experiments.gp
#
# Writes sensor2.png, sensors.png, buchner.png, martin_moyce.png and square.png to RESULT, from the curves in RESULT/curves.
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
curves = dir.'/curves/'
set key inside center top vertical Left reverse samplen 2.5 spacing 1.2
set linetype 8 linecolor rgb black linewidth 2.4

# Parts of plot commands, with a comma behind them; last ends it. Computed pressures are noisy: every step pale, their
# moving mean over it.
computed(name, column) = line(name.'_constant', column, 'linetype 1', 'α = 0.01, δ = 0.1') \
   .line(name.'_dynamic', column, 'linetype 2', 'dynamic model')
steps(name) = line(name.'_constant', 2, "linecolor rgb '#a9cfe8' linewidth 1", '') \
   .line(name.'_dynamic', 2, "linecolor rgb '#f3c3a0' linewidth 1", '')
line(name, column, style, label) = sprintf("'%s%s.dat' using 1:%d with lines %s title '%s', ", curves, name, column, style, label)
points(name, type, label) = sprintf( \
   "'%s%s.dat' using 1:2 with points linecolor rgb black pointsize 1.1 pointtype %d title '%s', ", curves, name, type, label)

last = '1/0 notitle'

time = 't √(g/H)'
pressure = 'p / (ρ g H)'
set terminal pngcairo size 1200,700 font font
set output dir.'/sensor2.png'
set title 'Lobovský et al., H = 300 mm, 15 mm above the floor. Pale: every step; lines: mean over 0.05' font 'DejaVu Sans,13'
set xlabel time
set ylabel pressure
set xrange [2.2:7.2]
set yrange [-0.1:3]
band = sprintf( \
   "'< paste %slow.dat %shigh.dat' using 1:2:5 with filledcurves linecolor rgb '#c8c8c8' title '2.5 to 97.5 %% of the repeats', ", \
   curves, curves)
eval 'plot '.band.steps('sensor2').line('sensor2', 2, 'linetype 8', 'measured, median').computed('sensor2', 3).last

set terminal pngcairo size 1200,1300 font font
set output dir.'/sensors.png'
set multiplot layout 3,1 margins 0.075,0.98,0.055,0.97 spacing 0,0.06
do for [k in '1 3 4'] {
   set xlabel k eq '4' ? time : ''
   set title 'Lobovský et al., H = 300 mm, '.word('3 . 30 80', k + 0).' mm above the floor' font 'DejaVu Sans,13' offset 0,-0.5
   eval 'plot '.steps('sensor'.k).computed('sensor'.k, 3).points('sensor'.k, 6, 'measured, one digitised curve').last
}
unset multiplot

set terminal pngcairo size 1200,1300 font font
set output dir.'/buchner.png'
set multiplot layout 3,1 margins 0.075,0.98,0.055,0.97 spacing 0,0.06
set xlabel ''
set yrange [-0.1:1.7]
do for [height in '160 120'] {
   set title 'Buchner, H = 600 mm, P1 computed '.height.' mm above the floor' font 'DejaVu Sans,13' offset 0,-0.5
   eval 'plot '.steps('buchner_'.height).computed('buchner_'.height, 3) \
      .points('buchner_trixi', 6, 'measured, TrixiParticles').points('buchner_pysph', 1, 'measured, PySPH').last
}
set xlabel time
set yrange [-0.1:0.8]
set key left top
set title 'P2, 584 mm above the floor' font 'DejaVu Sans,13' offset 0,-0.5
eval 'plot '.steps('buchner_upper').computed('buchner_upper', 3).points('buchner_upper', 6, 'measured, TrixiParticles').last
set key center top
unset multiplot

set terminal pngcairo size 1300,600 font font
set output dir.'/martin_moyce.png'
set multiplot layout 1,2 margins 0.065,0.985,0.11,0.94 spacing 0.085,0
set key left top
set title 'Martin \& Moyce, column 2 a high: front' font 'DejaVu Sans,13'
set xlabel 't √(2g/a)'
set ylabel 'x / a'
set xrange [0:9.5]
set yrange [1:16]
eval 'plot '.computed('front', 2) \
   .points('front_table2', 1, 'table 2, a = 57 mm').points('front_a225', 6, 'fig. 3, a = 57 mm') \
   .points('front_a1125', 8, 'fig. 3, a = 29 mm').last
set key center top
set title 'height at the left wall' font 'DejaVu Sans,13'
set xlabel 't √(g/a)'
set ylabel 'y / (2a)'
set xrange [0:5.5]
set yrange [0:1]
eval 'plot '.computed('height', 2).points('height', 1, 'table 6, a = 57 mm').last
unset multiplot

set terminal pngcairo size 900,600 font font
set output dir.'/square.png'
set key left top
set title 'Lobovský et al., column H = 600 mm high and wide: front' font 'DejaVu Sans,13'
set xlabel time
set ylabel 'x / H'
set xrange [0:1.7]
set yrange [1:2.8]
eval 'plot [0:1.7] 2.683 with lines dashtype 2 linewidth 1 linecolor rgb "#909090" title "wall", ' \
   .computed('square', 2).points('square', 6, 'measured').last
unset output
