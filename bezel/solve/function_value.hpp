#pragma once
// Functions of the caller at points, with errors that name the place.

#include <string>

#include "bezel/numeric/vec.hpp"

namespace bezel::solve_detail {

/// The value itself. @throws InputError naming the point when it is not finite
double finite(double value, const Vec2& at, const char* what);

/// "x = 0.5, y = 1": the shortest digits that identify the point.
std::string place(const Vec2& at);

}  // namespace bezel::solve_detail
