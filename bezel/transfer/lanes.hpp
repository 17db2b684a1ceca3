#pragma once
// Internal: how many numbers are worked on together.

#include <cstddef>

namespace bezel::detail {

/// Numbers that are worked on together, on every machine: sums keep their order, so the bits are
/// the same everywhere.
inline constexpr std::size_t lanes = 8;

/// n, rounded up to whole blocks.
constexpr std::size_t padded_to_lanes(std::size_t n) {
  return (n + lanes - 1) / lanes * lanes;
}

}  // namespace bezel::detail
