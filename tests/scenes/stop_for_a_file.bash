#!/usr/bin/env bash
# Runs a scene and asks it to stop, by the file STOP, once it has begun.
#
# usage: stop_for_a_file.bash DIRECTORY PROGRAM ARGUMENT...     DIRECTORY: that of the results, emptied first
set -euo pipefail
results=$1
shift
rm -rf "$results"
"$@" --output "$results" &
for ((k = 0; k < 400; k++)); do
   [ ! -s "$results/energy.dat" ] || break
   sleep 0.05
done
touch "$results/STOP"
wait $!
