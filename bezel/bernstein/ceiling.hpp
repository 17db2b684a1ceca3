#pragma once
// The maximum of a polynomial on the triangle, as sharp as a comparison with a ceiling needs.

#include <span>

namespace bezel::bernstein {

/// Above the ceiling a bound is sharp to this fraction of what the maximum exceeds the ceiling by.
inline constexpr double excess_tolerance = 1e-3;

/// Certified upper bound of the maximum on the triangle by best-first subdivision, which ends as
/// soon as the bound is not above `ceiling`, or not more than `tol`, or a thousandth of the excess
/// over the ceiling, above the maximum.
///
/// So a polynomial well below the ceiling costs a few comparisons, and one that exceeds it is known
/// to three digits of the excess.
///
/// @param b           coefficients, triangle_size(d), finite
/// @param ceiling     any value, infinite ones too
/// @param tol         at least 0
/// @param max_splits  the search gives up sharpening there: the bound holds, and is wider than tol
/// @throws InputError for a bad degree, a wrong size, a coefficient that is not finite,
///         a NaN ceiling or a tolerance that is not at least 0
/// @accuracy an upper bound, roundings included (30 d u max|b| at most)
/// @limits   maxima along whole curves need about (curvature / tol)^(1/2) splits
double upper_bound(int d, std::span<const double> b, double ceiling, double tol,
                   int max_splits = 2000);

}  // namespace bezel::bernstein
