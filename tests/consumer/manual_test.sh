#!/usr/bin/env bash
# Does what docs/library.md tells a reader to do, word for word, in a home of its own: installs, writes the files shown and runs the
# commands shown.
#
#   tests/consumer/manual_test.sh BUILD_FOLDER CXX_COMPILER
set -euo pipefail
[ $# = 2 ] || { sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//p}' "$0" >&2; exit 2; }
build=$(readlink -f "$1") compiler=$2
source=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../..
manual=$source/docs/library.md
HOME=$(mktemp -d)
export HOME
trap 'rm -rf "$HOME"' EXIT

# The reader's work folder has the build folder where the page says, a copy of this project, and the compiler under test as g++.
work=$HOME/work
mkdir -p "$work/build" "$HOME/bin"
ln -s "$build" "$work/build/release"
cp -r "$source/tests/consumer" "$work/consumer"
ln -s "$(command -v "$compiler")" "$HOME/bin/g++"
export PATH=$HOME/bin:$PATH CXX=$compiler
unset CMAKE_PREFIX_PATH PKG_CONFIG_PATH

# Blocks of sh are the commands; any other is the file that its first line names.
awk -v work="$work" '
  /^```/ && inside { inside = 0; next }
  /^```sh$/ { inside = 1; file = work "/commands.sh"; next }
  /^```/ { inside = 1; file = ""; next }
  inside && file == "" { file = work "/" $2; next }
  inside { print > file }' "$manual"
for file in commands.sh smallest.cpp CMakeLists.txt; do
  [ -s "$work/$file" ] || { echo "$manual shows no $file" >&2; exit 1; }
done
cd "$work"
bash -exuo pipefail commands.sh
