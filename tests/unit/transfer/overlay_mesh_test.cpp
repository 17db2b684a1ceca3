#include "bezel/transfer/overlay_mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bezel/base/error.hpp"
#include "bezel/mesh/generate.hpp"
#include "support/meshes.hpp"

namespace bezel::detail {
namespace {

std::vector<std::int32_t> brute_force(const OverlayMesh& mesh, const Box2& box) {
  std::vector<std::int32_t> out;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    if (mesh.element_box[e].overlaps(box)) out.push_back(static_cast<std::int32_t>(e));
  }
  return out;
}

TEST(FrontSearch, FindsWhatBruteForceFindsFromAnyStart) {
  GenerateOptions options;
  options.degree = 2;
  options.size = 0.12;
  const OverlayMesh mesh(std::make_shared<const TriangleMesh>(generate_annulus(0.4, 1.0, options)),
                         "donor", 1);
  const FrontSearch search(mesh);
  FrontSearch::Memory memory;
  RandomStream random("front search", 3);
  std::vector<std::int32_t> found;
  for (int i = 0; i < 2000; ++i) {
    const Vec2 centre{{random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)}};
    const Vec2 half{{random.uniform(0, 0.5), random.uniform(0, 0.5)}};
    Box2 box;
    box.include(centre - half);
    box.include(centre + half);
    const auto expected = brute_force(mesh, box);
    std::vector<std::int32_t> near;
    for (int k = 0; k < 3; ++k)
      near.push_back(static_cast<std::int32_t>(random.below(mesh.element_count())));
    if (!expected.empty()) near.push_back(expected[random.below(expected.size())]);
    search.query(box, near, memory, found);
    EXPECT_EQ(found, expected);
    search.query(box, {}, memory, found);
    EXPECT_EQ(found, expected);
  }
}

TEST(FrontSearch, NearestIsTheElementThatHoldsThePointOrTheClosest) {
  const OverlayMesh mesh(test::grid_mesh(4, 1, 1.0, test::same_place), "donor", 1);
  const FrontSearch search(mesh);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const auto c = mesh.corners(static_cast<std::int32_t>(e));
    EXPECT_EQ(search.nearest((c[0] + c[1] + c[2]) * (1.0 / 3.0)), static_cast<std::int32_t>(e));
  }
  const std::int32_t right = search.nearest({{5.0, 0.1}});
  EXPECT_EQ(mesh.element_box[static_cast<std::size_t>(right)].hi[0], 1.0);
}

TEST(FrontSearch, AWalkEndsAroundThePointItGoesTo) {
  const OverlayMesh mesh(test::grid_mesh(40, 1, 1.0, test::turn(0.3, 1.0)), "donor", 1);
  const FrontSearch search(mesh);
  FrontSearch::Memory memory;
  RandomStream random("walk towards", 1);
  for (int i = 0; i < 200; ++i) {
    const Vec2 p{{random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6)}};
    const std::int32_t e = search.towards(p);
    EXPECT_GE(inside_margin(mesh, e, p), -1e-12);
    if (inside_margin(mesh, e, p) < 1e-7) continue;
    EXPECT_EQ(search.containing(p, exterior, memory), e);
    EXPECT_EQ(
        search.containing(p, static_cast<std::int32_t>(random.below(mesh.element_count())), memory),
        e);
  }
  EXPECT_NE(search.towards({{5.0, 5.0}}), exterior);
}

// Across the opening of a ring, and where a walk comes to its inner boundary.
TEST(FrontSearch, TheElementAroundAPointDoesNotDependOnTheStart) {
  GenerateOptions options;
  options.degree = 3;
  options.size = 0.15;
  const OverlayMesh mesh(std::make_shared<const TriangleMesh>(generate_annulus(0.5, 1.0, options)),
                         "donor", 1);
  const FrontSearch search(mesh);
  FrontSearch::Memory memory;
  RandomStream random("walk across a ring", 1);
  for (int i = 0; i < 500; ++i) {
    const Vec2 p{{random.uniform(-1.1, 1.1), random.uniform(-1.1, 1.1)}};
    std::int32_t expected = exterior;
    for (std::size_t e = 0; e < mesh.element_count(); ++e) {
      if (inside_margin(mesh, static_cast<std::int32_t>(e), p) > clear_of_edges)
        expected = static_cast<std::int32_t>(e);
    }
    EXPECT_EQ(search.containing(p, exterior, memory), expected);
    EXPECT_EQ(
        search.containing(p, static_cast<std::int32_t>(random.below(mesh.element_count())), memory),
        expected);
  }
}

TEST(OverlayMesh, SpatialOrderIsAPermutation) {
  const OverlayMesh mesh(test::grid_mesh(9, 1, 1.0, test::same_place), "donor", 1);
  auto order = mesh.spatial_order();
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], static_cast<std::int32_t>(i));
}

TEST(OverlayMesh, EdgesKnowTheirSides) {
  const OverlayMesh mesh(test::grid_mesh(3, 2, 1.0, test::bend(0.2, 0.1)), "donor", 1);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const auto t = static_cast<std::int32_t>(e);
    for (const SideEdge& side : mesh.element_edges[e]) {
      EXPECT_EQ(mesh.edge_sides[side.edge.index()][side.reversed ? 1 : 0], t);
      const std::int32_t other = mesh.across(t, side.edge.value);
      EXPECT_NE(other, t);
      if (other != exterior) {
        EXPECT_EQ(mesh.across(other, side.edge.value), t);
      }
    }
  }
}

TEST(OverlayMesh, TwoElementsOnOneSideOfAnEdgeAreRefused) {
  // Two triangles over each other on the same edge.
  const auto mesh = std::make_shared<const TriangleMesh>(
      1, std::vector<Vec2>{{{0, 0}}, {{1, 0}}, {{0, 1}}, {{0.5, 1}}},
      std::vector<NodeId>{NodeId(0), NodeId(1), NodeId(2), NodeId(0), NodeId(1), NodeId(3)});
  try {
    const OverlayMesh overlay(mesh, "target", 1);
    FAIL() << "expected an InputError";
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "triangle 1: target mesh: lies on the same side of an edge as triangle 0, "
                 "expected at most one "
                 "triangle on each side");
    EXPECT_EQ(e.place().element, 1);
  }
}

TEST(InsideMargin, IsPositiveInsideAndNegativeOutside) {
  const OverlayMesh mesh(test::grid_mesh(2, 3, 1.0, test::bend(0.2, 0.2)), "donor", 1);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const auto t = static_cast<std::int32_t>(e);
    const Vec2 inside = bernstein::evaluate<Vec2>(3, mesh.element(t), {0.2, 0.5, 0.3});
    EXPECT_NEAR(inside_margin(mesh, t, inside), 0.2, 1e-12);
    for (std::size_t other = 0; other < mesh.element_count(); ++other) {
      if (other != e) {
        EXPECT_LT(inside_margin(mesh, static_cast<std::int32_t>(other), inside), 0.0);
      }
    }
  }
}

}  // namespace
}  // namespace bezel::detail
