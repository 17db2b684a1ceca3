#pragma once
// Values with a proven bound, faithfully rounded whatever the conditioning.
//
// Coefficients and parameters are taken as exact. Every function takes 0 <= degree <=
// max_interval_degree and finite values, checks both, and throws InputError otherwise.

#include <cstdint>
#include <span>

#include "bezel/bernstein/index.hpp"

namespace bezel::bernstein {

/// How a certified value was reached; the first that sufficed.
enum class Certificate : std::uint8_t {
  doubled = 2,     ///< twice the working precision (compensated Horner scheme)
  tripled = 3,     ///< compensated de Casteljau, K = 3
  quadrupled = 4,  ///< K = 4
  exact = 5        ///< exact arithmetic: the value is correctly rounded
};

struct CertifiedValue {
  double value;        ///< p(s) itself or one of the two doubles around it; 0 only when p(s) = 0
                       ///< or |p(s)| < 2^-1074
  double error_bound;  ///< |value - p(s)| <= error_bound; 0 when value == p(s) is proven
  Certificate certificate;
};

/// p(s), faithful: never further from p(s) than the neighbouring doubles.
///
/// Any finite s, though only s in [0, 1] has the fast levels; elsewhere exact arithmetic serves.
/// The sign of the value is the sign of p(s), a returned zero is proven (or |p(s)| < 2^-1074, told
/// by error_bound > 0), and overflow gives an infinite value and bound.
///
/// @accuracy  |value - p(s)| < ulp; error_bound <= 1.6 u |value| unless exact, then half an ulp
/// @cost      doubled: 13 d + 60 or so flops up to cond(p, s) = 1 / ((54 d^2 + ...) u); tripled and
///            quadrupled as evaluate_compensated; exact: 1 us per point of a
///            batch at d = 8, 5 us alone
/// @source    docs/methods/certified.md, where every constant is derived
CertifiedValue evaluate_certified(std::span<const double> b, double s);

/// Many points; any of `error_bound` and `certificate` may be empty when not wanted. The bits of
/// the scalar version, on every SIMD target with fused products.
///
/// @throws    also InputError when sizes differ
/// @cost      lanes are points; those that fail a level are packed and go on together. The spans
/// must
///            not overlap
void evaluate_certified(std::span<const double> b, std::span<const double> s,
                        std::span<double> value, std::span<double> error_bound = {},
                        std::span<Certificate> certificate = {});

}  // namespace bezel::bernstein
