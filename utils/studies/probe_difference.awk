# How far two runs' probes differ: rms of the difference over the rms of the first run's, in windows of t sqrt(g/d).
#
# usage: awk -v probe=P1 -v windows="2.6 6.15 20" -v width=0.2 -f probe_difference.awk FIRST/probes.dat SECOND/probes.dat
#
# Both are resampled to steps of 0.002. `width`: of a moving mean that takes out the acoustic noise, 0 for none.
# Prints one share for each window, with blanks between.
/^#/ { next }
FNR == 1 || !named[FILENAME] { named[FILENAME] = 1; run++; for (i = 1; i <= NF; i++) if ($i == probe) column = i; next }
{ n[run]++; time[run, n[run]] = $2; value[run, n[run]] = $column }

function resample(run, out,    k, i, x) {
   i = 1
   for (k = 0; k <= last; k++) {
      x = k*step
      while (i < n[run] - 1 && time[run, i + 1] < x) i++
      out[k] = value[run, i] + (value[run, i + 1] - value[run, i])*(x - time[run, i])/(time[run, i + 1] - time[run, i])
   }
}
function mean(values, half,    k, total, sum) {
   total[-1] = 0
   for (k = 0; k <= last; k++) total[k] = total[k - 1] + values[k]
   for (k = half; k <= last - half; k++) values[k] = (total[k + half] - total[k - half - 1])/(2*half + 1)
}
END {
   step = 0.002
   last = int((time[1, n[1]] < time[2, n[2]] ? time[1, n[1]] : time[2, n[2]])/step)
   resample(1, first); resample(2, second)
   half = int(width/step/2)
   if (half > 0) { mean(first, half); mean(second, half) }
   count = split(windows, edge, " ")
   for (i = 1; i < count; i++) {
      difference = scale = 0
      for (k = int(edge[i]/step); k < edge[i + 1]/step && k <= last - half; k++) { difference += (first[k] - second[k])^2; scale += first[k]^2 }
      printf "%s%s", (scale > 0 ? sprintf("%.3f", sqrt(difference/scale)) : "none"), (i < count - 1 ? " " : "\n")
   }
}
