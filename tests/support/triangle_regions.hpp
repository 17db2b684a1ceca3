#pragma once
// What must hold for the common part of two triangles, whatever they are; and triangles to try.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/geometry/triangle_intersection.hpp"

namespace support {

struct CurvedTriangle {
  int degree = 1;
  std::vector<bezel::Vec2> control;
};

inline double area(const CurvedTriangle& t) {
  return bezel::area(t.degree, t.control);
}

inline std::string show(const CurvedTriangle& a, const CurvedTriangle& b,
                        const bezel::TriangleIntersections& found) {
  std::ostringstream text;
  text.precision(17);
  for (const CurvedTriangle* t : {&a, &b}) {
    text << "\n  triangle of degree " << t->degree << ":";
    for (const bezel::Vec2& p : t->control) text << " (" << p.x() << ", " << p.y() << ")";
  }
  text << "\n  relation " << static_cast<int>(found.relation) << " " << found.reason;
  for (const bezel::CurvedPolygon& p : found.polygons) {
    text << "\n  polygon of area " << bezel::area(p);
    for (const auto& e : p.edges()) {
      const bezel::Vec2 v = p.vertices()[static_cast<std::size_t>(e.vertex)].point;
      text << "\n    triangle " << e.triangle << " side " << e.edge << " " << e.s0 << " " << e.s1
           << " from (" << v.x() << ", " << v.y() << ")";
    }
  }
  return text.str() + "\n";
}

/// A triangle around the centre with its control points off the straight positions by up to `bend`
/// of its size; positive determinant.
inline CurvedTriangle random_triangle(bezel::RandomStream& random, int degree, double size,
                                      const bezel::Vec2& centre, double bend) {
  using bezel::Vec2;
  CurvedTriangle t{degree, {}};
  do {
    t.control.clear();
    const double turn = random.uniform(0.0, 6.28);
    Vec2 corner[3];
    for (int k = 0; k < 3; ++k) {
      const double angle = turn + 2.0944 * k + random.uniform(-0.6, 0.6),
                   radius = size * random.uniform(0.5, 1.2);
      corner[k] = centre + Vec2{{radius * std::cos(angle), radius * std::sin(angle)}};
    }
    for (int k = 0; k <= degree; ++k)
      for (int j = 0; j + k <= degree; ++j) {
        const double scale = 1.0 / degree, off = bend * size * scale;
        t.control.push_back(
            scale * (static_cast<double>(degree - j - k) * corner[0] +
                     static_cast<double>(j) * corner[1] + static_cast<double>(k) * corner[2]) +
            Vec2{{off * random.uniform(-1.0, 1.0), off * random.uniform(-1.0, 1.0)}});
      }
  } while (bezel::check_validity(degree, t.control).status != bezel::Validity::valid);
  return t;
}

/// All control points on the lattice of `steps` points a unit: touching and coinciding sides and
/// corners on sides are frequent, and everything is exact.
inline CurvedTriangle lattice_triangle(bezel::RandomStream& random, int degree, int steps) {
  CurvedTriangle t;
  std::vector<double> det;
  do {
    t = random_triangle(random, degree, 0.75,
                        {{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5)}}, 0.6);
    for (bezel::Vec2& p : t.control)
      p = {{std::round(p.x() * steps) / steps, std::round(p.y() * steps) / steps}};
    // Positive coefficients are quickly seen, where a determinant that touches zero takes long.
    det = bezel::jacobian_determinant(degree, t.control);
  } while (*std::min_element(det.begin(), det.end()) <= 0.0);
  return t;
}

/// The same triangle, corner 1 called corner 0.
inline CurvedTriangle renumbered(const CurvedTriangle& t) {
  CurvedTriangle out = t;
  const int g = t.degree;
  for (int k = 0; k <= g; ++k)
    for (int j = 0; j + k <= g; ++j)
      out.control[static_cast<std::size_t>(bezel::bernstein::triangle_index(g, j, k))] =
          t.control[static_cast<std::size_t>(bezel::bernstein::triangle_index(g, g - j - k, j))];
  return out;
}

inline bezel::TriangleIntersections intersect(const CurvedTriangle& a, const CurvedTriangle& b,
                                              const bezel::TriangleIntersectOptions& options = {}) {
  return bezel::intersect(a.degree, a.control, b.degree, b.control, options);
}

inline double total_area(const std::vector<bezel::CurvedPolygon>& polygons) {
  double sum = 0.0;
  for (const bezel::CurvedPolygon& p : polygons) sum += bezel::area(p);
  return sum;
}

struct RegionCheck {
  bool unresolved = false;
  std::string wrong;  ///< empty: everything holds
};

