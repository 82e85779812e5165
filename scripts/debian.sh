#!/bin/bash
# scripts/debian.sh RELEASE [MODE], which is ./check debian: what a new user of Debian RELEASE (12 or 13) meets. In a
# bare one of debootstrap, on a copy of this tree: ./run, whose picture must have the golden hash, ./check MODE (full),
# and ./check packages. Says how long each took. TRUESHADE_DEBIAN=FOLDER keeps the Debian there, and goes on with it.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
source scripts/bare_debian.sh
release=${1:-}
mode=${2:-full}
[[ -n ${debian_suites[$release]:-} ]] || die "./check debian: '$release' is no release that is tried (one of: ${!debian_suites[*]})"
golden=$(sed -nE 's/.*"builtin:city", "many-lights", 800, 800, "([0-9a-f]{64})".*/\1/p' tests/golden/frames.h)

open_bare_debian "${debian_suites[$release]}"
copy_tree
here='cd /root/trueshade'

# timed WHAT COMMANDS: runs them there, and says how long they took.
timed() {
  SECONDS=0
  inside "$2" || die "Debian $release: $1 fails"
  say "Debian $release: $1 took $SECONDS s"
}
inside 'apt-get -qq update' >/dev/null
timed "./run" "$here && ./run"
hash=$(inside "$here && build/release/cli/trueshade render builtin:city --hash")
[[ $hash == "sha256:$golden "* ]] || die "Debian $release: builtin:city has the hash $hash"
timed "./check $mode" "$here && ./check $mode"
timed "./check packages" "$here && ./check packages"
say "Debian $release: $(inside "$here && g++ --version | head -n 1"), $(uname -m): the golden hash, the tests and the packages are right"
