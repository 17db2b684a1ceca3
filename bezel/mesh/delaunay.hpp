#pragma once
// Delaunay triangulation of points in the plane.

#include <array>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// The Delaunay triangulation of the convex hull of the points.
///
/// @param points  at least 3, finite, not all on one line
/// @return   counter-clockwise corners (positions in `points`); every triangle has a positive area
///           in double precision (scaled, so that it neither over- nor underflows). A point that
///           repeats another one is in no triangle. Where four or more points lie on one circle,
///           one of the triangulations
/// @throws   InputError for fewer than 3 points, a coordinate that is not finite, or points on one
///           line; NumericsError when Qhull gives up
/// @cost     O(n log n) expected; measured 0.30 s for 5e4 random points
/// @limits   floating point: of nearly cocircular points, either diagonal may be chosen
/// @source   [barber1996] (Qhull)
std::vector<std::array<int, 3>> delaunay(std::span<const Vec2> points);

}  // namespace bezel
