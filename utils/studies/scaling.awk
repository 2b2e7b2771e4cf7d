# How even columns can be divided among ranks, as the cuts of module `division` do, and what a step then takes.
#
# usage: awk -f scaling.awk -v size=100 -v target=1600 -v ranks=96 -v threads=1 -v tau=520 -v copy=38 -v serial=0.004 -v bytes=180
#            -v messages=5.3 -v reductions=4 -v latency=2 -v bandwidth=1 -v margin=3 POSITIONS...
#
# POSITIONS: tables of dynsph-snapshot-to-text, d/dx = size. Their particles are taken for those of a flow at d/dx = target: as many in a
# column, 2 dx wide there, as there were in that part of one here. tau, copy: ns of one thread for a step of a particle, of a copy;
# serial: share of a step outside parallel regions; bytes: sent for a copy and step; messages, reductions: of a rank in a step;
# latency [us] and bandwidth [GB/s a core] of the network; margin: columns of copies beside each cut.
# Prints a row: particles, ranks, threads, particles of a rank, columns of a rank, load over mean (mean of the tables, largest), copies
# over own particles, the efficiency where messages are hidden behind computing, then parts of the mean step's time where they are not:
# computing evenly (the efficiency), imbalance, copies, messages, reductions.
FNR == 1 { finish() }
/^#/ { next }
!($1 == $1 + 0) { for (i = 1; i <= NF; i++) if ($i == "x") place = i; next }
{ k = int($place*size/2); count[k]++; if (k > last) last = k }
END {
   finish()
   n = total/tables
   even = n/ranks*tau*(serial + (1 - serial)/threads)
   uneven = (sum_load/tables - 1)*even
   copies = sum_copies/tables*copy/threads
   sent = messages*latency*1e3 + sum_copies/tables*bytes/(bandwidth*threads)
   waits = ranks > 1 ? reductions*2*log(ranks)/log(2)*latency*1e3 : 0
   step = even + uneven + copies + sent + waits
   printf "| %.3g | %d | %d | %.0f | %.1f | %.3f | %.2f | %.2f |", n, ranks, threads, n/ranks, columns/tables/ranks, sum_load/tables, worst, \
      sum_copies/n*ranks/tables
   printf " %.0f |", 100*even/(step - sent)*speed_up()
   printf " %.0f | %.1f | %.1f | %.1f | %.1f |\n", 100*even/step*speed_up(), 100*uneven/step, 100*copies/step, 100*sent/step, 100*waits/step
}
# Of the threads of a rank: a part of their time is serial.
function speed_up() { return 1/(serial*threads + 1 - serial) }
function finish(    factor, n, c) {
   if (!last) return
   factor = target/size
   n = int((last + 1)*factor)
   all = 0
   for (c = 0; c < n; c++) { load[c] = count[int(c/factor)]*factor; all += load[c] }
   divide(n)
   total += all; columns += n; tables++
   split("", count); last = 0
}
# As module `division`: the largest load as small as whole columns allow.
function divide(n,    c, process, before, mine, largest, held, k, low, most, middle, heaviest, least) {
   before[0] = 0; heaviest = 0
   for (c = 0; c < n; c++) { before[c + 1] = before[c] + load[c]; if (load[c] > heaviest) heaviest = load[c] }
   low = all/ranks; if (heaviest > low) low = heaviest
   most = low + heaviest
   while (most - low > 1e-6*all/ranks) {
      middle = (low + most)/2
      if (needed(n, before, middle) > ranks) low = middle; else most = middle
   }
   least[ranks] = n
   for (process = ranks - 1; process >= 0; process--) {
      for (k = least[process + 1]; k > 0 && before[least[process + 1]] - before[k - 1] <= most; k--);
      least[process] = k
   }
   first[0] = 0; k = 0
   for (process = 1; process <= ranks; process++) {
      while (k < n && (before[k] + before[k + 1])*ranks < 2*process*all) k++
      first[process] = k > least[process] ? k : least[process]
      while (before[first[process]] - before[first[process - 1]] > most) first[process]--
   }
   for (k = 0; k < ranks; k++) {
      mine = before[first[k + 1]] - before[first[k]]
      for (c = first[k] - margin; c < first[k]; c++) if (c >= 0) held += load[c]
      for (c = first[k + 1]; c < first[k + 1] + margin; c++) if (c < n) held += load[c]
      if (mine > largest) largest = mine
   }
   sum_load += largest*ranks/all
   if (largest*ranks/all > worst) worst = largest*ranks/all
   sum_copies += held/ranks
}
function needed(n, before, most,    k, m, done) {
   m = 1; done = 0
   for (k = 1; k <= n; k++) if (before[k] - done > most) { m++; done = before[k - 1] }
   return m
}
