# Heave of a free cylinder against linear theory: when and how far on the other side it turns first, and how far both are apart.
#
# usage: awk -v name=cylinder -v height=0.2 -v rest=0 -v until=12 -f utils/studies/heave.awk input/reference/heave_decay.csv RESULTS/solids.dat
#
# rest: where it floats, in a tank of width L higher by 2 a y/(L + 2 a), for so much the level rises; height: where it starts, above that;
# until: time up to which the difference is taken.
# With -v most=RMS it fails if the root is larger, or if there is nothing to compare.
# Prints one line: the largest difference and the root of its mean square, in heights, and the first turn of both.
FNR == 1 { file++ }
/^#/ { next }
file == 1 { gsub(",", ""); t[++n] = $1; y[n] = $2; next }
!column { for (i = 1; i <= NF; i++) if ($i == name ".y") column = i; next }
$1 <= until {
   while (k < n - 1 && t[k + 1] <= $1) k++
   if (k < 1) k = 1
   exact = y[k] + (y[k + 1] - y[k])*($1 - t[k])/(t[k + 1] - t[k])
   value = ($column - rest)/height
   difference = value - exact
   if (difference < 0) difference = -difference
   if (difference > largest) largest = difference
   squares += difference^2; m++
   if (value < turn) { turn = value; turn_time = $1 }
   if (exact < exact_turn) { exact_turn = exact; exact_time = $1 }
}
END { printf "largest difference %.3f, rms %.3f; turns at t = %.2f, %.3f (linear theory %.2f, %.3f)\n", largest, sqrt(squares/m), turn_time, turn, exact_time, exact_turn
   if (most && !(m > 10 && sqrt(squares/m) <= most)) exit 1 }
