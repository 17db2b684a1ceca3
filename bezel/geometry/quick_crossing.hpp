#pragma once
// The common case of two edges of meshes: they miss each other or cross once, at a fair angle.

#include <cstdint>

#include "bezel/geometry/curve.hpp"

namespace bezel::geometry_kernel {

enum class Meeting : std::uint8_t {
  none,      ///< the curves are further apart than the distance asked for
  crossing,  ///< exactly one common point, simple and inside both curves
  unclear    ///< anything else, or not seen quickly: ask `intersect`
};

struct QuickCrossing {
  double s, t;  ///< parameters, more than 1e-9 inside [0, 1]
  int sign;     ///< of cross(a', b'), the same on both curves: +1 or -1
  double gap;   ///< distance of the two curves' points there, in length units
};

/// Decides quickly how two curves meet.
///
/// @param a, b      from cache_curve
/// @param distance  curves nearer than this must not be called apart
/// @param out       filled in for a crossing only
/// @accuracy s and t within (8 + d) u (1 + condition), d the higher degree; the sine of the angle
/// is
///           above 0.01 on all of both
/// @cost     5 ns when apart, 10 ns for crossing straight edges, 60 ns for crossing quadratics
/// @limits   degrees above 10 are always unclear
/// @source   docs/methods/geometry.md, "Edges that cross once"
Meeting meet_quickly(const CurveCache& a, const CurveCache& b, double distance, QuickCrossing& out);

}  // namespace bezel::geometry_kernel
