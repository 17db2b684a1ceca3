#pragma once
// Curved polygons: closed loops of pieces of the sides of two curved triangles.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// A place on the boundary of a triangle: parameter s of a side (bernstein/index.hpp). A corner is
/// the start (s = 0) of the side of its number; edge = -1: not on this boundary.
struct BoundaryPlace {
  int edge = -1;
  double s = 0.0;
  friend bool operator==(const BoundaryPlace&, const BoundaryPlace&) = default;
};

/// A joint of a curved polygon: a corner of a triangle, or a common point of both boundaries.
struct CurvedVertex {
  Vec2 point;
  std::array<BoundaryPlace, 2> place;  ///< on the first and on the second triangle
};

/// A piece of a side of a triangle, from s0 to s1.
struct CurvedEdge {
  int triangle;         ///< 0: the first one, 1: the second
  int edge;             ///< side 0, 1, 2 of it
  double s0, s1;        ///< in [0, 1]; s0 > s1: run backwards (only in a `difference`)
  std::int32_t vertex;  ///< index of the joint where it begins
};

/// A closed loop of curved edges, each joint stored once. Edge i ends where edge i + 1 begins, the
/// last where the first begins.
class CurvedPolygon {
 public:
  CurvedPolygon() = default;
  /// @param vertices  the joints, finite; edge i begins at vertices[edges[i].vertex]
  /// @param control   control points of all edges one after the other, finite; the first and last
  ///                  of an edge equal its joints bit for bit
  /// @param first     where each edge's control points begin, and the total: edges + 1 numbers
  /// @throws   InputError when sizes disagree, an index does not exist, a value is not finite, an
  ///           edge's degree is not 1 to 60, or an edge does not begin and end at its joints
  CurvedPolygon(std::vector<CurvedVertex> vertices, std::vector<CurvedEdge> edges,
                std::vector<Vec2> control, std::vector<std::size_t> first);

  std::span<const CurvedVertex> vertices() const { return vertices_; }
  std::span<const CurvedEdge> edges() const { return edges_; }
  std::size_t size() const { return edges_.size(); }  ///< number of edges
  /// Control points of edge i, in its direction; 0 <= i < size(), not checked.
  std::span<const Vec2> control(std::size_t i) const {
    return std::span<const Vec2>(control_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  Box2 box() const;  ///< of the control points: contains the polygon

 private:
  friend class CurvedPolygonBuilder;
  std::vector<CurvedVertex> vertices_;
  std::vector<CurvedEdge> edges_;
  std::vector<Vec2> control_;
  std::vector<std::size_t> first_;
};

// ---- Measures, by Green's theorem along the edges. The polygon as stored, control points taken as
// ---- exact; they throw InputError when it has no edges.

/// Area, positive for counter-clockwise loops.
///
/// @accuracy within 2 u r^2 D (N + 12), D and N the sums of d and of d (d + 1) over the edges'
/// degrees
///           d, r the largest distance of a control point from the first joint in a coordinate;
///           0.006 of it seen
/// @cost     2 d^2 products per edge; no allocation
double area(const CurvedPolygon& polygon);

/// Centre of mass of what the loop encloses.
///
/// @throws   InputError when the area is zero to rounding
Vec2 centroid(const CurvedPolygon& polygon);

/// Integral of x^a y^b over what the loop encloses, by Gauss rules of sufficient degree.
///
/// @param a, b  >= 0, with (a + b + 2) times the largest degree <= 400
/// @accuracy a few d u times the integral of |x|^a |y|^b over the loop's surroundings; positions
///           are those of the plane, not relative to the polygon: far from the origin terms cancel
double moment(const CurvedPolygon& polygon, int a, int b);

enum class PointInPolygon : std::uint8_t {
  inside,    ///< the loop goes round the point (proven)
  outside,   ///< it does not (proven)
  boundary,  ///< the point is exactly on an edge (proven)
  undecided  ///< on an edge, or too near to one for a proof (see `winding_number`)
};
/// Where a point is, decided exactly for the stored control points.
///
/// @param p     finite
/// @cost        0.1 us per edge away from the boundary; exact arithmetic near it
PointInPolygon contains(const CurvedPolygon& polygon, const Vec2& p);

}  // namespace bezel
