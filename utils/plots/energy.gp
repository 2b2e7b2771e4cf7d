# Energies against time, as shares of the energy the flow can lose (Figs. 9 and 12 of the paper).
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/energy.gp     writes RESULT/energy.png
if (!exists("plots")) plots = 'utils/plots'
load plots.'/style.gp'
data = dir.'/energy.dat'

set terminal pngcairo size 1200,700 font font
set output dir.'/energy.png'
set title head_text(data, 'title') noenhanced font 'DejaVu Sans,14'
set xlabel scaled_time
set ylabel 'energy / ΔE_M^{tot}'
set xrange [0:*]
set yrange [*<0:*]
set key inside right top box linecolor rgb '#d0d0d0' opaque height 0.3 width -1
set rmargin 4
set xzeroaxis linetype 1 linecolor rgb '#a0a0a0'

time = 'time_scaled'
plot data using (column(time)):(column("(E_M-E_M_rest)/dE")) with lines linetype 7 title 'mechanical, E_M − E_M^{rest}', \
     data using (column(time)):(column("E_K/dE")) with lines linetype 2 title 'kinetic, E_K', \
     data using (column(time)):(column("(E_P-E_P_rest)/dE")) with lines linetype 1 title 'potential, E_P − E_P^{rest}', \
     data using (column(time)):(column("(E_C-E_C_rest)/dE")) with lines linetype 3 title 'elastic, E_C − E_C^{rest}'
