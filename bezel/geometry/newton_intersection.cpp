#include "bezel/geometry/newton_intersection.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/newton_intersection_kernel.hpp"

namespace bezel {

using bernstein::NewtonStop;
using geometry_kernel::NewtonCurve;

NewtonIntersection newton_intersection(std::span<const Vec2> a, std::span<const Vec2> b, double s0,
                                       double t0, ResidualForm form,
                                       const NewtonIntersectionOptions& options) {
  cache_curve(a);  // checks the control points
  cache_curve(b);
  bernstein::checks::finite(s0, "start s");
  bernstein::checks::finite(t0, "start t");
  bernstein::checks::iteration(options.param_tol, options.max_iterations);
  NewtonIntersection out{s0, t0, 0, NewtonStop::max_iterations, 0.0, {{s0, t0}}};
  NewtonCurve first(a), second(b);
  while (out.iterations < options.max_iterations) {
    const Vec2 f = geometry_kernel::residual(first, out.s, second, out.t, form);
    if (f == Vec2{}) {
      ++out.iterations;
      out.stop = NewtonStop::zero_residual;
      break;
    }
    Vec2 step;
    if (!geometry_kernel::solve(first.derivative(out.s), -second.derivative(out.t), f, step)) {
      out.stop = NewtonStop::zero_derivative;
      break;
    }
    const double s = out.s - step.x(), t = out.t - step.y();
    if (!std::isfinite(s) || !std::isfinite(t)) {
      out.stop = NewtonStop::not_finite;
      break;
    }
    out.s = s;
    out.t = t;
    out.history.push_back({s, t});
    ++out.iterations;
    if (std::hypot(step.x(), step.y()) < options.param_tol) {
      out.stop = NewtonStop::small_step;
      break;
    }
  }
  out.condition = intersection_condition(a, b, out.s, out.t);
  return out;
}

double intersection_condition(std::span<const Vec2> a, std::span<const Vec2> b, double s,
                              double t) {
  cache_curve(a);
  cache_curve(b);
  const auto absolute = [](std::span<const Vec2> c, int i, double x) {
    std::vector<double> w;
    for (const Vec2& p : c) w.push_back(p[i]);
    return bernstein::absolute_value_sum(w, x);
  };
  Vec2 p = bernstein::evaluate_derivative_compensated(a, s, 2);
  Vec2 q = bernstein::evaluate_derivative_compensated(b, t, 2);
  double mu1 = absolute(a, 0, s) + absolute(b, 0, t), mu2 = absolute(a, 1, s) + absolute(b, 1, t);
  // Powers of two scale tangents and sizes alike: nothing over- or underflows on the way.
  const double largest =
      std::max({std::fabs(p.x()), std::fabs(p.y()), std::fabs(q.x()), std::fabs(q.y())});
  const double length = std::hypot(s, t);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(largest > 0.0) || !std::isfinite(largest) || length == 0.0) return infinity;
  const int exponent = -std::ilogb(largest);
  for (double* x : {&p[0], &p[1], &q[0], &q[1], &mu1, &mu2}) *x = std::ldexp(*x, exponent);
  // The determinant of [p, -q] with one rounding of each product's error.
  const WithError first = two_prod(p.x(), -q.y()), second = two_prod(p.y(), -q.x());
  const double det = (first.value - second.value) + (first.error - second.error);
  if (det == 0.0) return infinity;
  // J^-1 = [-q.y, q.x; -p.y, p.x] / det: v and w are its columns.
  const Vec2 v{{-q.y() * (mu1 / det), -p.y() * (mu1 / det)}};
  const Vec2 w{{q.x() * (mu2 / det), p.x() * (mu2 / det)}};
  return std::sqrt(dot(v, v) + 2.0 * std::fabs(dot(v, w)) + dot(w, w)) / length;
}

}  // namespace bezel
