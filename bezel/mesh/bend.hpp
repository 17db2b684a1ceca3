#pragma once
// Inner control points of a triangle with bent sides.

#include <span>

#include "bezel/numeric/vec.hpp"

namespace bezel::planar {

/// Adds to the inner control points of a triangle what one bent side asks for.
///
/// With the side's displacement s (1-s) eta(s) from its chord, the extension is lambda0 lambda1
/// eta(lambda1 + lambda2 / 2), lambda0 and lambda1 belonging to the side's start and end. Its k-th
/// derivatives are O(h^k) when those of the side are, as isoparametric order needs [lenoir1986];
/// extending by zero inner displacements loses that from degree 3 on.
///
/// @param g        degree, 1..10 (nothing to do below 3)
/// @param side     0, 1, 2 (bernstein/index.hpp)
/// @param bend     the side's g - 1 displacements in Bernstein form, in the side's direction
/// @param control  triangle_size(g) points; the inner ones change
void extend_bend(int g, int side, std::span<const Vec2> bend, std::span<Vec2> control);

}  // namespace bezel::planar
