#pragma once
// Internal: what lies outside one mesh is given to, and what was made is taken from, elements at
// the target's boundary, so that the whole mass is kept.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/transfer/overlay_mesh.hpp"

namespace bezel::detail {

/// Mass that elements have too little (or too much), all components of one element together.
struct ElementMasses {
  std::size_t components = 0;
  std::vector<std::int32_t> element;
  std::vector<double> mass;  ///< shape (element.size(), components)

  void add(std::int32_t e, std::span<const double> values) {
    element.push_back(e);
    mass.insert(mass.end(), values.begin(), values.end());
  }
};

/// Mass to add to target elements, each once, ascending.
///
/// What an element made is taken from it again. What a donor element has outside goes to the target
/// elements with a side on the target's boundary whose boxes overlap the donor's, in proportion to
/// their areas; where there is none, to all elements with a side on the boundary.
///
/// @param outside  donor elements and their masses over what no target element covers
/// @param made     target elements and their masses over what no donor element covers
/// @return   masses that add up to the sum of `outside` minus the sum of `made`, to rounding
/// @cost     a tree over the target's boundary elements, a query per donor element in `outside`
ElementMasses spread(const OverlayMesh& donor, const OverlayMesh& target,
                     const ElementMasses& outside, const ElementMasses& made);

}  // namespace bezel::detail
