#!/bin/bash
# tests/fuzz/coverage.sh: builds the replay with clang's coverage, runs every corpus, and prints which share of the lines
# of each reader the corpora reach. FOLDER of more inputs, a folder a target, may be given.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/setup.sh
install_packages command clang llvm
configure coverage TRUESHADE_SIMD=scalar TRUESHADE_BATCH=8
build coverage fuzz_replay
replay=build/coverage/tests/fuzz/fuzz_replay
rm -f build/coverage/*.profraw
for target in $("$replay"); do
  folders=("tests/fuzz/corpus/$target")
  [[ -n ${1:-} && -d $1/$target ]] && folders+=("$1/$target")
  LLVM_PROFILE_FILE=build/coverage/$target.profraw "$replay" "$target" "${folders[@]}" >/dev/null
done
llvm-profdata merge -sparse build/coverage/*.profraw -o build/coverage/all.profdata
llvm-cov report "$replay" -instr-profile build/coverage/all.profdata core/image_files/{exr_layout,jpeg_header,png_header,png_pixels,png_rows}.cpp \
  scenes/files scenes/files/gltf scenes/json scenes/pipeline/pipeline_json.cpp |
  awk '/^Filename|^TOTAL|\.cpp/ {printf "%-44s %6s lines %8s\n", $1, $8, $10}'
