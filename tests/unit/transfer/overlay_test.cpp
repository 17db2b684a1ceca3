#include "bezel/transfer/overlay.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bezel/bernstein/interval.hpp"
#include "bezel/mesh/generate.hpp"
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

TEST(ElementOverlay, AMeshOntoItselfHasNothingButItsEdges) {
  for (int g = 1; g <= 3; ++g) {
    const auto mesh = test::grid_mesh(4, g, 1.0, test::bend(0.15, 0.12));
    const OverlayMesh donor(mesh, "donor", 1);
    const OverlayMesh target(std::make_shared<const TriangleMesh>(*mesh), "target", 1);
    const FrontSearch search(donor);
    ElementOverlay overlay(donor, target, search);
    overlay.begin_chunk();
    OverlayCounts counts;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(target.element_count()); ++t) {
      const auto segments = segments_of(overlay, t, counts);
      ASSERT_EQ(segments.size(), 3U);
      for (const Segment& s : segments) {
        EXPECT_EQ(s.donor, t);
        EXPECT_EQ(s.source.edge, s.target.edge);
        EXPECT_EQ(s.source.from, s.target.from);
      }
    }
    EXPECT_EQ(counts.overlaps, static_cast<std::int64_t>(mesh->edge_count()));
    EXPECT_EQ(counts.max_joint_gap, 0.0);
  }
}

std::vector<std::int32_t> donors_of(ElementOverlay& overlay, std::int32_t t) {
  OverlayList list;
  OverlayCounts counts;
  overlay.add(t, list, counts);
  return {list[0].donors.begin(), list[0].donors.end()};
}

// Vertices on donor edges, and donor vertices on target edges.
TEST(ElementOverlay, AMeshAndItsRefinementsHaveWholeElementsInCommon) {
  for (int g = 1; g <= 4; ++g) {
    const auto coarse = test::grid_mesh(4, g, 1.0, test::bend(0.15, 0.12));
    auto fine = std::make_shared<const TriangleMesh>(refine_uniform(*coarse));
    for (std::size_t parts = 4; parts <= 16; parts *= 4) {
      expect_closed(coarse, fine);
      expect_closed(fine, coarse);
      const OverlayMesh large(coarse, "donor", 1), small(fine, "target", 1);
      const FrontSearch in_large(large), in_small(small);
      ElementOverlay down(large, small, in_large), up(small, large, in_small);
      down.begin_chunk();
      up.begin_chunk();
      std::vector<std::size_t> found(large.element_count(), 0);
      for (std::int32_t t = 0; t < static_cast<std::int32_t>(small.element_count()); ++t) {
        const auto donors = donors_of(down, t);
        ASSERT_EQ(donors.size(), 1U) << "element " << t << " of degree " << g;
        ASSERT_GE(donors[0], 0);
        ++found[static_cast<std::size_t>(donors[0])];
      }
      for (std::size_t t = 0; t < found.size(); ++t) {
        EXPECT_EQ(found[t], parts);
        EXPECT_EQ(donors_of(up, static_cast<std::int32_t>(t)).size(), parts);
      }
      fine = std::make_shared<const TriangleMesh>(refine_uniform(*fine));
    }
  }
}

// Donor edges that end on a target edge's vertex, pass through one and go on inside an element.
TEST(ElementOverlay, PiecesCloseWhereVerticesLieOnEdges) {
  for (const auto& place : {test::PlaneMap(test::same_place), test::bend(0.15, 0.12)}) {
    const auto donor = test::grid_mesh(4, 1, 1.0, test::same_place);
    for (const int n : {2, 3, 6, 8}) {
      expect_closed(donor, test::grid_mesh(n, 1, 1.0, place));
      expect_closed(donor, test::grid_mesh(n, 1, 0.75, place));
      expect_closed(test::grid_mesh(n, 1, 1.0, place), donor);
    }
  }
}

