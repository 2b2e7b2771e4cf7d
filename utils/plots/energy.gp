# Energies against time, as shares of the energy the flow can lose (Figs. 9 and 12 of the paper).
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/energy.gp     writes RESULT/energy.png
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
data = dir.'/energy.dat'

set terminal pngcairo size 1200,700 font font
set output dir.'/energy.png'
set title head_text(data, 'title') noenhanced font 'DejaVu Sans,14'
set xlabel scaled_time_in(data)
set ylabel energy_axis('energy', data)
set xrange [0:*]
set yrange [*<0:*]
set key outside above center horizontal Left reverse   # no corner is empty in all scenes
set rmargin 4
set xzeroaxis linetype 1 linecolor rgb '#a0a0a0'

eval 'plot '.curve(data, '(E_M-E_M_rest)/dE', 7, 'mechanical, E_M − E_M^{rest}') \
            .curve(data, 'E_K/dE', 2, 'kinetic, E_K') \
            .curve(data, '(E_P-E_P_rest)/dE', 1, 'potential, E_P − E_P^{rest}') \
            .curve(data, '(E_C-E_C_rest)/dE', 3, 'elastic, E_C − E_C^{rest}') \
            .curve(data, '(E_body-E_body_0)/dE', 5, 'of free bodies, E_{body} − E_{body}(0)')
