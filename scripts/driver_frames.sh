#!/bin/bash
# scripts/driver_frames.sh TEST [COUNT], which is ./check frames: COUNT (500) frames under states drawn at random, and as
# many that are lit by random light programs, drawn by each software driver of this machine and judged by TEST, the program
# of the judge's tests. None may be convicted: not under `unknown`, and not under the profile that a probe of the driver
# wrote (docs/data/profiles). Prints how many of their pixels are the very ones of the profile. The first seed is the
# day's, so that each run sees frames that none has seen.
set -euo pipefail
test=$(realpath "$1")
count=${2:-500}
cd "$(dirname "$0")/.."
source scripts/setup.sh
mesa=$(dpkg-query -W -f='${Version}' libgl1-mesa-dri | sed 's/-.*//')
export LEGAL_FRAMES=$count LEGAL_FIRST=${LEGAL_FIRST:-$(($(date +%s) / 86400 * 1000))}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
failed=()

# judged PROFILE TEST_CASE: a line for each theme of frames. No PROFILE: what the test holds the driver to.
judged() {
  [[ -z $1 || -e $1 ]] || { say "there is no $1: that driver is not probed"; return; }
  LEGAL_PROFILE=$1 "$test" "$2" >"$log" 2>&1 || { cat "$log"; failed+=("$2 under ${1:-unknown}"); }
  grep -E '^random frames|SKIPPED' "$log" || true
}
for profile in '' "docs/data/profiles/mesa-llvmpipe-$mesa.json"; do
  judged "$profile" "Of two thousand frames of llvmpipe's*"
  judged "$profile" "Of five hundred frames of llvmpipe's*"
done
for profile in '' "docs/data/profiles/mesa-lavapipe-$mesa.json"; do
  judged "$profile" "Of two thousand frames of a Vulkan device*"
  judged "$profile" "Of five hundred frames of a Vulkan device*"
done
judged '' "Of two hundred frames of SwiftShader's*"
((${#failed[@]} == 0)) || die "convicted, or no frame was drawn: ${failed[*]}"
say "$count frames a driver and kind from seed $LEGAL_FIRST by Mesa $mesa and SwiftShader: none is convicted"
