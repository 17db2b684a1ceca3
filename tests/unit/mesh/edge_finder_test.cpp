#include "bezel/mesh/edge_finder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bezel/mesh/generate.hpp"

namespace bezel {
namespace {

TEST(EdgeFinder, FindsEveryEdgeInBothDirections) {
  GenerateOptions options;
  options.degree = 3;
  options.size = 0.4;
  const TriangleMesh mesh = generate_disc(1, options);
  const EdgeFinder finder(mesh);
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const auto along = mesh.edge_nodes(EdgeId(e));
    std::vector<NodeId> nodes(along.begin(), along.end());
    EXPECT_EQ(finder.find(nodes).edge, EdgeId(e));
    EXPECT_FALSE(finder.find(nodes).reversed);
    std::reverse(nodes.begin(), nodes.end());
    EXPECT_EQ(finder.find(nodes).edge, EdgeId(e));
    EXPECT_TRUE(finder.find(nodes).reversed);
    std::swap(nodes[1], nodes[2]);  // the corners of an edge, but another curve
    EXPECT_FALSE(finder.find(nodes).edge.valid());
  }
}

TEST(EdgeFinder, WhatIsNoEdgeIsInvalid) {
  const std::vector<Vec2> control{Vec2{{0, 0}}, Vec2{{1, 0}}, Vec2{{0, 1}}, Vec2{{1, 1}}};
  const TriangleMesh mesh(1, control, {NodeId(0), NodeId(1), NodeId(2)});
  const EdgeFinder finder(mesh);
  const auto found = [&](std::vector<NodeId> nodes) { return finder.find(nodes).edge.valid(); };
  EXPECT_TRUE(found({NodeId(2), NodeId(1)}));
  EXPECT_FALSE(found({NodeId(2), NodeId(3)}));
  EXPECT_FALSE(found({NodeId(7), NodeId(8)}));
  EXPECT_FALSE(found({NodeId(-1), NodeId(1)}));
  EXPECT_FALSE(found({NodeId(0)}));
  EXPECT_FALSE(found({NodeId(0), NodeId(1), NodeId(2)}));
  EXPECT_FALSE(found({}));
}

}  // namespace
}  // namespace bezel
