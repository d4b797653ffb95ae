#!/usr/bin/env bash
# Installs the Debian packages that liebench needs and that are not there yet, through apt-get.
#
#   scripts/setup.sh [--tests] [--lint] [--sundials]
#
#   --tests      also what all tests need: clang with its sanitizers, LaTeX, pandas, matplotlib, Doxygen
#   --lint       also what .ci/run needs beyond the builds: clang-format, clang-tidy, shellcheck, codespell, mypy
#   --sundials   also SUNDIALS, with whose solvers liebench compares where it is there
#   --help       this text
#
# When nothing is missing it does nothing and needs neither network nor rights. Otherwise it runs apt-get as root
# or by sudo; where it can't, it names the packages and the command, and exits with status 3.
set -euo pipefail

usage() { sed -n '2,/^set -/{/^set -/d;s/^# \{0,1\}//p}' "$0"; }

# One package a word; in "a|b" either will do, and a is the one installed.
packages=(
  build-essential cmake ninja-build git ca-certificates
  libeigen3-dev libceres-dev libsuitesparse-dev libboost-dev libqd-dev
  nlohmann-json3-dev rapidjson-dev libcli11-dev libfmt-dev libxxhash-dev libmuparser-dev
  'gnuplot-nox|gnuplot-qt|gnuplot-x11'
  libgtest-dev libgmock-dev libvalijson-dev libbenchmark-dev 'pkgconf|pkg-config'
)
test_packages=(clang 'libclang-rt-14-dev|libclang-rt-[0-9]+-dev' 'llvm|llvm-[0-9]+'
  texlive-latex-recommended texlive-science python3-pandas python3-matplotlib doxygen)
lint_packages=(clang-format clang-tidy shellcheck codespell mypy)

while [ $# -gt 0 ]; do
  case $1 in
    --tests) packages+=("${test_packages[@]}") ;;
    --lint) packages+=("${lint_packages[@]}") ;;
    --sundials) packages+=(libsundials-dev) ;;
    -h | --help) usage; exit 0 ;;
    *) echo "setup.sh: unknown option '$1' (allowed: --tests, --lint, --sundials, --help)" >&2; exit 2 ;;
  esac
  shift
done

# Sets `missing` to the packages that are not installed.
find_missing() {
  local installed entry
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' | sed -n 's/^installed //p')
  missing=()
  for entry in "${packages[@]}"; do
    grep -qxE "$entry" <<<"$installed" || missing+=("${entry%%|*}")
  done
}

# Says what is missing, why it was not installed ($1), and how to do it by hand.
give_up() {
  {
    echo "setup.sh: $1"
    echo "setup.sh: missing Debian packages: ${missing[*]}"
    echo "setup.sh: install them with this command, as root, and try again:"
    echo
    echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}"
    echo
  } >&2
  exit 3
}

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  missing=("${packages[@]%%|*}")
  give_up "this is not a Debian system; the packages are named as Debian 12 has them"
fi

find_missing
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || give_up "you are not root and there is no sudo"
  as_root=(sudo)
  [ -t 0 ] || as_root+=(-n) # nobody is there to type a password
  "${as_root[@]}" true || give_up "you are not root and sudo refused"
fi

# libqd-dev depends on some gfortran: this one shares its gcc with build-essential, apt's own choice brings a second.
request=("${missing[@]}")
case " ${missing[*]} " in *" libqd-dev "*) request+=(gfortran) ;; esac

# --no-remove: a package that conflicts with one of ours is the user's to give up.
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3)
log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "setup.sh: installing ${missing[*]} (a few minutes the first time)" >&2
"${apt[@]}" update >"$log" 2>&1 || { tail -n 5 "$log"; echo "setup.sh: apt-get update failed, trying all the same"; } >&2
if ! "${apt[@]}" install --no-install-recommends --no-remove "${request[@]}" >"$log" 2>&1 </dev/null; then
  tail -n 20 "$log" >&2
  find_missing
  give_up "apt-get install failed, see above"
fi
echo "setup.sh: done, $SECONDS s" >&2
