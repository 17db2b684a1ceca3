#pragma once
// What the public functions on triangles check at the door.

#include <span>

#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

/// @throws InputError for a degree outside 1..max_degree, a wrong number of control points or one
/// not finite
void check_triangle(int g, std::span<const Vec2> control, int max_degree);
/// @throws InputError unless 0 <= tolerance < 1
void check_tolerance(double tolerance);

}  // namespace bezel::geometry_kernel
