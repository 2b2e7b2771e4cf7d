# What utils/studies/error_vs_time makes of its tables SCENE.dat: a line '# SCENE', a line of names, then a row for each run:
# method, d/dx, particles, steps, seconds (median, least, most of the repeats), repeats, and one column for each kind of error;
# 'none' is no number. A table's rows are in order of method and d/dx.
#
# task=runs SCENE.dat: all runs of a scene; an error on the front is bold.
# task=levels SCENE.dat...: time for errors between those of the default as a share of its time; methods: all names, the default first.
# task=energy_cfl energy_cfl.dat: a row for each scene and integrator, a column for each cfl number.
#
# usage: awk -v task=TASK -v methods="METHOD ..." -f utils/studies/error_vs_time.awk TABLE...
BEGIN { n_methods = split(methods, name, " "); base = name[1] }
task == "energy_cfl" {
   if (FNR == 1) next
   row = $1 " | " $2
   if (!(row in known)) { known[row]; rows[++n_rows] = row }
   if (!($3 in seen)) {   # in their order
      seen[$3]
      for (k = n_cfls++; k > 0 && cfl[k] + 0 > $3 + 0; k--) cfl[k + 1] = cfl[k]
      cfl[k + 1] = $3
   }
   value[row, $3] = $4
   next
}
/^#/ { if (runs) finish(); scene = $2; runs = 0; next }
$1 == "method" { kinds = NF - 8; for (k = 1; k <= kinds; k++) kind[k] = $(k + 8); next }
{
   runs++
   method[runs] = $1; size[runs] = $2; particles[runs] = $3; steps[runs] = $4
   seconds[runs] = $5; least[runs] = $6; most[runs] = $7; repeats[runs] = $8
   for (k = 1; k <= kinds; k++) error[runs, k] = $(k + 8)
}
END { if (runs) finish(); if (task == "levels") means(); if (task == "energy_cfl") all_cfls() }

function finish() { if (task == "runs") all_runs(); else all_levels() }

# Nobody has both less error and less time; times whose spreads overlap are the same.
function on_front(i, k,    j) {
   if (error[i, k] == "none") return 0
   for (j = 1; j <= runs; j++) if (error[j, k] != "none" && error[j, k] < error[i, k] && most[j] < least[i]) return 0
   return 1
}

function all_runs(    i, k) {
   printf "| method | d/dx | particles | steps | run time [s] | spread |"
   for (k = 1; k <= kinds; k++) printf " %s |", kind[k]
   printf "\n| --- | --- | --- | --- | --- | --- |"
   for (k = 1; k <= kinds; k++) printf " --- |"
   print ""
   for (i = 1; i <= runs; i++) {
      printf "| %s | %s | %s | %s | %s | %s |", method[i], size[i], particles[i], steps[i],
         (repeats[i] ? sprintf("%.3g", seconds[i]) : "failed"), (repeats[i] > 1 ? sprintf("%.3g to %.3g", least[i], most[i]) : "-")
      for (k = 1; k <= kinds; k++)
         printf((on_front(i, k) ? " **%s** |" : " %s |"), (error[i, k] == "none" ? "none" : sprintf("%.1e", error[i, k])))
      print ""
   }
}

# Seconds at which a method's errors come down to a level, by straight lines in logarithms between its resolutions. Less than 0:
# its coarsest run is better already, so that it needs at most so long. 0: it never gets there.
function time_for(name, k, level,    i, last, share) {
   last = 0
   for (i = 1; i <= runs; i++) {
      if (method[i] != name || error[i, k] == "none") continue
      if (error[i, k] <= level) {
         if (!last) return -seconds[i]
         if (!(error[i, k] > 0)) return seconds[i]
         share = log(error[last, k]/level)/log(error[last, k]/error[i, k])
         return exp((1 - share)*log(seconds[last]) + share*log(seconds[i]))
      }
      last = i
   }
   return 0
}

# A level is half way, in logarithms, between two errors of the default in a row: at its own points others of the same error would
# miss it by a digit. Errors of 1 and more say nothing, of whatever size they are.
function all_levels(    i, j, k, level, own, time, last, best, fastest) {
   if (!headed++) {
      printf "| scene | error | level | %s [s] |", base
      for (j = 1; j <= n_methods; j++) if (name[j] != base) printf " %s |", name[j]
      printf " fastest |\n| --- | --- | --- | --- |"
      for (j = 1; j <= n_methods; j++) printf " --- |"
      print ""
   }
   for (k = 1; k <= kinds; k++) {
      last = 0
      for (i = 1; i <= runs; i++) {
         if (method[i] != base || error[i, k] == "none" || !(error[i, k] > 0)) continue
         level = last ? sqrt(last*error[i, k]) : 1
         own = level < 1 && error[i, k] < last ? time_for(base, k, level) : 0
         if (own > 0) {   # less: a coarser run than these two was better by chance
            printf "| %s | %s | %.1e | %.3g |", scene, kind[k], level, own
            best = 1; fastest = base
            for (j = 1; j <= n_methods; j++) {
               if (name[j] == base) continue
               time = time_for(name[j], k, level)/own
               printf((time == 0 ? " - |" : time < 0 ? " < %.2f |" : " %.2f |"), (time < 0 ? -time : time))
               if (time > 0) { logs[j] += log(time); counted[j]++ }
               if (time < 0) time = -time
               if (time > 0 && time < best) { best = time; fastest = name[j] }
            }
            printf " %s |\n", fastest
         }
         last = error[i, k]
      }
   }
}

# Over the rows that have a number, which are not the same ones for all methods.
function means(    j) {
   printf "| all | geometric mean (rows) | | |"
   for (j = 1; j <= n_methods; j++) {
      if (name[j] == base) continue
      if (counted[j]) printf " %.2f (%d) |", exp(logs[j]/counted[j]), counted[j]; else printf " - |"
   }
   print " |"
}

function all_cfls(    i, k) {
   printf "| scene | integrator |"
   for (i = 1; i <= n_cfls; i++) printf " cfl %s |", cfl[i]
   printf "\n| --- | --- |"
   for (i = 1; i <= n_cfls; i++) printf " --- |"
   print ""
   for (k = 1; k <= n_rows; k++) {
      printf "| %s |", rows[k]
      for (i = 1; i <= n_cfls; i++) {
         if (!((rows[k], cfl[i]) in value)) printf " - |"
         else if (value[rows[k], cfl[i]] == "none") printf " failed |"
         else printf " %.1e |", value[rows[k], cfl[i]]
      }
      print ""
   }
}
