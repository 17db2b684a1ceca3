#include <gtest/gtest.h>

#include <cmath>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/numeric/quadrature.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/fields.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::bend;
using test::grid_mesh;
using test::one;
using test::PlaneMap;
using test::turn;

/// A map that moves the square to x > 0.
PlaneMap right_of_axis(const PlaneMap& first) {
  return test::moved(first, Vec2{{1.5, 0.0}});
}

class WeightedContinuous : public testing::TestWithParam<std::tuple<int, int, int>> {
 protected:
  void SetUp() override {
    const auto [g, p, kind] = GetParam();
    donor_ = grid_mesh(6, g, 1.0, right_of_axis(bend(0.1, 0.08)));
    target_ = grid_mesh(5, g, 0.7, right_of_axis(turn(0.4, 0.9)));
    options_.continuity = Continuity::continuous;
    options_.threads = 1;
    if (kind != 1) options_.weight = Formula("x");
    if (kind != 0) options_.density = "rho";
  }
  std::vector<Field> fields(Basis basis) const {
    const auto space = Space::discontinuous(donor_, std::get<1>(GetParam()), basis);
    return {project("rho", space, one(Formula("1.2 + 0.5*x + 0.3*sin(y)"))),
            project("u", space, one(Formula("sin(x + y)"))),
            Field("constant", space, std::vector<double>(space->coefficient_count(), 0.7))};
  }
  std::shared_ptr<const TriangleMesh> donor_, target_;
  TransferOptions options_;
};

TEST_P(WeightedContinuous, KeepsMassesAndConstants) {
  for (const Basis basis : {Basis::physical, Basis::reference}) {
    const TransferResult found = transfer(fields(basis), target_, options_);
    for (std::size_t k = 0; k < found.fields.size(); ++k) {
      const Field& f = found.fields[k];
      const FieldReport& line = found.report.fields[k];
      EXPECT_EQ(f.space().continuity(), Continuity::continuous);
      EXPECT_LT(line.relative_mass_defect, 1e-14) << f.name();
      ASSERT_TRUE(line.mass_solve);
      EXPECT_LT(line.mass_solve->relative_residual, 1e-13);
    }
    for (const double c : found.fields[2].coefficients()) EXPECT_NEAR(c, 0.7, 1e-13);
  }
}

// The mass that the report gives, by quadrature of weight * density * field.
TEST_P(WeightedContinuous, ReportsTheIntegralOfTheProducts) {
  const auto donors = fields(Basis::reference);
  const TransferResult found = transfer(donors, target_, options_);
  const TriangleRule rule = triangle_rule(30);
  double total = 0.0;
  for (std::size_t e = 0; e < target_->element_count(); ++e) {
    const auto control = target_->gather(ElementId(e));
    for (std::size_t q = 0; q < rule.weight.size(); ++q) {
      const auto map =
          bernstein::evaluate_gradient<Vec2>(target_->degree(), control, rule.lambda[q]);
      double u = 0.0, rho = 1.0;
      found.fields[1].evaluate(ElementId(e), rule.lambda[q], {&u, 1});
      if (!options_.density.empty())
        found.fields[0].evaluate(ElementId(e), rule.lambda[q], {&rho, 1});
      const double w = options_.weight ? map.value.x() : 1.0;
      total += rule.weight[q] * cross(map.du, map.dv) * w * rho * u;
    }
  }
  EXPECT_NEAR(found.report.fields[1].mass_after, total, 1e-13 * std::abs(total));
}

TEST_P(WeightedContinuous, ComesNearTheFunction) {
  const auto [g, p, kind] = GetParam();
  const TransferResult found = transfer(fields(Basis::physical), target_, options_);
  const double error = error_norms(found.fields[1], one(Formula("sin(x + y)"))).l2_relative;
  EXPECT_LT(error, p == 1 ? 2e-2 : 2e-3);
}

TEST_P(WeightedContinuous, HasTheSameBitsForAnyNumberOfThreads) {
  const auto donors = fields(Basis::reference);
  const TransferResult first = transfer(donors, target_, options_);
  options_.threads = 3;
  const TransferResult second = transfer(donors, target_, options_);
  for (std::size_t k = 0; k < donors.size(); ++k)
    EXPECT_TRUE(test::same_coefficients(first.fields[k], second.fields[k]));
}

// kind 0: weight; 1: density; 2: both.
INSTANTIATE_TEST_SUITE_P(Meshes, WeightedContinuous,
                         testing::Combine(testing::Values(1, 3), testing::Values(1, 2),
                                          testing::Values(0, 1, 2)));

TEST(WeightedContinuousErrors, WhatDoesNotGoTogether) {
  const auto donor = grid_mesh(3, 1, 1.0, right_of_axis(bend(0.0, 0.0)));
  const auto target = grid_mesh(3, 1, 0.5, right_of_axis(turn(0.3, 1.0)));
  const Field f("f", Space::discontinuous(donor, 1), std::vector<double>(18 * 3, 1.0));
  TransferOptions options;
  options.continuity = Continuity::continuous;
  options.weight = Formula("x");
  EXPECT_NO_THROW((void)transfer({&f, 1}, target, options));
  options.keep_boundary = true;
  EXPECT_THROW((void)transfer({&f, 1}, target, options), InputError);
  options.keep_boundary = false;
  options.bounds = Bounds::between(0.0, 2.0);
  EXPECT_THROW((void)transfer({&f, 1}, target, options), InputError);
}

}  // namespace
}  // namespace bezel
