# Whether columns of two tables, found by their names, are the same letter by letter, or to a tolerance.
# usage: awk -v names="NAME ..." [-v tolerance=...] -f ... ONE OTHER
function differs(a, b) { return tolerance == "" ? a != b : (a - b)^2 > tolerance^2 }
BEGIN { n = split(names, name, " ") }
FNR == 1 { file++; named = 0; rows = 0 }
/^#/ { next }
!named { for (i = 1; i <= NF; i++) column[file, $i] = i; named = 1; next }
{
   rows++
   for (i = 1; i <= n; i++) {
      if (!((file, name[i]) in column)) { print "there is no column " name[i]; failed = 1; exit 1 }
      value = $column[file, name[i]]
      if (file == 1) first[rows, i] = value
      else if (differs(value, first[rows, i])) { print name[i] " in row " rows ": " first[rows, i] " and " value; failed = 1; exit 1 }
   }
   count[file] = rows
}
END {
   if (failed) exit 1
   print count[1] " and " count[2] " rows"
   exit count[1] != count[2] || count[1] < 10
}
