#pragma once
// The first level of certified evaluation, vectorised: a compensated Horner scheme in s / (1 - s)
// with a running bound. Without checks; docs/methods/certified.md for the derivation.

#include <array>
#include <cstddef>

#include "bezel/bernstein/index.hpp"

namespace bezel::bernstein {

/// The coefficients C(d, j) b_j = high + low and what the test of faithfulness needs.
struct DoubledForm {
  using Values = std::array<double, max_interval_degree + 1>;
  int degree = 0;
  Values high, low, magnitude;  ///< magnitude = |high|
  double threshold = 0.0;       ///< faithful when |value| > threshold * p~ + smallest
  double bound_factor = 0.0;    ///< |error| <= 1.5 u |value| with bound_factor * p~ for its part
  double s_max = 0.0;  ///< larger s < 1 underflow in (1 - s)^d: use the reversed polynomial
};

/// The form for coefficients whose largest magnitude lies in [2^-30, 2^30], 1 <= d <= 60; reversed:
/// of p(1 - s).
DoubledForm doubled_form(int d, const double* b, bool reversed);

/// value[q] and bound[q] (may be null) at s[q]; the indices of points that failed go to `failed`
/// (room for count), their values are meaningless.
/// @return how many failed: outside (0, s_max], or too ill-conditioned
std::size_t evaluate_doubled(const DoubledForm& form, const double* s, std::size_t count,
                             double* value, double* bound, std::size_t* failed);

}  // namespace bezel::bernstein
