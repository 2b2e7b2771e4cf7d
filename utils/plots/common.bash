# What draw and animate share. Sourced, with `plots` (this directory) and `program` (its name in messages) set.

trap '' XFSZ   # a limit of the size of files is told as a full disk is

# complain MESSAGE: the end, with the exit code for files.
complain() { echo "$program: $1" >&2; exit 3; }

# begin RESULT: sets `result` and makes `scratch`. Names of directories must not become gnuplot's code: it works in a directory of
# its own, where plots and tables are links. Of a full disk it says nothing; so a picture comes to its place only when it is complete.
begin() {
   result=${1%/}
   [ -d "$result" ] || complain "'$result' is not a directory"
   command -v gnuplot >/dev/null || complain "gnuplot is missing (Debian, Ubuntu: apt-get install gnuplot-nox)"
   scratch=$(mktemp -d)
   trap 'rm -rf "$scratch"' EXIT
   ln -s "$plots" "$scratch/plots"
   mkdir "$scratch/result"
}

# deliver PICTURE END: from the scratch directory to the result, and says so, if the last bytes of it are END (od's names for them).
deliver() {
   local picture=$scratch/result/$1 end=$2 reason
   if [ "$(tail -c $((${#end}/3 + 1)) "$picture" | od -An -tx1 | tr -d '\n')" != " $end" ]; then
      reason=$(LC_ALL=C head -c 9999999 /dev/zero 2>&1 >>"$picture") || true   # fails as gnuplot did, and says why
      complain "cannot write '$picture': ${reason##*: }"
   fi
   cp "$picture" "$result/$1.partial" && mv "$result/$1.partial" "$result/$1" || { rm -f "$result/$1.partial"; exit 3; }
   echo "$result/$1"
}

# find_snapshots: sets `snapshots`, and `converter` where there are any. It is looked for in $DYNSPH_BIN, in build/bin of this
# checkout, where it was installed with this script, and on the PATH.
find_snapshots() {
   local place
   shopt -s nullglob
   snapshots=("$result"/snapshot_??????.vtkhdf)
   [ ${#snapshots[@]} -gt 0 ] || return 0
   for place in "${DYNSPH_BIN:-$plots/../../build/bin}" "$(dirname "$0")" "$plots/../../../bin"; do
      converter=$place/dynsph-snapshot-to-text
      [ ! -x "$converter" ] || return 0
   done
   converter=$(command -v dynsph-snapshot-to-text) ||
      complain "dynsph-snapshot-to-text not found: build dynsph, or set DYNSPH_BIN to its directory"
}

# common_frame < HEADS: settings of field.gp: left, right and upper end of the particles of all tables, in reference lengths. Where
# solids stand out of the fluid, up to half of its height more.
common_frame() {
   awk '
      $2 == "reference_length:" { d = $3 } $2 == "spacing:" { dx = $3 } $2 == "gravity:" { g = $3 }
      $2 == "outline" { n++; x[n] = $5; y[n] = $6 }
      $2 != "range" { next }
      $4 == "x:" && (!seen_x || $5 < left) { left = $5 }
      $4 == "x:" && (!seen_x++ || $6 > right) { right = $6 }
      $4 == "y:" && (!seen_y || $5 < lower) { lower = $5 }
      $4 == "y:" && (!seen_y++ || $6 > upper) { upper = $6 }
      END { if (!(d > 0 && g > 0)) d = 1
            top = upper
            for (k = 1; k <= n; k++) if (x[k] >= left && x[k] <= right && y[k] > top) top = y[k]
            if (top > upper) upper = top < 1.5*upper - 0.5*lower ? top : 1.5*upper - 0.5*lower
            printf "x_min=%.9g; x_max=%.9g; y_min=%.9g; y_max=%.9g", (left - dx/2)/d, (right + dx/2)/d, (lower - dx/2)/d, (upper + dx/2)/d }'
}
