# Vorticity of several snapshots below one another with one colour scale, from dynsph-spectra vorticity --field.
#
# usage: gnuplot -e "tables='A.dat B.dat'; labels='A B'; png='FILE.png'" utils/plots/vorticity_fields.gp
#
# limit: largest |vorticity| of the colours, in the units of the run; the same for all. top: largest y shown. labels: one word each,
# '_' for a blank.
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
if (!exists("labels")) labels = tables
if (!exists("png")) png = 'vorticity_fields.png'
if (!exists("limit")) limit = 10
unset datafile
set datafile commentschars '#'
set datafile missing 'NaN'
n = words(tables)
label(i) = system("echo '".word(labels, i)."' | tr _ ' '")
number(i, key, k) = real(word(head_text(word(tables, i), key), k))
columns_in(i) = int(system("awk '!/^#/ { print NF; exit }' '".word(tables, i)."'"))
rows_in(i) = int(system("grep -vc '^#' '".word(tables, i)."'"))

# One frame for all.
x_min = y_min = 1e30; x_max = y_max = -1e30
do for [i=1:n] {
   step = number(i, 'spacing', 1)
   x0 = number(i, 'lower', 1) - step/2; x1 = x0 + step*columns_in(i)
   y0 = number(i, 'lower', 2) - step/2; y1 = y0 + step*rows_in(i)
   if (x0 < x_min) { x_min = x0 }
   if (x1 > x_max) { x_max = x1 }
   if (y0 < y_min) { y_min = y0 }
   if (y1 > y_max) { y_max = y1 }
}
if (exists("top") && y_max > top) { y_max = top }
frame_x = 1170; frame_y = int(frame_x*(y_max - y_min)/(x_max - x_min)) + 1
left = 80; right = 150; above = 34; below = 10; foot = 44
size_y = n*(frame_y + above + below) + foot
set terminal pngcairo size left + frame_x + right, size_y font font
set output png
set multiplot
unset key
unset grid
set border 15
set tics scale 0.4
set xrange [x_min:x_max]
set yrange [y_min:y_max]
set cbrange [-limit:limit]
set palette defined (-1 '#2166ac', -0.5 '#92c5de', 0 '#f7f7f7', 0.5 '#f4a582', 1 '#b2182b')
set cblabel 'ω'
set ytics autofreq
do for [i=1:n] {
   bottom = foot + (n - i)*(frame_y + above + below) + below
   set lmargin at screen 1.0*left/(left + frame_x + right)
   set rmargin at screen 1.0*(left + frame_x)/(left + frame_x + right)
   set bmargin at screen 1.0*bottom/size_y
   set tmargin at screen 1.0*(bottom + frame_y)/size_y
   set colorbox user origin screen 1.0*(left + frame_x + 18)/(left + frame_x + right), screen 1.0*bottom/size_y \
      size screen 16.0/(left + frame_x + right), screen 1.0*frame_y/size_y
   set title sprintf('%s     t = %.2f', label(i), number(i, 'time', 1)) noenhanced offset 0,-0.6
   foot_label = i == n ? 'x' : ''
   set xlabel foot_label offset 0,0.4
   if (i == n) { set format x '%g' } else { set format x '' }
   set ylabel 'y' offset 1,0
   step = number(i, 'spacing', 1)
   x0 = number(i, 'lower', 1); y0 = number(i, 'lower', 2)   # not in `using`: it would be looked up for each point
   plot word(tables, i) matrix using (x0 + step*$1):(y0 + step*$2):3 with image
}
unset multiplot
