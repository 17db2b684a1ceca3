#include "bezel/transfer/element_transfer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "support/mesh_pairs.hpp"
#include "support/meshes.hpp"

namespace bezel::detail {
namespace {

struct Pair {
  Pair(const std::shared_ptr<const TriangleMesh>& a, const std::shared_ptr<const TriangleMesh>& b)
      : donor(a, "donor", 1),
        target(b, "target", 1),
        search(donor),
        overlay(donor, target, search) {
    overlay.begin_chunk();
  }
  OverlayMesh donor, target;
  FrontSearch search;
  ElementOverlay overlay;
  OverlayCounts counts;
};

TEST(ElementTransfer, WithoutFieldsItMeasuresAreas) {
  Pair pair(test::grid_mesh(4, 2, 1.0, test::bend(0.15, 0.1)),
            test::grid_mesh(3, 3, 0.7, test::bend(0.1, 0.1)));
  ElementTransfer element(pair.donor, pair.target, pair.search, {}, Uncovered::error);
  for (std::size_t t = 0; t < pair.target.element_count(); ++t) {
    GivenList given;
    const auto id = static_cast<std::int32_t>(t);
    OverlayList list;
    pair.overlay.add(id, list, pair.counts);
    const ElementOutcome outcome = element.process(id, list[0], given, {});
    EXPECT_FALSE(outcome.inconsistent);
    EXPECT_EQ(outcome.pairs, static_cast<std::int32_t>(given.donor.size()));
    EXPECT_NEAR(std::accumulate(given.area.begin(), given.area.end(), 0.0),
                pair.target.element_area[t], 1e-15);
    EXPECT_LE(std::abs(outcome.uncovered_area), 1e-15);
  }
}

TEST(ElementTransfer, APieceThatIsMissingIsNoticed) {
  Pair pair(test::grid_mesh(4, 2, 1.0, test::bend(0.15, 0.1)),
            test::grid_mesh(3, 2, 0.7, test::bend(0.1, 0.1)));
  ElementTransfer element(pair.donor, pair.target, pair.search, {}, Uncovered::error);
  OverlayList list;
  pair.overlay.add(4, list, pair.counts);
  ASSERT_GT(list.pieces.size(), 4U);
  for (std::size_t left_out = 0; left_out < list.pieces.size(); ++left_out) {
    std::vector<BoundaryPiece> broken(list.pieces.begin(), list.pieces.end());
    broken.erase(broken.begin() + static_cast<std::ptrdiff_t>(left_out));
    GivenList given;
    EXPECT_TRUE(element.process(4, {list.donors, broken, {}}, given, {}).inconsistent)
        << "without piece " << left_out;
  }
}

// Thin elements, elements far from the origin, and edges that nearly coincide: joints are open by
// the coincidence distance there, which must not hide a piece that is missing.
TEST(ElementTransfer, APieceThatIsMissingIsNoticedWhereJointsAreOpen) {
  const auto base = test::grid_mesh(2, 2, 1.0, test::bend(0.15, 0.1));
  struct Case {
    double flat, shear;
    Vec2 shift;
  };
  for (const Case& c : {Case{1.0, 1e-13, {}}, Case{1e-6, 1e-8, {}}, Case{1e-6, 1e-3, {}},
                        Case{1.0, 1e-9, {{3e5, -1e6}}}, Case{1.0, 0.3, {{3e5, -1e6}}}}) {
    const auto moved = [&](double shear) {
      return test::with_control(base, [&](const Vec2& p, std::size_t) {
        return Vec2{{p[0] + shear * p[1], c.flat * p[1]}} + c.shift;
      });
    };
    Pair pair(moved(0.0), moved(c.shear));
    ElementTransfer element(pair.donor, pair.target, pair.search, {}, Uncovered::error);
    int tried = 0;
    for (std::int32_t t = 0; t < static_cast<std::int32_t>(pair.target.element_count()); ++t) {
      OverlayList list;
      pair.overlay.add(t, list, pair.counts);
      GivenList given;
      ASSERT_FALSE(element.process(t, list[0], given, {}).inconsistent) << c.flat << " " << c.shear;
      for (std::size_t left_out = 0; left_out < list.segments.size(); ++left_out) {
        std::vector<Segment> broken(list.segments.begin(), list.segments.end());
        const Segment& gone = list.segments[left_out];
        const Part& part = gone.target.edge < 0 ? gone.source : gone.target;
        if (std::abs(part.to - part.from) < 1e-5) continue;
        broken.erase(broken.begin() + static_cast<std::ptrdiff_t>(left_out));
        std::vector<std::int32_t> donors;
        for (const Segment& s : broken)
          if (donors.empty() || donors.back() != s.donor) donors.push_back(s.donor);
        EXPECT_TRUE(element.process(t, {donors, {}, broken}, given, {}).inconsistent)
            << c.flat << " " << c.shear << " without piece " << left_out << " of " << t;
        ++tried;
      }
    }
    EXPECT_GE(tried, 24);
  }
}

TEST(ElementTransfer, APieceGivenToTheWrongElementIsNoticed) {
  Pair pair(test::grid_mesh(4, 2, 1.0, test::bend(0.15, 0.1)),
            test::grid_mesh(3, 2, 0.7, test::bend(0.1, 0.1)));
  ElementTransfer element(pair.donor, pair.target, pair.search, {}, Uncovered::error);
  OverlayList list;
  pair.overlay.add(4, list, pair.counts);
  ASSERT_GT(list.donors.size(), 1U);
  std::vector<BoundaryPiece> broken(list.pieces.begin(), list.pieces.end());
  broken[0].left = broken[0].left == 0 ? 1 : 0;
  GivenList given;
  const ElementOutcome outcome = element.process(4, {list.donors, broken, {}}, given, {});
  EXPECT_TRUE(outcome.inconsistent);
  EXPECT_GT(outcome.max_joint_gap, 1e-3);
}

}  // namespace
}  // namespace bezel::detail
