# Largest error of the energy balance against the cfl number, a line for each scene and integrator, by utils/studies/error_vs_time.
#
# usage: gnuplot -e "table='TABLE'; png='PICTURE'" utils/plots/energy_cfl.gp
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
set datafile missing 'none'
set terminal pngcairo size 1150,720 font font
set output png
series = system("awk 'NR > 1 && !seen[$1, $2]++ { print $1 \":\" $2 }' '".table."'")
scenes = system("awk 'NR > 1 && !seen[$1]++ { print $1 }' '".table."'")
integrators = system("awk 'NR > 1 && !seen[$2]++ { print $2 }' '".table."'")
place(list, name) = int(sum [k=1:words(list)] (word(list, k) eq name ? k : 0))
scene(text) = text[1:strstrt(text, ':') - 1]
integrator(text) = text[strstrt(text, ':') + 1:*]

set logscale xy
set xlabel 'cfl number'
set ylabel 'largest |error of the energy balance| / ΔE_M^{tot}'
set format y '10^{%T}'
set xtics (0.1, 0.19, 0.375, 0.53, 0.75, 1.06, 1.5, 2)
set xrange [0.09:2.3]
set key noenhanced
# Slopes where there is room: between the largest errors and the middle ones.
stats table using (column('cfl') > 0.5 && column('cfl') < 0.8 ? column('balance_error') : NaN) nooutput
middle = sqrt(STATS_max*STATS_median)
plot for [s in series] table using (strcol(1) eq scene(s) && strcol(2) eq integrator(s) ? column('cfl') : NaN) \
        :(column('balance_error')) \
        with linespoints linetype place(scenes, scene(s)) dashtype place(integrators, integrator(s)) \
        pointtype (word('7 4 8 6', place(integrators, integrator(s))) + 0) title scene(s).', '.integrator(s), \
     [0.25:1.1] middle*(x/0.75)**4 with lines linewidth 1 dashtype 3 linecolor rgb '#606060' title 'order 4', \
     [0.25:1.1] middle*(x/0.75)**5 with lines linewidth 1 dashtype 5 linecolor rgb '#606060' title 'order 5'
unset output
