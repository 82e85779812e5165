# Sourced by check and aarch64.sh: the golden frames of 200x150 pixels, drawn by a build that is slow or checked.

# golden_frame SCENE PRESET HASH COMMAND...: `COMMAND... render SCENE --preset PRESET --size 200x150 --hash`, in that order, must
# print the hash.
golden_frame() {
  local now
  now=$("$4" render "$1" --preset "$2" --size 200x150 --hash "${@:5}" </dev/null) || die "$1 under $2 is not drawn"
  [[ $now == "sha256:$3 "* ]] || die "$1 under $2 has the hash $now"
}

# draw_golden_frames STEP COMMAND...: each STEP-th frame of tests/golden/frames.h, one on each core: what makes the largest scene
# has one thread. With without_light_programs=true, of a build that has none, those of the preset gltf are left out.
draw_golden_frames() {
  local began=$SECONDS frames i drawn=0
  mapfile -t frames < <(sed -nE 's/.*\{"(builtin:[^"]*)", "([^"]*)", 200, 150, "([0-9a-f]{64})".*/\1 \2 \3/p' tests/golden/frames.h)
  if [[ ${without_light_programs:-} == true ]]; then mapfile -t frames < <(printf '%s\n' "${frames[@]}" | grep -v ' gltf '); fi
  ((${#frames[@]} > 0)) || die "tests/golden/frames.h names no frame of 200x150"
  export -f golden_frame die say
  # xargs puts the three words of a frame behind the command's.
  for ((i = 0; i < ${#frames[@]}; i += $1)); do echo "${frames[i]}"; done |
    xargs -P "$(nproc)" -L 1 bash -c 'golden_frame "${@: -3}" "${@:1:$# - 3}"' _ "${@:2}" ||
    die "a golden frame is not what it was (see above)"
  drawn=$(((${#frames[@]} + $1 - 1) / $1))
  say "$drawn golden frames, drawn in $((SECONDS - began)) s, have the golden hashes"
}
