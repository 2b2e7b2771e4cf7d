# How even columns can be divided among ranks, as the cuts of module `division` do.
#
# usage: awk -f balance.awk -v size=200 -v target=1600 -v ranks='8 64' -v margin=4 POSITIONS...
#
# POSITIONS: tables of dynsph-snapshot-to-text, d/dx = size. Their particles are taken for those of a flow at d/dx = target: as many in a
# column, 2 dx wide there, as there were in that part of one here. Prints for each table and number of ranks: ranks, columns of a rank,
# largest load over the mean, largest and mean share of copies (of `margin` columns beside each cut) in what a rank holds.
/^#/ { next }
FNR == 1 { finish() }
!($1 == $1 + 0) { for (i = 1; i <= NF; i++) if ($i == "x") place = i; next }
{ k = int($place*size/2); count[k]++; if (k > last) last = k }
END { finish() }
function finish(    factor, n, k, c, r, list, m) {
   if (!last) return
   factor = target/size
   n = int((last + 1)*factor)
   total = 0
   for (c = 0; c < n; c++) { load[c] = count[int(c/factor)]*factor; total += load[c] }
   m = split(ranks, list, " ")
   for (r = 1; r <= m; r++) divide(list[r], n)
   split("", count); last = 0
}
function divide(parts, n,    c, process, before, mine, largest, held, most, sum_held, first, k, used) {
   process = 1; before = 0; first[0] = 0
   for (c = 0; c < n; c++) {
      while (process < parts && (2*before + load[c])*parts >= 2*process*total) first[process++] = c
      before += load[c]
   }
   while (process <= parts) first[process++] = n
   for (k = 0; k < parts; k++) {
      mine = held = 0
      for (c = first[k]; c < first[k + 1]; c++) mine += load[c]
      for (c = first[k] - margin; c < first[k]; c++) if (c >= 0) held += load[c]
      for (c = first[k + 1]; c < first[k + 1] + margin; c++) if (c < n) held += load[c]
      if (mine > largest) largest = mine
      if (mine > 0) { used++; sum_held += held/mine; if (held/mine > most) most = held/mine }
   }
   printf "%d %.1f %.4f %.3f %.3f\n", parts, n/parts, largest*parts/total, most, sum_held/used
}
