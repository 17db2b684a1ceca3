#pragma once
// Exact position of a point relative to one curve: the pieces of an exact search, shared by
// winding numbers and location. Internal.

#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

/// A parameter, or a place between neighbouring doubles (or within 2^-120), where the curve meets a
/// point.
struct Incidence {
  double lo, hi;  ///< lo == hi: exactly there; else strictly between
  bool proven;    ///< false: common roots of both coordinates could not be excluded there
};

struct PointOnCurve {
  std::vector<Incidence> incidences;  ///< ascending; empty: the point is proven off the curve
  /// Crossings of the horizontal ray from p to the right, upwards minus downwards, a point of the
  /// curve at the height of p counting as below it. Meaningful when there are no incidences.
  int ray_crossings = 0;
};

/// curve: 1 to 61 finite control points; p finite; both unchecked.
///
/// Pieces whose coordinates, minus p, keep a sign are done: first in doubles with a bound of their
/// rounding, then exactly, 75 halvings beyond the 45 in doubles at most.
PointOnCurve point_on_curve(std::span<const Vec2> curve, const Vec2& p);

/// Where the derivative of a curve of degree >= 1 vanishes, by the same search.
std::vector<Incidence> vanishing_speed(std::span<const Vec2> curve);

}  // namespace bezel::geometry_kernel
