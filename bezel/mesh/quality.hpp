#pragma once
// How well shaped the elements of a mesh are.

#include "bezel/mesh/mesh.hpp"

namespace bezel {

/// Extremes over the elements and edges of a mesh; all zero for a mesh without elements.
struct MeshQuality {
  double min_angle = 0, max_angle = 0;  ///< between corners, in degrees; negative when clockwise
  ElementId min_angle_element;          ///< the first with the smallest angle
  double min_edge = 0, mean_edge = 0, max_edge = 0;  ///< corner to corner, length units
  /// Smallest over the elements of (smallest / largest) Bernstein coefficient of the Jacobian
  /// determinant: at most min det / max det, 1 for straight elements; <= 0 does not prove an
  /// element invalid (check_validity decides).
  double min_jacobian_ratio = 0;
  ElementId min_jacobian_element;  ///< the first with the smallest ratio
};

/// @cost one determinant polynomial of degree 2(g-1) per element
MeshQuality mesh_quality(const TriangleMesh& mesh);

}  // namespace bezel
