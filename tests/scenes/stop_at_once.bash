#!/usr/bin/env bash
# Runs a scene and sends it SIGTERM as soon as it has begun.
#
# usage: stop_at_once.bash DIRECTORY PROGRAM ARGUMENT...     DIRECTORY: that of the results
set -euo pipefail
results=$1
shift
"$@" --output "$results" &
for ((k = 0; k < 400; k++)); do
   [ ! -e "$results/run.lock" ] || break
   sleep 0.05
done
sleep 0.3   # signals are held right after the lock is taken
kill -TERM $!
wait $!
