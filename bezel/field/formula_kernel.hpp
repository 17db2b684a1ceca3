#pragma once
// Formulas of x and y at points of an element, with errors that name the place.

#include <span>

#include "bezel/formula/formula.hpp"
#include "bezel/mesh/ids.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::field_detail {

/// @throws InputError unless the formula has exactly two variables
void check_formula(const Formula& formula);
/// out[q] = formula(x, y) at points[q]. @throws InputError naming the triangle and point where it
/// is not finite
/// @param e     the triangle; with `each`, the one of the first points, every next triangle having
///              as many
void evaluate_formula(const Formula& formula, std::span<const Vec2> points, std::span<double> out,
                      ElementId e, std::size_t each = 0);

/// (d/dx, d/dy) of the formula. @throws InputError naming the triangle and point where it is not
/// finite
Vec2 formula_gradient(const Formula& formula, const Vec2& point, ElementId e);

}  // namespace bezel::field_detail
