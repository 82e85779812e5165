#!/bin/bash
# corpora.sh REPLAY CORPUS: every target that REPLAY names has files in a folder of CORPUS, every folder is a target's,
# and all of them together are below 340 kB.
set -euo pipefail
diff <("$1" | sort) <(cd "$2" && find . -mindepth 2 -type f -printf '%h\n' | sed 's|^\./||' | sort -u)
bytes=$(find "$2" -type f -printf '%s\n' | awk '{sum += $1} END {print sum}')
((bytes < 340000)) || { echo "the corpora have $bytes bytes"; exit 1; }
