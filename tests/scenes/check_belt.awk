# Reads a snapshot of tests/scenes/belt.nml as text: means of u over layers above the belt against U erfc(y/sqrt(4 nu t)).
function erfc(x,   t) { t = 1/(1 + 0.3275911*x); return t*(0.254829592 + t*(-0.284496736 + t*(1.421413741 + t*(-1.453152027 + t*1.061405429))))*exp(-x*x) }
BEGIN { belt = 0.2; speed = 0.5; nu = 0.01; time = 0.5; high = 0.05; layers = 3 }
/^#/ { next }
!named { for (i = 1; i <= NF; i++) column[$i] = i; named = 1; next }
{
   x = $column["x"]; layer = int(($column["y"] - belt)/high) + 1
   if (x < 1.5 || x > 2.5 || layer > layers) next
   n[layer]++; height[layer] += $column["y"] - belt; sum[layer] += $column["velocity_x"]
}
END {
   for (k = 1; k <= layers; k++) {
      if (n[k] < 20) { print "only " n[k] + 0 " particles in layer " k; exit 1 }
      exact = speed*erfc(height[k]/n[k]/sqrt(4*nu*time))
      error = (sum[k]/n[k] - exact)/speed
      print "y = " height[k]/n[k] ": u = " sum[k]/n[k] ", exact " exact ", difference " error " of U"
      if (error > 0.01 || error < -0.02) exit 1
   }
}
