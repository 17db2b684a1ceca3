#pragma once
// Internal to io: the order of the nodes of high-order triangles and lines in MSH and VTU files.

#include <vector>

namespace bezel::files {

/// Flat positions (bernstein/index.hpp) of a triangle's nodes in file order, degree >= 1: corners
/// 0, 1, 2; the inner nodes of sides 0, 1, 2 in their direction; then the interior as a triangle of
/// degree - 3 by the same rule. Gmsh 4 and VTK 9 share it, for Lagrange and Bezier cells alike.
std::vector<int> triangle_order(int degree);

/// Positions 0..degree of a line's nodes in file order: both ends, then the inner nodes.
std::vector<int> line_order(int degree);

}  // namespace bezel::files
