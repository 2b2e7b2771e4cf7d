# What all pictures share: fonts, colours that the colour-blind can tell apart, grid,
# and how a title is found. Loaded by the other scripts.
set encoding utf8
set datafile columnheaders          # columns are addressed by name: later ones may be added
set datafile missing 'NaN'

font = 'DejaVu Sans,13'
set border 3 linewidth 1 linecolor rgb '#404040'
set tics nomirror out scale 0.6 textcolor rgb '#202020'
set grid linetype 1 linewidth 0.6 linecolor rgb '#e0e0e0'
set key outside right top vertical Left reverse samplen 2.5 spacing 1.3

# Okabe and Ito's colours.
black  = '#202020'
blue   = '#0072b2'
red    = '#d55e00'
green  = '#009e73'
orange = '#e69f00'
purple = '#cc79a7'
sky    = '#56b4e9'
set linetype 1 linecolor rgb blue linewidth 1.8
set linetype 2 linecolor rgb red linewidth 1.8
set linetype 3 linecolor rgb green linewidth 1.8
set linetype 4 linecolor rgb purple linewidth 1.8
set linetype 5 linecolor rgb orange linewidth 1.8
set linetype 6 linecolor rgb sky linewidth 1.8
set linetype 7 linecolor rgb black linewidth 1.8

# viridis: equal steps of the quantity look equal, also in grey.
viridis = "set palette defined (0.00 '#440154', 0.125 '#472d7b', 0.25 '#3b528b', 0.375 '#2c728e', 0.50 '#21918c', \
   0.625 '#28ae80', 0.75 '#5ec962', 0.875 '#addc30', 1.00 '#fde725')"
eval viridis

# The value after '# key: ' in a file's head, '' when it is not there.
head_text(file, key) = system("sed -n -e '/^[^#]/q' -e 's/^# ".key.": *//p' '".file."'")
# How time is scaled in a table: the unit of its column time_scaled.
scaled_time_in(file) = system("sed -n -e '/^[^#]/q' -e 's/^# .* time_scaled \\[\\(.*\\)\\]$/\\1/p' '".file."' | sed -e 's/sqrt/√/' -e 's/ w$/ ω/'")
# Whether a table has a column; a scene has only those that it has something to say about.
column_names(file) = system("sed -n '/^[^#]/{p;q}' '".file."'")
has(file, name) = (sum [k=1:words(column_names(file))] (word(column_names(file), k) eq name)) > 0
# Part of a plot command for one column against time, with a comma behind it; '' where the table has no such column.
curve(file, name, style, label) = has(file, name) \
   ? sprintf("'%s' using (column('time_scaled')):(column('%s')) with lines linetype %d title '%s', ", file, name, style, label) : ''
# What energies are divided by, as an axis label: Delta E_Mtot, or the other measure that the head names.
scale_named_in(file) = system("sed -n -e '/^[^#]/q' -e 's/^# normalised by dE_Mtot = //p' '".file."'")
energy_axis(quantity, file) = (scale_named_in(file)[1:10] eq 'E_M(0) - E') ? quantity.' / ΔE_M^{tot}' \
   : (scale_named_in(file)[1:2] eq '1:') ? quantity : quantity.' / ('.scale_named_in(file).')'
