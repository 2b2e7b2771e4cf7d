# Errors against resolution, one panel for each scene, by utils/studies/convergence.
#
# usage: gnuplot -e "out='DIRECTORY'; scenes='SCENE SCENE'" utils/plots/convergence.gp     writes DIRECTORY/convergence.png
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
set datafile missing 'none'

columns = words(scenes) < 3 ? words(scenes) : 3
rows = (words(scenes) + columns - 1)/columns
set terminal pngcairo size 460*columns,440*rows font 'DejaVu Sans,10'
set output out.'/convergence.png'
set multiplot layout rows,columns margins 0.05,0.985,0.14,0.97 spacing 0.06,0.16
set logscale xy
set format y '10^{%T}'
set key at graph 0,-0.21 left top Left reverse samplen 1.5 spacing 1.1 font 'DejaVu Sans,9' noenhanced
set xlabel 'd/dx' offset 0,0.6
do for [scene in scenes] {
   table = out.'/'.scene.'.dat'
   names = system("sed -n 's/^resolution //p' '".table."'")
   n = words(names)
   set xrange [*:*]   # stats counts only what is in range
   stats table using 1:2 nooutput
   x1 = STATS_min_x; x2 = STATS_max_x; top = STATS_max_y
   set title scene noenhanced font 'DejaVu Sans,11' offset 0,-0.5
   set xrange [x1/1.2:x2*1.2]
   set xtics (12.5, 25, 50, 100, 200)
   if (int(x1)%20 == 0) { set xtics (20, 40, 80, 160) }
   # Slopes of first and second order through the first point.
   plot for [i=1:n] table using 1:(column(i + 1)) with linespoints linetype i pointtype 7 pointsize 0.8 title word(names, i), \
      [x1:x2] top*(x/x1)**(-1) with lines dashtype 2 linewidth 1 linecolor rgb '#909090' title 'order 1', \
      [x1:x2] top*(x/x1)**(-2) with lines dashtype 3 linewidth 1 linecolor rgb '#909090' title 'order 2'
}
unset multiplot
unset output
