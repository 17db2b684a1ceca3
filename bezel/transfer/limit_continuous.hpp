#pragma once
// Internal: continuous fields moved into bounds without changing their mass.

#include <span>
#include <string>

#include "bezel/transfer/limit.hpp"
#include "bezel/transfer/mass_solve.hpp"

namespace bezel::detail {

/// Moves a continuous field into bounds by flux correction.
///
/// The lumped projection b_i / m_i of the same data is an average of the donor's values over the
/// support of basis function i, so it keeps the bounds. With the element matrices M_e and
/// f_ei = m_ei x_i - (M_e x)_i, whose sum over an element vanishes, the projection x is
/// (b_i + sum_e f_ei) / m_i, and (b_i + sum_e alpha_e f_ei) / m_i has the same mass for any alpha.
/// Where the certified range of x leaves the bounds, alpha is reduced on the elements around, just
/// as far as the range asks; where that does not settle, as far as Zalesak's limiter asks, which
/// keeps the coefficients within the bounds.
///
/// @param c       element coefficients whose projection is x
/// @param x       dofs of the projection
/// @param bounds  of the data per element, or for all: each dof keeps those of the elements around
/// @param what    the field, for messages
/// @throws NumericsError when the bounds cannot hold the mass
/// @accuracy within the bounds up to 1e-14 of the largest value
Limited limit_continuous(ContinuousMass& mass, std::span<const double> c, std::span<const double> x,
                         const ValueBounds& bounds, const std::string& what, int threads);

}  // namespace bezel::detail
