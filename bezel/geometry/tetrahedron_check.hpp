#pragma once
// The door check of a tetrahedron's arguments.

#include <span>

#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

/// @throws InputError for a degree outside 1..max_tetrahedron_map_degree, a wrong number of control
/// points or one not finite
void check_tetrahedron(int g, std::span<const Vec3> control);

}  // namespace bezel::geometry_kernel
