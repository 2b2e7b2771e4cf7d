# Checks that the tables of a Markdown file have what they are there for.
#
# usage: awk -v tables=NUMBER -f check_tables.awk FILE
#
# There are that many tables; each has rows, each row has a number behind its first cell, and none says none, failed, nan or inf.
function fail(what) { print "line " NR ": " what; failed = 1; exit 1 }
!/^[|]/ { if (line && line < 3) fail("a table without rows"); line = 0; next }
line++ == 0 { found++ }
line > 2 {
   if ($0 !~ /[|] *(<|[*][*])? *[0-9.]+(e[-+]?[0-9]+)?([*][*])? *[(|]/) fail("no number: " $0)
   if ($0 ~ /[|] *([*][*])?-?(none|failed|nan|inf)/) fail("not a number: " $0)
   rows++
}
END {
   if (failed) exit 1
   if (found != tables) { print found + 0 " tables instead of " tables; exit 1 }
   print found " tables with " rows " rows"
}
