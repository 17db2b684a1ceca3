#!/usr/bin/env bash
# Installs a build tree into a temporary folder, moves that folder, and builds and runs an outside project against it:
# with CMake, with pkg-config, and with the installed command line tool. Debian's own packages are the only others.
#
# usage: tests/install/run.sh [BUILD_DIR]   (default build-release, built already)
set -euo pipefail
source_dir=$(cd "$(dirname "$0")/../.." && pwd)
build=${1:-$source_dir/build-release}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/first" >"$work/install.log" || { cat "$work/install.log" >&2; exit 1; }
mv "$work/first" "$work/installed"
prefix=$work/installed

fail() {
  echo "error: $*" >&2
  exit 1
}
if grep -rqF -e "$source_dir" -e "$work/first" "$prefix/lib/cmake" "$prefix/lib/pkgconfig"; then
  fail "the installed package files name the source or the first install folder: it cannot be moved"
fi

cmake -S "$source_dir/tests/install/consumer" -B "$work/cmake" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$prefix" >"$work/cmake.log" || { cat "$work/cmake.log" >&2; exit 1; }
cmake --build "$work/cmake" >"$work/build.log" || { cat "$work/build.log" >&2; exit 1; }
by_cmake=$("$work/cmake/all_of_it")
[ "$("$work/cmake/one_module")" = "0.5" ] || fail "one_module: found '$("$work/cmake/one_module")', expected '0.5'"

export PKG_CONFIG_PATH=$prefix/lib/pkgconfig
flags=$(pkg-config --cflags bezel)
case " $flags " in *" -ffp-contract=off "*) ;; *) fail "bezel.pc lost -ffp-contract=off: $flags" ;; esac
# shellcheck disable=SC2046,SC2086  # lists
"${CXX:-g++}" -std=c++20 -O2 $flags "$source_dir/tests/install/consumer/main.cpp" $(pkg-config --libs bezel) \
  -o "$work/by_pkg_config"
by_pkg_config=$("$work/by_pkg_config")

[ "$by_cmake" = "$by_pkg_config" ] || fail "CMake's program prints '$by_cmake', pkg-config's '$by_pkg_config'"
case "$by_cmake" in "conserved "*) ;; *) fail "the program prints '$by_cmake', expected 'conserved ...'" ;; esac

if [ -x "$build/cli/bezel" ]; then
  version=$("$prefix/bin/bezel" --version)
  expected=$(pkg-config --modversion bezel)
  case "$version" in *"$expected"*) ;; *) fail "bezel --version prints '$version', expected $expected" ;; esac
fi
echo "install: found, linked and run with CMake and pkg-config: $by_cmake"
