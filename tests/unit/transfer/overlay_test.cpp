#include "bezel/transfer/overlay.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bezel/bernstein/interval.hpp"
#include "support/meshes.hpp"

namespace bezel::detail {
namespace {

Vec2 end_of(const OverlayMesh& donor, const OverlayMesh& target, const Segment& s, bool from) {
  const bool source = s.target.edge < 0;
  const Part& part = source ? s.source : s.target;
  return curve_point((source ? donor : target).edge(part.edge), from ? part.from : part.to);
}

std::vector<Segment> segments_of(ElementOverlay& overlay, std::int32_t t, OverlayCounts& counts) {
  OverlayList list;
  overlay.add(t, list, counts);
  std::vector<Segment> segments;
  collect_segments(list[0], segments);
  return segments;
}

/// Every T n D of two meshes has a closed boundary, and the pieces of each target edge make up the
/// edge.
void expect_closed(const std::shared_ptr<const TriangleMesh>& a,
                   const std::shared_ptr<const TriangleMesh>& b) {
  const OverlayMesh donor(a, "donor", 1);
  const OverlayMesh target(b, "target", 1);
  const FrontSearch search(donor);
  ElementOverlay overlay(donor, target, search);
  overlay.begin_chunk();
  OverlayCounts counts;
  for (std::size_t t = 0; t < target.element_count(); ++t) {
    const auto segments = segments_of(overlay, static_cast<std::int32_t>(t), counts);
    std::array<double, 3> covered{};
    for (std::size_t begin = 0; begin < segments.size();) {
      Vec2 sum;
      std::size_t end = begin;
      for (; end < segments.size() && segments[end].donor == segments[begin].donor; ++end) {
        sum += end_of(donor, target, segments[end], false) -
               end_of(donor, target, segments[end], true);
        for (std::size_t k = 0; k < 3; ++k) {
          if (segments[end].target.edge == target.element_edges[t][k].edge.value) {
            covered[k] += std::abs(segments[end].target.to - segments[end].target.from);
          }
        }
      }
      EXPECT_LE(norm(sum), 1e-13) << "target " << t << " donor " << segments[begin].donor;
      begin = end;
    }
    for (const double c : covered) EXPECT_NEAR(c, 1.0, 1e-15);
  }
  EXPECT_EQ(counts.unresolved, 0);
}

TEST(ElementOverlay, PiecesClose) {
  for (int g = 1; g <= 4; ++g) {
    expect_closed(test::grid_mesh(5, g, 1.0, test::bend(0.15, 0.12)),
                  test::grid_mesh(6, g, 1.0, test::turn(0.3, 0.7, test::bend(0.1, -0.15))));
  }
}

TEST(ElementOverlay, PiecesCloseOnSharedEdges) {
  const auto coarse = test::grid_mesh(3, 2, 1.0, test::bend(0.15, 0.12));
  const auto twin = std::make_shared<const TriangleMesh>(*coarse);
  expect_closed(coarse, twin);
  expect_closed(coarse, test::grid_mesh(6, 2, 1.0, test::same_place));
}

TEST(ElementOverlay, IdenticalTrianglesShareTheirSidesOnly) {
  const auto mesh =
      std::make_shared<const TriangleMesh>(1, std::vector<Vec2>{{{0, 0}}, {{1, 0}}, {{0, 1}}},
                                           std::vector<NodeId>{NodeId(0), NodeId(1), NodeId(2)});
  const OverlayMesh donor(mesh, "donor", 1);
  const OverlayMesh target(std::make_shared<const TriangleMesh>(*mesh), "target", 1);
  const FrontSearch search(donor);
  ElementOverlay overlay(donor, target, search);
  overlay.begin_chunk();
  OverlayCounts counts;
  const auto segments = segments_of(overlay, 0, counts);
  ASSERT_EQ(segments.size(), 3U);
  for (const Segment& s : segments) {
    EXPECT_EQ(s.donor, 0);
    EXPECT_GE(s.target.edge, 0);
    EXPECT_GE(s.source.edge, 0);
  }
  EXPECT_EQ(counts.overlaps, 3);
}

TEST(CurvePoint, EqualsTheDefinition) {
  RandomStream random("curve point", 1);
  for (std::size_t n = 2; n <= 11; ++n) {
    std::vector<Vec2> c(n);
    for (Vec2& p : c) p = Vec2{{random.uniform(-1, 1), random.uniform(-1, 1)}};
    const double t = random.uniform();
    const auto [p, d] = edge_point(c, t);
    const Vec2 q = bernstein::evaluate<Vec2>(c, t);
    const Vec2 e = bernstein::evaluate_derivative<Vec2>(c, t);
    EXPECT_LE(norm(p - q), 1e-15);
    EXPECT_LE(norm(d - e), 1e-13);
    EXPECT_EQ(curve_point(c, 0.0), c.front());
    EXPECT_EQ(curve_point(c, 1.0), c.back());
  }
}

}  // namespace
}  // namespace bezel::detail
