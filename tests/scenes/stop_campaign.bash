#!/usr/bin/env bash
# Runs a campaign and stops one of its runs once it has begun.
#
# usage: stop_campaign.bash DIRECTORY PROGRAM ARGUMENT...     DIRECTORY: that of the run, emptied first
set -euo pipefail
run=$1
shift
rm -rf "$run"
"$@" &
for ((k = 0; k < 1000; k++)); do
   [ ! -s "$run/energy.dat" ] || break
   sleep 0.05
done
touch "$run/STOP"
wait $!
