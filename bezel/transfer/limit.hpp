#pragma once
// Internal: fields moved into bounds without changing their mass.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bezel/field/field.hpp"
#include "bezel/transfer/bounds.hpp"
#include "bezel/transfer/redistribute.hpp"

namespace bezel::detail {

/// Certified ranges are searched to this fraction of the polynomial's size: below it is rounding.
inline constexpr double range_tolerance = 1e-13;
/// Changes below this fraction of the field's largest coefficient are rounding and are not counted.
inline constexpr double counted_change = 1e-12;

/// What messages call it: "field 'u', component 1".
std::string component_name(const Field& field, int component);

/// Says when values out of bounds had nowhere to go.
/// @param what   the field, for the message
/// @param value  before they were moved
/// @throws NumericsError when what is left over is more than rounding
void check_room(const std::string& what, const ValueBounds& bounds, std::span<const double> weight,
                std::span<const double> value, const Redistribution& done);

/// One component's coefficients after limiting, and what it took.
struct Limited {
  std::vector<double> coefficients;  ///< as many as the space has
  BoundsReport report;
  bernstein::Range range;  ///< certified, over the whole field: within the bounds
};

/// Moves a discontinuous field into bounds: means by redistribute(), then each polynomial is scaled
/// towards its mean until its certified range fits.
///
/// The result lies within the bounds in exact arithmetic, as a polynomial everywhere in the
/// element, its coefficients being the doubles returned. A polynomial whose coefficients are within
/// the bounds comes back bit for bit, unless its mean takes up mass from elsewhere.
///
/// @param bounds  per element or for all
/// @param area    of the elements
/// @throws NumericsError when the bounds cannot hold the mass
/// @accuracy the factor is within 1e-3 of the excess, and 1e-13 of the polynomial's variation, of
///           the largest one that fits: the order of convergence is kept
Limited limit_discontinuous(const Field& field, int component, const ValueBounds& bounds,
                            std::span<const double> area, int threads);

/// The field with the components' coefficients replaced.
Field with_coefficients(const Field& field, std::span<const Limited> components);

}  // namespace bezel::detail
