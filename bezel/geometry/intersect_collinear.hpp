#pragma once
// Common parts of two curves that run on one straight line. Internal.

#include <span>

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/exact_curve.hpp"

namespace bezel::geometry_kernel {

/// Whether all control points of both curves lie on one line, exactly; neither is a point.
bool collinear(std::span<const Vec2> a, std::span<const Vec2> b);

/// Overlaps and single common points of such curves. Where one of them turns back the interval
/// ends, and another begins.
///
/// @accuracy  parameters that are not 0 or 1 are roots of polynomials whose coefficients are
/// rounded
///            once
void intersect_collinear(std::span<const Vec2> a, std::span<const Vec2> b, CurveIntersections& out);

}  // namespace bezel::geometry_kernel
