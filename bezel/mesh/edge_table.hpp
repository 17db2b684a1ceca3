#pragma once
// The edges of a mesh from its connectivity; for the constructors of meshes.

#include <cstddef>
#include <span>
#include <vector>

#include "bezel/mesh/mesh.hpp"

namespace bezel::mesh_detail {

/// Edges in order of first appearance, element by element and side by side. Two sides are one edge
/// when all their nodes agree, in one direction or the other.
struct EdgeTable {
  std::vector<NodeId> nodes;        ///< `length` per edge, from the smaller end node to the larger
  std::vector<SideEdge> sides;      ///< per element and side
  std::vector<std::size_t> offset;  ///< into `adjacent`, per edge, and its end
  std::vector<ElementSide> adjacent;  ///< along each edge, elements ascending
};

/// @param elements   node numbers, element_size per element
/// @param positions  for each side, the places of its nodes within an element, `length` per side
/// @cost O(sides), by hashing
EdgeTable build_edge_table(std::span<const NodeId> elements, std::size_t element_size,
                           std::span<const std::size_t> positions, std::size_t length);

}  // namespace bezel::mesh_detail
