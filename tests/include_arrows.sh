#!/bin/bash
# Fails on an #include against the arrows core <- scenes <- raster <- shading <- bench <- cli; oracle sees core and scenes. Also
# holds libraries to their places: OpenImageIO in core/image_io.cpp, core/jpeg_pixels.cpp and core/read_image.cpp, TBB in core/thread_pool.cpp, Embree in oracle/ray_scene.h.
# Usage: include_arrows.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
status=0
folders='core|scenes|raster|shading|compare|oracle|cli|bench|tests'

# allowed FOLDER NAMES: sources under FOLDER include from these folders of ours only.
allowed() {
  local found
  [[ -d $1 ]] || return 0
  found=$(grep -rnE "^ *# *include \"($folders)/" "$1" --include='*.h' --include='*.cpp' | grep -vE "\"($2)/" || true)
  if [[ -n $found ]]; then
    printf '%s may include from %s only:\n%s\n' "$1" "${2//|/, }" "$found"
    status=1
  fi
}

# only_in PATTERN FILES REGION: a library's headers are included by these files only.
only_in() {
  local found
  found=$(grep -rnE "^ *# *include [<\"]$1" core scenes raster shading oracle cli --include='*.h' --include='*.cpp' |
    grep -vE "^($2):" || true)
  if [[ -n $found ]]; then
    printf '%s belongs in %s only:\n%s\n' "$1" "$2" "$found"
    status=1
  fi
}

allowed core 'core'
allowed scenes 'core|scenes'
allowed raster 'core|scenes|raster'
allowed shading 'core|scenes|raster|shading'
allowed compare 'core|compare'
allowed oracle 'core|scenes|oracle'
allowed bench 'core|scenes|raster|shading|oracle|bench'
allowed cli 'core|scenes|raster|shading|compare|oracle|bench|cli'
only_in 'OpenImageIO/' 'core/(image_io|jpeg_pixels|read_image).cpp'
only_in '(tbb|oneapi)/' 'core/thread_pool.cpp'
only_in "embree" "oracle/ray_scene.h"
only_in 'epoxy/' 'oracle/gl/[a-z_]*\.(h|cpp)'
only_in 'CLI/' 'cli/options.cpp'
# The oracle judges our arithmetic, so it must not use it.
found=$(grep -nE '^ *# *include "(core/(half|srgb|fp_env)|scenes/trig)' oracle/*.h oracle/*.cpp 2>/dev/null || true)
if [[ -n $found ]]; then
  printf 'the oracle uses values of ours, never arithmetic:\n%s\n' "$found"
  status=1
fi
exit "$status"
