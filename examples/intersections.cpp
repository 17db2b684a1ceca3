// What two curves have in common, where a curve meets itself, and the common part of two curved
// triangles.
#include <cstdio>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/self_intersection.hpp"
#include "bezel/geometry/triangle_intersection.hpp"

namespace {

using bezel::Vec2;

void print(const bezel::CurveIntersections& found) {
  for (const bezel::Crossing& c : found.crossings)
    std::printf("crossing    s = %.6f  t = %.6f  %s\n", c.s, c.t,
                c.certified ? "certified" : "not certified");
  for (const bezel::Tangency& t : found.tangencies)
    std::printf("tangency    s = %.6f  t = %.6f\n", t.s, t.t);
  for (const bezel::Overlap& o : found.overlaps)
    std::printf("overlap     s = %.6f to %.6f  t = %.6f to %.6f\n", o.s0, o.s1, o.t0, o.t1);
  for (const bezel::UnresolvedBox& u : found.unresolved)
    std::printf("unresolved  s in [%g, %g]: %s\n", u.s_lo, u.s_hi, u.reason.c_str());
}

}  // namespace

int main() {
  // Two cubics, mirror images of each other: nine crossings.
  const std::vector<Vec2> a{Vec2{{-3, -3}}, Vec2{{-1, 15}}, Vec2{{1, -15}}, Vec2{{3, 3}}};
  const std::vector<Vec2> b{Vec2{{-3, -3}}, Vec2{{15, -1}}, Vec2{{-15, 1}}, Vec2{{3, 3}}};
  std::puts("two cubics");
  print(bezel::intersect(a, b));

  // A curve and its reversal.
  const std::vector<Vec2> reversed(a.rbegin(), a.rend());
  std::puts("a cubic and its reversal");
  print(bezel::intersect(a, reversed));

  const std::vector<Vec2> loop{Vec2{{0, 0}}, Vec2{{2, 1}}, Vec2{{-1, 1}}, Vec2{{1, 0}}};
  std::puts("a loop");
  print(bezel::self_intersections(loop).pairs);

  // Control points in rows from the bottom edge: 200 110 020, 101 011, 002.
  const std::vector<Vec2> triangle{Vec2{{0, 0}},      Vec2{{1.5, 1.25}}, Vec2{{3, 0}},
                                   Vec2{{0.5, 1.25}}, Vec2{{2, 1.5}},    Vec2{{1, 2.5}}};
  const std::vector<Vec2> straight{Vec2{{0, 0.25}}, Vec2{{3, 0.25}}, Vec2{{3, 1.5}}};
  std::puts("a quadratic and a straight triangle");
  const bezel::TriangleIntersections common = bezel::intersect(2, triangle, 1, straight);
  for (const bezel::CurvedPolygon& polygon : common.polygons) {
    std::printf("polygon of area %.6f\n", bezel::area(polygon));
    for (const bezel::CurvedEdge& edge : polygon.edges())
      std::printf("  triangle %d, side %d, s = %.6f to %.6f\n", edge.triangle, edge.edge, edge.s0,
                  edge.s1);
  }
}
