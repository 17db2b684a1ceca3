#pragma once
// Internal: from the discontinuous result of a transfer to the continuous one.

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bezel/transfer/group.hpp"
#include "bezel/transfer/limit.hpp"
#include "bezel/transfer/mass_solve.hpp"
#include "bezel/transfer/transfer.hpp"

namespace bezel::detail {

/// What became of one group; one entry per component.
struct ContinuousOutcome {
  std::vector<MassSolve> solve;
  /// Largest over the elements of |mass of the continuous field - mass received|.
  std::vector<double> max_element_change;
  std::vector<Limited> limited;  ///< where bounds are asked for
};

/// Coefficients within bounds from those of the elements and the dofs of the continuous field.
using ContinuousLimit = std::function<Limited(std::size_t component, std::span<const double> c,
                                              std::span<const double> dofs)>;

/// Replaces coefficients of the elements, shape (coefficient_count, components), by those of the
/// continuous field nearest in the inner product of `mass`.
/// @param given  shape (dofs, components): the values of the dofs that `mass` keeps; with any, the
///               total mass changes, without, it stays
ContinuousOutcome make_continuous(ContinuousMass& mass, int components,
                                  std::span<const double> given, std::span<double> coefficients,
                                  const ContinuousLimit& limit = {});

/// Bounds of each target element's values for a component of a group, and what it is called in
/// messages.
struct ComponentBounds {
  ValueBounds values;
  std::string what;
};
using BoundsOf = std::function<ComponentBounds(std::size_t group, std::size_t component)>;

/// Replaces the coefficients of each group by those of the nearest continuous field in L2, and its
/// target space by its continuous_space.
///
/// The continuous space is a part of the discontinuous one, so the projection of the projection is
/// the donor's own L2 projection on the continuous space. A constant closes what the solver left of
/// the total mass, unless boundary values are kept. With bounds the field is then moved into them,
/// see limit_continuous().
std::vector<ContinuousOutcome> make_continuous(std::span<Group> groups, const OverlayMesh& donor,
                                               const OverlayMesh& target, const FrontSearch& search,
                                               const TransferOptions& options,
                                               const MassSystemMaker& make_system,
                                               const BoundsOf& bounds = {});

}  // namespace bezel::detail
