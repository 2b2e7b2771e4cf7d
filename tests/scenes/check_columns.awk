# Checks columns of a table such as energy.dat, found by their names.
#
# usage: awk -v at_most="NAME FROM NUMBER ..." -v means="NAME FROM LEAST MOST ..." -v never_falls_by="NAME NUMBER ..." -v crosses="NAME VALUE FROM TO ..." -f check_columns.awk TABLE
#
# at_most: |value| <= NUMBER in every row whose `time` is FROM or later. never_falls_by: no row less than the one before
# by more than NUMBER. crosses: the first `time` at which the column passes VALUE, upwards or downwards, is from FROM to TO.
# means: the mean of the rows from then on is from LEAST to MOST.
# A column that is not there, a value that is no number and a table without rows fail.
BEGIN {
   n_most = split(at_most, most, " ")
   n_means = split(means, mean, " ")
   n_falls = split(never_falls_by, falls, " ")
   n_crosses = split(crosses, crossing, " ")
}
function fail(what) { print "row " rows ": " what; failed = 1; exit 1 }
function value_of(name) {
   if (!(name in column)) fail("there is no column " name)
   if ($column[name] !~ /^[-+]?[0-9.]+([Ee][-+]?[0-9]+)?$/) fail(name " = " $column[name] " is no number")
   return $column[name] + 0
}
/^#/ { next }
!named { for (i = 1; i <= NF; i++) column[$i] = i; named = 1; next }
{
   rows++
   time = value_of("time")
   for (i = 1; i < n_most; i += 3) {
      if (time < most[i + 1]) continue
      value = value_of(most[i])
      if (value < 0) value = -value
      seen[i]++
      if (value > largest[i]) largest[i] = value
      if (value > most[i + 2]) fail("|" most[i] "| = " value " is more than " most[i + 2] " at time " time)
   }
   for (i = 1; i < n_means; i += 4) if (time >= mean[i + 1]) { sum[i] += value_of(mean[i]); summands[i]++ }
   for (i = 1; i < n_falls; i += 2) {
      value = value_of(falls[i])
      if (rows > 1 && before[i] - value > falls[i + 1]) fail(falls[i] " falls by " before[i] - value " to " value)
      before[i] = value
   }
   for (i = 1; i < n_crosses; i += 4) {
      above[i] = value_of(crossing[i]) - crossing[i + 1]
      if (rows > 1 && !(i in when) && above[i]*above_before[i] <= 0)
         when[i] = time_before + (time - time_before)*above_before[i]/(above_before[i] - above[i])
      above_before[i] = above[i]
   }
   time_before = time
}
END {
   if (failed) exit 1
   if (rows < 2) { print "only " rows + 0 " rows"; exit 1 }
   for (i = 1; i < n_most; i += 3) {
      if (!seen[i]) { print "no row from time " most[i + 1] " on"; exit 1 }
      print "|" most[i] "| is at most " largest[i] + 0 " in " seen[i] " rows from time " most[i + 1] " on, allowed: " most[i + 2]
   }
   for (i = 1; i < n_means; i += 4) {
      if (!summands[i]) { print "no row from time " mean[i + 1] " on"; exit 1 }
      print "mean " mean[i] " is " sum[i]/summands[i] ", wanted: " mean[i + 2] " to " mean[i + 3]
      if (sum[i]/summands[i] < mean[i + 2] || sum[i]/summands[i] > mean[i + 3]) exit 1
   }
   for (i = 1; i < n_crosses; i += 4) {
      text = crossing[i] " passes " crossing[i + 1]
      if (!(i in when)) { print text " never"; exit 1 }
      print text " at " when[i] ", wanted: " crossing[i + 2] " to " crossing[i + 3]
      if (when[i] < crossing[i + 2] || when[i] > crossing[i + 3]) exit 1
   }
   for (i = 1; i < n_falls; i += 2) print falls[i] " never falls by more than " falls[i + 1] ", ends at " before[i]
}
