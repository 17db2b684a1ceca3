#pragma once
// Sums that do not lose digits, always in the given order: the same bits on every machine.

#include <span>

namespace bezel {

/// Compensated sum of values, as if computed in twice the working precision and rounded once.
///
/// @param values  any number of finite values (empty: 0), no overflow of a partial sum
/// @accuracy  |error| <= u |S| + n^2 u^2 sum |values|, S the exact sum, u = 2^-53
/// @cost      7 flops per value, one pass
/// @source    [ogita2005, algorithm 4.4, corollary 4.5]
double sum(std::span<const double> values);

/// Compensated dot product of equally long a and b, accurate as if in twice the working precision.
///
/// @throws    InputError when the lengths differ
/// @accuracy  |error| <= u |S| + n^2 u^2 sum |a_i b_i|, barring underflow
/// @cost      10 flops per pair
/// @source    [ogita2005, algorithm 5.3]
double dot(std::span<const double> a, std::span<const double> b);

}  // namespace bezel
