# Heights of regular waves at the gauges of a probes.dat, and what of them runs back.
#
# usage: awk -v period=T -v depth=H [-v gravity=1] -v from=TIME -v to=TIME [-v height="LEAST MOST" -v reflected=MOST] -v gauges="NAME ..." \
#           -f utils/studies/waves.awk DIR/probes.dat
#
# Prints for each gauge (&gauge along = 'y') its place, the mean level, the height of the first and of the second harmonic: least
# squares over the times asked for, of whole periods. Then the height of the waves that run to the right and the share that comes
# back, by least squares over all gauges with the wave number of w**2 = g k tanh(k h) (Goda & Suzuki 1976, Mansard & Funke 1980);
# gauges half a wave length apart cannot tell them apart. Status 1 if that height is not from LEAST to MOST, or that share larger.
BEGIN {
   if (gravity == "") gravity = 1
   w = 8*atan2(1, 1)/period
   k = w*w/gravity
   for (i = 0; i < 200; i++) k = (k + w*w/gravity/tanh(k*depth))/2
   n = split(gauges, name, " ")
}
function tanh(x) { return (1 - exp(-2*x))/(1 + exp(-2*x)) }
$2 == "gauge" { place[$3] = $7 }
/^#/ { next }
!named { for (i = 1; i <= NF; i++) column[$i] = i; named = 1; next }
$column["time"] < from || $column["time"] > to { next }
{
   t = $column["time"]
   rows++
   basis[1] = 1; basis[2] = cos(w*t); basis[3] = sin(w*t); basis[4] = cos(2*w*t); basis[5] = sin(2*w*t)
   for (i = 1; i <= 5; i++) {
      for (j = 1; j <= 5; j++) matrix[i, j] += basis[i]*basis[j]
      for (g = 1; g <= n; g++) right[i, g] += basis[i]*$column[name[g]]
   }
}
# Of matrix x = right, for all gauges at once; the matrix is positive definite.
function solve(   i, j, l, factor) {
   for (l = 1; l <= 5; l++) for (i = 1; i <= 5; i++) {
      if (i == l) continue
      factor = matrix[i, l]/matrix[l, l]
      for (j = l; j <= 5; j++) matrix[i, j] -= factor*matrix[l, j]
      for (g = 1; g <= n; g++) right[i, g] -= factor*right[l, g]
   }
   for (g = 1; g <= n; g++) for (i = 1; i <= 5; i++) x[i, g] = right[i, g]/matrix[i, i]
}
END {
   if (rows < 20) { print "only " rows + 0 " rows from " from " to " to; exit 1 }
   solve()
   for (g = 1; g <= n; g++) {
      printf "%s x %g mean %.5f height %.5f second %.5f\n", name[g], place[name[g]], x[1, g], 2*sqrt(x[2, g]^2 + x[3, g]^2), \
         2*sqrt(x[4, g]^2 + x[5, g]^2)
      # level = Re(A exp(i w t)), A = x2 - i x3 = a exp(-i k X) + b exp(i k X)
      c = cos(k*place[name[g]]); s = sin(k*place[name[g]])
      sum_c += c*c - s*s; sum_s += 2*c*s
      forth_re += c*x[2, g] + s*x[3, g]; forth_im += s*x[2, g] - c*x[3, g]
      back_re += c*x[2, g] - s*x[3, g]; back_im += -s*x[2, g] - c*x[3, g]
   }
   # n a + S b = forth, conj(S) a + n b = back
   det = n*n - sum_c^2 - sum_s^2
   a_re = (n*forth_re - (sum_c*back_re - sum_s*back_im))/det
   a_im = (n*forth_im - (sum_c*back_im + sum_s*back_re))/det
   b_re = (n*back_re - (sum_c*forth_re + sum_s*forth_im))/det
   b_im = (n*back_im - (sum_c*forth_im - sum_s*forth_re))/det
   found = 2*sqrt(a_re^2 + a_im^2)
   printf "wave length %.5f, height %.5f, reflected %.4f\n", 8*atan2(1, 1)/k, found, 2*sqrt(b_re^2 + b_im^2)/found
   if (height == "") exit 0
   split(height, wanted, " ")
   exit !(found >= wanted[1] + 0 && found <= wanted[2] + 0 && (reflected == "" || 2*sqrt(b_re^2 + b_im^2) <= reflected*found))
}
