# Energies of the oscillating drop with those published by Antuono et al. 2015, by utils/studies/drop_energies.
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/drop_energies.gp     writes RESULT/drop_energies.png
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
set terminal pngcairo size 1100,620 font font
set output dir.'/drop_energies.png'
set xlabel 't / T'
set ylabel 'change of energy / (E_K + E_P) at t = 0'
set format y '%.3f'
set xzeroaxis linetype 1 linecolor rgb '#a0a0a0'
table = dir.'/energies.dat'
plot table using 1:(column('dE_C')) with lines linetype 1 title 'E_C', \
   table using 1:(column('dE_C_published')) with points linetype 1 pointtype 6 title 'Antuono et al. 2015', \
   table using 1:(column('dE_M')) with lines linetype 2 title 'E_K + E_P', \
   table using 1:(column('dE_M_published')) with points linetype 2 pointtype 6 notitle, \
   table using 1:(column('minus_Q_delta')) with lines linetype 3 title '-Q_δ', \
   table using 1:(column('minus_Q_delta_published')) with points linetype 3 pointtype 6 notitle
