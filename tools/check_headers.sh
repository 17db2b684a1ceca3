#!/usr/bin/env bash
# Compiles public headers on their own with the first compiler named, and all of them together with each further one: both
# have the same standard library, so what a header lacks shows with one, and only warnings differ (default: g++ and, where
# present, clang++-14). A header that the source of its name includes first is compiled on its own wherever that source is,
# as with -DBEZEL_UNITY=OFF, and left out here unless --all is given.
#
# usage: tools/check_headers.sh [--all] [COMPILER...]
set -euo pipefail
cd "$(dirname "$0")/.."

all=
if [ "${1:-}" = --all ]; then all=yes; shift; fi
compilers=("$@")
if [ "${#compilers[@]}" -eq 0 ]; then
  compilers=(g++)
  if command -v clang++-14 >/dev/null; then compilers+=(clang++-14); fi
fi
export FLAGS="-std=c++20 -fsyntax-only -ffp-contract=off -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Werror \
  $(pkg-config --cflags libhwy) -I. $(pkg-config --cflags eigen3 | sed 's/-I/-isystem /g')"

compile() {
  # Through standard input: a header that is itself the main file draws warnings of its own.
  # shellcheck disable=SC2086  # FLAGS is a list
  if ! printf '#include "%s"\n' "$2" | "$1" $FLAGS -x c++ -; then
    echo "$2: does not compile on its own with $1" >&2
    return 1
  fi
}
export -f compile

first_of_its_source() {
  [ -f "${1%.hpp}.cpp" ] && [ "$(grep -m 1 '^#include' "${1%.hpp}.cpp")" = "#include \"$1\"" ]
}

mapfile -t headers < <(find bezel -name '*.hpp' | sort)
alone=()
for header in "${headers[@]}"; do
  if [ -n "$all" ] || ! first_of_its_source "$header"; then alone+=("$header"); fi
done
printf '%s\n' "${alone[@]}" | xargs -P "$(nproc)" -I{} bash -c 'compile "$@"' _ "${compilers[0]}" {}
for compiler in "${compilers[@]:1}"; do
  # shellcheck disable=SC2086  # FLAGS is a list
  printf '#include "%s"\n' "${headers[@]}" | "$compiler" $FLAGS -x c++ - || { echo "with $compiler" >&2; exit 1; }
done
echo "${#alone[@]} headers compile on their own with ${compilers[0]}${compilers[1]:+, all ${#headers[@]} together with ${compilers[*]:1}}"
