# How far the density is from rho0 in a snapshot: the share that 99.8 % of the particles do not exceed, the rms, and what part of the
# particles is beyond 1 %.
#
# usage: awk -f density.awk TABLE     TABLE: from dynsph-snapshot-to-text, with pressures
/^# density:/ { rho0 = $3; next }
/^# sound_speed:/ { c0 = $3; next }
/^#/ { next }
!place { for (i = 1; i <= NF; i++) if ($i == "pressure") place = i; next }
{
   # The state equation is linear: |rho - rho0|/rho0 = |p|/(rho0 c0^2).
   x = $place/(rho0*c0^2); if (x < 0) x = -x
   sum += x^2; n++; if (x > 0.01) beyond++
   bin[int(1e5*x)]++; if (int(1e5*x) > top) top = int(1e5*x)
}
END {
   left = 0.002*n
   for (k = top; k > 0; k--) { left -= bin[k]; if (left < 0) break }
   printf "%.5f %.5f %.3g\n", (k + 1)/1e5, sqrt(sum/n), beyond/n
}
