#pragma once
// Error-free transformations: the rounded result of one operation and its exact rounding error.
// They need -ffp-contract=off (set by the build) and round-to-nearest.

#include <cmath>

namespace bezel {

/// A rounded result and its exact error: the true value is value + error.
struct WithError {
  double value, error;
};

/// a + b exactly, as value + error.
///
/// @param a, b  finite, |a + b| below overflow
/// @return  value = fl(a + b); value + error == a + b exactly (also when subnormal)
/// @cost    6 flops, no branch
/// @source  [knuth1997, sec. 4.2.2, theorem B]
constexpr WithError two_sum(double a, double b) {
  const double s = a + b;
  const double z = s - a;
  return {s, (a - (s - z)) + (b - z)};
}

/// a + b exactly, when |a| >= |b| or a == 0; 3 flops.
/// @source [dekker1971, sec. 2]
constexpr WithError fast_two_sum(double a, double b) {
  const double s = a + b;
  return {s, b - (s - a)};
}

/// a * b exactly, as value + error.
///
/// @param a, b  finite, |a b| below overflow and zero or >= 2^-969 (else the error itself
/// underflows)
/// @return  value = fl(a b); value + error == a b exactly
/// @cost    one product and one std::fma
/// @source  [ogita2005, algorithm 3.5]
inline WithError two_prod(double a, double b) {
  const double p = a * b;
  return {p, std::fma(a, b, -p)};
}

}  // namespace bezel
