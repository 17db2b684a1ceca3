#pragma once
// How many numbers are worked on together.

#include <cstddef>

namespace bezel {

/// Numbers that are worked on together, on every machine: sums keep their order, so the bits are
/// the same everywhere.
inline constexpr std::size_t lanes = 8;

/// n, rounded up to whole blocks.
constexpr std::size_t padded_to_lanes(std::size_t n) {
  return (n + lanes - 1) / lanes * lanes;
}

/// Of `lanes` numbers, an array or a vector of the compiler's: in pairs, as vectors are halved.
template <class Numbers>
[[gnu::always_inline]] inline double sum_of_lanes(const Numbers& x) {
  return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

}  // namespace bezel
