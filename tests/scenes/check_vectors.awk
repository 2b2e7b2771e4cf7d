# Reads a disassembly: do the pair loops work on whole vectors? Counts packed and scalar arithmetic of doubles in the procedures
# that the loops end up in. What belongs to no pair loop there is scalar in part, so that each has a limit of its own; a loop that
# is not vectorised has its arithmetic once for each lane, and passes it by far.
BEGIN {
   # Of lanes, 2 is SSE2, whose few instructions do not do for the lists.
   n = split("first=sum_first|constant_loop|dynamic_loop second=complete_frozen_terms|first_stage|sum_eddy|sum_diffusion" \
             " stages=later_stage._omp_fn|sum_flow friction=solid_friction_MOD_(fluid_loop|sum_solid) lists=pick", rule, " ")
   for (i = 1; i <= n; i++) { split(rule[i], part, "="); name[i] = part[1]; procedures[i] = part[2] }
   if (lanes == 2) n--
   split("0.3 1 0.4 0.5 0.3", limit, " ")
   split("60 40 15 25 20", least, " ")
}
/^[0-9a-f]+ <.*>:$/ { here = 0; for (i = 1; i <= n; i++) if ($2 ~ "(" procedures[i] ")") here = i }
here && $2 ~ /^v?(fn?m(add|sub)[0-9]*|mul|add|sub|div|sqrt|min|max)[ps]d$/ {
   if ($2 ~ /pd$/) packed[here]++
   else scalar[here]++
}
END {
   for (i = 1; i <= n; i++) {
      bad = packed[i] < least[i] || scalar[i] > limit[i]*packed[i]
      failed = failed || bad
      printf "%-8s packed %4d, scalar %4d%s\n", name[i], packed[i], scalar[i], bad ? ": NOT VECTORISED" : ""
   }
   exit failed
}
