#pragma once
// Internal: a mesh laid out for the overlay: geometry of edges and elements in flat arrays, boxes,
// search.

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "bezel/mesh/bvh.hpp"
#include "bezel/mesh/mesh.hpp"
#include "bezel/transfer/straight_elements.hpp"

namespace bezel::detail {

/// No element: the outside of a mesh.
inline constexpr std::int32_t exterior = -1;

struct OverlayMesh {
  /// @param what "donor" or "target", for messages
  /// @throws InputError when an element is inverted or an edge has more than one element on a side
  OverlayMesh(std::shared_ptr<const TriangleMesh> source, const std::string& what, int threads);

  std::shared_ptr<const TriangleMesh> mesh;
  int degree = 1;
  std::size_t element_size = 0;    ///< control points per element
  std::vector<Vec2> edge_control;  ///< (degree+1) per edge, canonical direction
  std::vector<std::array<std::int32_t, 2>>
      edge_sides;  ///< element left and right of each edge, or exterior
  std::vector<std::array<std::int32_t, 2>> edge_vertex;  ///< nodes at an edge's ends
  std::vector<std::array<SideEdge, 3>> element_edges;
  std::vector<Vec2> element_control;
  std::vector<Box2> element_box;
  std::vector<double> element_area;      ///< exact up to rounding
  std::vector<double> element_diameter;  ///< of the boxes
  Box2 box;
  /// Of a mesh that was moved to another plane (flat_sweep.hpp): by how much the rounding of the
  /// coordinates that it came with moves points here. Else 0.
  double rounding = 0;
  /// ... and its nodes in the plane that it came from; else empty.
  std::vector<Vec2> given_control;
  std::vector<std::int32_t> numbers;  ///< of a part of a mesh: the elements' numbers in the whole

  /// Notes the plane that a moved mesh came from: areas of elements that no plane makes round are
  /// taken there.
  void came_from(std::vector<Vec2> control, double with_rounding);
  std::int32_t number_of(std::int32_t e) const {
    return numbers.empty() ? e : numbers[static_cast<std::size_t>(e)];
  }
  const Vec2& given(NodeId n) const {
    return given_control.empty() ? mesh->control(n) : given_control[n.index()];
  }
  std::size_t element_count() const { return element_box.size(); }
  std::size_t edge_count() const { return edge_sides.size(); }
  std::span<const Vec2> edge(std::int32_t e) const {
    const auto n = static_cast<std::size_t>(degree + 1);
    return {edge_control.data() + static_cast<std::size_t>(e) * n, n};
  }
  std::span<const Vec2> element(std::int32_t e) const {
    return {element_control.data() + static_cast<std::size_t>(e) * element_size, element_size};
  }
  /// What intersections need of edge e: what is stored, or `room`, filled here for a straight edge
  /// (most of them are never asked for).
  const CurveCache& edge_cache(std::int32_t e, CurveCache& room) const {
    if (degree > 1) return edge_cache_[static_cast<std::size_t>(e)];
    return room = cache_curve(edge(e));
  }
  Box2 edge_box(std::int32_t e) const;
  /// The smallest width of the elements beside edge e.
  double edge_width(std::int32_t e) const;
  /// The element on the other side of edge e, or exterior.
  std::int32_t across(std::int32_t element, std::int32_t e) const {
    const auto& s = edge_sides[static_cast<std::size_t>(e)];
    return s[0] == element ? s[1] : s[0];
  }
  std::array<Vec2, 3> corners(std::int32_t e) const;
  /// Twice the area over the diameter: about the smallest height of a triangle.
  double element_width(std::int32_t e) const {
    const auto i = static_cast<std::size_t>(e);
    return 2.0 * element_area[i] / element_diameter[i];
  }
  /// Elements in an order in which neighbours in the list are near each other (Morton order of the
  /// box centres).
  std::vector<std::int32_t> spatial_order() const;

 private:
  void lay_out_edges(const std::string& what, int threads);
  void lay_out_elements(const std::string& what, int threads);

  std::vector<CurveCache> edge_cache_;  // of curved edges
};

/// Gaps in what covers an element, up to this fraction of it, are rounding and are extended
/// whatever the policy.
inline double silent_gap(const OverlayMesh& mesh, std::int32_t e) {
  constexpr double usual = 1e-10, roundings = 32.0;  // of boundaries of both meshes
  return std::max(usual, roundings * mesh.rounding / mesh.element_width(e));
}

/// Finds the elements whose boxes overlap a box by walking over the adjacency graph from a known
/// element (an advancing front), and asks a tree only where the front meets the mesh's boundary or
/// has no start.
class FrontSearch {
 public:
  explicit FrontSearch(const OverlayMesh& mesh);
  /// Of a part of a mesh: `connected` is what the whole mesh is.
  FrontSearch(const OverlayMesh& part, bool connected);

  /// Per-thread memory of the walk.
  struct Memory {
    std::vector<std::uint32_t> stamp;
    std::uint32_t now = 0;
    std::vector<std::int32_t> found;
  };
  /// Ascending element numbers. `near`: elements that may lie in the box, tried as starts of the
  /// walk. The answer does not depend on them.
  void query(const Box2& box, std::span<const std::int32_t> near, Memory& memory,
             std::vector<std::int32_t>& out) const;
  /// Where a walk towards p ends, in the element around it unless p or the way to it lies outside:
  /// one to try first in query(). Exterior when there are no elements.
  std::int32_t towards(const Vec2& p) const;
  /// The element nearest to p by the distance of its corners and centre; for extending fields.
  std::int32_t nearest(const Vec2& p) const;
  /// The element that holds p well inside; exterior when there is none, also where p is too near to
  /// an edge to tell. The answer does not depend on the start of the walk.
  std::int32_t containing(const Vec2& p, std::int32_t start, Memory& memory) const;

  /// The elements of a straight mesh; else empty.
  const std::vector<StraightElement>& straight() const { return straight_; }

  /// Whether every vertex can be reached from every other along edges.
  bool connected() const { return connected_; }
  /// The edges that end in a vertex (a node number).
  std::span<const std::int32_t> edges_at(std::int32_t vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return {vertex_edges_.data() + vertex_offset_[v], vertex_offset_[v + 1] - vertex_offset_[v]};
  }

 private:
  void collect_edges_at_vertices();

  /// Made when it is first asked for.
  const Bvh& tree() const;

  const OverlayMesh& mesh_;
  mutable std::once_flag tree_made_;
  mutable std::unique_ptr<const Bvh> tree_;
  std::vector<std::uint32_t> vertex_offset_;
  std::vector<std::int32_t> vertex_edges_;
  std::vector<StraightElement> straight_;
  bool connected_ = false;
};

/// Finds lambda with b(lambda) = p for a triangle given by control points; start: an affine guess
/// or `warm`. False when Newton does not converge.
bool invert_map(int degree, std::span<const Vec2> control, const Vec2& p,
                std::array<double, 3>& lambda, bool warm);

/// The smallest barycentric coordinate of p in an element: positive inside, negative outside; minus
/// infinity when the map could not be inverted there.
double inside_margin(const OverlayMesh& mesh, std::int32_t element, const Vec2& p);

}  // namespace bezel::detail
