#pragma once
// The common part of two curved triangles, and what one of them leaves of the other.

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/curved_polygon.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

struct TriangleIntersectOptions {
  /// As in IntersectOptions: sides nearer to each other than this count as coincident, corners as
  /// lying on a side. 0: the given control points are taken as exact.
  double coincidence_distance = 0.0;
  /// Two regions that touch in one point only, where two sides are tangent: one polygon that
  /// touches itself there (false), or two simple polygons with that point as a joint (true).
  bool cut_where_touching = false;
};

enum class TriangleRelation : std::uint8_t {
  disjoint,         ///< no common point (intersect)
  touching,         ///< common boundary points only, no area (intersect)
  overlapping,      ///< both have parts inside and outside the other (intersect)
  first_in_second,  ///< the first is part of the second; their boundaries may touch (intersect)
  second_in_first,  ///< (intersect)
  same,             ///< both have the same boundary (intersect)
  unresolved        ///< could not be decided; `reason` says why (intersect)
};

/// The common part of two triangles: closed regions without holes, which have no common inner
/// points.
struct TriangleIntersections {
  TriangleRelation relation = TriangleRelation::disjoint;
  /// One per region, counter-clockwise, simple but for touching itself where two sides are tangent
  /// (see `cut_where_touching`). Empty when disjoint, touching or unresolved; the
  /// inner triangle's boundary (the first's when the same) in the cases of containment.
  std::vector<CurvedPolygon> polygons;
  std::string reason;  ///< unresolved: why
  Box2 box;            ///< unresolved: where, in the plane
};

/// What one triangle leaves of the other.
struct TriangleDifference {
  /// Of the two triangles, as `intersect` says.
  TriangleRelation relation = TriangleRelation::disjoint;
  /// Counter-clockwise loops around regions, clockwise ones around holes; empty when nothing
  /// remains or unresolved. Loops may touch each other.
  std::vector<CurvedPolygon> loops;
  std::string reason;  ///< unresolved: why
  Box2 box;            ///< unresolved: where, in the plane
};

/// Every region that two curved triangles have in common.
///
/// Sides are cut where `intersect` for curves finds common points; each part is inside, outside or
/// on the other boundary by the exact sign of a crossing at its end, or by the winding number of
/// one of its points in exact arithmetic; the parts are joined at their common points.
///
/// @param g, h   degrees, 1 to 40
/// @param a, b   control points, triangle_size(g) and triangle_size(h), finite, order
///               bernstein/index.hpp
/// @return   the relation and the regions; each edge knows its triangle, side and interval
/// @throws   InputError for a bad degree, size or value, a negative distance, or a triangle whose
///           Jacobian determinant is negative somewhere (check_validity says inverted)
/// @accuracy relation, number of regions, and which sides bound them: those of the given control
///           points, as far as `intersect` for curves is exact; parameters have its accuracy, and
///           joints are rounded
/// @cost     mostly the curves': 0.3 us when the sides do not meet, 2 us for quadratic triangles
///           that overlap; exact arithmetic where corners lie on sides or sides touch: 20 us or so.
///           No allocation when the boxes of the control points are apart
/// @limits   extents as `intersect` for curves. A positive determinant does not exclude maps that
///           overlap themselves; for such triangles the result is meaningless. Triangles whose
///           validity check_validity cannot decide are unresolved. The touching point of two sides
///           that lies within 2^-24 of another common point may stay unresolved
/// @source   [hermes2018, ch. 3] for the problem and the rules of joining
TriangleIntersections intersect(int g, std::span<const Vec2> a, int h, std::span<const Vec2> b,
                                const TriangleIntersectOptions& options = {});

/// The first triangle without the second: the same parts, joined the other way. With `intersect`,
/// area(A and B) + area(A without B) = area(A) to rounding.
TriangleDifference difference(int g, std::span<const Vec2> a, int h, std::span<const Vec2> b,
                              const TriangleIntersectOptions& options = {});

/// `intersect` for those who ask many times: storage is kept from one call to the next.
class TriangleIntersector {
 public:
  explicit TriangleIntersector(const TriangleIntersectOptions& options = {});
  ~TriangleIntersector();
  TriangleIntersector(TriangleIntersector&&) noexcept;
  TriangleIntersector& operator=(TriangleIntersector&&) noexcept;
  /// As the function of this name; `out` is overwritten and its storage reused. Not for several
  /// threads at once. After an exception `out` is valid and may hold anything.
  void intersect(int g, std::span<const Vec2> a, int h, std::span<const Vec2> b,
                 TriangleIntersections& out);

 private:
  struct Work;
  TriangleIntersectOptions options_;
  std::unique_ptr<Work> work_;
};

}  // namespace bezel
