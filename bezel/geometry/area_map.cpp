#include "bezel/geometry/area_map.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/numeric/double_double.hpp"
#include "bezel/numeric/eft.hpp"

namespace bezel {
namespace {

/// v - slope u for u and v with their errors.
double sheared(const WithError& u, const WithError& v, double slope) {
  const WithError product = two_prod(slope, u.value);
  const WithError sum = two_sum(v.value, -product.value);
  return sum.value + (sum.error + ((v.error - product.error) - slope * u.error));
}

}  // namespace

Vec2 AreaMap::operator()(const Vec2& p) const {
  if (identity) return p;
  WithError u = two_sum(p.x(), -centre.x()), v = two_sum(p.y(), -centre.y());
  if (turned) {
    std::swap(u, v);
    v = {-v.value, -v.error};
  }
  return {u.value / stretch, sheared(u, v, slope) * stretch};
}

Vec2 AreaMap::gradient(const Vec2& g) const {
  if (identity) return g;
  const double along_u = turned ? g.y() : g.x(), along_v = turned ? -g.x() : g.y();
  return {sheared({along_v, 0.0}, {along_u, 0.0}, -slope) * stretch, along_v / stretch};
}

double AreaMap::rounding(double largest_coordinate) const {
  return identity ? 0.0 : 0x1p-53 * (1.0 + std::abs(slope)) * largest_coordinate * stretch;
}

AreaMap round_map(std::span<const Vec2> points) {
  AreaMap map;
  const Vec2& start = points[0];
  Vec2 longest;
  for (const Vec2& p : points) {
    const Vec2 d = p - start;
    if (dot(d, d) > dot(longest, longest)) longest = d;
  }
  const double length_squared = dot(longest, longest);
  double left = 0.0, right = 0.0;
  for (const Vec2& p : points) {
    const double beside = cross(longest, p - start);
    left = std::max(left, beside);
    right = std::min(right, beside);
  }
  if (!(left - right < thin * length_squared)) return map;
  map.identity = false;
  map.centre = start;
  map.turned = std::abs(longest.y()) > std::abs(longest.x());
  map.slope = map.turned ? -longest.x() / longest.y() : longest.y() / longest.x();
  // In these coordinates widths have all their digits.
  double least = 0.0, most = 0.0;
  for (const Vec2& p : points) {
    const double beside = map(p).y();
    least = std::min(least, beside);
    most = std::max(most, beside);
  }
  const double length = std::max(std::abs(longest.x()), std::abs(longest.y()));
  if (!(most > least) || !std::isfinite(length / (most - least))) return {};
  map.stretch = std::ldexp(1.0, std::ilogb(length / (most - least)) / 2);
  return map;
}

RoundControl::RoundControl(std::span<const Vec2> control)
    : map_(round_map(control)), points_(control) {
  if (map_.identity) return;
  room_.resize(control.size());
  std::transform(control.begin(), control.end(), room_.begin(), map_);
  points_ = room_;
}

double triangle_cross(const Vec2& a, const Vec2& b, const Vec2& c) {
  const Vec2 p = b - a, q = c - a;
  if (!is_thin(p, q)) return cross(p, q);
  const auto difference = [](double x, double y) {
    const WithError d = two_sum(x, -y);
    return DoubleDouble(d.value, d.error);
  };
  return static_cast<double>(difference(b.x(), a.x()) * difference(c.y(), a.y()) -
                             difference(b.y(), a.y()) * difference(c.x(), a.x()));
}

}  // namespace bezel
