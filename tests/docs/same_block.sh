#!/bin/bash
# Fails unless FILE is a block of PAGE. Usage: same_block.sh SOURCE_FOLDER PAGE FILE
set -euo pipefail
cd "$1"
page=$(<"$2") file=$(<"$3")
[[ $page == *$'```bash\n'"$file"$'\n```'* ]] || { echo "$3 is not a block of $2"; exit 1; }
