#pragma once
// The door check of a triangle's arguments.

#include <span>

#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

/// @throws InputError for a degree outside 1..max_degree, a wrong number of control points or one
/// not finite
void check_triangle(int g, std::span<const Vec2> control, int max_degree);

}  // namespace bezel::geometry_kernel
