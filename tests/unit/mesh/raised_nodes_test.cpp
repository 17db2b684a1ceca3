#include "bezel/mesh/raised_nodes.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bezel/mesh/generate.hpp"

namespace bezel {
namespace {

// The raised mesh has the edges of the straight one, in its order and direction, each with the
// control points that edge() names; vertices keep their numbers, and no number is left out.
TEST(RaisedNodes, RaisedMeshHasTheSameEdges) {
  GenerateOptions options;
  options.degree = 1;
  options.size = 0.5;
  const TriangleMesh straight = generate_disc(1, options);
  for (int g = 1; g <= TriangleMesh::max_degree; ++g) {
    SCOPED_TRACE(g);
    const RaisedNodes nodes(straight, g);
    const std::vector<NodeId> elements = nodes.elements();
    std::vector<char> used(nodes.count(), 0);
    for (const NodeId node : elements) used.at(node.index()) = 1;
    EXPECT_EQ(std::count(used.begin(), used.end(), 1), static_cast<std::ptrdiff_t>(nodes.count()));
    const TriangleMesh raised(g, std::vector<Vec2>(nodes.count()), elements);
    ASSERT_EQ(raised.edge_count(), straight.edge_count());
    for (std::size_t e = 0; e < straight.edge_count(); ++e) {
      const auto ends = straight.edge_nodes(EdgeId(e)), along = raised.edge_nodes(EdgeId(e));
      EXPECT_EQ(along.front(), ends.front());
      EXPECT_EQ(along.back(), ends.back());
      for (int m = 1; m < g; ++m) {
        EXPECT_EQ(along[static_cast<std::size_t>(m)], nodes.edge({EdgeId(e), false}, m));
        EXPECT_EQ(along[static_cast<std::size_t>(m)], nodes.edge({EdgeId(e), true}, g - m));
      }
    }
    for (std::size_t e = 0; e < straight.element_count() && g >= 3; ++e)
      EXPECT_EQ(
          raised.nodes(ElementId(e))[static_cast<std::size_t>(bernstein::triangle_index(g, 1, 1))],
          NodeId(nodes.inner(ElementId(e))));
  }
}

}  // namespace
}  // namespace bezel
