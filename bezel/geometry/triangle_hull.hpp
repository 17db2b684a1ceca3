#pragma once
// What `locate` computes of a triangle: lines that may separate a point from its control points,
// and the triangle of its corners.

#include <algorithm>
#include <cmath>

#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/geometry/triangle_kernel.hpp"

namespace bezel::geometry_kernel {

/// A line along one side's chord, and where the control points are beside it.
struct SideRange {
  Vec2 from, chord;
  double lo, hi;  ///< of cross(chord, c - from) over the control points
  double length;  ///< |chord.x| + |chord.y|
};
inline SideRange side_range(int g, const Vec2* b, int side) {
  SideRange r{};
  r.from = b[bernstein::triangle_corner(g, side)];
  r.chord = b[bernstein::triangle_corner(g, (side + 1) % 3)] - r.from;
  r.length = std::fabs(r.chord.x()) + std::fabs(r.chord.y());
  const int n = bernstein::triangle_size(g);
  for (int i = 0; i < n; ++i) {
    const double c = cross(r.chord, b[i] - r.from);
    r.lo = std::min(r.lo, c);
    r.hi = std::max(r.hi, c);
  }
  return r;
}

/// How far beyond the hull a point must be to count as separated: what lambda within the tolerance
/// can reach, and rounding.
struct HullMargin {
  double extent;  ///< of the control points around the first one
  double fixed;   ///< for the tolerance
  double far_at;  ///< coordinates of the point of this size and more do not count
  /// A barycentric may be negative by `tolerance`: the map moves by at most g * 2 tolerance times
  /// the control net's extent there.
  HullMargin(int g, const Vec2* b, double tolerance) : extent(0) {
    const int n = bernstein::triangle_size(g);
    for (int i = 0; i < n; ++i)
      extent = std::max({extent, std::fabs(b[i].x() - b[0].x()), std::fabs(b[i].y() - b[0].y())});
    fixed = 4.0 * g * tolerance * extent;
    far_at = 4 * extent;
  }
  double operator()(const Vec2& p) const {
    const double far = std::max(std::fabs(p.x()), std::fabs(p.y()));
    return fixed + 0x1p-50 * (extent + (far < far_at ? far : 0.0));
  }
};

/// The triangle of the corners.
struct CornerFrame {
  Vec2 origin, du, dv;
  double det;
  CornerFrame(int g, const Vec2* b)
      : origin(b[0]),
        du(b[g] - origin),
        dv(b[bernstein::triangle_size(g) - 1] - origin),
        det(cross(du, dv)) {}
};

struct TriangleNet {
  int degree;
  const Vec2* control;
};

/// All of it, for many points.
struct LocateSetup {
  Box2 box;
  SideRange side[3];
  HullMargin margin;
  CornerFrame corners;
  double tolerance;
  LocateSetup(const TriangleNet& t, double barycentric_tolerance)
      : box(control_box(bernstein::triangle_size(t.degree) - 1, t.control)),
        side{side_range(t.degree, t.control, 0), side_range(t.degree, t.control, 1),
             side_range(t.degree, t.control, 2)},
        margin(t.degree, t.control, barycentric_tolerance),
        corners(t.degree, t.control),
        tolerance(barycentric_tolerance) {}
};

}  // namespace bezel::geometry_kernel
