#include "bezel/geometry/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bezel/geometry/curve_check.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel {

using geometry_kernel::curve_point;

Curve::Curve(std::vector<Vec2> control) : control_(std::move(control)) {
  geometry_kernel::checked_degree(control_);
}

Vec2 Curve::operator()(double s) const {
  return curve_point(degree(), control_.data(), s).value;
}
Vec2 Curve::derivative(double s) const {
  return curve_point(degree(), control_.data(), s).derivative;
}
Box2 Curve::box() const {
  return geometry_kernel::control_box(degree(), control_.data());
}

namespace {

double length_of(const IntervalRule& rule, int degree, const Vec2* b, double tolerance, int depth) {
  const auto gauss = [&](const Vec2* c) {
    double sum = 0;
    for (std::size_t q = 0; q < rule.node.size(); ++q)
      sum += rule.weight[q] * norm(curve_point(degree, c, rule.node[q]).derivative);
    return sum;
  };
  // Control polygon and chord enclose the length: exact for straight pieces.
  double polygon = 0;
  for (int i = 0; i < degree; ++i) polygon += norm(b[i + 1] - b[i]);
  const double chord = norm(b[degree] - b[0]);
  if (polygon - chord <= 1e-16 * polygon) return chord;
  std::vector<Vec2> parts(2 * static_cast<std::size_t>(degree + 1));
  Vec2 *left = parts.data(), *right = left + degree + 1;
  geometry_kernel::halve(degree, b, left, right);
  const double one = gauss(b), two = gauss(left) + gauss(right);
  if (depth == 0 || polygon <= tolerance || std::fabs(one - two) <= tolerance * 1e-3 + 2e-16 * two)
    return two;
  return length_of(rule, degree, left, tolerance, depth - 1) +
         length_of(rule, degree, right, tolerance, depth - 1);
}

/// The range of slopes, from the derivative's control points on [-1/4, 5/4].
void measure_turn(CurveCache& cache, int degree) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (degree <= 1) {
    cache.slope_lo = cache.chord_length > 0 ? 0.0 : -infinity;
    cache.slope_hi = cache.chord_length > 0 ? 0.0 : infinity;
    return;
  }
  geometry_kernel::PointBuffer<geometry_kernel::max_curve_points> differences, extended;
  Vec2 *h = differences.data(), *e = extended.data();
  for (int i = 0; i < degree; ++i)
    h[i] =
        cache.control[static_cast<std::size_t>(i) + 1] - cache.control[static_cast<std::size_t>(i)];
  geometry_kernel::restrict_curve(degree - 1, h, -0.25, 1.25, e);
  cache.slope_lo = infinity;
  cache.slope_hi = -infinity;
  for (int i = 0; i < degree; ++i) {
    const double along = dot(cache.chord, e[i]), across = cross(cache.chord, e[i]);
    if (!(along > 0)) {
      cache.slope_lo = -infinity;
      cache.slope_hi = infinity;
      return;
    }
    cache.slope_lo = std::min(cache.slope_lo, across / along);
    cache.slope_hi = std::max(cache.slope_hi, across / along);
  }
}

}  // namespace

double Curve::length() const {
  if (degree() == 0) return 0;
  double polygon = 0;
  for (std::size_t i = 0; i + 1 < control_.size(); ++i)
    polygon += norm(control_[i + 1] - control_[i]);
  return length_of(gauss_legendre(16), degree(), control_.data(), 1e-14 * polygon, 40);
}

CurveCache cache_curve(std::span<const Vec2> control) {
  geometry_kernel::checked_degree(control);
  const int d = static_cast<int>(control.size()) - 1;
  CurveCache cache{};
  cache.control = control;
  cache.box = geometry_kernel::control_box(d, control.data());
  cache.magnitude = geometry_kernel::largest_coordinate(cache.box);
  cache.chord = control.back() - control.front();
  cache.chord_length = norm(cache.chord);
  for (int i = 1; i < d; ++i) {
    const double c = cross(cache.chord, control[static_cast<std::size_t>(i)] - control.front());
    cache.band_lo = std::min(cache.band_lo, c);
    cache.band_hi = std::max(cache.band_hi, c);
  }
  cache.diameter = cache.box.diameter();
  measure_turn(cache, d);
  return cache;
}

}  // namespace bezel
