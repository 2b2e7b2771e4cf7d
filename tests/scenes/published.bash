#!/usr/bin/env bash
# Makes the page of the paper's claims from the published facts of runs alone, and compares it with the one that is published.
#
# usage: published.bash SOURCE DIRECTORY     DIRECTORY: where to do it, emptied first
set -euo pipefail
rm -rf "$2"
mkdir -p "$2/tables"
cp -r "$1/docs/results/paper_facts" "$2/tables"
status=0
DYNSPH_TABLES=$2/tables DYNSPH_RESULTS=$2 "$1/utils/paper/reproduce" standard tables || status=$?
[ $status -eq 4 ] || exit 1   # none of its runs is here
command='^Written by '   # differs
diff <(grep -v "$command" "$1/docs/results/paper.md") <(grep -v "$command" "$2/tables/paper.md")
