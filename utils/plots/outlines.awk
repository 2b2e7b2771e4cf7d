# Corners of the solids in the head of a table of dynsph-snapshot-to-text, below a line of names, a blank line behind each solid.
#
# usage: awk [-v frame='LEFT RIGHT LOWER UPPER'] -f outlines.awk TABLE
#
# With a frame only what of each solid is in it: gnuplot 5.4 itself cuts areas wrongly.
BEGIN { print "x y"; sides = split(frame, edge, " ") }
/^[^#]/ { exit }
$2 == "outline" {
   if ($4 != name) draw()
   name = $4
   n++
   x[n] = $5
   y[n] = $6
}
END { draw() }

function draw(    k) {
   for (k = 1; k <= sides; k++) cut(k > 2, edge[k], k % 2 ? 1 : -1)
   for (k = 1; k <= n; k++) print x[k], y[k]
   if (n > 0) print ""
   n = 0
}
# Leaves what is on the inner side of a line across an axis.
function cut(upright, at, inwards,    k, next_one, a, b, old_n, old_x, old_y) {
   for (k = 1; k <= n; k++) { old_x[k] = x[k]; old_y[k] = y[k] }
   old_n = n
   n = 0
   for (k = 1; k <= old_n; k++) {
      next_one = k % old_n + 1
      a = inwards*((upright ? old_y[k] : old_x[k]) - at)
      b = inwards*((upright ? old_y[next_one] : old_x[next_one]) - at)
      if (a >= 0) { n++; x[n] = old_x[k]; y[n] = old_y[k] }
      if (a*b < 0) {
         n++
         x[n] = (old_x[k]*b - old_x[next_one]*a)/(b - a)
         y[n] = (old_y[k]*b - old_y[next_one]*a)/(b - a)
      }
   }
}
