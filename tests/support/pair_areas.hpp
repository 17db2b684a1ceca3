#pragma once
// Areas that two elements share, by methods that have nothing in common with the overlay.

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "bezel/geometry/triangle.hpp"
#include "bezel/geometry/triangle_intersection.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::test {

/// Two straight triangles, counter-clockwise: clipped in rational arithmetic, the area rounded
/// once.
inline double straight_common_area(const std::array<Vec2, 3>& a, const std::array<Vec2, 3>& b) {
  using Point = std::array<mpq_class, 2>;
  const auto exact = [](const Vec2& p) { return Point{mpq_class(p[0]), mpq_class(p[1])}; };
  const auto cross_of = [](const Point& o, const Point& p, const Point& q) -> mpq_class {
    return (p[0] - o[0]) * (q[1] - o[1]) - (p[1] - o[1]) * (q[0] - o[0]);
  };
  std::vector<Point> polygon;
  for (const Vec2& p : a) polygon.push_back(exact(p));
  for (std::size_t k = 0; k < 3 && !polygon.empty(); ++k) {
    const Point from = exact(b[k]);
    const Point to = exact(b[(k + 1) % 3]);
    std::vector<Point> kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point& p = polygon[i];
      const Point& q = polygon[(i + 1) % polygon.size()];
      const mpq_class dp = cross_of(from, to, p);
      const mpq_class dq = cross_of(from, to, q);
      if (sgn(dp) >= 0) kept.push_back(p);
      if (sgn(dp) * sgn(dq) < 0) {
        const mpq_class s = dp / (dp - dq);
        kept.push_back({p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])});
      }
    }
    polygon = std::move(kept);
  }
  mpq_class twice = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i)
    twice += cross_of(polygon[0], polygon[i - 1], polygon[i]);
  return 0.5 * twice.get_d();
}

/// The area two curved triangles share by the exact kernel for two triangles, asked both ways
/// round.
/// @return false when the kernel leaves the pair undecided, or answers two things
inline bool curved_common_area(TriangleIntersector& intersector, int g, std::span<const Vec2> a,
                               int h, std::span<const Vec2> b, double& common) {
  TriangleIntersections found;
  const auto total = [&] {
    double sum = 0.0;
    for (const CurvedPolygon& p : found.polygons) sum += area(p);
    return sum;
  };
  intersector.intersect(g, a, h, b, found);
  if (found.relation == TriangleRelation::unresolved) return false;
  common = total();
  intersector.intersect(h, b, g, a, found);
  if (found.relation == TriangleRelation::unresolved) return false;
  return std::abs(total() - common) <= 1e-13 * std::max(area(g, a), area(h, b));
}

}  // namespace bezel::test
