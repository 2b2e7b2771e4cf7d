# Particles of one snapshot coloured by speed and by pressure, or by other fields; outlines of solids.
#
# usage: gnuplot -e "dir='RESULT'" utils/plots/field.gp      the last snapshot, as RESULT/field.png
#
# Optional settings in -e:
#   snapshot='FILE.vtkhdf'    another snapshot                 png='FILE.png'     another picture
#   panels='velocity pressure'  names of arrays to colour by, vectors by magnitude
#   x_min=, x_max=, y_max=    the same frame for several pictures
#   low_NAME=, high_NAME=     the ends of the colours of NAME, in the snapshot's units; of vorticity the larger, both ways
#   delay=N                   an animated GIF, N/100 s for each picture; each time this script is loaded adds one
#   table='FILE.txt'          an already converted snapshot    converter='...'    dynsph-snapshot-to-text
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
# In the checkout's build, where it was installed with this script, or on the PATH.
if (!exists("converter")) converter = system("PATH='".plots."/../../build/bin:".plots."/../../../bin':$PATH; " \
   ."command -v dynsph-snapshot-to-text || echo dynsph-snapshot-to-text")
if (!exists("png")) png = dir.'/field.png'
if (!exists("panels")) panels = 'velocity pressure'
temporary = ''
if (!exists("table")) {
   if (!exists("snapshot")) { snapshot = system("ls '".dir."'/snapshot_??????.vtkhdf | tail -n 1") }
   temporary = system('mktemp')
   table = temporary
   error = system("'".converter."' '".snapshot."' '".table."' 2>&1")
   if (strlen(error) > 0) { remove = system("rm -f '".temporary."'"); print error; exit status 3 }
}

g = real(head_text(table, 'gravity'))
d = real(head_text(table, 'reference_length'))
rho = real(head_text(table, 'density'))
dx = real(head_text(table, 'spacing'))
time = real(head_text(table, 'time'))
names = system("sed -n '/^[^#]/{p;q}' '".table."'")
number(name) = sum [k=1:words(names)] (word(names, k) eq name ? k : 0)
range(name, k) = real(word(head_text(table, 'range of '.name), k))   # smallest, largest, mean, deviation
xc = number('x'); yc = number('y')
scaled = g > 0 && d > 0                # otherwise quantities are shown as they are
if (!scaled) { d = 1; g = 1; rho = 1 }

if (!exists("x_min")) x_min = (range('x', 1) - 0.5*dx)/d
if (!exists("x_max")) x_max = (range('x', 2) + 0.5*dx)/d
if (!exists("y_min")) y_min = (range('y', 1) - 0.5*dx)/d
if (!exists("y_max")) y_max = (range('y', 2) + 0.5*dx)/d
margin = 0.01*(x_max - x_min)
wide = x_max - x_min + 2*margin
high = y_max - y_min + 2*margin

# Pixels: one unit of length is the same in both directions and in all panels. Wide frames stand one above the
# other, high ones in two columns.
left = 80; right = 150; above = 50; below = 34; foot = 26
n = words(panels)
columns = n > 1 && high > 0.5*wide ? 2 : 1
rows = (n + columns - 1)/columns
animated = exists("delay")
frame_x = animated ? (columns == 1 ? 730 : 400) : columns == 1 ? 1170 : 720
frame_y = int(frame_x*high/wide)
if (frame_y > 900) { frame_x = int(900.0*frame_x/frame_y); frame_y = 900 }
if (frame_x < 400) { frame_x = 400 }
size_x = columns*(left + frame_x + right)
size_y = rows*(frame_y + above + below) + foot

# Quantities by their name: how they are labelled and what they are divided by.
label(name) = name eq 'velocity' ? (scaled ? '|u| / √(gd)' : '|u|') : name eq 'pressure' ? (scaled ? 'p / (ρ_0 g d)' : 'p') \
   : name eq 'vorticity' ? (scaled ? 'ω √(d/g)' : 'ω') : name eq 'dissipation' ? (scaled ? 'Q_i / (ρ_0 g d dx^2)' : 'Q_i / dx^2') \
   : name eq 'density' ? (scaled ? 'ρ / ρ_0' : 'ρ') : name eq 'alpha' ? 'α_i' : name eq 'delta' ? 'δ_i' : name
scale_of(name) = name eq 'velocity' ? sqrt(g*d) : name eq 'pressure' ? rho*g*d : name eq 'vorticity' ? sqrt(g/d) \
   : name eq 'dissipation' ? rho*g*d*dx**2 : name eq 'density' ? rho : 1.0
heading = head_text(table, 'title')
if (scaled) { heading = heading.sprintf('     t √(g/d) = %.2f', time*sqrt(g/d)) } else { heading = heading.sprintf('     t = %.4g', time) }

if (!animated) { set terminal pngcairo size size_x,size_y font font; set output png }
if (animated && !exists("begun")) {
   set terminal gif animate delay delay loop 0 size size_x,size_y font font
   set output png
   begun = 1
}
set multiplot
unset key
unset grid
set border 15
set xrange [x_min - margin:x_max + margin]
set yrange [y_min - margin:y_max + margin]
set style fill solid noborder