// Two donor edges in one place, with nothing between them: each has one of the target's elements.
TEST(ElementOverlay, TheSidesOfASlitAreToldApart) {
  const auto square = [](bool slit) {
    std::vector<Vec2> p = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
    if (slit) p.insert(p.end(), {p[0], p[2]});
    const std::vector<int> nodes =
        slit ? std::vector<int>{0, 1, 2, 4, 5, 3} : std::vector<int>{0, 1, 2, 0, 2, 3};
    std::vector<NodeId> ids;
    for (const int n : nodes) ids.push_back(NodeId(n));
    return std::make_shared<const TriangleMesh>(1, p, ids);
  };
  const OverlayMesh donor(square(true), "donor", 1), target(square(false), "target", 1);
  const FrontSearch search(donor);
  ElementOverlay overlay(donor, target, search);
  overlay.begin_chunk();
  OverlayCounts counts;
  for (std::int32_t t = 0; t < 2; ++t) {
    const auto segments = segments_of(overlay, t, counts);
    ASSERT_EQ(segments.size(), 3U);
    for (const Segment& s : segments) EXPECT_EQ(s.donor, t);
  }
}

// What is found does not depend on which edges are looked for together.
TEST(ElementOverlay, ChunksGiveTheSamePieces) {
  const OverlayMesh donor(test::grid_mesh(9, 1, 1.0, test::bend(0.15, 0.12)), "donor", 1);
  const OverlayMesh target(test::grid_mesh(7, 1, 1.0, test::turn(0.3, 0.7, test::bend(0.1, -0.15))),
                           "target", 1);
  const FrontSearch search(donor);
  ElementOverlay alone(donor, target, search), together(donor, target, search);
  std::vector<std::int32_t> elements(target.element_count());
  for (std::size_t t = 0; t < elements.size(); ++t) elements[t] = static_cast<std::int32_t>(t);
  OverlayCounts counts, counts_together;
  OverlayList list, list_together;
  alone.begin_chunk();
  for (auto t = elements.rbegin(); t != elements.rend(); ++t) alone.add(*t, list, counts);
  together.begin_chunk(elements);
  for (const std::int32_t t : elements) together.add(t, list_together, counts_together);
  EXPECT_EQ(counts.crossings, counts_together.crossings);
  EXPECT_EQ(counts.max_joint_gap, counts_together.max_joint_gap);
  for (std::size_t t = 0; t < elements.size(); ++t) {
    std::vector<Segment> a, b;
    collect_segments(list[elements.size() - 1 - t], a);
    collect_segments(list_together[t], b);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].donor, b[i].donor);
      EXPECT_EQ(a[i].target.edge, b[i].target.edge);
      EXPECT_EQ(a[i].target.from, b[i].target.from);
      EXPECT_EQ(a[i].source.edge, b[i].source.edge);
      EXPECT_EQ(a[i].source.to, b[i].source.to);
    }
  }
}

// Region by region, each in the order of the pieces, which run with the region on their left.
TEST(Overlay, SegmentsComeByRegion) {
  const std::vector<std::int32_t> donors = {7, exterior, 3, 5};
  const std::vector<BoundaryPiece> pieces = {{{10, 0.0, 0.5}, false, 1, -1},
                                             {{20, 0.0, 1.0}, true, 0, 2},
                                             {{11, 0.25, 0.75}, false, 2, -1},
                                             {{21, 0.5, 1.0}, true, 2, 1},
                                             {{22, 0.0, 1.0}, true, 0, 0}};
  std::vector<Segment> segments;
  collect_segments({donors, pieces, {}}, segments);
  struct Expected {
    std::int32_t donor, target, source;
    double from, to;
  };
  const std::vector<Expected> expected = {
      {7, -1, 20, 0.0, 1.0},        {7, -1, 22, 0.0, 1.0}, {exterior, 10, -1, 0.0, 0.5},
      {exterior, -1, 21, 1.0, 0.5}, {3, -1, 20, 1.0, 0.0}, {3, 11, -1, 0.25, 0.75},
      {3, -1, 21, 0.5, 1.0}};
  ASSERT_EQ(segments.size(), expected.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const Part& part = expected[i].target >= 0 ? segments[i].target : segments[i].source;
    EXPECT_EQ(segments[i].donor, expected[i].donor) << i;
    EXPECT_EQ(segments[i].target.edge, expected[i].target) << i;
    EXPECT_EQ(segments[i].source.edge, expected[i].source) << i;
    EXPECT_EQ(part.from, expected[i].from) << i;
    EXPECT_EQ(part.to, expected[i].to) << i;
  }
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
