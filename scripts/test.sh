#!/usr/bin/env bash
# Builds everything in Release and runs the whole test suite; the last lines are ctest's summary.
# Installs missing Debian or Ubuntu packages first.
#
# BEZEL_BUILD_DIR   the build tree; default build-release
# BEZEL_CMAKE_ARGS  more arguments for cmake, separated by spaces
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/setup.sh test

export CCACHE_SLOPPINESS=${CCACHE_SLOPPINESS:-pch_defines,time_macros}  # for the tests' precompiled headers
build=${BEZEL_BUILD_DIR:-build-release}
launcher=()
if command -v ccache >/dev/null; then launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache); fi
# shellcheck disable=SC2086  # a list
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DBEZEL_BUILD_TESTS=ON -DBEZEL_BUILD_EXAMPLES=ON \
  "${launcher[@]}" ${BEZEL_CMAKE_ARGS:-}
cmake --build "$build" --parallel "$(nproc)"
ctest --test-dir "$build" --output-on-failure --parallel "$(nproc)"
