# Power spectral density of probes, as dynsph-spectra probe writes it.
#
# usage: gnuplot -e "tables='RESULT/probe_spectrum.dat'" utils/plots/probe_spectra.gp
#
# writes probe_spectrum.png beside the first table. Optional settings in -e:
#   tables='A.dat B.dat'      several runs in one picture
#   labels='"α = 0" "dynamic"'  what to call them; else the name of their directory
#   probe='P1'                one probe of each table; else all
#   png='FILE.png'            another picture             title='...'    another heading
#   f_max=, f_min=            frequencies shown           s_max=, s_min=   densities shown
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
first = word(tables, 1)
folder(file) = system("cd \"$(dirname '".file."')\" && basename \"$(pwd -P)\"")
if (!exists("png")) png = system("dirname '".first."'").'/probe_spectrum.png'
if (!exists("title")) title = head_text(first, 'title')
if (!exists("labels")) { labels = ''; do for [k=1:words(tables)] { labels = labels.' "'.folder(word(tables, k)).'"' } }

# Densities are S_NAME; S_min_NAME and S_max_NAME, of several runs averaged, become a band.
densities(file) = system("sed -n '/^[^#]/{p;q}' '".file."' | tr -s ' ' '\\n' | grep '^S_' | grep -v -e '^S_min_' -e '^S_max_' | tr '\\n' ' '")
band(file, name) = has(file, 'S_min_'.name[3:])
unit = system("sed -n 's/^# *3  [^ ]* \\[\\(.*\\)\\]$/\\1/p' '".first."' | sed -e 's/\\^2/²/' -e 's/ / · /'")
scale = system("sed -n -e '/^[^#]/q' -e 's/^# .* frequency_scaled \\[\\(.*\\)\\]$/\\1/p' '".first."' | sed -e 's/sqrt/√/' -e 's/ w$/ ω/'")
ratio = real(word(system("awk '!/^#/ { n++ } n == 3 { print $2/$1; exit }' '".first."'"), 1))   # scaled frequency over frequency

set terminal pngcairo size 1200,760 font font
set output png
set logscale xy
set format x '10^{%T}'
set format y '10^{%T}'
set grid xtics ytics nomxtics
set xlabel 'frequency  '.scale
set ylabel 'power spectral density  ['.unit.']'
set style fill transparent solid 0.2 noborder
# From the lowest frequency above zero, or the lowest mode, to the highest of all tables.
f_L = ratio*real('0'.head_text(first, 'f_L'))
f_H = ratio*real('0'.head_text(first, 'f_H'))
limits = system("awk '!/^#/ && $2 + 0 > 0 { if (!n++) low = $2 + 0; if ($2 + 0 < low) low = $2 + 0; if ($2 + 0 > high) high = $2 + 0 } END { print low, high }' ".tables)
if (!exists("f_max")) f_max = real(word(limits, 2))
if (!exists("f_min")) {
   f_min = real(word(limits, 1))
   if (f_L > 0 && 0.8*f_L < f_min) { f_min = 0.8*f_L }
   if (f_H > 0 && 0.8*f_H < f_min) { f_min = 0.8*f_H }
}
set xrange [f_min:f_max]
if (exists("s_min") && exists("s_max")) set yrange [s_min:s_max]

title_offset = f_L > 0 || f_H > 0 ? 2.2 : 0.2
if (title_offset > 1) set tmargin 6
set title title noenhanced font 'DejaVu Sans,14' offset 0,title_offset

# Acoustic modes of the box and their multiples, labels above the frame, a row for each kind.
do for [kind in 'L H'] {
   mode = kind eq 'L' ? f_L : f_H
   colour = kind eq 'L' ? '#505050' : '#b06a20'
   do for [n=1:3] {
      f = n*mode
      if (f >= f_min && f <= f_max) {
         thickness = n == 1 ? 1.2 : 0.5
         name = n == 1 ? 'c_0/2'.kind : sprintf('×%d', n)
         height = kind eq 'L' ? 1.025 : 1.065
         set arrow from first f, graph 0 to first f, graph 1 nohead back linewidth thickness linecolor rgb colour
         set label name at first f, graph height center font 'DejaVu Sans,10' textcolor rgb colour
      }
   }
}

curves = ''
number = 0
do for [k=1:words(tables)] {
   file = word(tables, k)
   names = exists("probe") ? 'S_'.probe : densities(file)
   do for [name in names] {
      number = number + 1
      label = (words(tables) > 1 ? word(labels, k).'  ' : '').(words(names) > 1 || words(tables) == 1 ? name[3:] : '')
      if (band(file, name)) {
         curves = curves.sprintf("'%s' using (column('frequency_scaled')):(column('S_min_%s')):(column('S_max_%s')) with filledcurves linetype %d notitle, ", \
            file, name[3:], name[3:], number)
      }
      curves = curves.sprintf("'%s' using (column('frequency_scaled')):(column('%s')) with lines linetype %d linewidth 1.2 title \"%s\" noenhanced, ", \
         file, name, number, label)
   }
}
eval 'plot '.curves[:strlen(curves) - 2]
