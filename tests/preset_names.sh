#!/bin/bash
# Fails where the name of a preset occurs outside scenes/pipeline/presets.cpp, the pipeline's schema, the command and tests: code
# that asks for a preset by name is a variant that should be a value. Usage: preset_names.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
# scenes/pipeline/pipeline.h: the name of the row that the default values are.
found=$(grep -rnE '"(many-lights|touchdesigner|light-volumes(-literal)?|redsdk|gl-fixed|punctual|gltf)"' \
  core scenes raster shading oracle judge gl --include='*.h' --include='*.cpp' |
  grep -vE '^scenes/pipeline/(presets\.cpp|pipeline\.h):' || true)
[[ -z $found ]] && exit 0
printf 'preset names outside scenes/pipeline/presets.cpp:\n%s\n' "$found"
exit 1
