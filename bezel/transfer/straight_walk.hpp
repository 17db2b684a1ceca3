#pragma once
// Internal: straight edges on their way through a mesh of straight triangles, many at a time.

#include <array>
#include <cstdint>
#include <span>

#include "bezel/mesh/mesh.hpp"
#include "bezel/numeric/vec.hpp"
#include "bezel/transfer/pile.hpp"
#include "bezel/transfer/straight_elements.hpp"

namespace bezel::detail {

/// Where a target edge leaves a donor element on its way through the donor mesh.
struct WalkStep {
  double r, s;  ///< parameters on the target's and the donor's edge; r is 1 at the last step
  std::int32_t donor;
  std::int32_t donor_edge;  ///< crossed at r; -1 at the target edge's end
  std::int64_t from_right;  ///< 1: the target edge comes from the donor edge's right side, else 0
};

/// The steps of an edge are this far apart.
inline constexpr std::int32_t straight_stride = 32;

/// Contacts nearer than this (in parameter) to edge ends or to other contacts are not plain.
inline constexpr double contact_isolation = 1e-9;

/// A point to be found in a mesh.
struct alignas(32) SoughtPoint {
  Vec2 p;
  std::int32_t vertex;   ///< the caller's
  std::int64_t element;  ///< filled in: the triangle that holds it well inside, or -1
};

/// Finds the triangles that hold points, where that is plain: -1 does not say that there is none.
///
/// Each triangle is left by the side that the point is farthest beyond.
///
/// @param start  a triangle; the answer depends on it only where none is found
/// @return   the triangle of the last point, or one near it
std::int32_t locate_straight(std::span<const StraightElement> elements,
                             std::span<SoughtPoint> points, std::int32_t start);

/// An edge a + r d, r in [0, 1], that begins well inside a triangle.
struct alignas(64) StraightWalk {
  Vec2 a, d;
  std::int32_t record;  ///< the caller's
  std::int32_t place;   ///< 4 times the triangle plus the side that the edge's line leaves it by
  // That side's ends right and left of the line, and where they lie: cross(d, x - a).
  Vec2 right, left;
  double beside_right, beside_left;
  // The way: filled in.
  double gap_squared;  ///< largest distance of the two edges' points at a crossing
  std::int32_t first_step, steps;
  bool ended;  ///< at the edge's end, after crossings that are all plain
};

/// Walks all edges to their ends, or to a crossing that is not plain.
///
/// The last step of a walk is where the line leaves the triangle that holds the edge's end. Which
/// vertices lie left and right of a line tells where it leaves each triangle; everything is decided
/// far above rounding (crossings near the ends of edges, or nearly along them, end the walk), so
/// that the crossings found are all there are.
///
/// @param elements, edges  of the mesh
/// @param steps  the walks' are added, each walk's straight_stride apart
void walk_straight(std::span<const StraightElement> elements,
                   std::span<const std::array<SideEdge, 3>> edges, std::span<StraightWalk> walks,
                   Pile<WalkStep>& steps);

}  // namespace bezel::detail