/// Area identities both ways, exchange, renumbering, provenance, orientation, and for `points`
/// random points: in the common part exactly when in both triangles.
inline RegionCheck check_regions(const CurvedTriangle& a, const CurvedTriangle& b,
                                 bezel::RandomStream& random, int points,
                                 const bezel::TriangleIntersectOptions& options = {}) {
  using bezel::TriangleRelation;
  using bezel::Vec2;
  RegionCheck out;
  const auto found = intersect(a, b, options), exchanged = intersect(b, a, options),
             renamed = intersect(renumbered(a), b, options);
  for (const auto* result : {&found, &exchanged, &renamed})
    out.unresolved = out.unresolved || result->relation == TriangleRelation::unresolved;
  if (out.unresolved) return out;
  const auto wrong = [&](const std::string& what) {
    out.wrong += (out.wrong.empty() ? "" : ", ") + what;
  };
  TriangleRelation mirrored = exchanged.relation;
  if (mirrored == TriangleRelation::first_in_second)
    mirrored = TriangleRelation::second_in_first;
  else if (mirrored == TriangleRelation::second_in_first)
    mirrored = TriangleRelation::first_in_second;
  if (mirrored != found.relation) wrong("another relation after exchange");
  if (renamed.relation != found.relation) wrong("another relation after renumbering");
  if (exchanged.polygons.size() != found.polygons.size()) wrong("other polygons after exchange");
  if (renamed.polygons.size() != found.polygons.size()) wrong("other polygons after renumbering");

  const double size = std::max(area(a), area(b)), tolerance = 1e-12 * size,
               common = total_area(found.polygons);
  if (std::fabs(common - total_area(exchanged.polygons)) > tolerance) wrong("area after exchange");
  if (std::fabs(common - total_area(renamed.polygons)) > tolerance) wrong("area after renumbering");
  const auto rest_a = bezel::difference(a.degree, a.control, b.degree, b.control, options),
             rest_b = bezel::difference(b.degree, b.control, a.degree, a.control, options);
  if (rest_a.relation == TriangleRelation::unresolved ||
      rest_b.relation == TriangleRelation::unresolved) {
    out.unresolved = true;
    return out;
  }
  if (rest_a.relation != found.relation) wrong("the difference has another relation");
  if (std::fabs(common + total_area(rest_a.loops) - area(a)) > tolerance)
    wrong("area of the first");
  if (std::fabs(common + total_area(rest_b.loops) - area(b)) > tolerance)
    wrong("area of the second");

  for (const bezel::CurvedPolygon& p : found.polygons) {
    if (bezel::area(p) < -1e-14 * size) wrong("clockwise polygon");
    for (std::size_t i = 0; i < p.size(); ++i) {
      const auto& e = p.edges()[i];
      if (!(e.s0 < e.s1)) wrong("an edge without length");
      const auto& start = p.vertices()[static_cast<std::size_t>(e.vertex)];
      const auto& end =
          p.vertices()[static_cast<std::size_t>(p.edges()[(i + 1) % p.size()].vertex)];
      const auto place = [&](const bezel::CurvedVertex& v) {
        return v.place[static_cast<std::size_t>(e.triangle)];
      };
      if (place(start) != bezel::BoundaryPlace{e.edge, e.s0}) wrong("provenance of a start");
      const bezel::BoundaryPlace last = e.s1 == 1.0 ? bezel::BoundaryPlace{(e.edge + 1) % 3, 0.0}
                                                    : bezel::BoundaryPlace{e.edge, e.s1};
      if (place(end) != last) wrong("provenance of an end");
    }
  }
  if (points == 0) return out;
  const auto whole_a = intersect(a, a), whole_b = intersect(b, b);
  if (whole_a.relation != TriangleRelation::same || whole_b.relation != TriangleRelation::same) {
    wrong("a triangle is not the same as itself: " + show(a, a, whole_a) + show(b, b, whole_b));
    return out;
  }
  const auto inside = [](const std::vector<bezel::CurvedPolygon>& polygons, const Vec2& p) {
    int turns = 0;  // clockwise loops take away
    for (const bezel::CurvedPolygon& polygon : polygons) {
      const auto place = bezel::contains(polygon, p);
      if (place == bezel::PointInPolygon::boundary || place == bezel::PointInPolygon::undecided)
        return -1;
      if (place == bezel::PointInPolygon::inside) turns += bezel::area(polygon) > 0 ? 1 : -1;
    }
    return turns;
  };
  bezel::Box2 box = whole_a.polygons[0].box();
  box.include(whole_b.polygons[0].box());
  for (int i = 0; i < points; ++i) {
    const Vec2 p{{random.uniform(box.lo.x(), box.hi.x()), random.uniform(box.lo.y(), box.hi.y())}};
    const int in_a = inside(whole_a.polygons, p), in_b = inside(whole_b.polygons, p),
              in_both = inside(found.polygons, p), in_rest = inside(rest_a.loops, p);
    if (in_a < 0 || in_b < 0 || in_both < 0 || in_rest < 0) continue;
    if (in_both != (in_a == 1 && in_b == 1 ? 1 : 0)) wrong("a point of the common part");
    if (in_rest != (in_a == 1 && in_b == 0 ? 1 : 0)) wrong("a point of the difference");
  }
  return out;
}

}  // namespace support
