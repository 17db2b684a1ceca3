#pragma once
// Internal: meshes and spaces compared by value.

#include "bezel/field/space.hpp"

namespace bezel::detail {

/// Degree, connectivity and control points are the same, bit for bit (tags may differ).
bool same_mesh(const TriangleMesh& a, const TriangleMesh& b);
/// The same mesh, basis, degrees and frames: coefficients of one mean the same on the other.
bool same_layout(const Space& a, const Space& b);

}  // namespace bezel::detail
