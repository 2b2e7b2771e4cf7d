# How extreme and stiff runs end, a row for each sweep, by utils/studies/stability.
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/stability_scenes.gp     writes RESULT/stability_scenes.png from RESULT/cases.txt
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
set datafile nocolumnheaders
cases = dir.'/cases.txt'

# Row and place in the row of each case.
places = "awk '!($1 in row) { row[$1] = rows++ } { print row[$1], n[$1]++, $2, $3, $1 }' ".cases
rows = system("awk '!n[$1]++ { rows++ } END { print rows }' ".cases) + 0
widest = system("awk '{ if (++n[$1] > most) most = n[$1] } END { print most }' ".cases) + 0
colour(class) = class eq 'stable' ? 0x9fd5c1 : class eq 'noisy' ? 0xf5d58c : class eq 'ended' ? 0xa9cfe8 : 0xd55e00

set terminal pngcairo size 1100,120 + 27*rows font 'DejaVu Sans,11'
set output dir.'/stability_scenes.png'
set title 'Each cell is a run, with the value that was varied' font 'DejaVu Sans,12' offset 0,1.6
set tmargin 5
set key at graph 0.5,1.005 center bottom horizontal Left reverse samplen 1 width 1
unset grid
set border 0
unset xtics
set xrange [-0.5:widest - 0.5]
set yrange [rows - 0.5:-0.5]
set style fill solid noborder
set ytics scale 0 noenhanced
plot '< '.places using 2:1:(0.46):(0.42):(colour(strcol(4))):ytic(5) with boxxyerror linecolor rgb variable notitle, \
   '< '.places using 2:1:3 with labels font 'DejaVu Sans,10' noenhanced notitle, \
   1/0 with boxes linecolor rgb 0x9fd5c1 title 'stable', 1/0 with boxes linecolor rgb 0xf5d58c title 'noisy', \
   1/0 with boxes linecolor rgb 0xa9cfe8 title 'ended with a message', 1/0 with boxes linecolor rgb 0xd55e00 title 'BAD'
unset output
