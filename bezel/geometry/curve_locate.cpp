#include "bezel/geometry/curve_locate.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/geometry/curve_check.hpp"
#include "bezel/geometry/curve_incidence.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using geometry_kernel::max_curve_points;
using geometry_kernel::PointBuffer;
using short_names::infinity;
using short_names::u;

constexpr double tiny = 0x1p-1050;  // covers underflow
constexpr int deepest = 45, most_pieces = 20000;

/// Halves the curve minus p, scaled by a power of two, and compares hulls with the tolerance.
class DistanceSearch {
 public:
  DistanceSearch(std::span<const Vec2> curve, const Vec2& p)
      : d_(static_cast<int>(curve.size()) - 1) {
    double magnitude = std::max(std::fabs(p.x()), std::fabs(p.y()));
    for (const Vec2& b : curve)
      magnitude = std::max({magnitude, std::fabs(b.x()), std::fabs(b.y())});
    exponent_ = magnitude > 0.0 ? std::ilogb(magnitude) + 1 : 0;
    Vec2* c = control_.data();
    for (int i = 0; i <= d_; ++i) {
      for (int axis = 0; axis < 2; ++axis)
        c[i][axis] = std::ldexp(curve[static_cast<std::size_t>(i)][axis], -exponent_) -
                     std::ldexp(p[axis], -exponent_);
      largest_ = std::max({largest_, std::fabs(c[i].x()), std::fabs(c[i].y())});
    }
  }

  double scaled(double distance) const { return std::ldexp(distance, -exponent_); }
  double unscaled(double distance) const { return std::ldexp(distance, exponent_); }

  /// The parameter of a near point: of the nearest as a rule, and within 4/3 of its distance when
  /// 2000 pieces suffice.
  double foot() {
    pieces_ = 0;
    near_ = {0.0, distance_bound(0.0)};
    offer(1.0);
    approach(control_.data(), 0.0, 1.0, 0);
    // Newton's method on (c - p) . c', its second term left out: it only needs to improve.
    for (int i = 0; i < 12; ++i) {
      const auto c = geometry_kernel::curve_point(d_, control_.data(), near_.s);
      const double slope = dot(c.derivative, c.derivative);
      const double before = near_.distance;
      if (slope > 0.0) offer(std::clamp(near_.s - dot(c.value, c.derivative) / slope, 0.0, 1.0));
      if (!(near_.distance < before)) break;
    }
    return near_.s;
  }
  /// The distance at s, rounded up: de Casteljau's error is 3 d u largest in each coordinate.
  double distance_bound(double s) {
    const Vec2 q = geometry_kernel::curve_point(d_, control_.data(), s).value;
    return std::hypot(q.x(), q.y()) * (1.0 + 4.0 * u) +
           1.5 * ((3.0 * d_ + 2.0) * u * largest_ + tiny);
  }

  struct Found {
    std::vector<CurveContact> contacts;  // distances scaled
    double lower = infinity;             // of the distance of everything else
  };

  /// Finds where the distance may be at most `within`; pieces further away than `threshold` >=
  /// within are dropped. `smallest`: size of a piece that is not halved further.
  Found run(double within, double threshold, double smallest) {
    within_ = within;
    threshold_ = threshold;
    smallest_ = smallest;
    pieces_ = 0;
    found_ = {};
    search(control_.data(), 0.0, 1.0, 0);
    return std::move(found_);
  }

 private:
  void search(const Vec2* c, double lo, double hi, int level) {
    ++pieces_;
    // Each coordinate is off by `error` at most: one rounding of the difference, d for each
    // halving.
    const double error = (2.0 + d_ * level) * u * largest_ + tiny;
    const double lower = lower_bound(c, error);
    if (lower > threshold_) {
      found_.lower = std::min(found_.lower, lower);
      return;
    }
    double furthest = 0.0, size = 0.0;
    for (int i = 0; i <= d_; ++i) {
      furthest = std::max(furthest, std::hypot(c[i].x(), c[i].y()));
      size = std::max({size, std::fabs(c[i].x() - c[0].x()), std::fabs(c[i].y() - c[0].y())});
    }
    const bool inside = upwards(furthest, error) <= within_;
    if (!inside && size > std::max(smallest_, 8.0 * error) && level < deepest &&
        pieces_ < most_pieces) {
      PointBuffer<max_curve_points> left, right;
      geometry_kernel::halve(d_, c, left.data(), right.data());
      const double mid = 0.5 * (lo + hi);
      search(left.data(), lo, mid, level + 1);
      search(right.data(), mid, hi, level + 1);
      return;
    }
    if (!inside && lower > within_) {
      found_.lower = std::min(found_.lower, lower);
      return;
    }
    if (found_.contacts.empty() || found_.contacts.back().hi != lo)
      found_.contacts.push_back({lo, lo, lo, infinity, false});
    CurveContact& contact = found_.contacts.back();
    contact.hi = hi;
    for (const int end : {0, d_}) {
      const double distance = upwards(std::hypot(c[end].x(), c[end].y()), error);
      if (distance < contact.distance_bound) {
        contact.distance_bound = distance;
        contact.s = end == 0 ? lo : hi;
      }
    }
  }

