// Mass, constants and coverage on pairs of meshes that are hard for an overlay, at every degree.

#include "property/transfer/robust_checks.hpp"

namespace bezel::test {
namespace {

class EveryDegree : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Geometry, EveryDegree, ::testing::Values(1, 2, 3, 4, 5));

TEST_P(EveryDegree, SharedBoundary) {
  const int g = GetParam();
  const auto donor = grid_mesh(3, g, 1.0, bend(0.15, -0.1));
  const auto target = grid_mesh(2, 1 + g % 5, 1.0, bend(-0.1, 0.12));
  expect_kept(donor, target, 1, 2, "shared boundary");
  if (g <= 3) expect_kept(donor, target, 4, 3, "shared boundary");
}

TEST_P(EveryDegree, ToItself) {
  const auto mesh = grid_mesh(2, GetParam(), 1.0, bend(0.15, -0.1));
  for (const int p : {0, 3}) expect_kept(mesh, mesh, p, p, "itself");
}

TEST_P(EveryDegree, ToRefinementsAndBack) {
  const auto coarse = grid_mesh(2, GetParam(), 1.0, bend(0.15, -0.1));
  const auto once = std::make_shared<const TriangleMesh>(refine_uniform(*coarse));
  expect_kept_both_ways(coarse, once, "once");
  expect_kept_both_ways(coarse, std::make_shared<const TriangleMesh>(refine_uniform(*once)),
                        "twice");
}

TEST_P(EveryDegree, HangingVertices) {
  const auto coarse = grid_mesh(2, GetParam(), 1.0, bend(0.15, -0.1));
  const auto local = locally_refined(coarse);
  ASSERT_EQ(local->element_count(), 17U);
  expect_kept(local, local, 1, 1, "hanging, itself");
  expect_kept_both_ways(coarse, local, "hanging");
  expect_kept_both_ways(grid_mesh(3, 2, 1.0, bend(-0.1, 0.1)), local, "hanging, others");
  if (GetParam() > 3) return;
  const auto twice = locally_refined(local);  // chains of hanging vertices
  ASSERT_EQ(twice->element_count(), 35U);
  expect_kept_both_ways(twice, local, "hanging, twice");
  expect_kept_both_ways(twice, grid_mesh(3, 2, 1.0, bend(-0.1, 0.1)), "hanging twice, others");
}

TEST_P(EveryDegree, SameCurvesWrittenOtherwise) {
  const auto mesh = grid_mesh(2, GetParam(), 1.0, bend(0.15, -0.1));
  expect_kept_both_ways(mesh, raised(mesh, 1), "raised");
  if (GetParam() > 2) return;  // the degree doubles
  RandomStream random("same curves", 3);
  expect_kept_both_ways(mesh, reparametrised(mesh, 0.3, random), "reparametrised");
}

TEST_P(EveryDegree, SizeRatioAThousand) {
  const int g = GetParam();
  const auto large = grid_mesh(2, g, 1.0, bend(0.15, -0.1));
  for (const Vec2& at : {Vec2{{0.31, 0.17}}, large->control(large->nodes(ElementId(0))[0])}) {
    const auto small = stretched(grid_mesh(2, g, 1.0, bend(0.1, 0.1)), 1e-3, 1e-3, at);
    expect_kept(large, small, 2, 2, "down", 10.0);
  }
}

TEST_P(EveryDegree, AspectRatioAMillion) {
  const int g = GetParam();
  const auto flat = stretched(grid_mesh(3, g, 1.0, bend(0.1, 0.1)), 1.0, 1e-6);
  const auto other = stretched(grid_mesh(2, g, 1.0, bend(-0.1, 0.1)), 1.0, 1e-6);
  expect_kept_both_ways(flat, other, "both flat");
}

// Rows and columns of width 1e-6 between ordinary ones: coordinates are rounded to 1e-10 of that.
TEST(Robust, ThinRowsOfElements) {
  const auto squeeze = [](double x) {
    const double off = std::abs(x);
    return off <= 0.5 ? 2e-6 * x : std::copysign(1e-6 + (2.0 * off - 1.0) * (1.0 - 1e-6), x);
  };
  for (const int g : {1, 2}) {
    const auto thin = grid_mesh(4, g, 1.0, [&](const Vec2& p) {
      return Vec2{{squeeze(p[0]), p[1]}};
    });
    const auto crossed = grid_mesh(4, g, 1.0, [&](const Vec2& p) {
      return Vec2{{p[0], squeeze(p[1])}};
    });
    const auto ordinary = grid_mesh(3, 2, 1.0, bend(0.1, 0.1));
    for (const auto& [from, to] : {std::pair(0, 1), std::pair(2, 2), std::pair(3, 3)}) {
      expect_kept(thin, crossed, from, to, "crossed", 1e3);
      expect_kept(thin, ordinary, from, to, "thin to ordinary", 1e3);
      expect_kept(ordinary, thin, from, to, "ordinary to thin", 1e3);
    }
  }
}

TEST(Robust, OneElementOverManyAndBack) {
  for (const int g : {1, 3}) {
    expect_kept_both_ways(grid_mesh(1, g, 1.0, bend(0.1, 0.1)),
                          grid_mesh(8, g, 1.0, bend(0.1, 0.1)), "many");
  }
}

TEST(Robust, SeveralPartsAndHoles) {
  GenerateOptions options;
  options.degree = 2;
  options.size = 0.5;
  const auto ring = std::make_shared<const TriangleMesh>(generate_annulus(0.4, 1.0, options));
  options.size = 0.35;
  options.seed = 2;
  const auto other = std::make_shared<const TriangleMesh>(generate_annulus(0.4, 1.0, options));
  expect_kept_both_ways(ring, other, "rings");
  const auto two = joined(stretched(grid_mesh(2, 2, 1.0, same_place), 1, 1, {{-1.5, 0}}),
                          stretched(grid_mesh(2, 2, 1.0, same_place), 1, 1, {{1.5, 0}}));
  const auto three =
      joined(stretched(grid_mesh(1, 2, 1.0, same_place), 0.7, 1, {{-1.5, 0}}),
             joined(stretched(grid_mesh(2, 2, 1.0, same_place), 0.3, 0.9, {{1.1, 0}}),
                    stretched(grid_mesh(2, 2, 1.0, bend(0.1, 0.1)), 0.3, 0.9, {{1.9, 0}})));
  expect_kept_both_ways(two, three, "parts");
  expect_kept_both_ways(two, ring, "parts and ring");
}

TEST(Robust, DegreesThatVaryFromElementToElement) {
  const auto donor = grid_mesh(3, 2, 1.0, bend(0.15, -0.1));
  const auto target = grid_mesh(2, 3, 1.0, bend(-0.1, 0.12));
  std::vector<int> degrees;
  for (std::size_t e = 0; e < donor->element_count(); ++e)
    degrees.push_back(static_cast<int>(e % 9));
  for (const Basis basis : bases) {
    const std::vector<Field> fields = {
        constant_and_checks(Space::discontinuous(donor, degrees, basis))};
    const TransferResult result = transfer(fields, target);
    EXPECT_EQ(result.fields[0].space().highest_degree(), 8);
    EXPECT_LE(off_constant(result.fields[0]), 1e-12);  // degree 8
    for (const FieldReport& f : result.report.fields) EXPECT_LE(f.relative_mass_defect, 1e-14);
  }
}

}  // namespace
}  // namespace bezel::test
