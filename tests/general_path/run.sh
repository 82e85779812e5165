#!/bin/bash
# Shows that speed-only code can be deleted: copies the sources, removes every folder named fast or bounded and every line
# marked `// fast path`, builds the library for this machine's best SIMD target and draws the golden frames.
# Usage: run.sh SOURCE_FOLDER COMPILER COMPILER_LAUNCHER
set -euo pipefail
source=$1 compiler=$2 launcher=${3:-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/source"
tar -C "$source" -cf - --exclude=./build --exclude=./.git . | tar -xf - -C "$work/source"
cd "$work/source"

mapfile -t folders < <(find programs raster shading -type d \( -name fast -o -name bounded \))
lines=$({ grep -rhoE '// fast path$' core programs raster shading || true; } | wc -l)
((${#folders[@]} > 0 && lines > 0)) || { echo "no fast path was found: the marks and folders have other names"; exit 1; }
rm -r "${folders[@]}"
find core programs raster shading -name '*.h' -o -name '*.cpp' | xargs sed -i '\,// fast path$,d'
echo "removed: ${folders[*]}, and $lines lines"

# Compiled by -O1, in half of the time: no bit depends on it.
sed -i 's/-O3/-O1/' cmake/flags.cmake
options=(-DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS_RELEASE="-O1 -DNDEBUG" -DTRUESHADE_SIMD=native -DTRUESHADE_TESTS=OFF -DTRUESHADE_PARTS=picture)
[[ -n $launcher ]] && options+=(-DCMAKE_CXX_COMPILER_LAUNCHER="$launcher")
# The copy gets one program more, which links the library as any other target does.
sed -i '/^if(TRUESHADE_PARTS STREQUAL "picture")/i \
add_executable(general_path tests/general_path/main.cpp)\
target_link_libraries(general_path trueshade::shading trueshade::scene_values)' CMakeLists.txt
cmake -S . --preset release "${options[@]}" >"$work/configure.log" 2>&1 || { cat "$work/configure.log"; exit 1; }
cmake --build build/release --target general_path >"$work/build.log" 2>&1 || { grep -E 'error|FAILED|undefined' "$work/build.log" | head -n 40; exit 1; }
$(find build/release -name general_path -type f)
