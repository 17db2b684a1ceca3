#pragma once
// Internal: a mesh of straight triangles laid out for walks along lines.

#include <array>
#include <cstdint>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel::detail {

struct OverlayMesh;

/// A straight triangle and what lies beyond its sides; side k runs from corner k to corner k + 1.
struct alignas(64) StraightElement {
  std::array<Vec2, 3> corner;
  /// 4 times the element beyond a side plus its number of that side; -1 where there is none.
  std::array<std::int32_t, 3> beyond;
  /// Bit k: side k runs against the direction of its edge.
  std::uint32_t reversed = 0;
};

/// @param mesh  of degree 1
std::vector<StraightElement> straight_elements(const OverlayMesh& mesh);

}  // namespace bezel::detail
