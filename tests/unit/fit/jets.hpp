#pragma once
// Whether the derivatives a curve gives are those of its points.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/fit/smooth_curve.hpp"

namespace bezel {

/// Compares derivatives with central differences of eighth order between the breakpoints.
/// @param tolerance  relative to the largest derivative seen
template <int dim>
void expect_consistent_jets(const SmoothCurve<dim>& curve, double tolerance) {
  constexpr double h = 4e-3;
  constexpr std::array<double, 4> first = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  constexpr std::array<double, 5> second = {-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
  double d1 = 0.0, d2 = 0.0;
  for (int i = 0; i <= 50; ++i) {
    d1 = std::max(d1, norm(curve(-1.0 + 0.04 * i).d1));
    d2 = std::max(d2, norm(curve(-1.0 + 0.04 * i).d2));
  }
  for (int i = 1; i < 50; ++i) {
    const double t = -1.0 + 0.04 * i;
    const auto near = [&](double b) { return std::fabs(b - t) <= 4 * h; };
    if (std::any_of(curve.breakpoints().begin(), curve.breakpoints().end(), near)) continue;
    if (t + 4 * h > 1.0 || t - 4 * h < -1.0) continue;
    Vec<dim> sum1{}, sum2 = second[0] * curve(t).x;
    for (std::size_t k = 0; k < 4; ++k) {
      const double step = h * static_cast<double>(k + 1);
      const Vec<dim> right = curve(t + step).x, left = curve(t - step).x;
      sum1 += first[k] * (right - left);
      sum2 += second[k + 1] * (right + left);
    }
    EXPECT_LE(norm((1 / h) * sum1 - curve(t).d1), tolerance * d1) << "t = " << t;
    EXPECT_LE(norm((1 / (h * h)) * sum2 - curve(t).d2), 100 * tolerance * (d1 + d2)) << "t = " << t;
  }
}

}  // namespace bezel
