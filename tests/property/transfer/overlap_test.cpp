// The areas of all pairs against a method that shares nothing with the overlay, and meshes that
// nearly coincide.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "bezel/geometry/triangle.hpp"
#include "bezel/mesh/generate.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::bend;
using test::grid_mesh;
using test::turn;

using Polygon = std::vector<Vec2>;

double polygon_area(const Polygon& p) {
  double twice = 0.0;
  for (std::size_t i = 2; i < p.size(); ++i) twice += cross(p[i - 1] - p[0], p[i] - p[0]);
  return 0.5 * twice;
}

/// Sutherland-Hodgman: a convex polygon cut by a counter-clockwise triangle.
double clipped_area(const std::array<Vec2, 3>& a, const std::array<Vec2, 3>& b) {
  Polygon p(a.begin(), a.end());
  for (std::size_t k = 0; k < 3 && !p.empty(); ++k) {
    const Vec2 from = b[k];
    const Vec2 along = b[(k + 1) % 3] - from;
    Polygon kept;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec2 s = p[i];
      const Vec2 e = p[(i + 1) % p.size()];
      const double ds = cross(along, s - from);
      const double de = cross(along, e - from);
      if (ds >= 0.0) kept.push_back(s);
      if ((ds > 0.0 && de < 0.0) || (ds < 0.0 && de > 0.0))
        kept.push_back(s + (e - s) * (ds / (ds - de)));
    }
    p = std::move(kept);
  }
  return polygon_area(p);
}

/// An element as n^2 straight triangles.
std::vector<std::array<Vec2, 3>> facets(const TriangleMesh& mesh, ElementId e, int n) {
  const auto control = mesh.gather(e);
  const auto at = [&](int j, int k) {
    return bernstein::evaluate<Vec2>(mesh.degree(), control,
                                     {(n - j - k) / static_cast<double>(n),
                                      j / static_cast<double>(n), k / static_cast<double>(n)});
  };
  std::vector<std::array<Vec2, 3>> out;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j + k < n; ++j) {
      out.push_back({at(j, k), at(j + 1, k), at(j, k + 1)});
      if (j + k + 1 < n) out.push_back({at(j + 1, k), at(j + 1, k + 1), at(j, k + 1)});
    }
  }
  return out;
}

Box2 box_of(const std::array<Vec2, 3>& t) {
  Box2 b;
  for (const Vec2& p : t) b.include(p);
  return b;
}

double faceted_area(const std::vector<std::array<Vec2, 3>>& a,
                    const std::vector<std::array<Vec2, 3>>& b) {
  double sum = 0.0;
  for (const auto& s : a) {
    const Box2 box = box_of(s);
    for (const auto& t : b) {
      if (box.overlaps(box_of(t))) sum += clipped_area(s, t);
    }
  }
  return sum;
}

std::map<std::pair<int, int>, double> areas_of(const std::shared_ptr<const TriangleMesh>& donor,
                                               const std::shared_ptr<const TriangleMesh>& target) {
  std::map<std::pair<int, int>, double> areas;
  for (const OverlapArea& pair : overlap_areas(donor, target)) {
    EXPECT_TRUE(areas.emplace(std::pair(pair.target.value, pair.donor.value), pair.area).second);
  }
  return areas;
}

TEST(OverlapAreas, StraightMeshesEqualPolygonClipping) {
  for (int seed = 0; seed < 3; ++seed) {
    const auto donor = grid_mesh(6, 1, 1.0, bend(0.15 + 0.02 * seed, 0.12));
    const auto target = grid_mesh(7, 1, 1.0, turn(0.3 + seed, 0.65, bend(0.1, -0.15)));
    const auto areas = areas_of(donor, target);
    std::size_t positive = 0;
    for (std::size_t t = 0; t < target->element_count(); ++t) {
      for (std::size_t d = 0; d < donor->element_count(); ++d) {
        const double clipped =
            clipped_area(facets(*target, ElementId(t), 1)[0], facets(*donor, ElementId(d), 1)[0]);
        const auto found = areas.find({static_cast<int>(t), static_cast<int>(d)});
        EXPECT_NEAR(found == areas.end() ? 0.0 : found->second, clipped, 1e-15) << t << " " << d;
        positive += clipped > 1e-14 ? 1U : 0U;
      }
    }
    EXPECT_GT(positive, 200U);
  }
}

