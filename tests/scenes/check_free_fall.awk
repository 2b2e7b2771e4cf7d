# Checks that a free solid falls by g t**2/2 until a time, and that it stays where it is sideways.
#
# usage: awk -v name=NAME -v gravity=G -v until=T -f check_free_fall.awk solids.dat
/^#/ { next }
!named { for (i = 1; i <= NF; i++) column[$i] = i; named = 1; next }
{
   if (!((name ".y") in column)) { print "there is no column " name ".y"; failed = 1; exit 1 }
   x = $column[name ".x"]; y = $column[name ".y"]
   if (!rows++) { x0 = x; y0 = y }
   away = x - x0
   if (away^2 > 1e-18) { print "row " rows ": it has gone aside by " away; failed = 1; exit 1 }
   if ($1 > until) next
   away = y - (y0 - gravity*$1^2/2)
   if (away^2 > 1e-24) { print "row " rows ": it has fallen by " away " too little"; failed = 1; exit 1 }
   fell = y0 - y
}
END { if (!failed && !(fell > 0.1)) { print "it has not fallen"; exit 1 } }
