#pragma once
// Control points of a curved mesh moved as an elastic body.

#include <span>
#include <vector>

#include "bezel/mesh/mesh.hpp"

namespace bezel::fit {

/// Moves control points so that those of `fixed` take the places `target` and the others follow.
///
/// The body is the lattice of control points, cut into g^2 small triangles per element: linear
/// elasticity with Poisson's ratio 1/4 and a stiffness inverse to a triangle's area, solved by
/// conjugate gradients. The boundary moves in `steps` equal steps, each from the lattice the one
/// before left.
///
/// @param g         degree
/// @param elements  connectivity, triangle_size(g) nodes per element
/// @param control   start: places of a mesh of positive small triangles; all points
/// @param fixed     per point
/// @param target    per point; read where fixed
/// @return   all points; the fixed ones are their targets bit for bit
/// @cost     at most 2000 iterations per step, linear in the number of points each
std::vector<Vec2> relax_lattice(int g, std::span<const NodeId> elements, std::vector<Vec2> control,
                                const std::vector<char>& fixed, std::span<const Vec2> target,
                                int steps);

}  // namespace bezel::fit
