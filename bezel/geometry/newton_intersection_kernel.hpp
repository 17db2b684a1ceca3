#pragma once
// The parts of Newton's method for intersections: residuals, tangents, the 2x2 system. Unchecked.

#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "bezel/bernstein/compensated_kernel.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/geometry/newton_intersection.hpp"
#include "bezel/numeric/eft.hpp"

namespace bezel::geometry_kernel {

/// The two levels of a point: their sum is the compensated value, not rounded.
struct PointLevels {
  Vec2 value, compensation;
};

/// A curve, its coordinates apart; on the stack.
class NewtonCurve {
 public:
  explicit NewtonCurve(std::span<const Vec2> control) : d_(static_cast<int>(control.size()) - 1) {
    for (int c = 0; c < 2; ++c)
      for (std::size_t j = 0; j < control.size(); ++j) b_[c][j] = control[j][c];
  }

  PointLevels levels(double s, int K) const {
    PointLevels out;
    double w[2 * max_curve_points], l[2] = {0.0, 0.0};
    for (int c = 0; c < 2; ++c) {
      bernstein::kernel::compensated_levels(d_, b_[c], s, K, w, l);
      out.value[c] = l[0];
      out.compensation[c] = l[1];
    }
    return out;
  }
  /// Plain: differences of the control points, de Casteljau, times the degree.
  Vec2 derivative(double s) const {
    Vec2 out;
    if (d_ == 0) return out;
    double w[max_curve_points];
    for (int c = 0; c < 2; ++c)
      bernstein::kernel::compensated_derivative_levels(d_, b_[c], s, 1, w, &out[c]);
    return out *= d_;
  }

 private:
  int d_;
  double b_[2][max_curve_points];
};

/// a(s) - b(t).
inline Vec2 residual(const NewtonCurve& a, double s, const NewtonCurve& b, double t,
                     ResidualForm form) {
  const int K = form == ResidualForm::plain ? 1 : 2;
  const PointLevels p = a.levels(s, K), q = b.levels(t, K);
  if (form == ResidualForm::rounded_values)
    return (p.value + p.compensation) - (q.value + q.compensation);
  Vec2 f;
  for (int c = 0; c < 2; ++c) {
    const WithError d = two_sum(p.value[c], -q.value[c]);
    f[c] = form == ResidualForm::plain
               ? d.value
               : d.value + ((p.compensation[c] - q.compensation[c]) + d.error);
  }
  return f;
}

/// x with [p, q] x = f, by elimination with the larger of the first column's entries as pivot;
/// false when the matrix is singular in floating point.
inline bool solve(Vec2 p, Vec2 q, Vec2 f, Vec2& x) {
  if (std::fabs(p[1]) > std::fabs(p[0]))
    for (Vec2* row : {&p, &q, &f}) std::swap((*row)[0], (*row)[1]);
  if (p[0] == 0.0) return false;
  const double m = p[1] / p[0], pivot = q[1] - m * q[0];
  if (pivot == 0.0) return false;
  x[1] = (f[1] - m * f[0]) / pivot;
  x[0] = (f[0] - q[0] * x[1]) / p[0];
  return true;
}

}  // namespace bezel::geometry_kernel
