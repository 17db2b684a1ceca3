#pragma once
// Internal to io: nodal values <-> Bernstein coefficients per node of a mesh, and change of degree.

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "bezel/mesh/mesh.hpp"

namespace bezel::files {

/// A numbering of a mesh's nodes in which every node plays one part: corner, or one place inside
/// one edge, or inside one element. It is the mesh's own numbering, plus copies at the end for
/// nodes that the mesh uses in two parts (their nodal values differ).
struct NodeLayout {
  std::vector<NodeId> elements;  ///< like TriangleMesh::connectivity()
  std::vector<NodeId> origin;    ///< per node, the mesh's node
};
NodeLayout node_layout(const TriangleMesh& mesh);

enum class Conversion { to_nodal, to_bernstein };

/// Converts values given per node of the layout, shape (nodes, components): corners are kept, inner
/// edge values are computed once per edge in its canonical direction, inner values per element. So
/// neighbours agree bit for bit.
std::vector<double> convert_nodes(const TriangleMesh& mesh, const NodeLayout& layout,
                                  std::span<const double> values, int components,
                                  Conversion conversion);

/// The mesh with nodal positions -> the mesh with control points, or back. Tags are kept.
TriangleMesh convert_mesh(const TriangleMesh& mesh, Conversion conversion);

/// The same geometry with another geometric degree (exact upwards; downwards the L2-nearest).
/// Corners are renumbered from 0 in their order, then come inner edge points, then inner points.
/// Tagged edges and points that are no edges or corners of the mesh are dropped.
TriangleMesh change_degree(const TriangleMesh& mesh, int degree);

/// Finds edges by their nodes.
class EdgeFinder {
 public:
  explicit EdgeFinder(const TriangleMesh& mesh);
  struct Found {
    EdgeId edge;
    bool reversed = false;  ///< the nodes run against the edge's canonical direction
  };
  std::optional<Found> find(std::span<const NodeId> nodes) const;

 private:
  const TriangleMesh& mesh_;
  std::unordered_multimap<std::uint64_t, EdgeId> by_ends_;
};

}  // namespace bezel::files
