# What files.cmake runs: programs that cannot write. usage: bash files.bash CASE DYNSPH SCENE
case=$1 dynsph=$2 scene=$3 bin=${2%/*} plots=$(dirname "$0")/../../utils/plots
short=(--quiet --overwrite --output "$case" --set time.max_steps=20)
loud=("${short[@]:1}")
rm -rf "$case" "$case.moved"
# Waits until the run has begun, does what is said to its directory, and ends with the run's exit code.
meanwhile() { # COMMAND...
   "$dynsph" --quiet --set output.snapshots=never --set output.checkpoint=never --output "$case" "$scene" &
   until [ -s "$case/energy.dat" ] && [ -s "$case/input_used.nml" ]; do sleep 0.05; done
   "$@"
   wait $!
}
case $case in
full_screen_*) exec "$dynsph" "--${case#full_screen_}" "$scene" >/dev/full ;;
closed_screen_*) exec "$dynsph" "--${case#closed_screen_}" "$scene" >&- ;;
quiet_check) exec "$dynsph" --quiet --check "$scene" >&- ;;
spectra_help) exec "$bin/dynsph-spectra" --help >/dev/full ;;
run_full_screen) "$dynsph" "${loud[@]}" "$scene" >/dev/full && grep -q '^steps = 20' "$case/summary.txt" ;;
run_closed_screen) "$dynsph" "${loud[@]}" "$scene" >&- && grep -q '^steps = 20' "$case/summary.txt" ;;
run_broken_pipe) set -o pipefail; "$dynsph" "${loud[@]}" "$scene" | true && grep -q '^steps = 20' "$case/summary.txt" ;;
limit_table) ulimit -f 8; exec "$dynsph" "${short[@]}" --set output.snapshots=never --set output.checkpoint=never "$scene" ;;
limit_snapshot) ulimit -f 16; exec "$dynsph" "${short[@]}" "$scene" ;;
limit_log)   # the log has more in it than the input
   ulimit -f 2
   exec "$dynsph" "${short[@]}" --set output.energy=never --set output.snapshots=never --set output.checkpoint=never "$scene" ;;
limit_text)
   "$dynsph" "${short[@]}" "$scene" 2>/dev/null
   ulimit -f 8
   exec "$bin/dynsph-snapshot-to-text" "$case/snapshot_000000.vtkhdf" "$case/table.txt" ;;
limit_picture)
   command -v gnuplot >/dev/null || { echo SKIPPED:; exit; }
   "$dynsph" "${short[@]}" --set output.snapshots=never "$scene" 2>/dev/null
   ulimit -f 8
   DYNSPH_BIN=$bin bash "$plots/draw" "$case"
   status=$?
   ! ls "$case"/*.png* 2>/dev/null || status=cut
   exit $status ;;
limit_animation)   # longer than a table
   command -v gnuplot >/dev/null || { echo SKIPPED:; exit; }
   "$dynsph" "${short[@]}" --set "output.snapshots=1 steps" "$scene" 2>/dev/null
   ulimit -f 160
   DYNSPH_BIN=$bin bash "$plots/animate" "$case"
   status=$?
   ! ls "$case"/*.gif* 2>/dev/null || status=cut
   exit $status ;;
no_animation | no_such_field)
   command -v gnuplot >/dev/null || { echo SKIPPED:; exit; }
   cadence=never field=velocity
   [ "$case" = no_animation ] || cadence='10 steps' field="x'; nothing"
   "$dynsph" "${short[@]}" --set "output.snapshots=$cadence" "$scene" 2>/dev/null
   DYNSPH_BIN=$bin exec bash "$plots/animate" "$case" "$field" ;;
few_open_files)
   for ((k = 3; k < 20; k++)); do eval "exec $k>&-"; done   # what this shell was left with
   ulimit -n 5
   exec "$dynsph" "${short[@]}" "$scene" ;;
link) mkdir -p linked; ln -sfn linked "$case"; "$dynsph" "${short[@]}" "$scene" && [ -s linked/summary.txt ] ;;
link_to_nowhere) ln -sfn nowhere "$case"; exec "$dynsph" "${short[@]}" "$scene" ;;
link_to_file) touch file; ln -sfn file "$case"; exec "$dynsph" "${short[@]}" "$scene" ;;
removed) meanwhile rm -r "$case" ;;
renamed) meanwhile mv "$case" "$case.moved" ;;
esac
