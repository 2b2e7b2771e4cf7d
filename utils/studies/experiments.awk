# Numbers of curves, for utils/studies/experiments.
#
# usage: awk -v task=TASK [-v width=W] [-v from=T] [-v to=T] [-v level=VALUE] -f experiments.awk [FILE...]
#
# curve: t, value in; t, value and the moving mean over W out, with a line of names. Of a file of this kind: reaches (the
# time of a level), peak, mean_peak, plateau. Of a measured one and a computed one: rms, largest, shift, rms_shifted, all at
# the measured times, or with _even at even ones and of the moving means. Of the band's lower end, a computed curve
# and the upper end: inside. FROM and TO limit the time. A number that there is not is 'none'.
FNR == 1 { f++ }
/^[-+0-9.]/ {
   # Digitised curves have points at the same time, one above the other.
   if (n[f] && $1 <= t[f, n[f]]) $1 = t[f, n[f]] + 1e-6
   n[f]++
   t[f, n[f]] = $1; value[f, n[f]] = $2; mean[f, n[f]] = $3
}

# The last point of curve f that is not after a time, and not the last of all.
function before(f, time,    low, high, middle) {
   low = 1; high = n[f]
   while (high - low > 1) { middle = int((low + high)/2); if (t[f, middle] <= time) low = middle; else high = middle }
   return low
}
# Curve f at a time, linear between its points, constant beyond its ends.
function at(f, time, array,    k, share) {
   k = before(f, time)
   share = (time - t[f, k])/(t[f, k + 1] - t[f, k])
   if (share < 0) share = 0
   if (share > 1) share = 1
   return (1 - share)*array[f, k] + share*array[f, k + 1]
}
# Integral of curve f from its start to a time.
function integral(f, time,    k) {
   if (time <= t[f, 1]) return 0
   if (time > t[f, n[f]]) time = t[f, n[f]]
   k = before(f, time)
   return sum[f, k] + (time - t[f, k])*(value[f, k] + at(f, time, value))/2
}
function integrate(f,    k) {
   sum[f, 1] = 0
   for (k = 2; k <= n[f]; k++) sum[f, k] = sum[f, k - 1] + (t[f, k] - t[f, k - 1])*(value[f, k] + value[f, k - 1])/2
}
function within(time) { return (from == "" || time >= from + 0) && (to == "" || time <= to + 0) }
# rms of curve 2, later by a shift, against curve 1; largest and largest_at on the way.
function rms(shift,    k, time, difference, squares, count) {
   largest = 0
   for (k = 1; k <= points; k++) {
      time = even ? from + (to - from)*(k - 0.5)/points : t[1, k]
      if (!within(time)) continue
      difference = even ? at(2, time - shift, mean) - at(1, time, mean) : at(2, time - shift, value) - value[1, k]
      squares += difference^2; count++
      if (difference^2 > largest^2) { largest = difference; largest_at = time }
   }
   return count ? sqrt(squares/count) : "none"
}
function best_shift(    s, this, best, least) {
   best = 0; least = rms(0)
   for (s = -50; s <= 150; s++) { this = rms(s/100); if (this < least) { least = this; best = s/100 } }
   return best
}

END {
   if (n[1] < 2 || (f > 1 && n[2] < 2)) { print "none"; exit }
   even = sub(/_even$/, "", task)
   points = even ? 960 : n[1]
   if (task == "curve") {
      integrate(1)
      print "t value mean"
      for (k = 1; k <= n[1]; k++) {
         a = t[1, k] - width/2; if (a < t[1, 1]) a = t[1, 1]
         b = t[1, k] + width/2; if (b > t[1, n[1]]) b = t[1, n[1]]
         printf "%.6f %.6g %.6g\n", t[1, k], value[1, k], (integral(1, b) - integral(1, a))/(b - a)
      }
   } else if (task == "reaches") {
      for (k = 2; k <= n[1]; k++) if (within(t[1, k]) && value[1, k] > level && value[1, k - 1] <= level) {
         print t[1, k - 1] + (t[1, k] - t[1, k - 1])*(level - value[1, k - 1])/(value[1, k] - value[1, k - 1]); exit }
      print "none"
   } else if (task ~ /peak/) {
      for (k = 1; k <= n[1]; k++) {
         this = task == "peak" ? value[1, k] : mean[1, k]
         if (within(t[1, k]) && (when == "" || this > most)) { most = this; when = t[1, k] } }
      printf "%s at %.2f\n", most, when
   } else if (task == "plateau") {
      integrate(1)
      print (integral(1, to) - integral(1, from))/(to - from)
   } else if (task == "inside") {
      for (k = 1; k <= 960; k++) {
         time = from + (to - from)*(k - 0.5)/960
         this = at(2, time, mean)
         count += this >= at(1, time, value) && this <= at(3, time, value)
      }
      print count/960
   } else if (task == "rms") print rms(0)
   else if (task == "largest") { rms(0); printf "%s at %.2f\n", largest, largest_at }
   else if (task == "shift") print best_shift()
   else if (task == "rms_shifted") print rms(best_shift())
}
