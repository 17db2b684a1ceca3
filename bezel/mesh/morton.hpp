#pragma once
// Places in the plane in an order in which neighbours in the list are near each other.

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

namespace detail {

constexpr std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0xffffffffULL;
  x = (x | (x << 16)) & 0x0000ffff0000ffffULL;
  x = (x | (x << 8)) & 0x00ff00ff00ff00ffULL;
  x = (x | (x << 4)) & 0x0f0f0f0f0f0f0f0fULL;
  x = (x | (x << 2)) & 0x3333333333333333ULL;
  x = (x | (x << 1)) & 0x5555555555555555ULL;
  return x;
}

}  // namespace detail

/// The numbers of the points in Morton order: along a curve that fills the square around them;
/// equal places by number.
/// @cost O(n log n)
/// @source [morton1966]
inline std::vector<std::int32_t> morton_order(std::span<const Vec2> points) {
  Box2 box;
  for (const Vec2& p : points) box.include(p);
  constexpr double largest = 4294967295.0;
  const double width = std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], 1e-300});
  const double scale = largest / width;
  std::vector<std::pair<std::uint64_t, std::int32_t>> keyed(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 c = points[i] - box.lo;
    const auto cell = [&](double x) {
      return detail::spread_bits(static_cast<std::uint64_t>(std::clamp(x * scale, 0.0, largest)));
    };
    keyed[i] = {cell(c[0]) | (cell(c[1]) << 1), static_cast<std::int32_t>(i)};
  }
  std::sort(keyed.begin(), keyed.end());
  std::vector<std::int32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = keyed[i].second;
  return order;
}

}  // namespace bezel
