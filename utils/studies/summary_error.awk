# Absolute value of a number of summary.txt less what it should be; 'none' where there is no such number or the run failed.
#
# usage: awk -v key=KEY|KEY-GOAL -f utils/studies/summary_error.awk SUMMARY
BEGIN {
   goal = 0
   if (match(key, /-[0-9.]+$/)) { goal = substr(key, RSTART + 1); key = substr(key, 1, RSTART - 1) }
}
$1 == "status" && $3 != "finished" { exit }
$1 == key && $3 + 0 == $3 { e = $3 - goal; found = 1 }
END { if (found) printf "%.4e", e < 0 ? -e : e; else printf "none" }
