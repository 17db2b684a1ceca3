#pragma once
// From the nodes along an edge to its number.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/mesh/mesh.hpp"

namespace bezel {

/// Finds the edges of a mesh by their nodes, as tagged edges name them. The mesh must outlive it.
class EdgeFinder {
 public:
  /// @cost O(edges)
  explicit EdgeFinder(const TriangleMesh& mesh);

  /// @param nodes  degree()+1 nodes along the edge, in either direction
  /// @return   the edge; `reversed` when the nodes run against its canonical direction. An invalid
  ///           EdgeId when the mesh has no such edge
  /// @cost     O(edges at the smaller corner)
  SideEdge find(std::span<const NodeId> nodes) const;

 private:
  const TriangleMesh* mesh_;
  std::vector<std::int32_t> offset_;  // per node: the edges that start there
  std::vector<EdgeId> edge_;
};

}  // namespace bezel
