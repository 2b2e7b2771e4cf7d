#!/usr/bin/env bash
# What ranks.cmake runs: one run by several ranks.
#
# usage: [DYNSPH_ALONE=PROGRAM] ranks.bash CASE DYNSPH INPUT LAUNCHER...
#
# LAUNCHER: what starts a program with ranks; their number comes behind it. PROGRAM: of a build without MPI, for the runs of one process.
set -euo pipefail
case=$1 dynsph=$2 input=$3
shift 3
launcher=("$@")
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} GOMP_SPINCOUNT=1000
status=0
rm -rf "$case"
mkdir "$case"
cd "$case"

# ranks N ARGUMENT...
ranks() { "${launcher[@]}" "$1" "$dynsph" --quiet "${@:2}"; }
alone() { "${DYNSPH_ALONE:-$dynsph}" --quiet "$@"; }
# same DIRECTORY DIRECTORY: all files but the two that have times of the clock in them.
same() {
   local file ended=0
   for file in "$1"/*; do
      case ${file##*/} in run.log | summary.txt) continue ;; esac
      cmp "$file" "$2/${file##*/}" || ended=1
   done
   return $ended
}
# Coarse, so that a scene takes a second; more ranks than it has strips for some.
short=(--set output.precision=double --set time.max_steps=40)
size_of() { awk '$1 == "resolution" { print ($3 > 50 ? $3/6 : $3 > 24 ? $3/2 : $3) }' "$1"; }

case $case in
same_bits_*)
   scene=$input/${case#same_bits_}.nml
   short+=(--set "scene.resolution=$(size_of "$scene")" "$scene")
   alone --output one "${short[@]}" 2>/dev/null
   for n in 2 3 4 7; do
      ranks $n --output "$n" "${short[@]}" 2>/dev/null
      same one $n
   done
   # And the other model, with threads.
   other=(--set model.diffusion=constant --set model.delta=0.1 --set model.alpha=0.02 --set fluid.viscosity=0)
   if grep -q "^ *diffusion = 'constant'" "$scene"; then other=(--set model.diffusion=dynamic --set fluid.viscosity=1e-3); fi
   short+=(--set output.fields=velocity,pressure,vorticity "${other[@]}")
   alone --output other_one "${short[@]}" 2>/dev/null
   OMP_NUM_THREADS=2 ranks 3 --output other_3 "${short[@]}" 2>/dev/null
   same other_one other_3 ;;
past_the_impact)
   # Ranks become empty and full again, cuts move; with threads, friction and all fields.
   short=(--set scene.resolution=16 --set time.max_steps=500 --set model.diffusion=dynamic --set fluid.viscosity=1e-4
      --set domain.bottom=no_slip --set domain.right=no_slip --set "output.snapshots=250 steps" --set output.precision=double
      --set output.fields=velocity,pressure,density,vorticity,alpha,delta,dissipation "$input/dam_break.nml")
   alone --output one "${short[@]}" 2>/dev/null
   OMP_NUM_THREADS=2 ranks 2 --output 2 "${short[@]}" 2>/dev/null
   ranks 7 --output 7 "${short[@]}" 2>/dev/null
   same one 2
   same one 7 ;;
every_stage)
   short+=(--set scene.resolution=20 --set time.diffusion=every_stage "$input/dam_break.nml")
   alone --output one "${short[@]}" 2>/dev/null
   ranks 3 --output 3 "${short[@]}" 2>/dev/null
   same one 3 ;;
auto)
   short+=(--set scene.resolution=12 --set fluid.reference_speed=auto "$input/dam_break.nml")
   alone --output one "${short[@]}" 2>/dev/null
   ranks 3 --output 3 "${short[@]}" 2>/dev/null
   same one 3 ;;
goes_on_with_others)
   # Stopped with three ranks, goes on with two, then with one.
   scene=(--set scene.resolution=20 --set output.precision=double --set output.energy="1 steps" "$input/dam_break_lobovsky.nml")
   alone --output one "${scene[@]}" 2>/dev/null
   ranks 3 --output run_$case "${scene[@]}" --set time.max_steps=100 2>/dev/null
   ranks 2 --resume run_$case --set time.max_steps=300 2>/dev/null
   alone --resume run_$case --set time.max_steps=0 2>/dev/null
   for table in energy probes; do cmp one/$table.dat run_$case/$table.dat; done
   grep '^steps = ' one/summary.txt >one.steps
   grep '^steps = ' run_$case/summary.txt | cmp - one.steps ;;
signal | kill | stop)
   ranks 3 --output run_$case --set scene.resolution=20 --set time.end_time=100 "$input/dam_break.nml" >messages 2>&1 &
   until [ -s run_$case/checkpoint_a.h5 ]; do sleep 0.1; done
   one=$(pgrep -f "^$dynsph --quiet --output run_$case" | tail -n 1)
   case $case in
   signal) kill -TERM "$one" ;;
   kill) kill -KILL "$one" ;;
   stop) touch run_$case/STOP ;;
   esac
   status=0
   wait $! || status=$?
   case $case in
   kill) [ $status -ne 0 ] && [ ! -e run_$case/summary.txt ] ;;
   *) [ $status -eq 4 ] && grep '^status = stopped' run_$case/summary.txt && [ "$(grep -c 'the run ended at' messages)" -eq 1 ] ;;
   esac
   ranks 2 --resume run_$case --set time.max_steps=5000 2>/dev/null
   grep '^steps = 5000' run_$case/summary.txt ;;
too_far | out_of_balance)
   # Fails with the words of a run of one process, once. In the first case the particle is one rank's.
   scene=(--set scene.resolution=16 --set time.balance_limit=5e-4 --set output.snapshots=never "$input/dam_break.nml")
   [ $case = out_of_balance ] ||
      scene=(--set domain.right=open --set domain.upper=399999,1.5 --set fluid.gravity=0 --set "body(1).lower=399997.7,0"
         --set "body(1).upper=399997.8,0.1" --set "body(1).velocity=20,0" --set "body(1).pressure=zero" --set "body(2).pressure=zero"
         --set fluid.mach=0.1 "$input/../tests/scenes/still_layers.nml")
   alone --output one "${scene[@]}" >words 2>&1 || status=$?
   [ $status -eq 2 ]
   status=0
   ranks 3 --output 3 "${scene[@]}" >messages 2>&1 || status=$?
   [ $status -eq 2 ] && [ "$(grep -cF "$(tail -n 1 words)" messages)" -eq 1 ] && same one 3 ;;
no_table)
   # Only one rank sees that its table has gone.
   ranks 3 --output run_$case --set scene.resolution=20 --set time.end_time=100 "$input/dam_break.nml" >messages 2>&1 &
   until [ -s run_$case/energy.dat ]; do sleep 0.1; done
   mv run_$case/energy.dat elsewhere
   status=0
   wait $! || status=$?
   [ $status -eq 3 ] && [ "$(grep -c 'was removed or renamed meanwhile' messages)" -eq 1 ] ;;
refusal)
   status=0
   ranks 3 --output run_$case --set fluid.mach=-1 "$input/dam_break.nml" >messages 2>&1 || status=$?
   [ $status -eq 1 ] && [ "$(grep -c 'is out of range' messages)" -eq 1 ] && [ ! -e run_$case ] ;;
*) echo "ranks.bash: no case '$case'" >&2; exit 1 ;;
esac
