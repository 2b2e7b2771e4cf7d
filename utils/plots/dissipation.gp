# Dissipated energy by its cause, and how well the budget closes (Figs. 13, 14 and 16 of the paper).
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/dissipation.gp     writes RESULT/dissipation.png
if (!exists("plots")) plots = 'utils/plots'
load plots.'/style.gp'
data = dir.'/energy.dat'

set terminal pngcairo size 1200,900 font font
set output dir.'/dissipation.png'
set multiplot
set key inside left top Left reverse box linecolor rgb '#d0d0d0' opaque height 0.3 width -1
set lmargin at screen 0.1
set rmargin at screen 0.965
set xrange [0:*]
time = 'time_scaled'

set tmargin at screen 0.94
set bmargin at screen 0.42
set title head_text(data, 'title') noenhanced font 'DejaVu Sans,14'
set ylabel energy_axis('energy', data)
set format x ''
set yrange [*<0:*]
curves = curve(data, 'Q_alpha/dE', 2, 'by viscosity, Q_α').curve(data, 'Q_delta/dE', 1, 'by density diffusion, Q_δ') \
         .curve(data, 'W_s/dE', 5, 'work of the walls, W_s').curve(data, 'W_f/dE', 6, 'work of the force, W_f')
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

set tmargin at screen 0.39
set bmargin at screen 0.08
unset title
set format x '%g'
set xlabel scaled_time_in(data)
set ylabel energy_axis('|error|', data)
set logscale y
set format y '10^{%L}'
set key bottom right
positive(value) = value > 0 ? value : NaN    # a logarithmic axis has no zero
largest_error = system("awk '!/^#/ && !column { for (k = 1; k <= NF; k++) if ($k == \"balance_error/dE\") column = k; next } \
   column { e = $column < 0 ? -$column : $column; if (e > most) most = e } END { print most + 0 }' '".data."'") + 0
# Errors of a few 1e-8 to 1, or whatever smaller ones there are.
set yrange [largest_error > 1e-7 || largest_error <= 0 ? 1e-8 : 1e-3*largest_error:1]
plot data using (column(time)):(positive(abs(column("balance_error/dE")))) with lines linetype 4 title 'error of the energy balance', \
     5e-3 with lines linetype 1 linewidth 1 linecolor rgb '#808080' dashtype 2 title '0.5 %'
unset multiplot
set key inside left top Left reverse box linecolor rgb '#d0d0d0' opaque height 0.3 width -1
