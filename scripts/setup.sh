#!/usr/bin/env bash
# Installs the Debian or Ubuntu packages that Bezel needs and that are missing; touches nothing, and needs no
# network, when none is.
#
# usage: scripts/setup.sh [build|test|ci|mpi]
#   build  library and command line tool (default)
#   test   ... and the test suite
#   ci     ... and what the slower checks need (clang 14, benchmarks, ccache)
#   mpi    what test installs, and Open MPI for builds with -DBEZEL_WITH_MPI=ON
set -euo pipefail

build=(g++ cmake ninja-build pkg-config libeigen3-dev libhwy-dev libfmt-dev libcli11-dev nlohmann-json3-dev
  libpugixml-dev libtbb-dev libpng-dev zlib1g-dev)
test=(python3 libgtest-dev libgmock-dev librapidcheck-dev libgmp-dev libmpfr-dev)
ci=(git libbenchmark-dev libqd-dev clang-14 clang-format-14 clang-tidy-14 ccache)
mpi=(libopenmpi-dev openmpi-bin)

case "${1:-build}" in
  build) wanted=("${build[@]}") ;;
  test) wanted=("${build[@]}" "${test[@]}") ;;
  ci) wanted=("${build[@]}" "${test[@]}" "${ci[@]}") ;;
  mpi) wanted=("${build[@]}" "${test[@]}" "${mpi[@]}") ;;
  *) echo "error: found '$1', expected build, test, ci or mpi" >&2; exit 2 ;;
esac

if ! command -v dpkg >/dev/null; then
  echo "This is neither Debian nor Ubuntu: please install the counterparts of these packages yourself:" >&2
  echo "  ${wanted[*]}" >&2
  exit 0
fi

missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  if [ "$status" != installed ]; then missing+=("$package"); fi
done
if [ "${#missing[@]}" -eq 0 ]; then exit 0; fi

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "error: missing packages and neither root nor sudo; as root: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
