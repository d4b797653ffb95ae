#!/usr/bin/env bash
# Sets the machine up, builds everything and passes all tests: the preset release (GCC), then asan (Clang's address and
# undefined-behaviour sanitizers).
#
#   scripts/test.sh [--quick]
#
#   --quick   the release preset only
#   --help    this text
set -euo pipefail

usage() { sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//p}' "$0"; }

presets=(release asan)
setup=(--tests)
while [ $# -gt 0 ]; do
  case $1 in
    --quick) presets=(release) setup=() ;;
    -h | --help) usage; exit 0 ;;
    *) echo "test.sh: unknown option '$1' (allowed: --quick, --help)" >&2; exit 2 ;;
  esac
  shift
done

# On a build machine a warning is an error, of GCC and of Clang; at a user's, whose compiler may be newer than ours, it is not.
strict=()
[ -z "${CI:-}" ] || strict=(-DLIEBENCH_WERROR=ON)

cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."
scripts/setup.sh "${setup[@]}"
for preset in "${presets[@]}"; do
  printf '\n== %s: build\n' "$preset"
  cmake --preset "$preset" "${strict[@]}"
  cmake --build --preset "$preset" --parallel "$(nproc)"
  printf '\n== %s: tests\n' "$preset"
  ctest --preset "$preset" -j2
done
