# What is known of a run, from its tables: lines 'key value'.
#
# usage: awk -f facts.awk RESULT/summary.txt RESULT/energy.dat     the first only where the run has ended
#
# The last time and whether the run has ended; of energy.dat each column at times of interest (COLUMN@T), when 80 and 90 % are
# dissipated; where it has ended the largest error of the balance, how much of the time the density varies by more than 1 %, by how much
# from t = 30 on, and all of the summary.
FILENAME ~ /summary.txt$/ { ended = 1; value = $0; sub(/^[^=]*= */, "", value); print $1, value; next }
/^#/ { next }
!columns {
   columns = NF
   for (i = 1; i <= NF; i++) column[$i] = i
   n_wanted = split("time Q_alpha/dE Q_delta/dE Q_omega/dE alpha_mean alpha_max delta_mean delta_max", wanted, " ")
   n_times = split("8 12 15.5 20 140", at, " ")
   next
}
{
   t = $column["time_scaled"] + 0
   # A stop in the middle of a row, or numbers of a table that is being written.
   if (NF < columns) next
   q_alpha = ("Q_alpha/dE" in column) ? $column["Q_alpha/dE"] : 0
   q_delta = ("Q_delta/dE" in column) ? $column["Q_delta/dE"] : 0
   q = q_alpha + q_delta
   # The last row of a run is at its end, but for round-off.
   for (k = 1; k <= n_times; k++) if (!done[k] && t >= at[k] - 1e-9) {
      done[k] = 1
      printf "Q@%s %.9g\n", at[k], q
      for (i = 1; i <= n_wanted; i++) if (wanted[i] in column) printf "%s@%s %.9g\n", wanted[i], at[k], $column[wanted[i]]
   }
   if (!eighty && q >= 0.8) { eighty = 1; print "t_80", t }
   if (!ninety && q >= 0.9) { ninety = 1; print "t_90", t }
   error = $column["balance_error/dE"]; if (error < 0) error = -error
   if (error > largest) largest = error
   if ("density_variation" in column) {
      variation = $column["density_variation"]
      if (t >= 30 && variation > late) late = variation
      if (last != "") { span += t - last; if (variation > 0.01) beyond += t - last }
   }
   last = t
}
END {
   print "t", last
   if (!ended) exit   # what is the largest is not known yet
   print "balance", largest
   if (span > 0) print "variation_beyond", beyond/span
   if (late > 0) print "variation_from_30", late
}
