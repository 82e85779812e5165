#!/bin/bash
# Fails on an #include that tests/include_arrows.txt does not allow, and on arrows that make a circle. Also holds libraries
# to their places: OpenImageIO in core/image_files, Embree in oracle/ray_scene.h, epoxy in gl/driver, MPI in
# farm/mpi, glslang in gl/vulkan and programs/front, Xbyak in programs/run/fast.
# Usage: include_arrows.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
status=0
fail() {
  printf '%s:\n%s\n' "$1" "$2"
  status=1
}

sources() { find "$@" \( -name '*.h' -o -name '*.cpp' \); }

declare -A arrows
while IFS=: read -r folder allowed; do
  [[ -z $folder || $folder == \#* ]] && continue
  arrows[$folder]=" $folder $allowed "
done <tests/include_arrows.txt

# Every include of ours, as "folder included_folder file:line".
while read -r folder included where; do
  [[ -v arrows[$folder] ]] || { fail "$folder has no row in tests/include_arrows.txt" "$where"; continue; }
  [[ ${arrows[$folder]} == *" $included "* ]] || fail "$folder may not include from $included" "$where"
done < <(sources core farm scenes raster scene_cache shading bands programs oracle judge gl bench compare explain cli view | xargs grep -nE '^ *# *include "' |
  sed -nE 's|^(([^:]*)/[^/:]*:[0-9]+): *# *include "(([^"]*)/)?[^/"]*".*|\2 \4 \1|p')

# unit FOLDER: the folder; of a `fast` or `bounded` folder that the folder above calls, the folder above.
unit() {
  local above=${1%/*}
  if [[ $1 =~ /(fast|bounded)$ && ${arrows[$above]} == *" $1 "* ]]; then echo "$above"; else echo "$1"; fi
}
circle=$(for folder in "${!arrows[@]}"; do
  for target in ${arrows[$folder]}; do echo "$(unit "$folder") $(unit "$target")"; done
done | tsort 2>&1 >/dev/null) || fail 'these folders include each other' "$circle"

# only_in PATTERN FILES: a library's headers are included by these files only.
only_in() {
  local found
  found=$(sources core farm scenes raster shading programs oracle judge gl compare explain cli view | xargs grep -nE "^ *# *include [<\"]$1" | grep -vE "^($2):" || true)
  [[ -z $found ]] || fail "$1 belongs in $2 only" "$found"
}
only_in 'OpenImageIO/' 'core/image_files/[a-z_]*.cpp'
only_in 'embree' 'oracle/ray_scene.h'
only_in 'mpi.h' 'farm/mpi/[a-z_]*\.(h|cpp)'
only_in 'glslang/' '(gl/vulkan|programs/front)/[a-z_]*\.(h|cpp)'
only_in 'spirv-tools/' 'programs/front/[a-z_]*\.(h|cpp)'
only_in 'xbyak/' 'programs/run/fast/vector_assembler.h'
only_in 'epoxy/' 'gl/driver/[a-z_]*\.(h|cpp)'

# The oracle, the judge and the OpenGL twin judge our arithmetic, so they must not use it.
found=$(sources oracle judge gl | xargs grep -nE '^ *# *include "(core/(half|small_float|srgb|srgb_codes|fp_env)|core/simd/([a-z_]*-inl|front_order)|scenes/trig)' || true)
[[ -z $found ]] || fail 'the judges use values of ours, never arithmetic' "$found"
exit "$status"
