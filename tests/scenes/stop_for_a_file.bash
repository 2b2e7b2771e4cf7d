#!/usr/bin/env bash
# Runs something that makes a result, and asks that run to stop, by the file STOP, once it has begun.
#
# usage: stop_for_a_file.bash DIRECTORY PROGRAM ARGUMENT...     DIRECTORY: that of the result, emptied first
set -euo pipefail
results=$1
shift
rm -rf "$results"
"$@" &
for ((k = 0; k < 1000; k++)); do
   [ ! -s "$results/energy.dat" ] || break
   sleep 0.05
done
touch "$results/STOP"
wait $!
