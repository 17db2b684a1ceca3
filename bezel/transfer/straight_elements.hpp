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

/// A point whose barycentric coordinates exceed this lies in one element only, and no edge is near.
inline constexpr double clear_of_edges = 1e-8;

/// A point as seen from an element.
struct StraightPlace {
  bool inside;          ///< or on the boundary
  bool clear;           ///< inside, with no edge near
  std::int32_t beyond;  ///< `beyond` of the side that it is farthest beyond
};

inline StraightPlace place_in(const StraightElement& element, const Vec2& p) {
  const auto& c = element.corner;
  const double l0 = cross(c[1] - c[0], p - c[0]), l1 = cross(c[2] - c[1], p - c[1]),
               l2 = cross(c[0] - c[2], p - c[2]);
  const double first = l1 < l0 ? l1 : l0;
  const double smallest = l2 < first ? l2 : first;
  const std::int32_t beyond = l2 < first ? element.beyond[2] : element.beyond[l1 < l0 ? 1 : 0];
  return {smallest >= 0.0, smallest > clear_of_edges * (l0 + l1 + l2), beyond};
}

/// @param mesh  of degree 1
std::vector<StraightElement> straight_elements(const OverlayMesh& mesh);

}  // namespace bezel::detail
