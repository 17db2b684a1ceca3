#pragma once
// Distinct types for the numbers of nodes, edges and elements, so that they cannot be mixed up.

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace bezel {

/// A zero-based number of one kind of thing; -1 means none.
template <class Tag>
struct Id {
  std::int32_t value = -1;
  constexpr Id() = default;
  constexpr explicit Id(std::int32_t v) : value(v) {}
  constexpr explicit Id(std::size_t v) : value(static_cast<std::int32_t>(v)) {}
  constexpr bool valid() const { return value >= 0; }
  constexpr std::size_t index() const { return static_cast<std::size_t>(value); }
  friend constexpr auto operator<=>(const Id&, const Id&) = default;
};

using NodeId = Id<struct NodeTag>;        ///< a control point of a mesh
using EdgeId = Id<struct EdgeTag>;        ///< an edge of a mesh, shared by its elements
using ElementId = Id<struct ElementTag>;  ///< a triangle or tetrahedron
using TriangleId = ElementId;

}  // namespace bezel

template <class Tag>
struct std::hash<bezel::Id<Tag>> {
  std::size_t operator()(const bezel::Id<Tag>& id) const noexcept {
    return std::hash<std::int32_t>{}(id.value);
  }
};
