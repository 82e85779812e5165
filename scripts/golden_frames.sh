# Sourced by check and aarch64.sh: the golden frames of 200x150 pixels, drawn by a build that is slow or checked.

# draw_golden_frames COMMAND...: each by `COMMAND... render SCENE --preset PRESET --size 200x150 --hash`, in that order, which
# must print the hash of tests/golden/frames.h.
draw_golden_frames() {
  local scene preset hash now drawn=0 began=$SECONDS
  while read -r scene preset hash; do
    now=$("$1" render "$scene" --preset "$preset" --size 200x150 --hash "${@:2}" </dev/null) || die "$scene under $preset is not drawn"
    [[ $now == "sha256:$hash "* ]] || die "$scene under $preset has the hash $now"
    drawn=$((drawn + 1))
  done < <(sed -nE 's/.*\{"(builtin:[^"]*)", "([^"]*)", 200, 150, "([0-9a-f]{64})".*/\1 \2 \3/p' tests/golden/frames.h)
  ((drawn > 0)) || die "tests/golden/frames.h names no frame of 200x150"
  say "$drawn golden frames, drawn in $((SECONDS - began)) s, have the golden hashes"
}
