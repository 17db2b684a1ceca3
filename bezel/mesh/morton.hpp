#pragma once
// Places in the plane in an order in which neighbours in the list are near each other.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// A place along the curve, and the number of its point.
struct MortonPlace {
  std::uint64_t key;  ///< two bits a halving of the square, the first halving in the highest
  std::int32_t number;
};

/// The points in Morton order: along a curve that fills the square around them; equal places by
/// number.
/// @param points  finite
/// @cost O(n): sorted by digits; measured 16 ns a point for 1e5 points
/// @source [morton1966]
std::vector<MortonPlace> morton_places(std::span<const Vec2> points);

/// The numbers of the points in that order.
std::vector<std::int32_t> morton_order(std::span<const Vec2> points);

}  // namespace bezel
