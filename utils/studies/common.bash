# What the studies share, to be sourced at their start. Then the top of the source is the current directory, and all files that a
# study makes are below $results.
#
# DYNSPH_BUILD     the build, instead of build
# DYNSPH_RESULTS   where runs go, instead of results
# DYNSPH_TABLES    where `publish` and `picture` leave copies; utils/studies/all: docs/results
# JOBS             runs side by side, instead of 2
# THREADS          threads of each of these runs, instead of 1: for a few large ones on many cores
set -euo pipefail
export LC_NUMERIC=C
unset GNUTERM   # a terminal of the user's that pictures have no use for
study=$(basename "$0")
script=$(cd "$(dirname "$0")" && pwd)/$study
called=utils/$(basename "$(dirname "$script")")/$study
command="$called${*:+ $*}"
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=${DYNSPH_BUILD:-build} results=${DYNSPH_RESULTS:-results} jobs=${JOBS:-2} threads=${THREADS:-1}

# The comment at the head of the study, for who calls it with a word that it does not know.
usage() { awk 'NR > 1 { if (!/^#/) exit; sub(/^# ?/, ""); print }' "$script" >&2; exit 1; }
needs() { # PROGRAM...
   local program
   for program in "$@"; do
      [ -x "$build/bin/$program" ] || {
         echo "$called: build first: cmake -B build && cmake --build build -j2" >&2; exit 3; }
   done
}

# --- What a table was made with.
# One line: version, commit, build type, compiler, how the pair loops are compiled; processor, cores; day.
made_with() {
   "$build/bin/dynsph" --version | awk '
      NR == 1 { line = $0 }
      /^GCC version/ { line = line ", GCC " $3 }
      /^clusters/ { line = line ", " $0 }
      END { print line }' | tr '\n' ';'
   awk -F': *' '
      /^model name/ { name = $2 } /^cpu family/ { family = $2 } /^model[ \t]*:/ { model = $2 } /^processor/ { cores++ }
      /^flags/ { wide = / avx512f / ? ", AVX-512" : / avx2 / ? ", AVX2" : "" }
      END { printf " %s, family %s, model %s%s, %d cores; ", name, family, model, wide, cores }' /proc/cpuinfo 2>/dev/null ||
      printf ' %s; ' "$(uname -m)"
   date +%Y-%m-%d
}
# Adds it to what $out was made with; to be called before each run.
stamp() {
   local line
   line=$(made_with)
   grep -sqxF "$line" "$out/made_with" || echo "$line" >>"$out/made_with"
}
# publish NAME HEADING FILE [MADE_WITH]: the tables in FILE under their head as $out/NAME.md.
publish() {
   {
      printf '# %s\n\nWritten by `%s` with\n\n' "$2" "$command"
      awk '!seen[$0]++ { print "- " $0 }' "${4:-$out/made_with}"   # two runs that begin together may both have written a line
      echo
      sed '1{/^$/d}' "$3"
   } >"$out/$1.md"
   echo "table $out/$1.md" >&2
   [ -z "${DYNSPH_TABLES:-}" ] || { mkdir -p "$DYNSPH_TABLES"; cp "$out/$1.md" "$DYNSPH_TABLES"; }
}
picture() { # FILE
   echo "picture $1"
   [ -z "${DYNSPH_TABLES:-}" ] || { mkdir -p "$DYNSPH_TABLES"; cp "$1" "$DYNSPH_TABLES"; }
}
has_gnuplot() { command -v gnuplot >/dev/null; }

# --- Runs and their numbers.
# Whether a run has come to its end, good or bad; one that was stopped has not.
ended() { [ -e "$1/summary.txt" ] && ! grep -qE '^status = stopped: (SIG|file|max_wall)' "$1/summary.txt"; }
# run DIRECTORY SCENE KEY=VALUE...: a scene of input/, unless it has ended; one that was broken off goes on.
# Messages are beside the directory.
run() {
   local dir=$1 scene=$2 arguments=() setting
   shift 2
   ! ended "$dir" || return 0
   for setting in "$@"; do arguments+=(--set "$setting"); done
   arguments+=(--overwrite --output "$dir" "input/$scene.nml")
   [ ! -e "$dir/input_used.nml" ] || arguments=(--resume "$dir")
   mkdir -p "$(dirname "$dir")"
   stamp
   OMP_NUM_THREADS=$threads "$build/bin/dynsph" --quiet "${arguments[@]}" >"$dir.messages" 2>&1 </dev/null || echo "$dir: see $dir.messages" >&2
}
# side_by_side FUNCTION: calls it for each line that comes in, with its words.
side_by_side() { xargs -P "$jobs" -L 1 bash -c "$1 \"\$@\"" _; }
# value DIRECTORY KEY [FORM]: a value of its summary; '-' if there is none.
value() {
   awk -v key="$2" -v form="${3:-%s}" '
      $1 == key { number = $3 + 0 == $3; text = $0; sub(/^[^=]*= */, "", text); printf((number ? form : "%s"), text); found = 1; exit }
      END { if (!found) printf "-" }' "$1/summary.txt" 2>/dev/null || printf -- -
}
# row CELL...: a line of a table; header CELL...: its first two.
row() { printf '|'; printf ' %s |' "$@"; echo; }
header() { row "$@"; row "${@/*/---}"; }
export -f made_with stamp ended run value
export out build threads
