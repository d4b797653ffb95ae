#!/usr/bin/env bash
# Reproduces every figure of the paper: sets the machine up, builds the release preset, runs `liebench figures`.
#
#   scripts/reproduce.sh [--out DIR] [--jobs N] [OPTION of liebench figures...]
#
#   --out DIR   where figures, records and the table go; by default reproduced/ in this repository
#   --jobs N    cores for building and for running; by default all of them
#   --help      this text; other options are handed on to `liebench figures`, e.g. --only figure3
set -euo pipefail

usage() { sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//p}' "$0"; }
bad() { echo "reproduce.sh: $*" >&2; exit 2; }

top=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.." && pwd)
out=$top/reproduced
jobs=$(nproc)
options=()

while [ $# -gt 0 ]; do
  case $1 in
    --out=* | --jobs=*) set -- "${1%%=*}" "${1#*=}" "${@:2}"; continue ;;
    --out)
      [ -n "${2:-}" ] || bad "--out needs a folder"
      out=$2
      shift 2
      ;;
    --jobs)
      [[ ${2:-} =~ ^[1-9][0-9]*$ ]] || bad "--jobs '${2:-}': a number of cores, 1 or more, is needed"
      jobs=$2
      options+=(--jobs "$jobs")
      shift 2
      ;;
    -h | --help) usage; exit 0 ;;
    *) options+=("$1"); shift ;;
  esac
done
case $out in /*) ;; *) out=$PWD/$out ;; esac # a relative folder is meant from where the user stands

cd "$top"
scripts/setup.sh
cmake --preset release
cmake --build --preset release --target liebench --parallel "$jobs"

status=0
build/release/liebench figures --out "$out" "${options[@]}" || status=$?

# What a failed run has written is kept, and shown too.
echo
for kind in 'figures:*.svg *.pdf *.png' 'records:*.jsonl' 'tables:verification.md verification.csv formulations.md'; do
  for pattern in ${kind#*:}; do
    if compgen -G "$out/$pattern" >/dev/null; then printf '%-9s%s\n' "${kind%%:*}" "$out/$pattern"; fi
  done
done
exit "$status"
