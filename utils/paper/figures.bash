# Noise (claims L3 and A1) and the figures of the paper's campaign.

noise_models='alpha_0 alpha_0.01 dynamic'
# Resolutions at which the three models that are compared have ended, at Ma 0.1.
noise_sizes() {
   local model
   for model in $noise_models; do sizes dam_${model}_ma_0.1 Q@20; done | sort -n | uniq -c | awk '$1 == 3 { print $2 }'
}
# The largest of them whose runs are here; the largest of which the noise is known.
noise_size_here() {
   local size model here
   for size in $(noise_sizes); do
      here=yes
      for model in $noise_models; do
         has_finished "$out/dam_${model}_ma_0.1_$size" && [ -s "$out/dam_${model}_ma_0.1_$size/probes.dat" ] &&
            [ -n "$(last_snapshot "dam_${model}_ma_0.1_$size" 4)" ] || here=
      done
      [ -z "$here" ] || echo "$size"
   done | tail -n 1
}
noise_size() {
   local file
   for file in "$facts"/noise_*.tables; do [ ! -e "$file" ] || basename "$file" .tables; done | sed 's/noise_//' | sort -n | tail -n 1
}
# The K-th but last snapshot of a run; 0: the last; nothing if there are not so many.
last_snapshot() {
   local snapshots=("$out/$1"/snapshot_??????.vtkhdf) k=${2:-0}
   if [ -e "${snapshots[0]}" ] && [ ${#snapshots[@]} -gt "$k" ]; then echo "${snapshots[-1 - k]}"; fi
}
# Rows of `dynsph-spectra vorticity` in the largest rectangle that lies inside the fluid of all snapshots, after the rectangle and its
# lesser side; nothing if there is none of 8 dx each way, which a spectrum needs.
enstrophies() { # D/DX SNAPSHOT...
   local rectangle size=$1
   shift
   rectangle=$("$build/bin/dynsph-spectra" vorticity --overwrite "$@" | tr -d , | awk -v size="$size" '
      NR > 1 { for (k = 1; k <= 4; k++) { x = $(k + 7); if (NR == 2 || (k < 3 ? x > r[k] : x < r[k])) r[k] = x } }
      END { a = r[3] - r[1]; b = r[4] - r[2]; side = a < b ? a : b
            if (side > 8.01/size) printf "%s,%s,%s,%s %s", r[1], r[2], r[3], r[4], side }')
   [ -n "$rectangle" ] || return 0
   # Between the points of the grid on which it was found a fluid may be a little thinner.
   "$build/bin/dynsph-spectra" vorticity --filling 0.7 --field --overwrite --rectangle "${rectangle% *}" "$@" | sed "1s/.*/$rectangle/"
}

# Makes facts noise_D/DX and tables noise_D/DX.tables: vorticity in a rectangle that lies inside all fluids, at t = 16 to 20; P1, while
# the flow is violent, and how far models are apart before and after the plunging jet lands, and from what was measured.
noise() {
   local size
   size=$(noise_size_here)
   [ -n "$size" ] || return 0
   noise_at "$size" >"$scratch/noise.tables"
   put "$scratch/noise" "$facts/noise_$size"
   put "$scratch/noise.tables" "$facts/noise_$size.tables"
}
noise_at() { # D/DX
   local size=$1 model run snapshots back above file=$scratch/noise measured=input/reference/lobovsky2014_p1_H300.csv
   for back in 4 3 2 1 0; do
      snapshots=()
      for model in $noise_models; do snapshots+=("$(last_snapshot "dam_${model}_ma_0.1_$size" $back)"); done
      enstrophies "$size" "${snapshots[@]}" | sed "s/^/$back /"
   done >"$scratch/enstrophies"
   # The table is of the last snapshots; the facts are of those whose rectangle has room for two waves of the number pi/(2h), h = 2 dx.
   awk -v models="$noise_models" -v size="$size" -v facts="$file" '
      BEGIN { split(models, model, " "); printf "" >facts; back = -1 }
      $1 != back { back = $1; k = 0; rectangle = $2; tall = $3 >= 2*4*2/size; snapshots += tall; next }
      { k++; if (tall) { resolved[k] += $3*(1 - $4); noise[k] += $3*$4 }
        if (back == 0) row[k] = sprintf("| %s | %s | %.2f %% | %.3f %% | %s | %.3f %% | %.4f %% |", model[k], $3, 100*$4, 100*$5, $6, 100*$7, 100*$8) }
      END {
         if (row[1] == "") print "At d/dx = " size " the fluids have no rectangle in common at t = 20."
         else {
            printf "d/dx = %s, Ma 0.1. Vorticity at t = 20 in the rectangle %s:\n\n", size, rectangle
            print "| model | enstrophy | above pi/(2h) | above pi/h | kinetic energy | above pi/(2h) | above pi/h |"
            print "| --- | --- | --- | --- | --- | --- | --- |"
            for (k = 1; k <= 3; k++) print row[k]
         }
         if (noise[1] > 0) {
            print "snapshots", snapshots >facts
            print "enstrophy_resolved_over_alpha_0", resolved[3]/resolved[1] >facts
            print "enstrophy_share_over_alpha_0", noise[3]/(resolved[3] + noise[3])*(resolved[1] + noise[1])/noise[1] >facts
         } }' "$scratch/enstrophies"
   echo
   header 'model: P1, t = 7 to 20' deviation 'above f sqrt(d/g) = 10' 'above 40' 'largest rise from an octave to the next, from 20 on'
   for model in $noise_models; do
      run=$out/dam_${model}_ma_0.1_$size
      printf '| %s |' "$model"
      for above in 10 40; do
         "$build/bin/dynsph-spectra" probe --probe P1 --from 7 --segment 2 --above $above --overwrite --output "$run/P1_spectrum.dat" "$run/probes.dat" |
            awk -v above=$above '$1 == "P1" { if (above == 10) printf " %.4f |", $3; printf " %s %% |", $5 }'
      done
      # Mean density of an octave over that of the octave below it: less than 1 as long as the spectrum falls.
      awk -v fact="rise_$model" -v facts="$file" '/^#/ || !($1 > 10) { next } { band = int(log($1/10)/log(2)); total[band] += $3; n[band]++; if (band > last) last = band }
         END { for (band = 1; band < last; band++) { rise = total[band]/n[band]/(total[band - 1]/n[band - 1]); if (rise > worst) worst = rise }
               printf " %.2f |\n", worst; print fact, worst >>facts }' "$run/P1_spectrum.dat"
   done
   echo
   header 'rms difference of P1 to that of the dynamic model over its rms, means over 0.2' '2.6 to 4' '4 to 6.15' '6.15 to 7' '7 to 8' '8 to 20'
   for model in alpha_0 alpha_0.01; do
      p1_difference "2.6 4 6.15 7 8 20" "$out/dam_dynamic_ma_0.1_$size/probes.dat" "$out/dam_${model}_ma_0.1_$size/probes.dat" |
         sed "s/ / | /g; s/^/| $model | /; s/\$/ |/"
   done
   probe_differences "$out/dam_dynamic_ma_0.1_$size" "$out/dam_alpha_0.01_ma_0.1_$size" >>"$file"
   # The curve in the columns of a probe's table.
   { echo 'time time_scaled P1'; grep -v '^[#t]' "$measured" | tr , ' ' | LC_ALL=C sort -n | awk '{ print $1, $1, $2 }'; } >"$scratch/measured.dat"
   for model in alpha_0.01 dynamic; do
      p1_difference "2.6 6.15" "$scratch/measured.dat" "$out/dam_${model}_ma_0.1_$size/probes.dat" | sed "s/^/P1_measured_$model /" >>"$file"
   done
}

# Those that docs show.
shown=' dissipation_by_model resolution_dynamic dynamic_model vorticity_fields vorticity_spectra P1 '
# draw SCRIPT PICTURE SETTINGS: one picture in $out/figures.
draw() {
   gnuplot -e "png='$plain/figures/$2.png'; $3" "utils/plots/$1.gp" 2>"$out/figures/messages" || { cat "$out/figures/messages" >&2; undrawn+=" $2"; return; }
   if [[ $shown == *" $2 "* ]]; then picture "$out/figures/$2.png"; else echo "picture $out/figures/$2.png"; fi
}
# snapshot_at RUN TIME: the first one that is not earlier; nothing if there is none.
snapshot_at() {
   [ -e "$plain/$1/snapshots.vtkhdf.series" ] || return 0
   sed -n 's/.*"name": "\(.*\)", "time": \([^}]*\)}.*/\1 \2/p' "$plain/$1/snapshots.vtkhdf.series" |
      awk -v t="$2" -v dir="$plain/$1" '$2 >= t - 1e-9 { print dir "/" $1; exit }'
}
# draw_snapshot PICTURE RUN TIME FIELDS
draw_snapshot() {
   local snapshot
   snapshot=$(snapshot_at "$2" "$3")
   [ -z "$snapshot" ] || draw field "$1" "snapshot='$snapshot'; panels='$4'; converter='$build/bin/dynsph-snapshot-to-text'"
}
# Lists for curves.gp: tables of runs and labels for them, '_' for a blank. False if none is here, or one that is known is not.
files='' labels=''
curves_of() { # LABEL:RUN...
   local pair
   files='' labels=''
   for pair in "$@"; do
      if [ ! -s "$out/${pair#*:}/energy.dat" ]; then
         # A picture without a run that is known would say less than the one that is published.
         [ "$(fact "${pair#*:}" state)" != finished ] || return 1
         continue
      fi
      files+=" $plain/${pair#*:}/energy.dat" labels+=" ${pair%%:*}"
   done
   [ -n "$files" ]
}
draw_figures() {
   local size alpha pairs model run runs='' undrawn=''
   mkdir -p "$out/figures"
   # Lists of files are parted by blanks: a name that has none.
   plain=$scratch/runs
   ln -s "$(cd "$out" && pwd)" "$plain"
   # The patch.
   size=$(finest patch_alpha_0.01 Q@8)
   pairs=()
   for alpha in 0 0.01 0.02 0.03; do pairs+=("α_=_$alpha:patch_alpha_${alpha}_$size"); done
   if curves_of "${pairs[@]}"; then
      draw curves patch_dissipation "tables='$files'; labels='$labels'; what='Q_alpha Q_delta Q'; heading='Water patch, d/dx = $size'"
      draw curves patch_density "tables='$files'; labels='$labels'; what='density_variation'; heading='Water patch, d/dx = $size: largest of a particle'"
   fi
   # Constant coefficients.
   size=$(finest dam_alpha_0.01_ma_0.05 Q@12)
   pairs=()
   for alpha in $alphas; do pairs+=("α_=_$alpha:dam_alpha_${alpha}_ma_0.05_$size"); done
   pairs+=("dynamic:dam_dynamic_ma_0.05_$size")
   if curves_of "${pairs[@]}"; then
      draw curves dissipation_by_model "tables='$files'; labels='$labels'; what='Q_alpha Q_delta Q'; heading='Dam break, d/dx = $size, Ma 0.05'"
   fi
   for model in alpha_0.01 dynamic; do
      pairs=()
      for size in $(sizes dam_${model}_ma_0.1 Q@8); do pairs+=("d/dx_=_$size:dam_${model}_ma_0.1_$size"); done
      if curves_of "${pairs[@]}"; then
         draw curves resolution_$model "tables='$files'; labels='$labels'; what='Q_alpha Q_delta Q'; heading='Dam break, $model, Ma 0.1'"
         draw curves resolution_log_$model "tables='$files'; labels='$labels'; what='Q'; logarithmic=1; heading='Dam break, $model, Ma 0.1'"
      fi
   done
   pairs=()
   for size in $(sizes dam_dynamic_ma_0.05 Q@8); do pairs+=("d/dx_=_$size:dam_dynamic_ma_0.05_$size"); done
   if curves_of "${pairs[@]}"; then
      draw curves coefficients "tables='$files'; labels='$labels'; what='alpha_mean alpha_max delta_mean delta_max'; heading='Dynamic model, Ma 0.05'"
   fi
   # Energies, and how well they balance; where energy is dissipated; what the dynamic model does.
   for model in alpha_0.01 dynamic; do
      size=$(finest dam_${model}_ma_0.05 Q@12)
      [ -n "$size" ] && [ -s "$out/dam_${model}_ma_0.05_$size/energy.dat" ] || continue
      run=dam_${model}_ma_0.05_$size runs+=" $plain/dam_${model}_ma_0.05_$size"
      gnuplot -e "dir='$plain/$run'" utils/plots/energy.gp && mv "$out/$run/energy.png" "$out/figures/energies_$model.png"
   done
   [ -z "$runs" ] || draw energy_balance energy_balance "dirs='$runs'"
   for run in "$out"/dam_alpha_0.01_ma_0.05_*; do
      if grep -qs "fields = .*dissipation" "$run/input_used.nml"; then draw_snapshot dissipation "$(basename "$run")" 10 dissipation; fi
   done
   size=$(finest dam_dynamic_ma_0.1 Q@12)
   if [ -n "$size" ]; then draw_snapshot dynamic_model "dam_dynamic_ma_0.1_$size" 10 'vorticity delta'; fi
   size=$(noise_size_here)
   if [ -n "$size" ] && [ "$size" = "$(noise_size)" ]; then draw_noise "$size"; fi
   [ -z "$undrawn" ] || { echo "reproduce: not drawn:$undrawn" >&2; return 1; }
}
draw_noise() { # D/DX
   local model run stem spectra='' fields='' probes='' labels='' quoted=''
   for model in $noise_models; do
      run=$plain/dam_${model}_ma_0.1_$1
      stem=$(basename "$(last_snapshot "dam_${model}_ma_0.1_$1")" .vtkhdf)
      spectra+=" $run/vorticity_spectrum_${stem#snapshot_}.dat" fields+=" $run/vorticity_field_${stem#snapshot_}.dat" probes+=" $run/P1_spectrum.dat"
      labels+=" ${model/alpha_/α_=_}"
      quoted+=" \"${model/alpha_/α = }\""
   done
   draw vorticity_spectra vorticity_spectra "tables='$spectra'; labels='$labels'"
   draw vorticity_fields vorticity_fields "tables='$fields'; labels='$labels'; top=0.7"
   draw probe_spectra P1_spectra "tables='$probes'; labels='$quoted'; probe='P1'"
   draw impact P1 "runs='$(for model in alpha_0.01 dynamic; do echo "$plain/dam_${model}_ma_0.1_$1"; done | tr '\n' ' ')'; labels='α_=_0.01 dynamic'"
}
