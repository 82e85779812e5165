#!/bin/bash
# scripts/planted_faults.sh [FAULT...]: plants faults of the kind that each part of CI is there for, one at a time, in a copy
# of HEAD in build/planted, and runs the test that has to find it. The test must pass without the fault, and what it says of
# the fault must be the fault's own words, so that neither a test that fails anyway nor a build that breaks counts. Builds
# what these tests need and no more. The last line is the verdict.
set -euo pipefail
cd "$(dirname "$0")/.."
copy=$PWD/build/planted
commit=$(git rev-parse --short=8 HEAD)

# FAULT|what is wrong then|FILE|an edit by sed|what the test says of it. The test is the function of that name.
faults=(
  'race|a list that threads share is read without its lock|core/threads/thread_pool.cpp|/join_loop() {$/{n;d}|ThreadSanitizer: data race'
  'past_end|a reader takes one byte more than its file has|scenes/files/ply_header.cpp|s/(file.data()), file.size())/(file.data()), file.size() + 1)/|heap-buffer-overflow'
  'nan|a blend factor of zero is multiplied, and 0 * infinity is NaN|shading/blend/blend-inl.h|s/group->drop_source = term.src == BlendFactor::zero;/group->drop_source = false;/|A zero factor drops its term'
  'page|a button of the page calls what is not there|cli/pages/script/viewer.js|s/"Zoom in (+)", () => this.zoom_by(2)/"Zoom in (+)", () => this.zoom_in(2)/|(FAIL\|ERROR): test_every_button_of_the_bar'
  'module|a function of the Python module is not exported|python/trueshade/__init__.py|/^strategies = /d|no attribute .strategies.\|FAILED tests/python/test_stub.py'
  'word|a word of a guide is wrong: an option that does not exist|docs/export.md|0,/trueshade export /s//trueshade exports /|exports'
)

race() {  # ./check threads
  configure tsan TRUESHADE_SIMD=sse4 TRUESHADE_PARTS=all TRUESHADE_TESTS=core
  build tsan test_core
  build/tsan/tests/core/test_core 'loops within loops*'
}
past_end() {  # ./check readers, and ./check fuzz
  configure fuzz "TRUESHADE_SIMD=avx2;sse4" TRUESHADE_PARTS=all TRUESHADE_TESTS=fuzz
  build fuzz fuzz_replay
  build/fuzz/tests/fuzz/fuzz_replay ply tests/fuzz/corpus/ply
}
nan() {  # ./check full
  with_command
  build release test_shading
  build/release/tests/shading/test_shading 'A zero factor*'
}
page() {  # ./check pages
  with_command
  ./check pages Page.test_every_button_of_the_bar_does_what_it_says
}
module() {  # ./check python
  with_command
  ./check python -k test_the_names_are_those_of_the_stub
}
word() {  # ./check full
  with_command
  build release trueshade
  tests/docs/page.sh "$PWD/build/release/cli/trueshade" "$PWD" docs/export.md
}
with_command() { configure release TRUESHADE_SIMD=native TRUESHADE_PARTS=all TRUESHADE_TESTS=shading; }

[[ -e $copy/.git ]] || git worktree add --quiet --force --detach "$copy"
cd "$copy"
git checkout --quiet --force --detach "$commit"
source scripts/setup.sh  # whose folder is now the copy
log=build/planted.log
mkdir -p build

# passes FAULT: whether its test does; what it says is in the log.
passes() {
  ("$1") >"$log" 2>&1 </dev/null &  # beside: in a condition nothing would end at the first command that fails
  wait $!
}

tried=0 found=0
for row in "${faults[@]}"; do
  IFS='|' read -r name wrong file edit words <<<"${row//\\|/$'\x01'}"
  words=${words//$'\x01'/|}
  [[ $# == 0 || " $* " == *" $name "* ]] || continue
  tried=$((tried + 1))
  passes "$name" || { cat "$log"; die "planted_faults: the test of '$name' fails without the fault"; }
  sed -i "$edit" "$file"
  ! git diff --quiet -- "$file" || die "planted_faults: '$name' changes nothing in $file any more"
  verdict='NOT FOUND'
  if ! passes "$name"; then
    if grep -qE "$words" "$log"; then
      verdict=found
      found=$((found + 1))
    else
      cat "$log"
      verdict='NOT FOUND: something else failed (see above)'
    fi
  fi
  git checkout --quiet -- "$file"
  printf '%-9s %s: %s\n' "$name" "$wrong" "$verdict"
done
((tried > 0)) || die "planted_faults: there is no fault '$*'"
say "$found of $tried planted faults are found on $commit"
((found == tried))
