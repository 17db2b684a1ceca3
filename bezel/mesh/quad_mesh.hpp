#pragma once
// A mesh of curved quadrilaterals with shared control points.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "bezel/geometry/quadrilateral.hpp"
#include "bezel/mesh/ids.hpp"
#include "bezel/mesh/mesh.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

/// A mesh of tensor-product Bezier quadrilaterals of one degree (geometry/quadrilateral.hpp:
/// corners, sides and the order of control points).
///
/// Neighbours name the same NodeIds along a common side, so an edge has one geometry, stored from
/// the corner with the smaller NodeId to the one with the larger. Sides whose corners agree but
/// whose inner control points differ are a slit, not an edge.
class QuadMesh {
 public:
  static constexpr int max_degree = max_quad_degree;

  /// @param degree    geometric degree, 1..max_degree
  /// @param control   all control points, finite; points that no element uses are allowed
  /// @param elements  connectivity, quad_size(degree) nodes per element
  /// @throws InputError for a bad degree or size, a NodeId out of range, a repeated corner, a
  ///         control point that is not finite (naming node and element). Orientation is not checked
  ///         here (see validity)
  /// @cost     O(elements), by hashing
  QuadMesh(int degree, std::vector<Vec2> control, std::vector<NodeId> elements);

  int degree() const { return degree_; }
  std::size_t element_count() const {
    return elements_.size() / static_cast<std::size_t>(nodes_per_element());
  }
  std::size_t node_count() const { return control_.size(); }
  std::size_t edge_count() const { return adjacent_offset_.size() - 1; }
  /// Number of distinct corners.
  std::size_t vertex_count() const { return vertex_count_; }
  int nodes_per_element() const { return quad_size(degree_); }

  std::span<const Vec2> control() const { return control_; }
  const Vec2& control(NodeId n) const { return control_[n.index()]; }
  std::span<const NodeId> nodes(ElementId e) const {
    const auto n = static_cast<std::size_t>(nodes_per_element());
    return {elements_.data() + e.index() * n, n};
  }
  /// Node of corner 0..3 of an element.
  NodeId corner(ElementId e, int corner) const;
  std::vector<Vec2> gather(ElementId e) const;  ///< an element's control points
  Box2 box() const;                             ///< of all elements' control points

  /// degree()+1 nodes in canonical direction.
  std::span<const NodeId> edge_nodes(EdgeId e) const {
    const auto n = static_cast<std::size_t>(degree_ + 1);
    return {edge_nodes_.data() + e.index() * n, n};
  }
  /// The edges of the element's sides 0 to 3.
  std::array<SideEdge, 4> edges(ElementId e) const;
  /// The elements along an edge, ascending; three or more where the mesh is no surface.
  std::span<const ElementSide> adjacent(EdgeId e) const {
    return {adjacent_.data() + adjacent_offset_[e.index()],
            adjacent_offset_[e.index() + 1] - adjacent_offset_[e.index()]};
  }
  bool is_boundary(EdgeId e) const { return adjacent(e).size() == 1; }

  /// check_quad_validity of one element.
  [[nodiscard]] QuadValidity validity(ElementId e) const;
  /// Sum of quad_area over the elements, in twice the working precision.
  double area() const;

 private:
  int degree_;
  std::size_t vertex_count_ = 0;
  std::vector<Vec2> control_;
  std::vector<NodeId> elements_;
  std::vector<NodeId> edge_nodes_;
  std::vector<SideEdge> element_edges_;  // 4 per element
  std::vector<std::size_t> adjacent_offset_;
  std::vector<ElementSide> adjacent_;
};

}  // namespace bezel
