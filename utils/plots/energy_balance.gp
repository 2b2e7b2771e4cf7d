# How well the energy budget closes (as Fig. 16 of the paper): one result, or a panel for each of several.
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/energy_balance.gp     writes RESULT/energy_balance.png
#        gnuplot -e "dirs='RESULT RESULT ...'; png='PICTURE'" utils/plots/energy_balance.gp
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
single = exists("dir")
if (single) { dirs = dir; png = dir.'/energy_balance.png' }
name_of(i) = single ? dir : word(dirs, i)   # a name alone may have blanks
n = single ? 1 : words(dirs)
columns = n == 1 ? 1 : n <= 12 ? 4 : 6
rows = (n + columns - 1)/columns
width = single ? 1200 : 330*columns
height = single ? 600 : 300*rows

set terminal pngcairo size width,height font single ? font : 'DejaVu Sans,10'
set output png
set multiplot layout rows,columns margins (single ? 120.0 : 80.0)/width,1 - 25.0/width,(single ? 75.0 : 55.0)/height, \
   1 - (single ? 50.0 : 30.0)/height \
   spacing 62.0/width,78.0/height
positive(value) = value > 0 ? value : NaN    # a logarithmic axis has no zero
set logscale y
set format y '10^{%L}'
set key bottom right inside opaque
do for [i=1:n] {
   data = name_of(i).'/energy.dat'
   set title head_text(data, 'title') noenhanced font single ? 'DejaVu Sans,14' : 'DejaVu Sans,10' offset 0,single ? 0 : -0.5
   set xlabel scaled_time_in(data) offset 0,single ? 0 : 0.5
   unset ylabel
   if (single) { set ylabel energy_axis('|error of the balance|', data) }
   if (!single && i%columns == 1) { set ylabel '|error|' offset 1,0 }
   largest_error = system("awk '!/^#/ && !column { for (k = 1; k <= NF; k++) if ($k == \"balance_error/dE\") column = k; next } \
      column { e = $column < 0 ? -$column : $column; if (e > most) most = e } END { print most + 0 }' '".data."'") + 0
   # Errors of a few 1e-8 to 1, or whatever smaller ones there are.
   set xrange [0:*]
   set yrange [single && largest_error <= 1e-7 && largest_error > 0 ? 1e-3*largest_error : 1e-8:1]
   if (!single) {
      set yrange [1e-10:1]
      unset key
      # Few ticks: a panel is narrow.
      last = system("tail -n 1 '".data."' | awk '{ print $2 }'") + 0
      step = last > 0 ? 10**floor(log10(last/2)) : 1
      set xtics step*(last > 10*step ? 5 : last > 5*step ? 2 : 1)
      set label 1 sprintf('at most %.1e', largest_error) at graph 0.97,0.07 right front
   }
   plot data using (column('time_scaled')):(positive(abs(column('balance_error/dE')))) with lines linetype 4 \
           title 'error of the energy balance', \
        5e-3 with lines linetype 1 linewidth 1 linecolor rgb '#808080' dashtype 2 title '0.5 %'
}
unset multiplot
