#pragma once
// What the geometry property tests share: an independent evaluation, random control points,
// printing.

#include <sstream>
#include <string>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/geometry/curve.hpp"

namespace geometry_test {

using bezel::Vec2;
using Points = std::vector<Vec2>;

inline Vec2 evaluate(Points c, double s) {
  for (std::size_t d = c.size() - 1; d > 0; --d)
    for (std::size_t i = 0; i < d; ++i) c[i] = (1 - s) * c[i] + s * c[i + 1];
  return c[0];
}

/// Uniform in the unit square, rounded to `bits` bits.
inline Points random_points(bezel::RandomStream& random, int degree, int bits = 53) {
  Points points;
  const double unit = static_cast<double>(1ull << bits);
  for (int i = 0; i <= degree; ++i) {
    const double x = random.uniform(), y = random.uniform();
    points.push_back(Vec2{{static_cast<double>(static_cast<long long>(x * unit)) / unit,
                           static_cast<double>(static_cast<long long>(y * unit)) / unit}});
  }
  return points;
}

/// By de Casteljau extrapolation: the control points of c on [s0, s1].
inline Points part(const Points& c, double s0, double s1) {
  const std::size_t n = c.size();
  Points result;
  for (std::size_t k = 0; k < n; ++k) {  // blossom with k arguments s1, the others s0
    Points q = c;
    for (std::size_t d = n - 1; d > 0; --d) {
      const double s = d <= k ? s1 : s0;
      for (std::size_t i = 0; i < d; ++i) q[i] = (1 - s) * q[i] + s * q[i + 1];
    }
    result.push_back(q[0]);
  }
  return result;
}
inline std::string show(const Points& a, const Points& b, const bezel::CurveIntersections& found) {
  std::ostringstream text;
  text << std::hexfloat;
  for (const Points* c : {&a, &b}) {
    text << "\n  curve";
    for (const Vec2& p : *c) text << " (" << p.x() << ", " << p.y() << ")";
  }
  text << std::defaultfloat;
  text.precision(17);
  for (const auto& c : found.crossings)
    text << "\n  crossing " << c.s << " " << c.t << " sign " << c.sign << " condition "
         << c.condition;
  for (const auto& c : found.tangencies) text << "\n  tangency " << c.s << " " << c.t;
  for (const auto& c : found.overlaps)
    text << "\n  overlap " << c.s0 << " " << c.s1 << " | " << c.t0 << " " << c.t1 << " gap "
         << c.gap;
  for (const auto& c : found.unresolved)
    text << "\n  unresolved " << c.s_lo << " " << c.s_hi << " | " << c.t_lo << " " << c.t_hi << " "
         << c.reason;
  return text.str() + "\n";
}

}  // namespace geometry_test
