# Dissipated energy by its cause (Figs. 13 and 14 of the paper).
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/dissipation.gp     writes RESULT/dissipation.png
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
data = dir.'/energy.dat'

set terminal pngcairo size 1200,700 font font
set output dir.'/dissipation.png'
set key inside left top Left reverse box linecolor rgb '#d0d0d0' opaque height 0.3 width -1
set rmargin 4
set xrange [0:*]
time = 'time_scaled'

set title head_text(data, 'title') noenhanced font 'DejaVu Sans,14'
set ylabel energy_axis('energy', data)
set xlabel scaled_time_in(data)
set yrange [*<0:*]
curves = curve(data, 'Q_alpha/dE', 2, 'by viscosity, Q_α').curve(data, 'Q_delta/dE', 1, 'by density diffusion, Q_δ') \
         .curve(data, 'W_s/dE', 5, 'work of the walls, W_s').curve(data, 'W_f/dE', 6, 'work of the force, W_f') \
         .curve(data, 'W_solid/dE', 3, 'work of solids, W_{solid}').curve(data, 'Q_sponge/dE', 4, 'by sponges, Q_{sponge}') \
         .curve(data, 'Q_damper/dE', 8, 'by dampers, Q_{damper}')
# Where nothing dissipates and nothing works on the fluid, show what it has.
if (curves eq '') {
   curves = curve(data, '(E_M-E_M_rest)/dE', 7, 'mechanical energy, E_M − E_M^{rest}')
   set key bottom
}
if (has(data, 'Q_alpha/dE') && has(data, 'Q_delta/dE')) {
   plot data using (column(time)):(column("Q_alpha/dE") + column("Q_delta/dE")) with lines linetype 7 \
           title 'dissipated, Q = Q_α + Q_δ', @curves
} else {
   plot @curves
}
