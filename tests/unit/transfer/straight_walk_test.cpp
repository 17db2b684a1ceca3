#include "bezel/transfer/straight_walk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/mesh/generate.hpp"
#include "bezel/transfer/numbering.hpp"
#include "bezel/transfer/overlay_mesh.hpp"
#include "support/meshes.hpp"
#include "support/simd_targets.hpp"

namespace bezel::detail {
namespace {

std::vector<std::shared_ptr<const TriangleMesh>> some_meshes() {
  GenerateOptions options;
  options.size = 0.15;
  return {std::make_shared<const TriangleMesh>(generate_annulus(0.4, 1.0, options)),
          // Walks to the farthest side go in circles here.
          test::grid_mesh(2, 1, 1.0, test::bend(0.15, -0.1)),
          test::grid_mesh(7, 1, 1.0, test::bend(0.2, 0.2))};
}

/// The triangle whose barycentric coordinates of p are all above clear_of_edges; -1: none.
std::int32_t holder(const OverlayMesh& mesh, const Vec2& p) {
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    if (inside_margin(mesh, static_cast<std::int32_t>(e), p) > clear_of_edges)
      return static_cast<std::int32_t>(e);
  return -1;
}

TEST(LocateStraight, FindsTheTriangleThatHoldsAPointOrNone) {
  RandomStream random("locate straight", 1);
  for (const auto& source : some_meshes()) {
    const OverlayMesh mesh(source, "donor", 1);
    const auto elements = straight_elements(mesh);
    for (const std::size_t count : {0U, 1U, 7U, 16U, 300U}) {
      std::vector<SoughtPoint> points(count);
      for (SoughtPoint& point : points) {
        // Also outside, on vertices and on edges.
        point.p = {{random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)}};
        if (random.below(8) == 0)
          point.p = mesh.corners(static_cast<std::int32_t>(random.below(mesh.element_count())))[0];
        if (random.below(8) == 0) {
          const auto edge = mesh.edge(static_cast<std::int32_t>(random.below(mesh.edge_count())));
          point.p = 0.5 * (edge[0] + edge[1]);
        }
        point.element = 12345;
      }
      const auto start = static_cast<std::int32_t>(random.below(mesh.element_count()));
      const std::int32_t last = locate_straight(elements, points, start);
      EXPECT_GE(last, 0);
      EXPECT_LT(last, static_cast<std::int32_t>(mesh.element_count()));
      std::size_t missed = 0;
      for (const SoughtPoint& point : points) {
        const std::int32_t expected = holder(mesh, point.p);
        if (point.element == -1) {
          missed += expected >= 0 ? 1 : 0;
        } else {
          EXPECT_EQ(point.element, expected);
        }
      }
      // Around a hole, outside or in circles.
      EXPECT_LE(missed, count / 3);
    }
  }
}

/// count walks from inside the mesh in any direction.
std::vector<StraightWalk> some_walks(const OverlayMesh& mesh,
                                     const std::vector<StraightElement>& elements, int count,
                                     RandomStream& random) {
  std::vector<StraightWalk> walks;
  while (walks.size() < static_cast<std::size_t>(count)) {
    StraightWalk walk{};
    walk.a = {{random.uniform(-1, 1), random.uniform(-1, 1)}};
    walk.d = Vec2{{random.uniform(-1, 1), random.uniform(-1, 1)}} - walk.a;
    const std::int32_t first = holder(mesh, walk.a);
    if (first < 0) continue;
    const auto& corner = elements[static_cast<std::size_t>(first)].corner;
    std::array<double, 3> beside{};
    for (std::size_t k = 0; k < 3; ++k) beside[k] = cross(walk.d, corner[k] - walk.a);
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t next = (k + 1) % 3;
      if (beside[k] >= 0.0 || beside[next] < 0.0) continue;
      walk.place = 4 * first + static_cast<std::int32_t>(k);
      walk.right = corner[k];
      walk.left = corner[next];
      walk.beside_right = beside[k];
      walk.beside_left = beside[next];
    }
    walks.push_back(walk);
  }
  return walks;
}

struct Met {
  double r, s;
  std::int32_t edge;
};

/// All donor edges that a + r d crosses, in order.
std::vector<Met> crossings(const OverlayMesh& mesh, const Vec2& a, const Vec2& d) {
  std::vector<Met> met;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const auto edge = mesh.edge(static_cast<std::int32_t>(e));
    const Vec2 along = edge[1] - edge[0];
    const double r = cross(edge[0] - a, along) / cross(d, along);
    const double s = cross(edge[0] - a, d) / cross(d, along);
    if (r > 0.0 && r < 1.0 && s > 0.0 && s < 1.0)
      met.push_back({r, s, static_cast<std::int32_t>(e)});
  }
  std::sort(met.begin(), met.end(), [](const Met& x, const Met& y) { return x.r < y.r; });
  return met;
}

