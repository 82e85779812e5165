# Sourced by check and aarch64.sh: the golden frames of 200x150 pixels, drawn by a build that is slow or checked.

# golden_frame SCENE PRESET HASH COMMAND...: `COMMAND... render SCENE --preset PRESET --size 200x150 --hash`, in that order, must
# print the hash.
golden_frame() {
  local now
  now=$("$4" render "$1" --preset "$2" --size 200x150 --hash "${@:5}" </dev/null) || die "$1 under $2 is not drawn"
  [[ $now == "sha256:$3 "* ]] || die "$1 under $2 has the hash $now"
}

# draw_golden_frames STEP COMMAND...: each STEP-th frame of tests/golden/frames.h, one on each core: what makes the largest scene
# has one thread.
draw_golden_frames() {
  local began=$SECONDS frames i drawn=0 failed=0
  mapfile -t frames < <(sed -nE 's/.*\{"(builtin:[^"]*)", "([^"]*)", 200, 150, "([0-9a-f]{64})".*/\1 \2 \3/p' tests/golden/frames.h)
  ((${#frames[@]} > 0)) || die "tests/golden/frames.h names no frame of 200x150"
  for ((i = 0; i < ${#frames[@]}; i += $1)); do
    if ((drawn >= $(nproc))); then wait -n || failed=1; fi
    # shellcheck disable=SC2086 # three words
    golden_frame ${frames[i]} "${@:2}" &
    drawn=$((drawn + 1))
  done
  for ((i = 0; i < drawn && i < $(nproc); ++i)); do wait -n || failed=1; done
  ((failed == 0)) || die "a golden frame is not what it was (see above)"
  say "$drawn golden frames, drawn in $((SECONDS - began)) s, have the golden hashes"
}
