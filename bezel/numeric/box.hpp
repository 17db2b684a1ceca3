#pragma once
// What boxes are made of boxes: apart from vec.hpp, which nearly everything includes.

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// The box moved out by `by` on every side: it overlaps whatever is within that of the box along
/// each axis, but for the rounding of its corners.
///
/// @param box  an empty one stays empty
/// @param by   finite; negative values move the sides in
template <int dim>
constexpr Box<dim> grown(Box<dim> box, double by) {
  for (int i = 0; i < dim; ++i) {
    box.lo[i] -= by;
    box.hi[i] += by;
  }
  return box;
}

}  // namespace bezel
