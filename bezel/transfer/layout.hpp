#pragma once
// Internal: meshes and spaces compared by value.

#include "bezel/field/space.hpp"
#include "bezel/transfer/transfer.hpp"

namespace bezel::detail {

/// Degree, connectivity and control points are the same, bit for bit (tags may differ).
bool same_mesh(const TriangleMesh& a, const TriangleMesh& b);
/// The same mesh, basis, degrees and frames: coefficients of one mean the same on the other.
bool same_layout(const Space& a, const Space& b);

/// Whether each target element's result depends linearly on the donors it meets: no continuity, no
/// bounds, no mass spread.
inline bool is_linear(const TransferOptions& options) {
  return options.continuity == Continuity::discontinuous &&
         options.bounds.kind == Bounds::Kind::none && options.conserve == Conserve::covered;
}

}  // namespace bezel::detail
