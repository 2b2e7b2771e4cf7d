# Enstrophy and kinetic energy against wavenumber, several snapshots together, from dynsph-spectra vorticity.
#
# usage: gnuplot -e "tables='A.dat B.dat'; labels='A B'; png='FILE.png'" utils/plots/vorticity_spectra.gp
#
# labels: one word each, '_' for a blank; the tables' names without it.
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
if (!exists("labels")) labels = tables
if (!exists("png")) png = 'vorticity_spectra.png'
n = words(tables)
label(i) = system("echo '".word(labels, i)."' | tr _ ' '")
k_kernel = head_text(word(tables, 1), 'kernel_wavenumbers')

set terminal pngcairo size 1500,700 font font
set output png
set multiplot layout 1,2
set logscale xy
set format y '10^{%L}'
set xlabel 'wavenumber'
set grid linetype 1 linewidth 0.6 linecolor rgb '#e0e0e0'
do for [i=1:2] {
   k = real(word(k_kernel, i))
   set arrow i from first k, graph 0 to first k, graph 1 nohead linecolor rgb '#808080' dashtype 2
   name = i == 1 ? 'π/(2h)' : 'π/h'
   set label name at first k, graph 0.97 right offset -0.3,0 textcolor rgb '#606060'
}
do for [panel=1:2] {
   set ylabel panel == 1 ? 'enstrophy spectrum' : 'kinetic energy spectrum'
   column_name = panel == 1 ? 'enstrophy_spectrum' : 'energy_spectrum'
   if (panel == 1) { unset key } else { set key outside right top }
   plot for [i=1:n] word(tables, i) using (column('wavenumber')):(column(column_name)) with lines linetype i title label(i)
}
unset multiplot
