#pragma once
// Quotients of exact numbers, and the simplest one in an interval.

#include <optional>

#include "bezel/numeric/dyadic.hpp"

namespace bezel {

/// num / den, den > 0; not reduced.
struct Ratio {
  Dyadic num;
  Dyadic den = 1.0;
};

/// -1, 0 or +1: the sign of a - b.
int compare(const Ratio& a, const Ratio& b);
/// The nearest double, ties to even. @limits zero or infinite where that is no normal double
double to_double(const Ratio& a);
/// numerator / denominator within 4 u, also where the numbers themselves are no doubles; the
/// denominator is not 0.
double quotient(const Dyadic& numerator, const Dyadic& denominator);
/// The largest integer q with q * divisor <= dividend. @param dividend >= 0 @param divisor > 0
Dyadic floor_quotient(const Dyadic& dividend, const Dyadic& divisor);

/// The fraction with the smallest denominator in [lo, hi], 0 <= lo <= hi, by continued fractions.
///
/// @return  nothing when the denominator has more than max_bits bits
/// @cost    a division with remainder for each partial quotient
std::optional<Ratio> simplest_between(const Dyadic& lo, const Dyadic& hi, int max_bits);

}  // namespace bezel
