# The tables of the paper's campaign, from what its runs have left.

# Facts of runs, a file each with lines 'key value'. They go where tables go: so a campaign can be pieced together on several machines,
# and its tables be made again, long after the runs themselves are gone.
facts=${DYNSPH_TABLES:+$DYNSPH_TABLES/$(basename "$out")_facts}
facts=${facts:-$out/facts}

# Makes those of each run that is here and has gone on since. One that has not ended takes the place of no other, nor does an older one.
gather() {
   local dir name state of known
   for dir in "$out"/*/; do
      dir=${dir%/} name=$(basename "$dir")
      [ -s "$dir/energy.dat" ] || continue
      # The time first: should the run end after that, it is seen again.
      of=$(last_written "$dir")
      state='not ended'
      if has_finished "$dir"; then state=finished; elif ended "$dir"; then state=failed; fi
      known=$(fact "$name" state)
      case $state$known in
      'not endedfinished' | 'not endedfailed') continue ;;
      *-) ;;
      *) [[ $(fact "$name" of) < $of ]] || continue ;;
      esac
      {
         echo "state $state"
         echo "of $of"
         version_of "$dir"
         case $state in
         finished)
            awk -f utils/paper/facts.awk "$dir/summary.txt" "$dir/energy.dat"
            case $name in
            patch*) densities "$dir" ;;
            bar_*_ma_0.1_*_[1-9]) probe_differences "${dir%_*}_0" "$dir" ;;
            esac ;;
         failed) tail -n 1 "$dir/energy.dat" | awk '{ print "t", $2 }' ;;
         *) awk -f utils/paper/facts.awk "$dir/energy.dat" ;;
         esac
      } >"$scratch/facts"
      put "$scratch/facts" "$facts/$name"
   done
}
has_finished() { grep -qsE '^status = (finished|stopped: max_steps)' "$1/summary.txt"; }
# When the last of what facts are made of was written: of the run, and for a start of the one that it is compared with.
last_written() { # DIRECTORY
   local file
   for file in "$1"/{energy.dat,summary.txt} "${1%_[1-9]}_0/summary.txt"; do
      [ ! -e "$file" ] || date -u -r "$file" '+%F %T.%N'
   done | LC_ALL=C sort | tail -n 1
}
# Version, and what the program was made with: the line of made_with that has the version as `--version` writes it.
version_of() { # DIRECTORY
   local version
   version=$(sed -n 's/^│ dynsph *\(.*[^ ]\) *│$/\1/p' "$1/run.log" 2>/dev/null | tail -n 1)
   [ -n "$version" ] || return 0
   echo "version $version"
   awk -v made="$(sed 's/\([^ ]*\) \(.*\) \([^ ]*\)/dynsph \1 (\2, \3)/' <<<"$version")" '
      index($0, made) == 1 { line = $0 } END { if (line) print "made_with", line }' "$out/made_with" 2>/dev/null || true
}
# put FILE PLACE: whole or not at all, whoever else may write there.
put() {
   local partial
   partial=$(mktemp "$(dirname "$2")/.XXXXXX")
   cat "$1" >"$partial"
   chmod 644 "$partial"
   mv "$partial" "$2"
}
# Of all snapshots of a run, the largest share that 99.8 % of the particles do not exceed, the largest rms, and the most of the particles
# that are beyond 1 %.
densities() { # DIRECTORY
   local snapshot
   for snapshot in "$1"/snapshot_??????.vtkhdf; do
      [ -e "$snapshot" ] || continue
      "$build/bin/dynsph-snapshot-to-text" "$snapshot" "$scratch/snapshot.txt" >/dev/null
      awk -f utils/paper/density.awk "$scratch/snapshot.txt"
   done | awk '{ if ($1 > share) share = $1; if ($2 > rms) rms = $2; if ($3 > most) most = $3 }
      END { if (NR) printf "variation_998 %s\nvariation_rms %s\nbeyond_most %g\n", share, rms, most }'
}
# How far P1 of two runs is apart, before the plunging jet lands and from t = 8 on; nothing if one has not got there.
probe_differences() { # DIRECTORY DIRECTORY
   local dir
   for dir in "$@"; do { has_finished "$dir" && [ -s "$dir/probes.dat" ]; } || return 0; done
   p1_difference '2.6 6.15 8 20' "$1/probes.dat" "$2/probes.dat" | awk '{ print "P1_before", $1; print "P1_after", $3 }'
}
p1_difference() { awk -v probe=P1 -v windows="$1" -v width=0.2 -f utils/studies/probe_difference.awk "$2" "$3"; }
# fact RUN KEY [FORM]: '-' where it is not known, or no number although FORM is that of one.
fact() {
   awk -v key="$2" -v form="${3:-%s}" '$1 == key && (form == "%s" || $2 + 0 == $2) { sub(/^[^ ]* /, ""); printf form, $0; found = 1; exit } END { if (!found) printf "-" }' \
      "$facts/$1" 2>/dev/null || printf -- -
}
# Resolutions at which there is a run NAME_D/DX that knows KEY, the coarsest first.
sizes() { # NAME KEY
   local file
   for file in "$facts/$1"_*; do
      if [[ ${file##*_} =~ ^[0-9]+$ ]] && [ "${file%_*}" = "$facts/$1" ] && grep -q "^$2 [-0-9]" "$file"; then echo "${file##*_}"; fi
   done | sort -n
}
finest() { sizes "$@" | tail -n 1; }
# ratio A B: '-' where a number is not there.
ratio() { awk -v a="$1" -v b="$2" 'BEGIN { if (a == "-" || b == "-" || b == 0) printf "-"; else printf "%.2f", a/b }'; }
# Of VALUE:DEVIATION words, (largest - least)/mean, and the deviation of that if those of the two are known.
spread() {
   printf '%s\n' "$@" | awk -F: '
      $1 == "-" { next }
      { if (!n++ || $1 < low) { low = $1; of_low = $2 }
        if (n == 1 || $1 > high) { high = $1; of_high = $2 }
        sum += $1 }
      END { if (n < 2 || sum <= 0) { printf "-"; exit }
            printf "%.3f", (high - low)/(sum/n)
            if (of_low of_high ~ /[0-9]/) printf " %.3f", sqrt(of_low^2 + of_high^2)/(sum/n) }'
}
spread_shown() { spread "$@" | sed 's/ / +- /'; }
# Runs whose starts differ by 1e-12. d/dx of those of a model, the coarsest first, and how many starts have ended.
bar_sizes() { # MODEL MA
   { grep -ls '^state finished' "$facts/bar_$1_ma_$2"_*_[0-9] || true; } |
      awk -F_ '{ n[$(NF - 1)]++ } END { for (size in n) print size, n[size] }' | sort -n
}
# The d/dx whose starts are asked: a given one if it has as many as any other, else the finest that has.
bar_size() { # MODEL MA [D/DX]
   bar_sizes "$1" "$2" | awk -v wanted="${3:-}" '
      $2 > most { most = $2; size = "" }
      $2 == most && size != wanted || size == "" { size = $1 }
      END { print size }'
}
# Standard deviation of a fact, with '+-' as it is shown, and mean of those whose start is not the unchanged one.
starts_of() { # MODEL MA KEY NUMBERS D/DX
   local file
   for file in "$facts/bar_$1_ma_$2_$5"_$4; do
      [ ! -e "$file" ] || echo "$(fact "$(basename "$file")" "$3")"
   done | awk '$1 + 0 == $1'
}
deviation() { # MODEL MA KEY [D/DX]
   starts_of "$1" "$2" "$3" '[0-9]' "$(bar_size "$1" "$2" "${4:-}")" |
      awk '{ n++; sum += $1; square += $1^2 } END { if (n > 2) { v = (square - sum^2/n)/(n - 1); printf "%.6g", sqrt(v > 0 ? v : 0) } else printf "-" }'
}
varies() { deviation "$@" | awk '{ printf($1 == "-" ? "+- -" : "+- %.3f", $1) }'; }
average() { # MODEL MA KEY
   starts_of "$@" '[1-9]' "$(bar_size "$1" "$2")" | awk '{ n++; sum += $1 } END { if (n) printf "%.3f", sum/n; else printf "-" }'
}
# verdict KIND PAPER OURS [DEVIATION]: `below` a bound or `about` a number. Holds: to 10 %; roughly: to 30 %; within +-: above the bound,
# but by less than twice the deviation.
verdict() {
   if [ "$3" = - ]; then echo 'not computed'; return; fi
   awk -v kind="$1" -v paper="$2" -v ours="$3" -v s="${4:-0}" 'BEGIN {
      off = ours/paper - 1
      if (kind == "below") print off <= 0 ? "holds" : ours - 2*s <= paper ? "within +-" : off <= 0.3 ? "roughly" : "does not hold"
      else { if (off < 0) off = -off; print off <= 0.1 ? "holds" : off <= 0.3 ? "roughly" : "does not hold" }
   }'
}
# A fact at all resolutions, 'value (d/dx), ...'.
each() { # NAME KEY FORM
   local size text=''
   for size in $(sizes "$1" "$2"); do text+=", $(fact "$1_$size" "$2" "$3") ($size)"; done
   [ -n "$text" ] && echo "${text#, }" || echo -
}
# One number of the paper against a fact at all resolutions; the verdict is on the finest.
simple() { # CLAIM STATEMENT KIND PAPER NAME KEY [FORM] [NOTE]
   local size
   size=$(finest "$5" "$6")
   row "$1" "$2" "$([ "$3" = below ] && echo "< $4" || echo "~ $4")" "$(each "$5" "$6" "${7:-%.3g}")${8:+; $8}" \
      "$(verdict "$3" "$4" "$(fact "$5_$size" "$6")")" "\`$5\`"
}
# The same for a number that is reckoned from others: OURS has its text, LAST what is judged, with its deviation after a blank.
reckoned() { # CLAIM STATEMENT KIND PAPER OURS LAST RUNS
   row "$1" "$2" "$([ "$3" = below ] && echo "< $4" || echo "~ $4")" "$5" "$(verdict "$3" "$4" $6)" "\`$7\`"
}
# Ratio of two facts of a run at all resolutions.
quotients() { # CLAIM STATEMENT PAPER NAME KEY KEY
   local size text='' last=-
   for size in $(sizes "$4" "$5"); do
      last=$(ratio "$(fact "$4_$size" "$5")" "$(fact "$4_$size" "$6")")
      text+=", $last ($size)"
   done
   text=${text:-, -}
   reckoned "$1" "$2" about "$3" "${text#, }" "$last" "$4"
}

claims() {
   local dam=dam_alpha_0.01_ma_0.05 dynamic=dam_dynamic_ma_0.05 run size alpha text values model
   header claim statement paper 'ours (d/dx)' verdict runs
   # The water patch: alpha as in the paper's runs at d/dx = 100 (runs.bash).
   simple W1 'density varies by less than 1 %: largest of a particle, at any time' below 0.01 patch_alpha_0.01 max_density_variation %.4f \
      "beyond 1 % for $(each patch_alpha_0.01 variation_beyond %.4f) of the time, and at most $(each patch_alpha_0.01 beyond_most %.2g) of the particles at once"
   simple W1 'the same, of 99.8 % of the particles in each snapshot' below 0.01 patch_alpha_0.01 variation_998 %.4f \
      "rms $(each patch_alpha_0.01 variation_rms %.4f)"
   simple W1 'the same, of all particles at all times from t = 30 on' below 0.01 patch_alpha_0.01 variation_from_30 %.4f
   simple W1 'error of the total energy' below 0.003 patch_alpha_0.01 balance %.1e
   simple W2 'dissipated at t = 140' about 0.55 patch_alpha_0.01 Q@140 %.3f "2 d wide: $(each patchwide_alpha_0.01 Q@140 %.3f)"
   size=$(for alpha in 0 0.01 0.03; do sizes patch_alpha_$alpha Q@140; done | sort -n | uniq -c | awk '$1 == 3 { print $2 }' | tail -n 1)
   if [ -n "$size" ]; then
      text='' values=()
      for alpha in 0 0.01 0.02 0.03; do
         values+=("$(fact "patch_alpha_${alpha}_$size" Q@140 %.3f)")
         text+=", ${values[-1]}"
      done
      reckoned W3 "Q(140) for alpha h c0 as with alpha = 0, 0.01, 0.02, 0.03 at d/dx = 100 hardly moves: spread" below 0.05 "$(spread "${values[@]}") (${text#, })" \
         "$(spread "${values[@]}")" "patch_alpha_*_$size"
   fi
   quotients W3 'Q_alpha/Q_delta, alpha h c0 as with alpha = 0.01' 1 patch_alpha_0.01 Q_alpha/dE@140 Q_delta/dE@140
   quotients W3 'the same, patch 2 d wide' 1 patchwide_alpha_0.01 Q_alpha/dE@140 Q_delta/dE@140
   quotients W3 'Q_delta/Q_alpha, alpha h c0 as with alpha = 0.03' 0.5 patch_alpha_0.03 Q_delta/dE@140 Q_alpha/dE@140
   # The dam break with constant coefficients.
   simple D1 'error of the total energy, Ma 0.05' below 0.005 $dam balance %.1e
   simple D1 'dissipated at t = 15.5' about 0.8 $dam Q@15.5 %.3f "$(varies alpha_0.01 0.05 Q@15.5); 0.8 at t = $(each $dam t_80 %.1f)"
   simple D1 'dissipated at t = 20' about 0.9 $dam Q@20 %.3f "$(varies alpha_0.01 0.05 Q@20)"
   simple D2 'first maximum of E_K' about 3.0 $dam time_kinetic_maximum %.2f
   simple D2 'maximum of E_P' about 5.5 $dam time_potential_maximum %.2f
   simple D2 'second maximum of E_K' about 6.8 $dam time_kinetic_maximum_2 %.2f
   simple D2 'elastic peak' about 8.5 $dam time_elastic_peak %.2f
   size=$(for alpha in $alphas; do sizes dam_alpha_${alpha}_ma_0.05 Q@20; done | sort -n | uniq -c | awk '$1 == 5 { print $2 }' | tail -n 1)
   if [ -n "$size" ]; then
      text='' values=()
      for alpha in $alphas; do
         values+=("$(fact "dam_alpha_${alpha}_ma_0.05_$size" Q@20 %.3f):$(deviation alpha_$alpha 0.05 Q@20)")
         text+=", ${values[-1]%:*} $(varies alpha_$alpha 0.05 Q@20)"
      done
      reckoned D3 "Q(20) for alpha = ${alphas// /, }: spread" below 0.05 "$(spread_shown "${values[@]}") (${text#, })" "$(spread "${values[@]}")" \
         "dam_alpha_*_ma_0.05_$size"
   fi
   quotients D3 'Q_delta/Q_alpha(20) at alpha = 0.005, Ma/alpha = 10' 1 dam_alpha_0.005_ma_0.05 Q_delta/dE@20 Q_alpha/dE@20
   quotients D3 'Q_delta/Q_alpha(20) at alpha = 0.03' 0.333 dam_alpha_0.03_ma_0.05 Q_delta/dE@20 Q_alpha/dE@20
   quotients D4 'Q_alpha/Q_delta(20), Ma 0.1, at each d/dx' 1 dam_alpha_0.01_ma_0.1 Q_alpha/dE@20 Q_delta/dE@20
   all_sizes D4 'Q(20) nearly the same at each d/dx from 100 on: spread' dam_alpha_0.01_ma_0.1 alpha_0.01
   # The dynamic model.
   simple L1 'mean alpha_i at t = 12' about 0.002 $dynamic alpha_mean@12 %.4f
   simple L1 'mean delta_i' about 0.04 $dynamic delta_mean@12 %.3f
   simple L1 'largest alpha_i' about 0.01 $dynamic alpha_max@12 %.4f "strain rate clipped: $(each dam_strain_rate_ma_0.05 alpha_max@12 %.4f)"
   simple L1 'largest delta_i' about 0.2 $dynamic delta_max@12 %.3f
   for model in dynamic strain_rate; do
      text=
      [ $model = dynamic ] || text=', strain rate clipped'
      run=dam_${model}_ma_0.05
      quotients L2 "Q_alpha/Q_delta(20)$text" 1 $run Q_alpha/dE@20 Q_delta/dE@20
      against L2 "Q(12) over that with alpha = 0$text" dam_alpha_0_ma_0.05 $run Q@12 alpha_0 $model
      against L2 "Q_alpha(20) over that with alpha = 0.005$text" dam_alpha_0.005_ma_0.05 $run Q_alpha/dE@20 alpha_0.005 $model
      against L2 "Q_delta(20) over that with alpha = 0.005$text" dam_alpha_0.005_ma_0.05 $run Q_delta/dE@20 alpha_0.005 $model
   done
   simple L3 'Q_omega(20), Ma 0.1' below 0.01 dam_dynamic_ma_0.1 Q_omega/dE@20 %.1e
   judged L3 'share of enstrophy above pi/(2h), Ma 0.1, over that with alpha = 0' below 1 enstrophy_share_over_alpha_0 "$(averaged)"
   judged L3 'vorticity resembles that with alpha = 0: enstrophy below pi/(2h) over the one there' about 1 enstrophy_resolved_over_alpha_0 "$(averaged)"
   judged A1 'P1 of both models coincides to t = 6.15 (we say: to 2 %): rms of the difference, from 2.6 on' below 0.02 P1_before "$(starts P1_before)"
   judged A1 'and is shifted in time after it: the same from 8 on' - - P1_after "$(starts P1_after)"
   for model in dynamic alpha_0.01; do
      judged A1 "near the experiment: rms of the difference to Lobovsky et al. over their rms, 2.6 to 6.15, ${model/_/ }" - - P1_measured_$model
   done
   judged A1 'no spurious high frequencies: rise of the spectrum from an octave to the next, dynamic' below 1 rise_dynamic
   judged A1 'the same, alpha = 0.01' below 1 rise_alpha_0.01
   all_sizes L4 'Q(20) nearly the same at each d/dx from 100 on: spread' dam_dynamic_ma_0.1 dynamic
}
# What `noise` found. KIND -: a number that there is no verdict on.
judged() { # CLAIM STATEMENT KIND PAPER KEY [NOTE]
   local size value sign=$3
   size=$(noise_size)
   value=$(fact "noise_$size" "$5" %.3g)
   sign=${sign/below/<} sign=${sign/about/\~}
   row "$1" "$2" "$sign $4" "$value ($size)${6:+; $6}" "$([ "$3" = - ] && echo '-' || verdict "$3" "$4" "$value")" '`dam_*_ma_0.1`'
}
averaged() { echo "mean of $(fact "noise_$(noise_size)" snapshots) snapshots, t = 16 to 20"; }
starts() { echo "starts of one model: $(average dynamic 0.1 "$1") ($(bar_size dynamic 0.1)), $(average alpha_0.01 0.1 "$1") ($(bar_size alpha_0.01 0.1))"; }
# How much Q(20) changes with the resolution.
all_sizes() { # CLAIM STATEMENT NAME MODEL
   local size values=()
   for size in $(sizes "$3" Q@20); do
      # The paper says it of 100 and more.
      case $tier in quick | smoke) ;; *) [ "$size" -ge 100 ] || continue ;; esac
      values+=("$(fact "$3_$size" Q@20 %.3f):$(deviation "$4" 0.1 Q@20 "$size")")
   done
   reckoned "$1" "$2" below 0.05 "$(spread_shown "${values[@]}"): $(each "$3" Q@20 %.3f), $(varies "$4" 0.1 Q@20)" "$(spread "${values[@]}")" "$3"
}
# A fact of a run with the dynamic model over that of one with constant coefficients, with what both models vary by.
against() { # CLAIM STATEMENT OTHER NAME KEY OTHER_MODEL MODEL
   local size text='' last=-
   for size in $(sizes "$4" "$5"); do
      [ "$(fact "$3_$size" "$5")" != - ] || continue
      last=$(ratio "$(fact "$4_$size" "$5")" "$(fact "$3_$size" "$5")")
      text+=", $last = $(fact "$4_$size" "$5" %.3f)/$(fact "$3_$size" "$5" %.3f) ($size)"
   done
   text=${text:-, -}", $(varies "$7" 0.05 "$5") and $(varies "$6" 0.05 "$5")"
   reckoned "$1" "$2" about 1 "${text#, }" "$last" "$4, $3"
}

# --- What starts that differ by 1e-12 do.
error_bars() {
   local model mach size n key run cells
   header 'model, Ma' 'd/dx' runs 'Q_alpha(12)' 'Q_delta(12)' 'Q(12)' 'Q_alpha(20)' 'Q_delta(20)' 'Q(15.5)' 'Q(20)'
   for mach in 0.05 0.1; do
      for model in $(printf 'alpha_%s ' $alphas) dynamic; do
         while read -r size n; do
            run=bar_${model}_ma_${mach}_${size}_0
            cells=()
            for key in Q_alpha/dE@12 Q_delta/dE@12 Q@12 Q_alpha/dE@20 Q_delta/dE@20 Q@15.5 Q@20; do
               cells+=("$(fact "$run" $key %.3f) $(varies "$model" "$mach" $key "$size")")
            done
            row "$model, $mach" "$size" "$n" "${cells[@]}"
         done < <(bar_sizes "$model" "$mach")
      done
   done
}
# Differences between runs that the paper speaks of: larger than what two runs differ by anyhow, when they are more than twice the
# standard deviation of a difference.
differences() {
   printf "'+-' is that of a difference, by the starts at this d/dx or the finest there are. Real: more than twice that.\n\n"
   header claim 'difference (d/dx)' ours '+-' real
   # Constant coefficients against each other, at Ma 0.05.
   difference D3 'Q(20), alpha = 0.03 and 0' Q@20 0.05 alpha_0.03 alpha_0
   difference D3 'Q(20), alpha = 0.02 and 0.005' Q@20 0.05 alpha_0.02 alpha_0.005
   difference D3 'Q_alpha(20), alpha = 0.03 and 0.005' Q_alpha/dE@20 0.05 alpha_0.03 alpha_0.005
   difference D3 'Q_delta(20), alpha = 0.03 and 0.005' Q_delta/dE@20 0.05 alpha_0.03 alpha_0.005
   difference L2 'Q(12), dynamic and alpha = 0' Q@12 0.05 dynamic alpha_0
   difference L2 'Q(12), alpha = 0.01 and 0' Q@12 0.05 alpha_0.01 alpha_0
   difference L2 'Q_alpha(20), dynamic and alpha = 0.005' Q_alpha/dE@20 0.05 dynamic alpha_0.005
   difference L2 'Q_delta(20), dynamic and alpha = 0.005' Q_delta/dE@20 0.05 dynamic alpha_0.005
   difference L2 'Q(20), dynamic and alpha = 0.005' Q@20 0.05 dynamic alpha_0.005
   difference L2 'Q(20), dynamic and alpha = 0.01' Q@20 0.05 dynamic alpha_0.01
   difference D4 'Q(20), dynamic and alpha = 0.01, Ma 0.1' Q@20 0.1 dynamic alpha_0.01
   between_sizes D4 alpha_0.01
   between_sizes L4 dynamic
}
difference() { # CLAIM WORDS KEY MA MODEL MODEL
   local size
   { sizes "dam_$5_ma_$4" "$3"; sizes "dam_$6_ma_$4" "$3"; } | sort -n | uniq -d | while read -r size; do
      compared "$1" "$2 ($size)" "$(fact "dam_$5_ma_$4_$size" "$3")" "$(fact "dam_$6_ma_$4_$size" "$3")" \
         "$(deviation "$5" "$4" "$3" "$size")" "$(deviation "$6" "$4" "$3" "$size")"
   done
}
# Each resolution against the next finer one.
between_sizes() { # CLAIM MODEL
   local size coarser=''
   for size in $(sizes "dam_$2_ma_0.1" Q@20); do
      [ -z "$coarser" ] || compared "$1" "Q(20), ${2/_/ }, Ma 0.1, d/dx = $coarser and $size" "$(fact "dam_$2_ma_0.1_$coarser" Q@20)" \
         "$(fact "dam_$2_ma_0.1_$size" Q@20)" "$(deviation "$2" 0.1 Q@20 "$coarser")" "$(deviation "$2" 0.1 Q@20 "$size")"
      coarser=$size
   done
}
compared() { # CLAIM WORDS A B DEVIATION DEVIATION
   awk -v claim="$1" -v words="$2" -v a="$3" -v b="$4" -v s="$5" -v r="$6" 'BEGIN {
      d = a - b; both = real = "-"
      if (s != "-" && r != "-") { both = sprintf("%.3f", sqrt(s^2 + r^2)); real = d^2 > 4*(s^2 + r^2) ? "yes" : "no" }
      printf "| %s | %s | %+.3f | %s | %s |\n", claim, words, d, both, real }'
}
# --- What other readings of the paper do.
ablation() {
   local model name
   header reading 'model, Ma' 'E_K max' 'E_P max' 'E_K max' 'Q_alpha(20)' 'Q_delta(20)' 'Q(15.5)' 'Q(20)' 'balance error' 'alpha mean(12)' 'alpha max(12)' 'delta mean(12)'
   for model in alpha_0.01_ma_0.1 alpha_0.01_ma_0.05 dynamic_ma_0.1 dynamic_ma_0.05; do
      reading 'as it is here' $model "bar_${model}_${question}_0"
      while IFS='|' read -r name _; do reading "${name% }" $model "reading_${model}_${name% }_$question"; done < <(readings)
   done
}
reading() { # WORDS MODEL RUN
   local model=${2/_ma_/, }
   [ "$(fact "$3" state)" = finished ] || return 0
   row "${1//_/ }" "${model//_/ }" "$(fact "$3" time_kinetic_maximum %.2f)" "$(fact "$3" time_potential_maximum %.2f)" "$(fact "$3" time_kinetic_maximum_2 %.2f)" \
      "$(fact "$3" Q_alpha/dE@20 %.3f)" "$(fact "$3" Q_delta/dE@20 %.3f)" "$(fact "$3" Q@15.5 %.3f)" "$(fact "$3" Q@20 %.3f)" "$(fact "$3" balance %.1e)" \
      "$(fact "$3" alpha_mean@12 %.4f)" "$(fact "$3" alpha_max@12 %.4f)" "$(fact "$3" delta_mean@12 %.3f)"
}
# The same for the patch: what W1 to W3 are about.
patch_ablation() {
   local name run alpha cells=()
   for alpha in $patch_alphas; do cells+=("Q(140), alpha = $alpha"); done
   header reading "${cells[@]}" 'Q_alpha/Q_delta, alpha = 0.01' 'largest density variation' 'of 99.8 %' 'beyond 1 %, share of the time' 'balance error'
   while IFS='|' read -r name _; do
      name=patchreading_${name% } run=${name}_alpha_0.01_$patch_question
      [ "$(fact "$run" state)" = finished ] || continue
      cells=()
      for alpha in $patch_alphas; do cells+=("$(fact "${name}_alpha_${alpha}_$patch_question" Q@140 %.3f)"); done
      name=${name#*_}
      row "${name//_/ }" "${cells[@]}" "$(ratio "$(fact "$run" Q_alpha/dE@140)" "$(fact "$run" Q_delta/dE@140)")" "$(fact "$run" max_density_variation %.4f)" \
         "$(fact "$run" variation_998 %.4f)" "$(fact "$run" variation_beyond %.4f)" "$(fact "$run" balance %.1e)"
   done < <(patch_readings)
}
# --- All runs.
all_runs() {
   local name state
   header run particles steps 'reached t' 'ns a particle-step' Q_alpha Q_delta Q 'balance error' version
   ls "$facts" | awk '/^(dam|patch|patchwide)_/' | sort -V | while read -r name; do
      state=$(fact "$name" state)
      row "\`$name\`" "$(fact "$name" particles)" "$(fact "$name" steps)" "$(fact "$name" t %.4g)$([ "$state" = finished ] || echo " ($state)")" \
         "$(fact "$name" ns_per_particle_step_per_core %.0f)" "$(fact "$name" Q_alpha %.3f)" "$(fact "$name" Q_delta %.3f)" "$(fact "$name" Q_total %.3f)" "$(fact "$name" balance %.1e)" "$(fact "$name" version)"
   done
}

write_tables() {
   local file
   gather
   noise
   {
      echo "Times are t sqrt(g/d), energies shares of Delta E_M^tot. '+-': standard deviation of runs whose starts differ by 1e-12, at the finest d/dx that they have."
      echo 'Holds: the number as the paper has it, or within 10 % of one that it gives as approximate; roughly: within 30 %; within +-: beyond'
      echo 'a bound by less than twice the deviation. Judged at the finest d/dx.'
      echo
      claims
      printf '\n## Noise (L3, A1)\n\n'
      cat "$facts/noise_$(noise_size).tables" 2>/dev/null ||
         echo 'Not known: it needs alpha = 0, alpha = 0.01 and the dynamic model at Ma 0.1 and one d/dx, with their snapshots and probes.'
      printf '\n## What single runs vary by\n\nStarts that differ by 1e-12 (`body(1).velocity`).\n\n'
      error_bars
      printf '\n## Differences and what single runs vary by\n\n'
      differences
      printf '\n## Other readings of the paper\n\nd/dx = %s, one thing changed at a time.\n\n' "$question"
      ablation
      printf '\nWater patch, d/dx = %s, alpha h c0 as with alpha at d/dx = 100:\n\n' "$patch_question"
      patch_ablation
      printf '\n## All runs\n\n'
      all_runs
      echo
      echo "Facts of each: $(basename "$facts")."
   } >"$scratch/table.md"
   for file in "$facts"/*; do [ ! -e "$file" ] || sed -n 's/^made_with //p' "$file"; done | LC_ALL=C sort -u >"$scratch/made_with"
   publish paper "The paper's claims" "$scratch/table.md" "$scratch/made_with"
}