TEST(WalkStraight, MeetsEveryEdgeOnTheWay) {
  RandomStream random("walk straight", 1);
  for (const auto& source : some_meshes()) {
    const OverlayMesh mesh(source, "donor", 1);
    const auto elements = straight_elements(mesh);
    for (const int count : {1, 5, 200}) {
      auto walks = some_walks(mesh, elements, count, random);
      Pile<WalkStep> steps;
      walk_straight(elements, mesh.element_edges, walks, steps);
      int ended = 0;
      for (const StraightWalk& walk : walks) {
        if (!walk.ended) continue;  // out of the mesh, or by a vertex
        ++ended;
        const auto expected = crossings(mesh, walk.a, walk.d);
        ASSERT_EQ(static_cast<std::size_t>(walk.steps), expected.size() + 1);
        EXPECT_LE(walk.gap_squared, 1e-28);
        for (std::size_t i = 0; i < expected.size(); ++i) {
          const WalkStep& step = steps[static_cast<std::size_t>(walk.first_step) +
                                       i * static_cast<std::size_t>(straight_stride)];
          EXPECT_EQ(step.donor_edge, expected[i].edge);
          EXPECT_NEAR(step.r, expected[i].r, 1e-11);
          EXPECT_NEAR(step.s, expected[i].s, 1e-11);
          const auto& sides = mesh.edge_sides[static_cast<std::size_t>(step.donor_edge)];
          EXPECT_EQ(sides[step.from_right != 0 ? 1 : 0], step.donor);
        }
        const WalkStep& last =
            steps[static_cast<std::size_t>(walk.first_step + (walk.steps - 1) * straight_stride)];
        EXPECT_GE(inside_margin(mesh, last.donor, walk.a + walk.d), 0.0);
      }
      if (count == 200) {
        EXPECT_GE(ended, 80);
      }
    }
  }
}

TEST(WalkStraight, HasTheSameBitsOnEveryTarget) {
  RandomStream random("walk straight on targets", 1);
  for (const auto& source : some_meshes()) {
    const OverlayMesh mesh(source, "donor", 1);
    const auto elements = straight_elements(mesh);
    const auto walks = some_walks(mesh, elements, 50, random);
    std::vector<double> expected;
    support::on_every_target([&] {
      auto own = walks;
      Pile<WalkStep> steps;
      walk_straight(elements, mesh.element_edges, own, steps);
      std::vector<SoughtPoint> points(own.size());
      for (std::size_t i = 0; i < own.size(); ++i) points[i].p = own[i].a + own[i].d;
      locate_straight(elements, points, 0);
      std::vector<double> found;
      for (std::size_t i = 0; i < own.size(); ++i) {
        found.push_back(static_cast<double>(points[i].element));
        found.push_back(own[i].ended ? own[i].gap_squared : -1.0);
        if (!own[i].ended) continue;
        for (std::int32_t k = 0; k < own[i].steps; ++k) {
          const WalkStep& step =
              steps[static_cast<std::size_t>(own[i].first_step + k * straight_stride)];
          found.insert(found.end(), {step.r, step.s, static_cast<double>(step.donor),
                                     static_cast<double>(step.donor_edge),
                                     static_cast<double>(step.from_right)});
        }
      }
      if (expected.empty()) expected = found;
      EXPECT_EQ(found, expected);
    });
  }
}

TEST(Numbering, NumbersInTheOrderOfMeeting) {
  Numbering numbers(5);
  for (int round = 0; round < 3; ++round) {
    numbers.begin();
    EXPECT_EQ(numbers.count(), 0U);
    for (std::int32_t i = -1; i < 5; ++i) EXPECT_FALSE(numbers.knows(i));
    EXPECT_EQ(numbers.take(3), 0U);
    {
      Numbering::Taker taker(numbers);
      EXPECT_EQ(taker.take(-1), 1U);
      EXPECT_EQ(taker.take(3), 0U);
      EXPECT_EQ(taker.take(4), 2U);
      EXPECT_EQ(taker.count(), 3U);
    }
    EXPECT_EQ(numbers.count(), 3U);
    EXPECT_EQ(numbers.number(4), 2U);
    numbers.mark(0, 0);  // known, not counted
    EXPECT_TRUE(numbers.knows(0));
    EXPECT_FALSE(numbers.knows(1));
    EXPECT_EQ(numbers.take(2), 3U);
  }
}

}  // namespace
}  // namespace bezel::detail
