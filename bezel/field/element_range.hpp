#pragma once
// The range of a field on one element.

#include "bezel/field/field.hpp"

namespace bezel {

/// Certified range of one component on one element: contains every value there.
///
/// @param tol  at least 0: each end lies within tol of the true one, or the search has ended (20000
///             splits; 2^-12 of the element where d g > 40 in a physical basis)
/// @throws InputError when the element or component does not exist or tol is negative or NaN
/// @cost   a physical basis is composed with the element's map first: O((d g)^4)
bernstein::Range element_range(const Field& field, ElementId e, int component, double tol);

}  // namespace bezel
