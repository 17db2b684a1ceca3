#pragma once
// Signs of determinants of points in the plane, always right.

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// Sign of cross(a - c, b - c): +1 when a, b, c turn counter-clockwise, 0 when they are on one
/// line.
///
/// @param a, b, c  finite, of size about 1 (below 1e70, and differences zero or above 1e-130, so
///                 that no product over- or underflows)
/// @return   the sign of the exact value for the given doubles
/// @cost     7 flops when the sign is clear; exact expansions otherwise
/// @source   [shewchuk1997, sec. 4.1] for the filter bound (3 + 16 u) u
int orientation(const Vec2& a, const Vec2& b, const Vec2& c);

/// +1 when d lies inside the circle through a, b, c (counter-clockwise), -1 outside, 0 on it.
///
/// @param a, b, c, d  as for orientation(), differences zero or above 1e-65
/// @return   the sign of the exact value for the given doubles; opposite when a, b, c turn
/// clockwise
/// @cost     30 flops when the sign is clear; exact expansions otherwise: measured 1 microsecond
///           when the differences are exact
/// @source   [shewchuk1997, sec. 4.3] for the filter bound (10 + 96 u) u
int in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d);

}  // namespace bezel
