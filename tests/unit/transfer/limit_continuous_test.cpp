// Bounds on continuous targets.

#include "bezel/transfer/limit_continuous.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bezel/transfer/transfer.hpp"
#include "support/fields.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::bend;
using test::checkerboard;
using test::grid_mesh;
using test::one;
using test::sampled_range;
using test::turn;

TransferOptions continuous(const Bounds& bounds) {
  TransferOptions options;
  options.continuity = Continuity::continuous;
  options.bounds = bounds;
  return options;
}

class ContinuousBounds : public ::testing::TestWithParam<int> {};

TEST_P(ContinuousBounds, ZeroOneDonorStaysWithinAtEveryDegree) {
  const int g = GetParam();
  const auto donor = grid_mesh(4, g, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(4, g, 1.0, turn(0.3, 0.7, bend(0.1, -0.15)));
  const Field f = checkerboard(donor, 0, Basis::reference);
  for (int p = 1; p <= (g == 1 ? 8 : 4); ++p) {
    for (const Bounds& bounds : {Bounds::between(0.0, 1.0), Bounds::local()}) {
      TransferOptions options = continuous(bounds);
      options.degree = p;
      const TransferResult result = transfer(std::span(&f, 1), target, options);
      const FieldReport& report = result.report.fields[0];
      EXPECT_EQ(result.fields[0].space().continuity(), Continuity::continuous);
      EXPECT_LE(report.relative_mass_defect, 1e-14) << p;
      EXPECT_LE(report.bounds.mass_moved, 1e-14) << p;
      EXPECT_GT(report.bounds.elements_limited, 8) << p;
      EXPECT_GE(report.min_after, -1e-14) << p;
      EXPECT_LE(report.max_after, 1.0 + 1e-14) << p;
      const auto [lo, hi] = sampled_range(result.fields[0], 12);
      EXPECT_GE(lo, -1e-14) << p;
      EXPECT_LE(hi, 1.0 + 1e-14) << p;
    }
  }
}

TEST_P(ContinuousBounds, OrderDegreePlusOneIsKeptAtTightBounds) {
  const int g = GetParam();
  const Formula wave("sin(2*x + 1.2)*cos(1.5*y - 0.2)");
  for (int p = 1; p <= 4; ++p) {
    double last = 0.0;
    std::int64_t limited = 0;
    for (const int n : {5, 10}) {
      const auto donor = grid_mesh(n, g, 1.0, bend(0.15, 0.12));
      const auto target = grid_mesh(n, g, 1.0, turn(0.4, 0.7, bend(0.1, -0.15)));
      const Field f = project("wave", Space::discontinuous(donor, p), one(wave));
      const TransferResult result =
          transfer(std::span(&f, 1), target, continuous(Bounds::between(-1.0, 1.0)));
      EXPECT_LE(result.report.fields[0].max_after, 1.0 + 1e-14);
      EXPECT_LE(result.report.fields[0].relative_mass_defect, 1e-14);
      limited += result.report.fields[0].bounds.elements_limited;
      const double error = error_norms(result.fields[0], one(wave)).l2_relative;
      // Meshes this coarse miss the order by a half at degree 3, bounded or not.
      if (last > 0.0) {
        EXPECT_GT(std::log2(last / error), p + 0.4) << "degree " << p;
      }
      last = error;
    }
    EXPECT_GT(limited, 0) << "degree " << p;
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, ContinuousBounds, ::testing::Values(1, 2));

// The coefficients' range would keep only order 2: a polynomial whose coefficients are far out of
// the bounds and whose values are within stays as it is.
TEST(ContinuousBounds, RangesCountNotCoefficients) {
  const auto mesh = grid_mesh(2, 1, 1.0, test::same_place);
  const Formula steep("(2*x - 1)^2");
  const Field f = project("steep", Space::discontinuous(mesh, 2), one(steep));
  const TransferResult plain = transfer(std::span(&f, 1), mesh, continuous({}));
  const auto c = plain.fields[0].coefficients();
  ASSERT_LT(*std::min_element(c.begin(), c.end()), -0.99);
  const TransferResult bounded =
      transfer(std::span(&f, 1), mesh, continuous(Bounds::between(-1e-4, 9.0001)));
  EXPECT_EQ(bounded.report.fields[0].bounds.elements_limited, 0);
  EXPECT_LE(error_norms(bounded.fields[0], one(steep)).max, 1e-13);
}

TEST(ContinuousBounds, MeansOutOfBoundsGiveTheirMassToOthers) {
  const auto donor = grid_mesh(6, 1, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(5, 2, 1.0, bend(-0.1, 0.1));
  const Formula plane("x + 2*y");
  const Field f = project("plane", Space::discontinuous(donor, 2), one(plane));
  const TransferResult result =
      transfer(std::span(&f, 1), target, continuous(Bounds::between(-1.0, 1.5)));
  const FieldReport& report = result.report.fields[0];
  EXPECT_GT(report.bounds.mass_moved, 0.1);
  EXPECT_LE(report.relative_mass_defect, 1e-14);
  EXPECT_GE(report.min_after, -1.0 - 1e-14);
  EXPECT_LE(report.max_after, 1.5 + 1e-14);
}

TEST(ContinuousBounds, SameBitsForAnyNumberOfThreads) {
  const auto donor = grid_mesh(9, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(10, 2, 1.0, bend(-0.1, 0.1));
  const Field f = checkerboard(donor, 2, Basis::reference);
  TransferOptions options = continuous(Bounds::local());
  options.threads = 1;
  const TransferResult single = transfer(std::span(&f, 1), target, options);
  options.threads = 4;
  const TransferResult several = transfer(std::span(&f, 1), target, options);
  EXPECT_THAT(several.fields[0].coefficients(),
              testing::ElementsAreArray(single.fields[0].coefficients()));
}

TEST(ContinuousBounds, Errors) {
  const auto mesh = grid_mesh(2, 1, 1.0, test::same_place);
  const std::vector<Formula> values{Formula("0.5"), Formula("2")};
  const Field f = project("v", Space::discontinuous(mesh, 1), values);
  EXPECT_THAT(
      [&] { transfer(std::span(&f, 1), mesh, continuous(Bounds::between(0.0, 1.0))); },
      testing::ThrowsMessage<NumericsError>("field 'v', component 1: its mass 8 does not fit into "
                                            "the bounds, which allow 0 to 4"));
  TransferOptions kept = continuous(Bounds::local());
  kept.keep_boundary = true;
  EXPECT_THROW(transfer(std::span(&f, 1), mesh, kept), InputError);
}

}  // namespace
}  // namespace bezel
