#pragma once
// Numbers of the control points of a straight mesh raised to a higher degree.

#include <cstddef>
#include <vector>

#include "bezel/mesh/mesh.hpp"

namespace bezel {

/// The numbering that curved meshes made from straight ones have: the vertices keep their numbers,
/// then come the inner control points of the edges, g - 1 each in the edge's canonical direction,
/// then those of the elements in the order of bernstein/index.hpp. The mesh must outlive it.
class RaisedNodes {
 public:
  /// @param straight  of degree 1
  /// @param g         degree of the raised mesh, 1..TriangleMesh::max_degree
  RaisedNodes(const TriangleMesh& straight, int g);

  /// How many control points there are.
  std::size_t count() const;
  /// The m-th control point along an edge, 1 <= m <= g - 1, counted against its canonical direction
  /// where `reversed`.
  NodeId edge(const SideEdge& side, int m) const {
    return NodeId(edge_base_ + side.edge.index() * edge_nodes_ +
                  static_cast<std::size_t>((side.reversed ? g_ - m : m) - 1));
  }
  /// The first inner control point of an element; the others follow.
  std::size_t inner(ElementId e) const { return inner_base_ + e.index() * inner_nodes_; }
  /// All elements' control points, triangle_size(g) each.
  /// @cost  O(elements g^2)
  std::vector<NodeId> elements() const;

 private:
  const TriangleMesh* straight_;
  int g_;
  std::size_t edge_nodes_, inner_nodes_, edge_base_, inner_base_;
};

}  // namespace bezel
