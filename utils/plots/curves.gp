# Columns of several energy tables against time, a panel for each column.
#
# usage: gnuplot -e "tables='A/energy.dat B/energy.dat'; what='Q_alpha Q_delta Q'; png='FILE.png'" utils/plots/curves.gp
#
# what: columns; energies as shares of Delta E_M^tot, Q = Q_alpha + Q_delta. labels: one word a table, '_' for a blank. logarithmic=1:
# so the axes of the quantities. heading: above all. Q has the key, or the first panel.
if (!exists("plots")) plots = system("dirname '".ARG0."'")
load plots.'/style.gp'
if (!exists("labels")) labels = tables
n = words(tables)
panels = words(what)
columns = panels < 3 ? panels : panels == 4 ? 2 : 3
rows = (panels + columns - 1)/columns
label(i) = system("echo '".word(labels, i)."' | tr _ ' '")
# Those of seven and more are told apart by dashes.
colours = blue.' '.red.' '.green.' '.purple.' '.orange.' '.sky.' '.black
do for [k=1:7] { set linetype 7 + k linecolor rgb word(colours, k) linewidth 1.8 dashtype 2 }

# A column as gnuplot names it; what a run does not have is nothing: Q_alpha of a run without viscosity.
share(name) = name[1:2] eq 'Q_' ? name.'/dE' : name
term(file, name) = has(file, share(name)) ? sprintf("column('%s')", share(name)) : '0'
quantity(file, name) = name eq 'Q' ? term(file, 'Q_alpha').'+'.term(file, 'Q_delta') : has(file, share(name)) ? term(file, name) : 'NaN'
axis(name) = name eq 'Q' ? 'Q / ΔE_M^{tot}' : name eq 'Q_alpha' ? 'Q_α / ΔE_M^{tot}' : name eq 'Q_delta' ? 'Q_δ / ΔE_M^{tot}' \
   : name eq 'density_variation' ? '|ρ − ρ_0| / ρ_0' : name eq 'alpha_mean' ? 'mean α_i' : name eq 'alpha_max' ? 'largest α_i' \
   : name eq 'delta_mean' ? 'mean δ_i' : name eq 'delta_max' ? 'largest δ_i' : name

set terminal pngcairo size (columns == 1 ? 1100 : 250 + 550*columns),60 + 520*rows font font
set output png
set multiplot layout rows,columns title (exists("heading") ? heading : '') font 'DejaVu Sans,14'
set xlabel scaled_time_in(word(tables, 1))
key_panel = word(what, panels) eq 'Q' ? 'Q' : word(what, 1)
if (exists("logarithmic")) { set logscale y }
do for [name in what] {
   set ylabel axis(name)
   if (exists("logarithmic")) { set yrange [1e-4:1]; set key inside right bottom } else { set yrange [0:*]; set key inside left top }
   if (name eq 'density_variation' || name eq 'alpha_mean') { set key inside right top }
   if (name eq 'Q' && !exists("logarithmic")) { set key inside right bottom }
   if (name ne key_panel) { unset key }
   curves = ''
   do for [i=1:n] {
      what_it_is = quantity(word(tables, i), name)
      if (what_it_is ne 'NaN') {
         curves = curves.sprintf("'%s' using (column('time_scaled')):(%s) with lines linetype %d title '%s', ", word(tables, i), \
            what_it_is, i, label(i))
      }
   }
   eval 'plot '.curves[:strlen(curves) - 2]
}
unset multiplot
