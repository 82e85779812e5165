#!/bin/bash
# Fails where a folder of sources has no README.md, or one of more than ten lines besides blank ones.
# Usage: folder_readmes.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
status=0
while read -r folder; do
  lines=$(grep -c . "$folder/README.md" 2>/dev/null || true)
  [[ -n $lines ]] || { echo "$folder has no README.md"; status=1; continue; }
  ((lines <= 10)) || { echo "$folder/README.md has $lines lines, and ten are the most"; status=1; }
done < <(find core scenes raster scene_cache shading programs oracle judge gl bench compare explain cli cmake scripts -type f \( -name '*.h' -o -name '*.cpp' -o -name '*.cmake' -o -name '*.sh' \) \
  -printf '%h\n' | sort -u; echo tests)
exit "$status"
