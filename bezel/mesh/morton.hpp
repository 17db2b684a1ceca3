#pragma once
// Places in the plane in an order in which neighbours in the list are near each other.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// The numbers of the points in Morton order: along a curve that fills the square around them;
/// equal places by number.
/// @cost O(n): sorted by digits
/// @source [morton1966]
std::vector<std::int32_t> morton_order(std::span<const Vec2> points);

}  // namespace bezel
