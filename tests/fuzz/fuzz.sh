#!/bin/bash
# tests/fuzz/fuzz.sh SECONDS [TARGET...]: builds the fuzzer and runs each target for so many seconds, from its corpus and
# from what earlier runs have found, which build/fuzz/found keeps. One line a target says how many inputs were run. A finding
# stays in build/fuzz/findings and ends in exit code 1.
set -euo pipefail
cd "$(dirname "$0")/../.."
source scripts/setup.sh
install_packages tests clang
[[ -e build/fuzz/build.ninja ]] || configure fuzz "TRUESHADE_SIMD=avx2;sse4" TRUESHADE_PARTS=all TRUESHADE_TESTS=fuzz  # or that of ./check readers
build fuzz fuzzer
build fuzz fuzz_replay
seconds=$1
shift
targets=("$@")
((${#targets[@]} > 0)) || mapfile -t targets < <(build/fuzz/tests/fuzz/fuzz_replay)
mkdir -p build/fuzz/findings

# fuzzed TARGET: runs it, and says what it found.
fuzzed() {
  local target=$1 dictionary=() status=0 executions log=build/fuzz/$1.log
  mkdir -p "build/fuzz/found/$target"
  local seeds=("tests/fuzz/corpus/$target")
  [[ $target == light_glsl ]] && seeds+=(scenes/light_models)  # the models that ship
  [[ -e tests/fuzz/$target.dict ]] && dictionary=("-dict=tests/fuzz/$target.dict")
  ASAN_OPTIONS=quarantine_size_mb=16 TRUESHADE_FUZZ_TARGET=$target build/fuzz/tests/fuzz/fuzzer -max_total_time="$seconds" -timeout=1 -rss_limit_mb=512 \
    -max_len=32768 -print_final_stats=1 -artifact_prefix="build/fuzz/findings/$target-" "${dictionary[@]}" \
    "build/fuzz/found/$target" "${seeds[@]}" >"$log" 2>&1 || status=1
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  printf '%-14s %10s inputs, %s\n' "$target" "${executions:-?}" "$(grep -aoE 'cov: [0-9]+ ft: [0-9]+' "$log" | tail -n 1)"
  grep -aE 'ERROR|runtime error|SUMMARY|broken promise' "$log" | head -n 4 || true
  return "$status"
}

# One on each core.
export -f fuzzed
export seconds
status=0
printf '%s\n' "${targets[@]}" | xargs -P "$(nproc)" -I '{}' bash -c 'fuzzed "$1"' _ '{}' || status=1
if ((status != 0)); then die "there are findings in build/fuzz/findings"; fi
say "${#targets[@]} targets ran for $seconds s each, without a finding"
