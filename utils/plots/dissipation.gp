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
set lmargin at screen 0.085
set rmargin at screen 0.965
set xrange [0:*]
time = 'time_scaled'

set tmargin at screen 0.94
set bmargin at screen 0.42
set title head_text(data, 'title') noenhanced font 'DejaVu Sans,14'
set ylabel 'energy / ΔE_M^{tot}'
set format x ''
set yrange [*<0:*]
plot data using (column(time)):(column("Q_alpha/dE") + column("Q_delta/dE")) with lines linetype 7 title 'dissipated, Q = Q_α + Q_δ', \
     data using (column(time)):(column("Q_alpha/dE")) with lines linetype 2 title 'by viscosity, Q_α', \
     data using (column(time)):(column("Q_delta/dE")) with lines linetype 1 title 'by density diffusion, Q_δ', \
     data using (column(time)):(column("W_s/dE")) with lines linetype 5 title 'work of the walls, W_s'

set tmargin at screen 0.39
set bmargin at screen 0.08
unset title
set format x '%g'
set xlabel scaled_time
set ylabel '|error| / ΔE_M^{tot}'
set logscale y
set format y '10^{%L}'
set key bottom right
set yrange [1e-8:1]
positive(value) = value > 0 ? value : NaN    # a logarithmic axis has no zero
plot data using (column(time)):(positive(abs(column("balance_error/dE")))) with lines linetype 4 title 'error of the energy balance', \
     5e-3 with lines linetype 1 linewidth 1 linecolor rgb '#808080' dashtype 2 title '0.5 %'
unset multiplot
set key inside left top Left reverse box linecolor rgb '#d0d0d0' opaque height 0.3 width -1
