#pragma once
// Exact binomial coefficients.

#include <cstdint>

namespace bezel {

/// Largest n for which every C(n, k) is a double exactly (C(56, 28) < 2^53).
inline constexpr int max_exact_binomial = 56;
/// Largest n served.
inline constexpr int max_binomial = 120;

/// C(n, k), 0 <= k <= n <= max_binomial: exact for n <= max_exact_binomial, correctly rounded
/// above. Zero when k < 0 or k > n. @throws InputError when n is out of range.
double binomial(int n, int k);

/// An unsigned 128-bit integer: high 2^64 + low.
struct Integer128 {
  std::uint64_t high, low;
};
/// C(n, k) exactly, for the same arguments as binomial() (C(120, 60) < 2^117).
Integer128 exact_binomial(int n, int k);

}  // namespace bezel
