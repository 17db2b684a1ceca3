#pragma once
// Internal: a donor field's values along the boundary of the target, for continuous targets that
// keep them.

#include <vector>

#include "bezel/transfer/group.hpp"
#include "bezel/transfer/transfer.hpp"

namespace bezel::detail {

struct BoundaryValues {
  std::vector<char> fixed;     ///< per dof of the continuous space: is it on the boundary
  std::vector<double> values;  ///< shape (dofs, components): their values, 0 elsewhere
};

/// The interpolant of the donor's fields at the equally spaced nodes of the target's boundary
/// edges.
///
/// A node in several donor elements takes the value of the one with the smallest number; a node
/// outside the donor mesh that of the nearest element's polynomial, or 0 with Uncovered::zero.
BoundaryValues boundary_values(const Group& g, const OverlayMesh& donor, const OverlayMesh& target,
                               const FrontSearch& search, Uncovered policy, int threads);

}  // namespace bezel::detail
