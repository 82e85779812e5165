#!/bin/bash
# Fails unless every source is compiled with -ffp-contract=off and without options that change floating-point results or
# tie the program to one CPU. Usage: compile_flags.sh COMPILE_COMMANDS_JSON
set -euo pipefail
commands=$(grep '"command"' "$1")
[[ -n $commands ]] || { echo "no compile command in $1"; exit 1; }
# Catch's main computes nothing of ours.
without=$(grep -v -- '-ffp-contract=off' <<<"$commands" | grep -v 'catch_main\.cpp' || true)
with=$(grep -E -- '(^|[ "])-(ffast-math|Ofast|march=|mtune=native|mfma|mavx|msse[34]|funsafe-math|ffp-contract=(fast|on)|frounding)' <<<"$commands" || true)
[[ -z $without && -z $with ]] && { echo "$(wc -l <<<"$commands") sources"; exit 0; }
printf 'without -ffp-contract=off:\n%s\nwith an option that is not allowed:\n%s\n' "$without" "$with"
exit 1
