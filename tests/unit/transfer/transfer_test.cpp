#include "bezel/transfer/transfer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "bezel/mesh/generate.hpp"
#include "support/fields.hpp"
#include "support/meshes.hpp"
#include "support/message_of.hpp"
#include "support/swept.hpp"

namespace bezel {
namespace {

using test::bend;
using test::checkerboard;
using test::grid_mesh;
using test::largest_difference;
using test::message_of;
using test::one;
using test::same_coefficients;
using test::same_place;
using test::turn;

struct Case {
  int donor_g, target_g, donor_p, target_p;
  Basis donor_basis, target_basis;
};
std::ostream& operator<<(std::ostream& out, const Case& c) {
  return out << "g" << c.donor_g << "to" << c.target_g << "_p" << c.donor_p << "to" << c.target_p
             << "_basis" << static_cast<int>(c.donor_basis) << static_cast<int>(c.target_basis);
}

class EveryPair : public ::testing::TestWithParam<Case> {};

TEST_P(EveryPair, ConservesMassAndReproducesConstants) {
  const Case c = GetParam();
  const auto donor = grid_mesh(5, c.donor_g, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(6, c.target_g, 1.0, turn(0.3, 0.7, bend(0.1, -0.15)));
  const auto space = Space::discontinuous(donor, c.donor_p, c.donor_basis);
  const Formula constant("3.25");
  const Formula wave("1 + sin(3*x)*cos(2*y)");
  const std::vector<Field> fields = {sample("constant", space, one(constant)),
                                     project("wave", space, one(wave)),
                                     checkerboard(donor, c.donor_p, c.donor_basis)};
  TransferOptions options;
  options.degree = c.target_p;
  options.same_basis = false;
  options.basis = c.target_basis;
  const TransferResult result = transfer(fields, target, options);
  EXPECT_LE(error_norms(result.fields[0], one(constant)).max, 1e-12);
  EXPECT_LE(result.report.max_partition_residual, 1e-13);
  EXPECT_LE(result.report.max_joint_gap, 1e-13);
  EXPECT_EQ(result.report.unresolved, 0);
  for (const FieldReport& f : result.report.fields) {
    EXPECT_LE(f.relative_mass_defect, 1e-14) << f.name;
    EXPECT_LE(f.max_element_defect, 1e-15) << f.name;
    EXPECT_NEAR(f.mass_after, f.mass_before - f.mass_outside, 1e-13) << f.name;
    EXPECT_GT(f.mass_outside, 0.1) << f.name;
    EXPECT_EQ(f.mass_made, 0.0) << f.name;
  }
  EXPECT_NEAR(result.report.outside_area, 4.0 - 4.0 * 0.49, c.target_g == 1 ? 1e-13 : 1e-12);
}

std::vector<Case> every_pair() {
  std::vector<Case> cases;
  for (const Basis from : {Basis::reference, Basis::physical}) {
    for (const Basis to : {Basis::reference, Basis::physical}) {
      cases.push_back({1, 1, 1, 1, from, to});
      cases.push_back({2, 2, 2, 2, from, to});
      cases.push_back({3, 3, 3, 3, from, to});
      cases.push_back({1, 3, 2, 3, from, to});
      cases.push_back({3, 1, 1, 0, from, to});
      cases.push_back({2, 3, 0, 2, from, to});
    }
  }
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Bases, EveryPair, ::testing::ValuesIn(every_pair()),
                         [](const auto& tested) {
                           std::ostringstream name;
                           name << tested.param;
                           return name.str();
                         });

class SameMesh : public ::testing::TestWithParam<std::tuple<int, Basis>> {};

TEST_P(SameMesh, ReproducesTheField) {
  const auto [g, basis] = GetParam();
  const auto mesh = grid_mesh(4, g, 1.0, bend(0.2, -0.15));
  const auto space = Space::discontinuous(mesh, g, basis);
  const Formula wave("exp(x)*sin(2*y)");
  const std::vector<Field> fields = {project("wave", space, one(wave)),
                                     checkerboard(mesh, g, basis)};
  // A copy with its own memory: nothing may depend on the two meshes being one object.
  const auto copy = std::make_shared<const TriangleMesh>(*mesh);
  const TransferResult result = transfer(fields, copy);
  for (std::size_t i = 0; i < fields.size(); ++i)
    EXPECT_LE(largest_difference(fields[i], result.fields[i]), 1e-12);
  EXPECT_EQ(result.report.pairs, static_cast<std::int64_t>(mesh->element_count()));
  EXPECT_GT(result.report.overlaps, 0);
}

TEST_P(SameMesh, RefinedAndBackReproducesTheField) {
  const auto [g, basis] = GetParam();
  const auto coarse = grid_mesh(3, g, 1.0, bend(0.2, -0.15));
  const auto fine = std::make_shared<const TriangleMesh>(refine_uniform(*coarse));
  const Formula wave("exp(x)*sin(2*y)");
  const Field f = project("wave", Space::discontinuous(coarse, g, basis), one(wave));
  const TransferResult down = transfer(std::span(&f, 1), fine);
  EXPECT_LE(down.report.fields[0].relative_mass_defect, 1e-14);
  const TransferResult up = transfer(down.fields, coarse);
  EXPECT_LE(largest_difference(f, up.fields[0]), 1e-12);
  EXPECT_EQ(up.report.pairs, static_cast<std::int64_t>(fine->element_count()));
}

INSTANTIATE_TEST_SUITE_P(Degrees, SameMesh,
                         ::testing::Combine(::testing::Values(1, 2, 3, 4),
                                            ::testing::Values(Basis::reference, Basis::physical)));

TEST(Transfer, PhysicalPolynomialsAreExact) {
  for (int p = 0; p <= 6; ++p) {
    const auto donor = grid_mesh(4, 3, 1.0, bend(0.15, 0.12));
    const auto target = grid_mesh(3, 2, 1.0, turn(0.5, 0.65, bend(0.1, -0.15)));
    const Formula poly("(1 + 0.3*x - 0.7*y)^" + std::to_string(p));
    const Field f = project("p", Space::discontinuous(donor, p, Basis::physical), one(poly));
    const TransferResult result = transfer(std::span(&f, 1), target);
    EXPECT_LE(error_norms(result.fields[0], one(poly)).l2_relative, 1e-13) << "degree " << p;
  }
}

TEST(Transfer, ErrorFallsWithOrderDegreePlusOne) {
  const Formula wave("exp(x^2) + 2*y");
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    for (int p = 1; p <= 3; ++p) {
      double last = 0.0;
      double order = 0.0;
      for (const int n : {6, 12}) {
        const auto donor = grid_mesh(n, p, 1.0, bend(0.15, 0.12));
        const auto target = grid_mesh(n, p, 1.0, turn(0.4, 0.7, bend(0.1, -0.15)));
        const Field f = sample("wave", Space::discontinuous(donor, p, basis), one(wave));
        const double error =
            error_norms(transfer(std::span(&f, 1), target).fields[0], one(wave)).l2_relative;
        if (last > 0.0) order = std::log2(last / error);
        last = error;
      }
      EXPECT_GT(order, p + 1 - 0.3) << "degree " << p;
    }
  }
}

TEST(Transfer, SameBitsForAnyNumberOfThreads) {
  const auto donor = grid_mesh(20, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(21, 2, 1.0, bend(-0.1, 0.1));
  const Formula wave("sin(5*x)*y");
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    const Field f = project("wave", Space::discontinuous(donor, 2, basis), one(wave));
    TransferOptions options;
    options.threads = 1;
    const TransferResult single = transfer(std::span(&f, 1), target, options);
    options.threads = 4;
    const TransferResult several = transfer(std::span(&f, 1), target, options);
    EXPECT_TRUE(same_coefficients(single.fields[0], several.fields[0]));
    EXPECT_EQ(single.report.crossings, several.report.crossings);
    EXPECT_EQ(single.report.fields[0].mass_outside, several.report.fields[0].mass_outside);
  }
}

TEST(Transfer, VectorsAndSeveralDegreesInOnePassEqualOneByOne) {
  const auto donor = grid_mesh(4, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(5, 2, 1.0, bend(-0.1, 0.1));
  const std::vector<Formula> velocity = {Formula("y^2"), Formula("1+x")};
  const Formula density("2+x*y");
  const std::vector<Field> fields = {
      project("velocity", Space::discontinuous(donor, 2), velocity),
      project("density", Space::discontinuous(donor, 1, Basis::physical), one(density))};
  const TransferResult together = transfer(fields, target);
  ASSERT_EQ(together.fields.size(), 2U);
  EXPECT_EQ(together.fields[0].components(), 2);
  EXPECT_EQ(together.fields[1].space().basis(), Basis::physical);
  ASSERT_EQ(together.report.fields.size(), 3U);
  for (std::size_t i = 0; i < 2; ++i) {
    const TransferResult alone = transfer(std::span(&fields[i], 1), target);
    EXPECT_TRUE(same_coefficients(alone.fields[0], together.fields[i]));
  }
}

// 0 but for one donor element, which is as small as a hundredth to a thousandth of the target's.
TEST(Transfer, KeepsTheMassOfEachSmallDonorByItself) {
  for (const int g : {1, 2}) {
    const auto target = grid_mesh(1, g, 0.63, turn(0.3, 0.9));
    for (const int n : test::swept({33, 16})) {
      const auto donor = grid_mesh(n, g, 1.0, bend(0.1, 0.08));
      for (const Basis basis : {Basis::physical, Basis::reference}) {
        for (const int p : {0, 1, 2, 3}) {
          const auto space = Space::discontinuous(donor, p, basis);
          const std::size_t size = space->coefficient_count() / donor->element_count();
          std::vector<Field> fields;
          for (std::size_t e = 0; e < donor->element_count(); e += 7) {
            std::vector<double> c(space->coefficient_count(), 0.0);
            std::fill_n(c.begin() + static_cast<std::ptrdiff_t>(e * size), size, 1.0);
            fields.emplace_back("element " + std::to_string(e), space, std::move(c));
          }
          TransferOptions options;
          options.uncovered = Uncovered::extend;
          for (const FieldReport& f : transfer(fields, target, options).report.fields)
            EXPECT_LE(f.relative_mass_defect, 1e-14) << "g " << g << " p " << p << " " << f.name;
        }
      }
    }
  }
}

TEST(Transfer, ContinuousDonorsAreReadLikeAnyOther) {
  const auto donor = grid_mesh(4, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(5, 2, 1.0, bend(-0.1, 0.1));
  const Formula wave("sin(2*x)+y");
  const Field continuous = sample("u", Space::continuous(donor, 2), one(wave));
  const std::vector<double> c(continuous.coefficients().begin(), continuous.coefficients().end());
  const Field discontinuous("u", Space::discontinuous(donor, 2), c);
  const TransferResult a = transfer(std::span(&continuous, 1), target);
  const TransferResult b = transfer(std::span(&discontinuous, 1), target);
  EXPECT_TRUE(same_coefficients(a.fields[0], b.fields[0]));
}

// Two discretisations of one disc: neither covers the other.
class Discs : public ::testing::Test {
 protected:
  std::shared_ptr<const TriangleMesh> disc(int g, double size, std::uint64_t seed) const {
    GenerateOptions options;
    options.degree = g;
    options.size = size;
    options.seed = seed;
    return std::make_shared<const TriangleMesh>(generate_disc(1.0, options));
  }
};

TEST_F(Discs, RefusedByDefaultNamingTheTriangles) {
  const auto donor = disc(2, 0.4, 1);
  const auto target = disc(2, 0.35, 2);
  const Formula constant("2");
  const Field f = sample("u", Space::discontinuous(donor, 2), one(constant));
  try {
    (void)transfer(std::span(&f, 1), target);
    FAIL() << "expected an UncoveredError";
  } catch (const UncoveredError& e) {
    EXPECT_FALSE(e.elements().empty());
    EXPECT_GT(e.area(), 1e-8);
    EXPECT_LT(e.area(), 1e-2);
    EXPECT_THAT(e.what(),
                ::testing::HasSubstr("the donor mesh does not cover the target mesh: area "));
    EXPECT_THAT(e.what(),
                ::testing::HasSubstr(std::to_string(e.elements().front().first.value) + ": "));
    EXPECT_THAT(e.what(), ::testing::HasSubstr("use extend"));
  }
}

TEST_F(Discs, ExtendKeepsConstantsAndTheBalance) {
  for (const int g : {1, 2, 3}) {
    for (const Basis basis : {Basis::reference, Basis::physical}) {
      const auto donor = disc(g, 0.4, 1);
      const auto target = disc(g, 0.3, 2);
      const Formula constant("2");
      const Formula wave("exp(x)*cos(y)");
      const auto space = Space::discontinuous(donor, g, basis);
      const std::vector<Field> fields = {sample("c", space, one(constant)),
                                         project("w", space, one(wave))};
      TransferOptions options;
      options.uncovered = Uncovered::extend;
      const TransferResult result = transfer(fields, target, options);
      EXPECT_LE(error_norms(result.fields[0], one(constant)).max, 1e-12);
      EXPECT_LE(result.report.max_partition_residual, 1e-13);
      EXPECT_GT(result.report.uncovered_area, 1e-10);
      EXPECT_GT(result.report.outside_area, 1e-10);
      EXPECT_NEAR(result.report.fields[0].mass_made, 2.0 * result.report.uncovered_area, 1e-13);
      for (const FieldReport& f : result.report.fields)
        EXPECT_LE(f.relative_mass_defect, 1e-14) << f.name;
      const double projected = error_norms(fields[1], one(wave)).l2_relative;
      EXPECT_LE(error_norms(result.fields[1], one(wave)).l2_relative, 3.0 * projected)
          << "degree " << g;
    }
  }
}

TEST(Transfer, ConstantsComeBackOnPartlyCoveredElements) {
  // The target's corners stick out of the donor by 3e-4.
  for (int g = 1; g <= 3; ++g) {
    const auto donor = grid_mesh(3, g, 1.0, bend(0.15, 0.12));
    const auto target = grid_mesh(4, g, 1.0, turn(0.3, 0.8, bend(0.1, -0.15)));
    const Formula constant("3.25");
    for (const Basis from : {Basis::reference, Basis::physical}) {
      const Field f = sample("u", Space::discontinuous(donor, 2, from), one(constant));
      for (const Basis to : {Basis::reference, Basis::physical}) {
        TransferOptions options;
        options.uncovered = Uncovered::extend;
        options.same_basis = false;
        options.basis = to;
        const TransferResult result = transfer(std::span(&f, 1), target, options);
        EXPECT_GT(result.report.uncovered_area, 1e-8);
        EXPECT_LE(error_norms(result.fields[0], one(constant)).max, 1e-13)
            << "degree " << g << " basis " << static_cast<int>(from) << static_cast<int>(to);
      }
    }
  }
}

TEST_F(Discs, ZeroMakesNothing) {
  const auto donor = disc(2, 0.4, 1);
  const auto target = disc(2, 0.35, 2);
  const Formula wave("1+x");
  const Field f = project("u", Space::discontinuous(donor, 2), one(wave));
  TransferOptions options;
  options.uncovered = Uncovered::zero;
  const TransferResult result = transfer(std::span(&f, 1), target, options);
  // Gaps below 1e-10 of a triangle are rounding and are extended whatever the policy.
  EXPECT_LE(std::abs(result.report.fields[0].mass_made), 1e-10);
  EXPECT_GT(result.report.uncovered_area, 1e-6);
  EXPECT_LE(result.report.fields[0].relative_mass_defect, 1e-14);
  EXPECT_FALSE(result.report.uncovered_elements.empty());
}

TEST(Transfer, TargetFarOutsideTheDonorIsAllUncovered) {
  const auto donor = grid_mesh(3, 1, 1.0, same_place);
  const auto target = grid_mesh(2, 1, 1.0, [](const Vec2& p) { return p + Vec2{{10.0, 0.0}}; });
  const Formula constant("2");
  const Field f = sample("u", Space::discontinuous(donor, 1), one(constant));
  TransferOptions options;
  EXPECT_THROW((void)transfer(std::span(&f, 1), target, options), UncoveredError);
  options.uncovered = Uncovered::extend;
  const TransferResult result = transfer(std::span(&f, 1), target, options);
  EXPECT_NEAR(result.report.uncovered_area, 4.0, 1e-14);
  EXPECT_NEAR(result.report.fields[0].mass_made, 8.0, 1e-12);
  EXPECT_NEAR(result.report.fields[0].mass_outside, 8.0, 1e-12);
  EXPECT_EQ(result.report.pairs, 0);
}

TEST(Transfer, DonorWithAHoleIsFoundAroundIt) {
  // Targets across the hole see donors on both sides, which no walk inside the box connects.
  GenerateOptions options;
  options.size = 0.2;
  options.degree = 2;
  const auto donor = std::make_shared<const TriangleMesh>(generate_annulus(0.4, 1.0, options));
  const auto target = grid_mesh(1, 1, 0.6, same_place);
  const Formula constant("1");
  const Field f = sample("u", Space::discontinuous(donor, 1), one(constant));
  TransferOptions zero;
  zero.uncovered = Uncovered::zero;
  const TransferResult result = transfer(std::span(&f, 1), target, zero);
  double donor_area = 0.0;
  for (std::size_t e = 0; e < donor->element_count(); ++e)
    donor_area += area(2, donor->gather(ElementId(e)));
  EXPECT_NEAR(result.report.uncovered_area, 3.14159265358979 * 0.16, 2e-3);
  EXPECT_NEAR(result.report.outside_area, donor_area - (1.44 - result.report.uncovered_area),
              1e-12);
  EXPECT_LE(result.report.fields[0].relative_mass_defect, 1e-14);
}

TEST(Transfer, ProgressEndsAtOneAndCanStopTheWork) {
  const auto donor = grid_mesh(20, 1, 1.0, same_place);
  const auto target = grid_mesh(19, 1, 1.0, turn(0.2, 0.6));
  const Formula constant("1");
  const Field f = sample("u", Space::discontinuous(donor, 1), one(constant));
  double last = 0.0;
  (void)transfer(std::span(&f, 1), target, {}, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    return true;
  });
  EXPECT_EQ(last, 1.0);
  EXPECT_THROW((void)transfer(std::span(&f, 1), target, {}, [](double) { return false; }),
               Interrupted);
}

TEST(TransferErrors, NameWhatIsWrong) {
  const auto mesh = grid_mesh(2, 1, 1.0, same_place);
  const auto other = grid_mesh(2, 1, 1.0, same_place);
  const Formula constant("1");
  const Field f = sample("u", Space::discontinuous(mesh, 1), one(constant));
  const Field g = sample("v", Space::discontinuous(other, 1), one(constant));
  EXPECT_EQ(message_of([&] { (void)transfer({}, mesh); }),
            "transfer: no field given, expected at least one");
  EXPECT_EQ(message_of([&] {
              (void)transfer(std::vector<Field>{f, g}, mesh);
            }),
            "transfer: field 'v' lives on another mesh than field 'u', expected all donor fields "
            "on one mesh");
  TransferOptions options;
  options.degree = 11;
  EXPECT_EQ(message_of([&] { (void)transfer(std::span(&f, 1), mesh, options); }),
            "transfer: degree 11 is not supported, expected 0 to 10");
  const auto inverted =
      std::make_shared<const TriangleMesh>(1, std::vector<Vec2>{{{0, 0}}, {{1, 0}}, {{0, 1}}},
                                           std::vector<NodeId>{NodeId(0), NodeId(2), NodeId(1)});
  EXPECT_THAT(message_of([&] { (void)transfer(std::span(&f, 1), inverted); }),
              ::testing::StartsWith("triangle 0: target mesh: the element is inverted"));
}

}  // namespace
}  // namespace bezel