TEST(OverlapAreas, CurvedMeshesApproachFacets) {
  for (int g = 2; g <= 4; ++g) {
    const auto donor = grid_mesh(2, g, 1.0, bend(0.25, 0.2));
    const auto target = grid_mesh(2, g, 1.0, turn(0.4, 0.65, bend(0.2, -0.25)));
    const auto areas = areas_of(donor, target);
    double total = 0.0;
    for (std::size_t t = 0; t < target->element_count(); ++t) {
      for (std::size_t d = 0; d < donor->element_count(); ++d) {
        const auto found = areas.find({static_cast<int>(t), static_cast<int>(d)});
        const double exact = found == areas.end() ? 0.0 : found->second;
        std::array<double, 2> error{};
        for (std::size_t i = 0; i < 2; ++i) {
          const int n = i == 0 ? 12 : 24;
          error[i] = std::abs(
              faceted_area(facets(*target, ElementId(t), n), facets(*donor, ElementId(d), n)) -
              exact);
        }
        // The facets' error is c / n^2 with |c| below curvature times perimeter.
        EXPECT_LE(error[1], 2e-3 / 4) << g << " " << t << " " << d;
        EXPECT_LE(error[1], 0.4 * error[0] + 2e-5) << g << " " << t << " " << d;
        total += exact;
      }
    }
    double target_area = 0.0;
    for (std::size_t t = 0; t < target->element_count(); ++t)
      target_area += area(g, target->gather(ElementId(t)));
    EXPECT_NEAR(total, target_area, 1e-13);
  }
}

TEST(OverlapAreas, OfElementsMuchSmallerThanTheOthersAreTheirOwn) {
  for (const int g : {1, 3}) {
    const auto small = grid_mesh(100, g, 1.0, bend(0.1, 0.1));
    const auto large = grid_mesh(1, g, 0.7, bend(0.1, 0.1));
    std::map<int, double> area_in;
    for (const OverlapArea& pair : overlap_areas(small, large))
      area_in[pair.donor.value] += pair.area;
    for (const auto& [d, found] : area_in) {
      const Box2 box = small->box(ElementId(d));
      if (std::max({-box.lo[0], -box.lo[1], box.hi[0], box.hi[1]}) > 0.5) continue;
      const double own = area(g, small->gather(ElementId(d)));
      EXPECT_NEAR(found / own, 1.0, 1e-13) << g << " " << d;
    }
    EXPECT_GT(area_in.size(), 4000U);
  }
}

TEST(OverlapAreas, SwappingTheMeshesSwapsThePairs) {
  const auto a = grid_mesh(5, 3, 1.0, bend(0.15, 0.12));
  const auto b = grid_mesh(6, 2, 1.0, bend(-0.1, 0.2));
  const auto ab = areas_of(a, b);
  const auto ba = areas_of(b, a);
  for (const auto& [pair, area] : ab) {
    const auto found = ba.find({pair.second, pair.first});
    EXPECT_NEAR(found == ba.end() ? 0.0 : found->second, area, 1e-15);
  }
}

// Every control point moved by a random amount between 1e-17 and 3 % of an element, or all by the
// same: the two meshes' edges run along each other, cross at tiny angles, or coincide to rounding.
class Jitter : public ::testing::TestWithParam<int> {};

