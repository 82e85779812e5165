#!/bin/bash
# tests/fuzz/coverage.sh: builds the replay with clang's coverage, runs every corpus, and prints which share of the lines
# of each reader the corpora reach. FOLDER of more inputs, a folder a target, may be given.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/setup.sh
install_packages tests clang llvm
configure coverage TRUESHADE_SIMD=scalar
build coverage fuzz_replay
replay=build/coverage/tests/fuzz/fuzz_replay
rm -f build/coverage/*.profraw
for target in $("$replay"); do
  folders=("tests/fuzz/corpus/$target")
  [[ -n ${1:-} && -d $1/$target ]] && folders+=("$1/$target")
  LLVM_PROFILE_FILE=build/coverage/$target.profraw "$replay" "$target" "${folders[@]}" >/dev/null
done
llvm-profdata merge -sparse build/coverage/*.profraw -o build/coverage/all.profdata
readers='scenes/files/|scenes/json/|pipeline_json|exr_layout|jpeg_header|png_header|png_pixels|png_rows'
left_aside='load_scene|scene_files|gltf_geometry'  # what opens files in folders, of which a target has none
llvm-cov report "$replay" -instr-profile build/coverage/all.profdata | grep -E "$readers" | grep -vE "$left_aside" |
  awk '{printf "%-44s %5d lines %8s\n", $1, $8, $10; lines += $8; missed += $9}
       END {printf "%-44s %5d lines %7.2f%%\n", "readers", lines, 100 * (lines - missed) / lines}'