  void offer(double s) {
    const double distance = distance_bound(s);
    if (distance < near_.distance) near_ = {s, distance};
  }

  void approach(const Vec2* c, double lo, double hi, int level) {
    const double error = (2.0 + d_ * level) * u * largest_ + tiny;
    if (++pieces_ > 2000 || level > deepest || lower_bound(c, error) >= 0.75 * near_.distance)
      return;
    const double mid = 0.5 * (lo + hi);
    offer(mid);
    PointBuffer<max_curve_points> left, right;
    geometry_kernel::halve(d_, c, left.data(), right.data());
    const bool left_first = std::hypot(c[0].x(), c[0].y()) <= std::hypot(c[d_].x(), c[d_].y());
    if (left_first) approach(left.data(), lo, mid, level + 1);
    approach(right.data(), mid, hi, level + 1);
    if (!left_first) approach(left.data(), lo, mid, level + 1);
  }

  static double upwards(double distance, double error) {
    return distance * (1.0 + 4.0 * u) + 1.5 * error;
  }

  /// Of the distance from the origin to the control points' hull: their box, and their projection
  /// on the direction to the chord's middle, which is accurate to second order in the size.
  double lower_bound(const Vec2* c, double error) const {
    const Box2 box = geometry_kernel::control_box(d_, c);
    const double dx = std::max({0.0, box.lo.x(), -box.hi.x()}),
                 dy = std::max({0.0, box.lo.y(), -box.hi.y()});
    double lower = std::hypot(dx, dy) * (1.0 - 4.0 * u);
    const Vec2 middle = c[0] + c[d_];
    const double length = std::hypot(middle.x(), middle.y());
    if (length > 0x1p-900) {
      const Vec2 n{{middle.x() / length, middle.y() / length}};  // within 4 u of a unit vector
      double nearest = infinity;
      for (int i = 0; i <= d_; ++i) nearest = std::min(nearest, dot(c[i], n));
      lower = std::max(lower, nearest - 12.0 * u * largest_);
    }
    return lower - 1.5 * error;
  }

  int d_, exponent_ = 0;
  PointBuffer<max_curve_points> control_;
  double largest_ = 0.0;
  double within_ = 0.0, threshold_ = 0.0, smallest_ = 0.0;
  int pieces_ = 0;
  struct Near {
    double s, distance;
  } near_{};
  Found found_;
};

CurveLocateResult locate_exactly(std::span<const Vec2> curve, const Vec2& p) {
  CurveLocateResult out{CurveLocation::off, {}, 0.0};
  if (std::all_of(curve.begin(), curve.end(), [&](const Vec2& b) { return b == p; }))
    return {CurveLocation::on, {{0.0, 0.0, 1.0, 0.0, true}}, 0.0};
  DistanceSearch search(curve, p);
  for (const auto& incidence : geometry_kernel::point_on_curve(curve, p).incidences) {
    const double bound =
        incidence.proven ? 0.0 : search.unscaled(search.distance_bound(incidence.lo));
    out.contacts.push_back({incidence.lo, incidence.lo, incidence.hi, bound, incidence.proven});
    if (incidence.proven) out.status = CurveLocation::on;
    if (!incidence.proven && out.status == CurveLocation::off)
      out.status = CurveLocation::undecided;
  }
  if (out.status != CurveLocation::off) return out;
  const double half = 0.5 * search.distance_bound(search.foot());
  const auto found = search.run(0.0, half, 0.0);
  if (found.contacts.empty())
    out.distance_lower_bound = std::max(0.0, search.unscaled(found.lower));
  return out;
}

}  // namespace

CurveLocateResult locate(std::span<const Vec2> curve, const Vec2& p, double tolerance) {
  geometry_kernel::checked_degree(curve);
  geometry_kernel::check_point(p);
  if (!(tolerance >= 0.0) || std::isinf(tolerance))
    throw InputError("tolerance " + std::to_string(tolerance) +
                     ", expected a finite distance of at least 0");
  if (tolerance == 0.0) return locate_exactly(curve, p);

  DistanceSearch search(curve, p);
  const double within = search.scaled(tolerance);
  const double foot = search.foot(), nearest = search.distance_bound(foot);
  // Off: down to rounding, and not nearer than half the distance. On: the ends of the intervals to
  // a part of the tolerance.
  auto found = nearest > within ? search.run(within, std::max(within, 0.5 * nearest), 0.0)
                                : search.run(within, within, within / 64.0);
  CurveLocateResult out{CurveLocation::off, {}, 0.0};
  for (CurveContact& contact : found.contacts) {
    if (foot >= contact.lo && foot <= contact.hi && nearest < contact.distance_bound) {
      contact.distance_bound = nearest;
      contact.s = foot;
    }
    contact.proven = contact.distance_bound <= within;
    contact.distance_bound = search.unscaled(contact.distance_bound);
    if (contact.proven) out.status = CurveLocation::on;
    if (!contact.proven && out.status == CurveLocation::off) out.status = CurveLocation::undecided;
  }
  if (out.status == CurveLocation::off) out.distance_lower_bound = search.unscaled(found.lower);
  out.contacts = std::move(found.contacts);
  return out;
}

}  // namespace bezel
