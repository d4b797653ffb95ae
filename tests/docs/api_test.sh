#!/usr/bin/env bash
# Doxygen reads all headers without a warning, and what their comments say stands in its pages.
#
#   tests/docs/api_test.sh FOLDER
set -euo pipefail
out=$1
command -v doxygen >/dev/null || { echo "skipped: there is no doxygen (Debian package doxygen)"; exit 77; }
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
rm -rf "$out"
mkdir -p "$out"
{ cat docs/Doxyfile; echo "OUTPUT_DIRECTORY = \"$out\""; } | doxygen -

failures=0
# expect PAGE TEXT: tags of the page do not count.
expect() {
  grep -qF -- "$2" <(sed 's/<[^>]*>//g; s/&gt;/>/g; s/&lt;/</g; s/&amp;/\&/g' "$out/html/$1") && return
  echo "api_test.sh: $1 lacks \"$2\"" >&2
  failures=$((failures + 1))
}
expect lie__group_8h.html "A Lie group G of dimension m in left trivialisation: q' = DL_q(e) v~, v in R^m [Bruels & Cardona 2010]."
expect conceptliebench_1_1LieGroup.html "  commutator(v, w)     the vector of [v~, w~], the operator v^ w of eq. (15)"
expect structliebench_1_1TimingRules.html "of one repetition, s: shorter runs are repeated within it"
expect structliebench_1_1Axes.html "The axes of a panel."
expect timing_8h.html "The interquartile range of the repetitions over their median."
# A comment within a function is no documentation.
if grep -rqF "The logarithms below are those of the motion only" "$out/html"; then
  echo "api_test.sh: a comment of a function's body stands in the pages" >&2
  failures=$((failures + 1))
fi
[ $failures = 0 ]
