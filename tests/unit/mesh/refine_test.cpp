// refine_uniform of generate.hpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/mesh/generate.hpp"
#include "unit/mesh/mesh_checks.hpp"

namespace bezel {
namespace {

using namespace test;

constexpr double u = 0x1p-53;

std::vector<NodeId> ids(std::initializer_list<int> values) {
  std::vector<NodeId> out;
  for (const int v : values) out.emplace_back(v);
  return out;
}

TriangleMesh jittered(int degree) {
  GenerateOptions options;
  options.degree = degree;
  options.size = 0.5;
  options.seed = 11;
  options.curve_jitter = 0.2;
  return generate_disc(0.7, options);
}

TEST(Refine, ChildrenAreThoseOfSubdivide) {
  for (int g = 1; g <= TriangleMesh::max_degree; ++g) {
    const auto mesh = jittered(g);
    const auto fine = refine_uniform(mesh);
    ASSERT_EQ(fine.element_count(), 4 * mesh.element_count());
    for (std::size_t e = 0; e < mesh.element_count(); ++e) {
      const auto b = mesh.gather(ElementId(e));
      double scale = 0;
      for (const Vec2& p : b) scale = std::max({scale, std::abs(p[0]), std::abs(p[1])});
      const auto children = bernstein::subdivide<Vec2>(g, b);
      for (std::size_t c = 0; c < 4; ++c) {
        const auto found = fine.gather(ElementId(4 * e + c));
        for (std::size_t n = 0; n < found.size(); ++n)
          for (int axis = 0; axis < 2; ++axis)
            // Both sides within (g + 4) u max|b| and 2 g u max|b| of the exact point.
            ASSERT_NEAR(found[n][axis], children[c][n][axis], (3 * g + 4) * u * scale)
                << "degree " << g << " child " << c << " point " << n;
      }
    }
  }
}

TEST(Refine, KeepsTopologyAreaAndTags) {
  for (const int g : {1, 2, 3, 6}) {
    auto mesh = jittered(g);
    const double before = total_area(mesh);
    const double length = boundary_lengths(mesh).at("boundary");
    for (int level = 0; level < 2; ++level) {
      const auto fine = refine_uniform(mesh);
      expect_consistent(fine);
      EXPECT_EQ(euler(fine), 1);
      EXPECT_EQ(fine.vertex_count(), mesh.vertex_count() + mesh.edge_count());
      EXPECT_EQ(fine.edge_count(), 2 * mesh.edge_count() + 3 * mesh.element_count());
      EXPECT_NEAR(total_area(fine), before, 1e-14);
      EXPECT_EQ(fine.tags().groups, mesh.tags().groups);
      EXPECT_EQ(fine.tags().entities, mesh.tags().entities);
      EXPECT_EQ(fine.tags().element_entity, std::vector<int>(fine.element_count(), 1));
      EXPECT_EQ(fine.tags().edges.size(), 2 * mesh.tags().edges.size());
      EXPECT_NEAR(boundary_lengths(fine).at("boundary"), length, 1e-3);
      mesh = fine;
    }
  }
}

TEST(Refine, DyadicControlPointsAreExact) {
  // One quadratic triangle; every new point by hand.
  const std::vector<Vec2> control{Vec2{{0, 0}}, Vec2{{4, -1}}, Vec2{{8, 0}},
                                  Vec2{{1, 4}}, Vec2{{4, 4}},  Vec2{{0, 8}}};
  const auto fine = refine_uniform(TriangleMesh(2, control, ids({0, 1, 2, 3, 4, 5})));
  const std::vector<Vec2> middle{Vec2{{4, 4}},       Vec2{{2.25, 3.75}}, Vec2{{0.5, 4}},
                                 Vec2{{4.25, 1.75}}, Vec2{{2.25, 1.75}}, Vec2{{4, -0.5}}};
  EXPECT_EQ(fine.gather(ElementId(3)), middle);
  const std::vector<Vec2> first{Vec2{{0, 0}},   Vec2{{2, -0.5}},    Vec2{{4, -0.5}},
                                Vec2{{0.5, 2}}, Vec2{{2.25, 1.75}}, Vec2{{0.5, 4}}};
  EXPECT_EQ(fine.gather(ElementId(0)), first);
}

TEST(Refine, EntitiesDifferPerElementAndSidesKeepTheirDirection) {
  const std::vector<Vec2> control{Vec2{{0, 0}}, Vec2{{1, 0}}, Vec2{{1, 1}}, Vec2{{0, 1}},
                                  Vec2{{9, 9}}};
  Tags tags;
  tags.element_entity = {7, 3};
  tags.edges = {{ids({2, 0}), 5}, {ids({1, 2}), 6}};
  tags.points = {{NodeId(2), 8}, {NodeId(4), 9}};
  const auto fine = refine_uniform(TriangleMesh(1, control, ids({0, 1, 2, 0, 2, 3}), tags));
  EXPECT_EQ(fine.tags().element_entity, (std::vector<int>{7, 7, 7, 7, 3, 3, 3, 3}));
  ASSERT_EQ(fine.tags().edges.size(), 4u);
  const auto place = [&](NodeId n) { return fine.control(n); };
  EXPECT_EQ(fine.tags().edges[0].entity, 5);
  EXPECT_EQ(place(fine.tags().edges[0].nodes[0]), (Vec2{{1, 1}}));
  EXPECT_EQ(place(fine.tags().edges[0].nodes[1]), (Vec2{{0.5, 0.5}}));
  EXPECT_EQ(fine.tags().edges[1].nodes[0], fine.tags().edges[0].nodes[1]);
  EXPECT_EQ(place(fine.tags().edges[1].nodes[1]), (Vec2{{0, 0}}));
  EXPECT_EQ(place(fine.tags().edges[3].nodes[1]), (Vec2{{1, 1}}));
  ASSERT_EQ(fine.tags().points.size(), 2u);
  EXPECT_EQ(place(fine.tags().points[0].node), (Vec2{{1, 1}}));
  EXPECT_EQ(fine.tags().points[0].entity, 8);
  EXPECT_EQ(place(fine.tags().points[1].node), (Vec2{{9, 9}}));  // tagged, so kept although unused
  EXPECT_EQ(fine.node_count(), 10u);
}

TEST(Refine, ATaggedCurveBesideTheMeshIsHalvedToo) {
  const std::vector<Vec2> control{Vec2{{0, 0}}, Vec2{{2, 0}}, Vec2{{0, 2}}, Vec2{{4, 4}},
                                  Vec2{{7, 7}}};
  Tags tags;
  tags.edges = {{ids({1, 3}), 5}};
  const auto fine = refine_uniform(TriangleMesh(1, control, ids({0, 1, 2}), tags));
  ASSERT_EQ(fine.tags().edges.size(), 2u);
  EXPECT_EQ(fine.control(fine.tags().edges[0].nodes[1]), (Vec2{{3, 2}}));
  EXPECT_EQ(fine.control(fine.tags().edges[1].nodes[1]), (Vec2{{4, 4}}));
  EXPECT_TRUE(std::none_of(fine.control().begin(), fine.control().end(), [](const Vec2& p) {
    return p == Vec2{{7, 7}};
  }));  // unused nodes go
}

TEST(Refine, WithoutElementsStaysEmpty) {
  EXPECT_EQ(refine_uniform(TriangleMesh(4, {}, {})).element_count(), 0u);
}

}  // namespace
}  // namespace bezel