# Discs of the particle's size; below about two pixels they cost time and show no more than a dot does. A GIF has hard edges: small
# discs are squares there, and quicker. It knows one palette, not one for each panel; so its colours are given by red, green and blue.
pixels = frame_x*dx/d/wide
shades = 120/n   # of the 256 colours of a GIF, half of which gnuplot keeps for others
shape = animated && pixels <= 3 ? '(0.5*dx/d):(0.5*dx/d):' : pixels > 2 ? '(0.56*dx/d):' : ''
style = animated && pixels <= 3 ? 'boxxyerror' : pixels > 2 ? 'circles' : pixels > 0.6 ? 'points pointtype 7 pointsize 0.22' : 'dots'
colour = animated ? '(palette(column(place)/scale)) with '.style.' linecolor rgb variable' \
   : '(column(place)/scale) with '.style.' linecolor palette'
# Solids: grey below the fluid, the outline above it.
corners(frame) = "'< awk ".frame." -f ''".plots."/outlines.awk'' ''".table."''' using ($1/d):($2/d) "
frame = sprintf("-v frame=''%.9g %.9g %.9g %.9g''", d*(x_min - margin), d*(x_max + margin), d*(y_min - margin), d*(y_max + margin))
solid = strlen(head_text(table, 'outline of .*')) > 0
areas = solid ? corners(frame)."with filledcurves closed fillcolor rgb '#e4e4e4', " : ''
outlines = solid ? ', '.corners('').'with lines linewidth 1.5 linecolor rgb black' : ''
set clip two   # of an edge both ends may be outside
do for [i=1:n] {
   name = word(panels, i)
   row = (i - 1)/columns
   start = left + ((i - 1)%columns)*(left + frame_x + right)
   bottom = foot + (rows - 1 - row)*(frame_y + above + below) + below
   set lmargin at screen 1.0*start/size_x
   set rmargin at screen 1.0*(start + frame_x)/size_x
   set bmargin at screen 1.0*bottom/size_y
   set tmargin at screen 1.0*(bottom + frame_y)/size_y
   set colorbox user origin screen 1.0*(start + frame_x + 18)/size_x, screen 1.0*bottom/size_y \
      size screen 16.0/size_x, screen 1.0*frame_y/size_y
   place = number(name)
   scale = scale_of(name)
   if (place == 0) {
      print sprintf("%s: no '%s' in this snapshot", png, name)
      continue
   }
   # A few extreme particles must not take all the colours.
   smallest = range(name, 1)/scale; largest = range(name, 2)/scale
   mean = range(name, 3)/scale; spread = 3*range(name, 4)/scale
   low = mean - spread > smallest ? mean - spread : smallest
   high_end = mean + spread < largest ? mean + spread : largest
   # Below a free surface in a field of gravity the colours begin at no pressure, elsewhere suction is of interest.
   if (low < 0.2*high_end && (smallest >= 0 || (name eq 'pressure' && scaled))) { low = 0 }
   if (exists('low_'.name)) { low = value('low_'.name)/scale }
   if (exists('high_'.name)) { high_end = value('high_'.name)/scale }
   if (name eq 'vorticity') {
      # White is no rotation, red anticlockwise, blue clockwise.
      high_end = abs(low) > abs(high_end) ? abs(low) : abs(high_end)
      if (high_end == 0) { high_end = 1 }
      low = -high_end
      set palette defined (-1 '#2166ac', -0.5 '#92c5de', 0 '#f7f7f7', 0.5 '#f4a582', 1 '#b2182b')
   } else {
      eval viridis
   }
   if (animated) { set palette maxcolors shades }
   # All the same: a range that has a width nevertheless.
   if (high_end <= low) { high_end = low + (low == 0 ? 1 : 0.1*abs(low)) }
   set cbrange [low:high_end]
   set cblabel label(name) offset 0.5,0
   set title heading noenhanced font 'DejaVu Sans,14' offset 0,-0.3
   if (i > 1) { unset title }
   set size ratio -1
   set xtics scale 0.4
   if (high < 1) { set ytics 0.2 scale 0.4 } else { set ytics scale 0.4 }
   bottom_label = i > n - columns ? (scaled ? 'x / d' : 'x') : ''
   set xlabel bottom_label offset 0,0.3
   set ylabel scaled ? 'y / d' : 'y' offset 1,0
   eval 'plot '.areas.'table using (column(xc)/d):(column(yc)/d):'.shape.colour.outlines
   if (animated) {
      # The box of colours, as a plot beside the panel.
      set lmargin at screen 1.0*(start + frame_x + 18)/size_x
      set rmargin at screen 1.0*(start + frame_x + 34)/size_x
      unset title; unset xlabel; unset ylabel
      set format x ''; set format y ''; set xtics scale 0; set ytics scale 0
      set size noratio
      set y2tics out scale 0.4 textcolor rgb '#202020'
      set y2label label(name) offset 0.5,0
      set y2range [low:high_end]
      half = 0.5*(high_end - low)/shades
      set samples shades + 1   # the first is taken for a row of names
      plot [0:1][low:high_end] '+' using (0.5):(low + (2*$0 + 1)*half):(0.5):(half):(palette(low + (2*$0 + 1)*half)) \
         with boxxyerror fillcolor rgb variable
      unset y2tics; unset y2label; set format x; set format y
   }
}
unset multiplot
if (!animated) { unset output }
if (strlen(temporary) > 0) { remove = system("rm -f '".temporary."'") }
