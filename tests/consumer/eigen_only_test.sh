#!/usr/bin/env bash
# The headers of groups and integrators need Eigen and the C++ library, nothing else: compiles a source that includes all of them but
# groups/extended.h (QD), and complains of every file of liebench that this reads and that lies in a room above or includes a foreign
# header.
#
#   tests/consumer/eigen_only_test.sh CXX_COMPILER
set -euo pipefail
[ $# = 1 ] || { sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//p}' "$0" >&2; exit 2; }
compiler=$1
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/../.."
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

for header in groups/*.h integrators/*.h; do
  [ "$header" = groups/extended.h ] || echo "#include \"$header\""
done >"$folder/all.cpp"
read -ra eigen < <(pkg-config --cflags eigen3)
"$compiler" -std=c++20 -fsyntax-only -MD -MF "$folder/all.d" -I. "${eigen[@]}" "$folder/all.cpp"

complaints=0
complain() { echo "$*" >&2; complaints=$((complaints + 1)); }
files=0
while read -r file; do
  files=$((files + 1))
  case $file in
    groups/* | integrators/* | problems/system.h | problems/audited_system.h) ;;
    *) complain "$file is read by a header of groups or integrators" ;;
  esac
  # Headers of the C++ library have names without a dot and a slash.
  while read -r foreign; do
    complain "$file includes <$foreign>"
  done < <(sed -n 's/^#include <\(.*\)>.*/\1/p' "$file" | grep -vE '^[a-z_]+$|^Eigen/[A-Za-z]+$' || true)
done < <(grep -oE '[^ ]+\.h' "$folder/all.d" | grep -E '^(\./)?[a-z]+/' | sed 's|^\./||')
[ "$files" -ge "$(wc -l <"$folder/all.cpp")" ] || complain "only $files headers were looked at"
echo "$files headers, $complaints complaints"
[ "$complaints" = 0 ]