TEST_P(Jitter, NothingIsLost) {
  const int g = GetParam();
  for (int k = 1; k <= 17; ++k) {
    for (int kind = 0; kind < 3; ++kind) {
      const double size = (k == 1 ? 0.03 : std::pow(10.0, -k)) * 0.5 / g;
      const auto donor = grid_mesh(4, g, 1.0, bend(0.1, 0.12));
      std::vector<Vec2> control(donor->control().begin(), donor->control().end());
      RandomStream random("jitter", static_cast<std::uint64_t>(100 * k + 10 * kind + g));
      for (Vec2& p : control) {
        const bool boundary = std::max(std::abs(p[0]), std::abs(p[1])) > 1.0 - 1e-12;
        Vec2 step{{random.uniform(-1, 1) * size, random.uniform(-1, 1) * size}};
        if (kind == 1) step = Vec2{{0.7 * size, 0.3 * size}};  // a translation
        if (kind == 0 && boundary) step = Vec2{};              // the same domain
        p += step;
      }
      const auto target = std::make_shared<const TriangleMesh>(
          g, control,
          std::vector<NodeId>(donor->connectivity().begin(), donor->connectivity().end()));
      const Basis basis = k % 2 == 0 ? Basis::physical : Basis::reference;
      const auto space = Space::discontinuous(donor, g, basis);
      const Formula constant("3.25");
      std::vector<double> checks(space->coefficient_count());
      for (std::size_t e = 0; e < donor->element_count(); ++e) {
        for (int i = 0; i < bernstein::triangle_size(g); ++i) {
          checks[space->offset(ElementId(e)) + static_cast<std::size_t>(i)] =
              e % 3 == 0 ? 1.0 : 0.0;
        }
      }
      const std::vector<Field> fields = {sample("constant", space, {&constant, 1}),
                                         Field("checks", space, checks)};
      TransferOptions options;
      options.uncovered = Uncovered::extend;
      const TransferResult result = transfer(fields, target, options);
      const std::string where =
          "g " + std::to_string(g) + " k " + std::to_string(k) + " kind " + std::to_string(kind);
      EXPECT_LE(error_norms(result.fields[0], {&constant, 1}).max, 3.25 * 1e-13) << where;
      EXPECT_LE(result.report.max_partition_residual, 1e-14) << where;
      EXPECT_LE(result.report.max_joint_gap, 1e-11) << where;
      EXPECT_EQ(result.report.unresolved, 0) << where;
      for (const FieldReport& f : result.report.fields)
        EXPECT_LE(f.relative_mass_defect, 1e-14) << where;
      if (k < 13) continue;
      // The same mesh to rounding: the field must come back, jumps and all.
      for (std::size_t e = 0; e < donor->element_count(); ++e) {
        double before = 0.0;
        double after = 0.0;
        fields[1].evaluate(ElementId(e), {0.3, 0.3, 0.4}, {&before, 1});
        result.fields[1].evaluate(ElementId(e), {0.3, 0.3, 0.4}, {&after, 1});
        EXPECT_NEAR(after, before, 1e-10) << where;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Degrees, Jitter, ::testing::Values(1, 2, 3, 4));

TEST(SizeRatios, OneElementOverThousandsAndBack) {
  for (const int g : {1, 2}) {
    for (const Basis basis : {Basis::reference, Basis::physical}) {
      const auto large = grid_mesh(1, g, 1.0, bend(0.1, 0.1));
      const auto small = grid_mesh(40, g, 1.0, bend(0.1, 0.1));
      const Formula constant("1");
      for (const bool down : {true, false}) {
        const auto& donor = down ? large : small;
        const auto& target = down ? small : large;
        const Field f = sample("c", Space::discontinuous(donor, 3, basis), {&constant, 1});
        TransferOptions options;
        options.uncovered = Uncovered::extend;
        const TransferResult result = transfer({&f, 1}, target, options);
        EXPECT_LE(error_norms(result.fields[0], {&constant, 1}).max, 1e-12);
        EXPECT_LE(result.report.fields[0].relative_mass_defect, 1e-13);
        EXPECT_LE(result.report.max_partition_residual, 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace bezel
