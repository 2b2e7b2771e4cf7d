# Errors against measured run time, a line for each method with its resolutions as points, by utils/studies/error_vs_time.
#
# usage: gnuplot -e "out='DIRECTORY'; png='PICTURE'; panels='SCENE:ERROR ...'; methods='METHOD ...'" utils/plots/error_vs_time.gp
#
# Reads DIRECTORY/SCENE.dat; a panel for each SCENE:ERROR, and the key in the last place.
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
set datafile missing 'none'

n = words(panels) + 1
columns = n <= 3 ? n : n <= 6 && n != 4 ? 3 : 4
if (n == 4) { columns = 2 }
rows = (n + columns - 1)/columns
width = 440*columns
height = 400*rows
set terminal pngcairo size width,height font 'DejaVu Sans,10'
set output png
set multiplot layout rows,columns margins 68.0/width,1 - 15.0/width,52.0/height,1 - 34.0/height spacing 68.0/width,82.0/height
colours = blue.' '.red.' '.green.' '.purple.' '.orange.' '.sky
colour(i) = i == 1 ? black : word(colours, (i - 2)%6 + 1)
type(i) = word('7 5 9 11 13 6 4 8 10 12', (i - 1)%10 + 1) + 0

set logscale xy
set format xy '10^{%T}'
set xlabel 'run time [s]' offset 0,0.4
unset key
do for [panel in panels] {
   colon = strstrt(panel, ':')
   scene = panel[1:colon - 1]
   kind = panel[colon + 1:*]
   table = out.'/'.scene.'.dat'
   set title scene.': '.kind noenhanced font 'DejaVu Sans,10' offset 0,-0.5
   set ylabel 'error' offset 1.2,0
   plot for [i=1:words(methods)] table using (strcol(1) eq word(methods, i) ? column(5) : NaN):(column(kind)) \
      with linespoints linecolor rgb colour(i) linewidth (i == 1 ? 2.6 : 1.6) pointtype type(i) pointsize (i == 1 ? 1.2 : 1)
}
unset border
unset tics
unset grid
unset xlabel
unset ylabel
unset title
unset logscale
set key inside center center Left reverse samplen 3 spacing 1.4 font 'DejaVu Sans,11' noenhanced
set xrange [0:1]
set yrange [0:1]
plot for [i=1:words(methods)] '+' using (NaN):(NaN) with linespoints linecolor rgb colour(i) linewidth (i == 1 ? 2.6 : 1.6) \
   pointtype type(i) pointsize (i == 1 ? 1.2 : 1) title word(methods, i)
unset multiplot
unset output
