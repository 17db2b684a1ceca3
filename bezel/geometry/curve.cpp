#include "bezel/geometry/curve.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/geometry/curve_check.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel {

using geometry_kernel::curve_point;
using geometry_kernel::max_curve_points;

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
  cache.chord = control.back() - control.front();
  cache.chord_length = norm(cache.chord);
  for (int i = 1; i < d; ++i) {
    const double c = cross(cache.chord, control[static_cast<std::size_t>(i)] - control.front());
    cache.band_lo = std::min(cache.band_lo, c);
    cache.band_hi = std::max(cache.band_hi, c);
  }
  cache.magnitude = std::max(std::max(std::fabs(cache.box.lo.x()), std::fabs(cache.box.hi.x())),
                             std::max(std::fabs(cache.box.lo.y()), std::fabs(cache.box.hi.y())));
  return cache;
}

CurveIntersections intersect(std::span<const Vec2> a, std::span<const Vec2> b,
                             const IntersectOptions& options) {
  CurveIntersections out;
  intersect(cache_curve(a), cache_curve(b), options, out);
  return out;
}

void intersect(std::span<const Vec2> a, std::span<const Vec2> b, const IntersectOptions& options,
               CurveIntersections& out) {
  intersect(cache_curve(a), cache_curve(b), options, out);
}

namespace {

struct NearestSearch {
  int degree;
  const Vec2* control;
  Vec2 p;
  double best_squared, best_s;

  void offer(double s) {
    const Vec2 q = curve_point(degree, control, s, p).value;
    const double d = dot(q, q);
    if (d < best_squared || (d == best_squared && s < best_s)) {
      best_squared = d;
      best_s = s;
    }
  }
  /// Newton on (c - p) . c' inside [s0, s1].
  void polish(double s0, double s1) {
    double s = 0.5 * (s0 + s1);
    std::array<Vec2, max_curve_points> hodograph;
    for (int i = 0; i < degree; ++i) {
      const auto k = static_cast<std::size_t>(i);
      hodograph[k] = static_cast<double>(degree) * (control[i + 1] - control[i]);
    }
    for (int i = 0; i < 30; ++i) {
      const auto f = curve_point(degree, control, s, p);
      const Vec2 second =
          degree >= 2 ? curve_point(degree - 1, hodograph.data(), s).derivative : Vec2{};
      const double g = dot(f.value, f.derivative);
      double h = dot(f.derivative, f.derivative) + dot(f.value, second);
      if (!(h > 0)) h = dot(f.derivative, f.derivative);
      if (!(h > 0)) break;
      const double next = std::clamp(s - g / h, s0, s1);
      const double step = std::fabs(next - s);
      s = next;
      if (step <= 1e-16) break;
    }
    offer(s);
  }
  /// c: the control points on [s0, s1] minus p.
  void descend(const Vec2* c, double s0, double s1, int depth) {
    // Lower bound: distance of the origin to the control points' box.
    const Box2 box = geometry_kernel::control_box(degree, c);
    const double dx = std::max({0.0, box.lo.x(), -box.hi.x()}),
                 dy = std::max({0.0, box.lo.y(), -box.hi.y()});
    if (dx * dx + dy * dy >= best_squared) return;
    offer(0.5 * (s0 + s1));
    const Vec2 chord = c[degree] - c[0];
    double straight = 1e300;
    for (int i = 0; i < degree; ++i) {
      const Vec2 e = c[i + 1] - c[i];
      straight = std::min(straight, dot(e, chord) - 0.95 * norm(e) * norm(chord));
    }
    if (straight > 0 || depth >= 50) {
      polish(s0, s1);
      if (depth >= 8) return;
    }
    geometry_kernel::PointBuffer<max_curve_points> left, right;
    geometry_kernel::halve(degree, c, left.data(), right.data());
    const double s = 0.5 * (s0 + s1);
    if (dot(c[0], c[0]) <= dot(c[degree], c[degree])) {
      descend(left.data(), s0, s, depth + 1);
      descend(right.data(), s, s1, depth + 1);
    } else {
      descend(right.data(), s, s1, depth + 1);
      descend(left.data(), s0, s, depth + 1);
    }
  }
};

}  // namespace

FootPoint foot_point(std::span<const Vec2> curve, const Vec2& p) {
  geometry_kernel::checked_degree(curve);
  if (!std::isfinite(p.x()) || !std::isfinite(p.y())) throw InputError("the point is not finite");
  const int d = static_cast<int>(curve.size()) - 1;
  NearestSearch search{d, curve.data(), p, std::numeric_limits<double>::infinity(), 0.0};
  search.offer(0.0);
  search.offer(1.0);
  if (d > 0) {
    std::array<Vec2, max_curve_points> shifted;
    for (int i = 0; i <= d; ++i)
      shifted[static_cast<std::size_t>(i)] = curve[static_cast<std::size_t>(i)] - p;
    search.polish(0.0, 1.0);
    search.descend(shifted.data(), 0.0, 1.0, 0);
  }
  const double s = search.best_s;
  const Vec2 point = s == 0.0   ? curve.front()
                     : s == 1.0 ? curve.back()
                                : curve_point(d, curve.data(), s).value;
  return {s, point, std::sqrt(search.best_squared)};
}

}  // namespace bezel
