#pragma once
// A curved mesh of Bezier simplices with shared control points.

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/mesh/ids.hpp"
#include "bezel/mesh/tags.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

/// An element seen from one of its sides. `reversed`: the element's direction of the side is
/// opposite to the edge's canonical direction.
struct ElementSide {
  ElementId element;
  int side = 0;
  bool reversed = false;
  friend bool operator==(const ElementSide&, const ElementSide&) = default;
};

/// An element's view of one of its edges.
struct SideEdge {
  EdgeId edge;
  bool reversed = false;
};

/// A mesh of Bezier simplices of one geometric degree. Template over the dimension; instantiated
/// for 2.
///
/// Control points are shared: neighbours name the same NodeIds along a common edge, so an edge has
/// one geometry, stored from the corner with the smaller NodeId to the one with the larger. Two
/// elements whose corners agree but whose inner edge control points differ do not share the edge.
template <int dim>
class SimplexMesh {
 public:
  static constexpr int max_degree = 10;
  static constexpr std::size_t edges_per_element = dim == 2 ? 3 : 6;

  /// @param degree    geometric degree, 1..max_degree
  /// @param control   all control points, finite; points that no element uses are allowed
  /// @param elements  connectivity, shape (m, simplex_size(dim, degree)), ordered by index.hpp
  /// @param tags      entities, groups and tagged edges; sizes and node numbers are checked
  /// @throws InputError for a bad degree or size, a NodeId out of range, a repeated corner, a
  ///         control point that is not finite (naming node and element), tags that do not fit.
  ///         Orientation is NOT checked here (see check_validity)
  /// @cost     O(m) expected, by hashing; measured 0.02 s for 1e5 linear triangles. Edges are
  ///           numbered in order of first appearance, element by element and side by side
  SimplexMesh(int degree, std::vector<Vec<dim>> control, std::vector<NodeId> elements,
              Tags tags = {});

  int degree() const { return degree_; }
  std::size_t element_count() const { return element_count_; }
  std::size_t node_count() const { return control_.size(); }
  std::size_t edge_count() const {
    return edge_nodes_.size() / static_cast<std::size_t>(degree_ + 1);
  }
  /// Number of distinct corners.
  std::size_t vertex_count() const { return vertex_count_; }
  int nodes_per_element() const { return bernstein::simplex_size(dim, degree_); }

  std::span<const Vec<dim>> control() const { return control_; }
  const Vec<dim>& control(NodeId n) const { return control_[n.index()]; }
  std::span<const NodeId> nodes(ElementId e) const {
    const auto n = static_cast<std::size_t>(nodes_per_element());
    return {elements_.data() + e.index() * n, n};
  }
  std::span<const NodeId> connectivity() const { return elements_; }
  /// Copies an element's control points into out (size nodes_per_element()).
  void gather(ElementId e, std::span<Vec<dim>> out) const;
  std::vector<Vec<dim>> gather(ElementId e) const;
  Box<dim> box(ElementId e) const;  ///< of the element's control points (contains the element)
  Box<dim> box() const;             ///< of all elements' control points

  // Edges (2D: sides of triangles).
  /// degree()+1 nodes in canonical direction.
  std::span<const NodeId> edge_nodes(EdgeId e) const {
    const auto n = static_cast<std::size_t>(degree_ + 1);
    return {edge_nodes_.data() + e.index() * n, n};
  }
  void gather_edge(EdgeId e, std::span<Vec<dim>> out) const;
  /// The edges of the element's sides 0, 1, 2 (index.hpp).
  std::array<SideEdge, edges_per_element> edges(ElementId e) const {
    std::array<SideEdge, edges_per_element> sides;
    for (std::size_t s = 0; s < edges_per_element; ++s)
      sides[s] = element_edges_[e.index() * edges_per_element + s];
    return sides;
  }
  /// The elements along an edge, in ascending order: one on the boundary, two inside; three or more
  /// where the mesh is no surface (elements that overlap or branch). Such meshes are accepted: the
  /// list names all of them.
  std::span<const ElementSide> adjacent(EdgeId e) const {
    return {adjacent_.data() + adjacent_offset_[e.index()],
            adjacent_offset_[e.index() + 1] - adjacent_offset_[e.index()]};
  }
  bool is_boundary(EdgeId e) const { return adjacent(e).size() == 1; }

  const Tags& tags() const { return tags_; }

 private:
  void build_edges();

  int degree_;
  std::size_t element_count_ = 0;
  std::size_t vertex_count_ = 0;
  std::vector<Vec<dim>> control_;
  std::vector<NodeId> elements_;
  std::vector<NodeId> edge_nodes_;
  std::vector<SideEdge> element_edges_;  // 3 per element
  std::vector<std::size_t> adjacent_offset_;
  std::vector<ElementSide> adjacent_;
  Tags tags_;
};

using TriangleMesh = SimplexMesh<2>;
extern template class SimplexMesh<2>;

}  // namespace bezel
