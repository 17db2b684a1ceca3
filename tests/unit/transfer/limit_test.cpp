// Bounds on transferred fields.

#include "bezel/transfer/limit.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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

struct Case {
  int g;
  Basis basis;
};
std::vector<Case> every_case() {
  std::vector<Case> cases;
  for (const Basis basis : {Basis::reference, Basis::physical})
    for (const int g : {1, 2, 3}) cases.push_back({g, basis});
  return cases;
}
std::string name_of(const testing::TestParamInfo<Case>& info) {
  return "g" + std::to_string(info.param.g) +
         (info.param.basis == Basis::reference ? "reference" : "physical");
}

class Bounded : public ::testing::TestWithParam<Case> {};

TEST_P(Bounded, ZeroOneDonorStaysWithinAtEveryDegree) {
  const auto [g, basis] = GetParam();
  const auto donor = grid_mesh(4, g, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(4, g, 1.0, turn(0.3, 0.7, bend(0.1, -0.15)));
  const Field f = checkerboard(donor, 0, basis);
  for (int p = 0; p <= (g == 1 ? 8 : 4); ++p) {
    for (const Bounds& bounds : {Bounds::between(0.0, 1.0), Bounds::local()}) {
      TransferOptions options;
      options.degree = p;
      options.bounds = bounds;
      const TransferResult result = transfer(std::span(&f, 1), target, options);
      const FieldReport& report = result.report.fields[0];
      EXPECT_LE(report.relative_mass_defect, 1e-14) << p;
      EXPECT_GE(report.min_after, 0.0) << p;
      EXPECT_LE(report.max_after, 1.0) << p;
      EXPECT_LE(report.bounds.mass_moved, 1e-14) << p;  // means are averages of 0 and 1
      const auto [lo, hi] = sampled_range(result.fields[0], 12);
      EXPECT_GE(lo, -4e-15) << p;  // rounding of the evaluation
      EXPECT_LE(hi, 1.0 + 4e-15) << p;
      EXPECT_GE(report.bounds.elements_limited, p > 0 ? 8 : 0) << p;
    }
  }
}

TEST_P(Bounded, OrderDegreePlusOneIsKeptAtTightBounds) {
  const auto [g, basis] = GetParam();
  // The maximum 1 is attained inside an element, and -1 only beyond the mesh.
  const Formula wave("sin(2*x + 1.2)*cos(1.5*y - 0.2)");
  for (int p = 1; p <= (g == 3 ? 3 : 4); ++p) {
    double last = 0.0;
    std::int64_t limited = 0;
    for (const int n : {5, 10}) {
      const auto donor = grid_mesh(n, g, 1.0, bend(0.15, 0.12));
      const auto target = grid_mesh(n, g, 1.0, turn(0.4, 0.7, bend(0.1, -0.15)));
      const Field f = project("wave", Space::discontinuous(donor, p, basis), one(wave));
      TransferOptions options;
      const double free =
          error_norms(transfer(std::span(&f, 1), target, options).fields[0], one(wave)).l2_relative;
      options.bounds = Bounds::between(-1.0, 1.0);
      const TransferResult result = transfer(std::span(&f, 1), target, options);
      EXPECT_LE(result.report.fields[0].max_after, 1.0);
      EXPECT_LE(result.report.fields[0].relative_mass_defect, 1e-14);
      limited += result.report.fields[0].bounds.elements_limited;
      const double error = error_norms(result.fields[0], one(wave)).l2_relative;
      EXPECT_LE(error, 1.05 * free) << "degree " << p;
      // Meshes this coarse miss the order by a half at degree 3, bounded or not.
      if (last > 0.0) {
        EXPECT_GT(std::log2(last / error), p + 0.4) << "degree " << p;
      }
      last = error;
    }
    EXPECT_GT(limited, 0) << "degree " << p;
  }
}

INSTANTIATE_TEST_SUITE_P(Meshes, Bounded, ::testing::ValuesIn(every_case()), name_of);

TEST(Bounds, FieldsWithinThemComeBackBitForBit) {
  const auto donor = grid_mesh(4, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(5, 2, 1.0, turn(0.3, 0.7));
  const Formula wave("sin(2*x)*cos(y)");
  const Field f = project("wave", Space::discontinuous(donor, 3), one(wave));
  TransferOptions options;
  const TransferResult plain = transfer(std::span(&f, 1), target, options);
  options.bounds = Bounds::between(-3.0, std::numeric_limits<double>::infinity());
  const TransferResult bounded = transfer(std::span(&f, 1), target, options);
  EXPECT_THAT(bounded.fields[0].coefficients(),
              testing::ElementsAreArray(plain.fields[0].coefficients()));
  EXPECT_EQ(bounded.report.fields[0].bounds.elements_limited, 0);
  EXPECT_EQ(bounded.report.fields[0].bounds.mass_moved, 0.0);
}

TEST(Bounds, MeansOutOfBoundsGiveTheirMassToOthers) {
  const auto donor = grid_mesh(6, 1, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(5, 2, 1.0, bend(-0.1, 0.1));
  const Formula wave("x + 2*y");
  const Field f = project("wave", Space::discontinuous(donor, 2), one(wave));
  TransferOptions options;
  options.bounds = Bounds::between(-1.0, 1.5);
  const TransferResult result = transfer(std::span(&f, 1), target, options);
  const FieldReport& report = result.report.fields[0];
  EXPECT_GT(report.bounds.mass_moved, 0.1);
  EXPECT_LE(report.relative_mass_defect, 1e-14);
  EXPECT_GE(report.min_after, -1.0);
  EXPECT_LE(report.max_after, 1.5);
}

TEST(Bounds, ComponentsAreBoundedOneByOne) {
  const auto donor = grid_mesh(4, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(5, 2, 1.0, turn(0.3, 0.7));
  const std::vector<Formula> parts{Formula("x > 0"), Formula("5*(y > 0.1)")};
  const Field both = project("v", Space::discontinuous(donor, 2), parts);
  TransferOptions options;
  options.bounds = Bounds::local();
  const TransferResult result = transfer(std::span(&both, 1), target, options);
  for (std::size_t c = 0; c < 2; ++c) {
    const Field part = project("v", both.space_ptr(), one(parts[c]));
    const TransferResult alone = transfer(std::span(&part, 1), target, options);
    const auto all = result.fields[0].coefficients();
    const auto own = alone.fields[0].coefficients();
    // Two components in one pass are rounded differently from one.
    for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(all[2 * i + c], own[i], 1e-13);
    EXPECT_EQ(result.report.fields[c].bounds.elements_limited,
              alone.report.fields[0].bounds.elements_limited);
    EXPECT_GE(result.report.fields[c].min_after, result.report.fields[c].min_before);
    EXPECT_LE(result.report.fields[c].max_after, result.report.fields[c].max_before);
  }
}

TEST(Bounds, SameBitsForAnyNumberOfThreads) {
  const auto donor = grid_mesh(9, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(10, 2, 1.0, bend(-0.1, 0.1));
  const Field f = checkerboard(donor, 2, Basis::physical);
  TransferOptions options;
  options.bounds = Bounds::local();
  options.threads = 1;
  const TransferResult single = transfer(std::span(&f, 1), target, options);
  options.threads = 4;
  const TransferResult several = transfer(std::span(&f, 1), target, options);
  EXPECT_THAT(several.fields[0].coefficients(),
              testing::ElementsAreArray(single.fields[0].coefficients()));
  EXPECT_EQ(single.report.fields[0].bounds.mass_moved, several.report.fields[0].bounds.mass_moved);
}

TEST(Bounds, UncoveredPartsThatCountAsZero) {
  const auto donor = grid_mesh(4, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(5, 2, 1.5, test::same_place);
  const Formula two("2");
  const Field f = project("two", Space::discontinuous(donor, 1), one(two));
  TransferOptions options;
  options.uncovered = Uncovered::zero;
  options.bounds = Bounds::local();
  const TransferResult local = transfer(std::span(&f, 1), target, options);
  EXPECT_EQ(local.report.fields[0].min_after, 0.0);
  EXPECT_LE(local.report.fields[0].max_after, 2.0 + 1e-12);
  EXPECT_LE(local.report.fields[0].relative_mass_defect, 1e-14);
  options.bounds = Bounds::between(1.0, 3.0);
  EXPECT_THAT(
      [&] { transfer(std::span(&f, 1), target, options); },
      testing::ThrowsMessage<InputError>(
          "transfer: 32 uncovered triangles count as 0, which the bounds 1 to 3 leave out"));
}

TEST(Bounds, LocalOnesOfElementsWithoutDonorAreTheWholeDonors) {
  const auto donor = grid_mesh(4, 1, 1.0, test::same_place);
  const auto target = grid_mesh(6, 1, 1.5, test::same_place);
  const Formula wave("x^3");
  const Field f = project("wave", Space::discontinuous(donor, 3), one(wave));
  TransferOptions options;
  options.uncovered = Uncovered::extend;  // up to 3.4 at the edge
  options.bounds = Bounds::local();
  const TransferResult result = transfer(std::span(&f, 1), target, options);
  EXPECT_GE(result.report.fields[0].min_after, -1.0 - 1e-9);
  EXPECT_LE(result.report.fields[0].max_after, 1.0 + 1e-9);
  EXPECT_LE(result.report.fields[0].relative_mass_defect, 1e-14);
}

TEST(Bounds, Errors) {
  const auto donor = grid_mesh(2, 1, 1.0, test::same_place);
  const Formula two("2");
  const Field f = project("two", Space::discontinuous(donor, 1), one(two));
  const auto bounded = [&](double lo, double hi) {
    TransferOptions options;
    options.bounds = Bounds::between(lo, hi);
    return transfer(std::span(&f, 1), donor, options);
  };
  EXPECT_THAT([&] { bounded(1.0, 0.0); },
              testing::ThrowsMessage<InputError>(
                  "transfer: found bounds 1 to 0, expected two numbers in ascending order"));
  EXPECT_THROW(bounded(std::nan(""), 1.0), InputError);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW(bounded(infinity, infinity), InputError);
  EXPECT_THAT([&] { bounded(0.0, 1.0); },
              testing::ThrowsMessage<NumericsError>("field 'two': its mass 8 does not fit into the "
                                                    "bounds, which allow 0 to 4"));
  EXPECT_NO_THROW(bounded(2.0, 2.0));
}

}  // namespace
}  // namespace bezel
