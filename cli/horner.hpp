#pragma once
// Compensated Horner evaluation in the monomial basis, for comparison with the Bernstein basis.

#include <cmath>
#include <vector>

#include "bezel/bernstein/newton.hpp"
#include "bezel/numeric/eft.hpp"

namespace bezel::cli {

/// sum a_i s^i, plain.
inline double horner(const std::vector<double>& a, double s) {
  double p = 0.0;
  for (std::size_t i = a.size(); i-- > 0;) p = p * s + a[i];
  return p;
}

/// sum (a_i + low_i) s^i as if in twice the working precision; |low_i| <= u |a_i|.
/// @source [graillat2008], with the low parts of the coefficients among the errors
inline double compensated_horner(const std::vector<double>& a, const std::vector<double>& low,
                                 double s) {
  double p = 0.0, error = 0.0;
  for (std::size_t i = a.size(); i-- > 0;) {
    const WithError product = two_prod(p, s), sum = two_sum(product.value, a[i]);
    p = sum.value;
    error = error * s + ((product.error + sum.error) + low[i]);
  }
  return p + error;
}

struct HornerNewton {
  double s;
  int iterations;
  bernstein::NewtonStop stop;
};

/// Newton's method from s; `compensated` 0: plain, 1: p compensated, 2: p and p'.
/// @source [graillat2008], [jiang2013, sec. 8]
inline HornerNewton newton_horner(const std::vector<double>& a, double s, int compensated,
                                  double param_tol, int max_iterations) {
  const std::vector<double> none(a.size(), 0.0);
  std::vector<double> slope, slope_low;  // i a_i, exactly
  for (std::size_t i = 1; i < a.size(); ++i) {
    const WithError c = two_prod(static_cast<double>(i), a[i]);
    slope.push_back(c.value);
    slope_low.push_back(c.error);
  }
  for (int i = 0; i < max_iterations; ++i) {
    const double p = compensated >= 1 ? compensated_horner(a, none, s) : horner(a, s);
    const double dp = compensated >= 2 ? compensated_horner(slope, slope_low, s) : horner(slope, s);
    if (dp == 0.0 && p != 0.0) return {s, i, bernstein::NewtonStop::zero_derivative};
    const double step = p == 0.0 ? 0.0 : p / dp;
    if (!std::isfinite(s - step)) return {s, i, bernstein::NewtonStop::not_finite};
    s -= step;
    if (std::fabs(step) < param_tol) return {s, i + 1, bernstein::NewtonStop::small_step};
  }
  return {s, max_iterations, bernstein::NewtonStop::max_iterations};
}

}  // namespace bezel::cli
