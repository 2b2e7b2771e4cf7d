# Growth on a still lattice over cfl and a coefficient, with the edges of linear theory and of the step rule, by
# utils/studies/stability.
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/stability_lattice.gp     writes RESULT/stability_lattice.png
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
set datafile nocolumnheaders
set terminal pngcairo size 1300,560 font 'DejaVu Sans,11'
set output dir.'/stability_lattice.png'
set multiplot layout 1,2
# Blue: dies out or stays; from yellow to red: grows, by the factor in a step.
colour(g) = g < 1.001 ? 0xa9cfe8 : g < 1.05 ? 0xf7e1a0 : g < 1.3 ? 0xf0b070 : 0xd55e00
set style fill solid noborder
unset grid
set ylabel 'cfl = dt c_0/h'
set yrange [0:3.3]
set bmargin 9
set key at screen 0.5,0.01 center bottom samplen 2 width 1 maxrows 4
set xrange [-0.025:0.625]
set xlabel 'δ, α = 0'
plot dir.'/map_delta.txt' using 1:3:(0.024):(0.094):(colour($5)) with boxxyerror linecolor rgb variable notitle, \
   1/0 with boxes linecolor rgb 0xa9cfe8 title 'stable', 1/0 with boxes linecolor rgb 0xf7e1a0 title 'growth < 5 % a step', \
   1/0 with boxes linecolor rgb 0xf0b070 title '< 30 %', 1/0 with boxes linecolor rgb 0xd55e00 title '> 30 %', \
   '< grep "^frozen" '.dir.'/edges.txt | awk "\$3 == 0"' using 2:4 with lines linecolor rgb 'black' linewidth 2 title 'theory', \
   '' using 2:5 with points pointtype 6 linecolor rgb 'black' title 'measured edge', \
   (x > 0.1264 ? 0.2644/x : 2.091) with lines linecolor rgb 'black' linewidth 1.5 dashtype 2 title 'step rule'
set xrange [-0.05:1.25]
set xlabel 'α, δ = 0'
plot dir.'/map_alpha.txt' using 2:3:(0.048):(0.094):(colour($5)) with boxxyerror linecolor rgb variable notitle, \
   '< grep "^frozen" '.dir.'/edges_alpha.txt | awk "\$2 == 0"' using 3:4 with lines linecolor rgb 'black' linewidth 2 notitle, \
   '' using 3:5 with points pointtype 6 linecolor rgb 'black' notitle, \
   (x > 0.2391 ? 0.5/x : 2.091) with lines linecolor rgb 'black' linewidth 1.5 dashtype 2 notitle
unset multiplot
unset output
