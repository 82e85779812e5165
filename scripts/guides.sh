#!/bin/bash
# scripts/guides.sh, which is ./check guides: what a reader of the guides meets. A copy of this tree, new in build/guides,
# is built by the README's first command, ./run; then all commands that guides show, in blocks and in sentences, are run
# by the command that ./run leaves, whose kernels are those of this machine and the scalar ones. CI runs the same commands
# by a build of all kernels.
set -euo pipefail
cd "$(dirname "$0")/.."
source scripts/setup.sh
install_packages tests  # the drivers and programs that guides name; ./run installs what it needs itself
copy=build/guides
rm -rf "$copy"
copy_checkout "$copy"
SECONDS=0
quietly "./run" "$copy/run"
say "./run took $SECONDS s, its packages there"
[[ -e $copy/out/city.png && -e $copy/out/city.exr && -e $copy/out/report.html ]] || die "./run left no picture"
command=$copy/build/release/cli/trueshade
failed=()
for page in README.md docs/*.md; do
  grep -qE '^```(sh|json)$' "$page" || continue
  bash tests/docs/page.sh "$command" . "$page" || failed+=("$page")
done
/usr/bin/python3 tests/docs/inline_commands.py "$command" . || failed+=("commands in sentences")
((${#failed[@]} == 0)) || die "of the build of ./run these are not as they say: ${failed[*]}"
say "what the guides show runs with the build of ./run"
