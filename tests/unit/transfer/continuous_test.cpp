// Continuous targets: the global L2 projection.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <tuple>

#include "bezel/mesh/generate.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/fields.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::bend;
using test::grid_mesh;
using test::largest_difference;
using test::one;
using test::same_coefficients;
using test::turn;

TransferOptions to_continuous(int degree = -1) {
  TransferOptions options;
  options.continuity = Continuity::continuous;
  options.degree = degree;
  return options;
}

enum class Kind { discontinuous_reference, discontinuous_physical, continuous, element_constants };

/// The donor field of a kind, for a formula; element_constants: 0 or 1 by chance.
Field make_donor(const std::shared_ptr<const TriangleMesh>& mesh, Kind kind, int p,
                 const Formula& f, const char* name = "u") {
  switch (kind) {
    case Kind::discontinuous_reference:
      return project(name, Space::discontinuous(mesh, p), one(f));
    case Kind::discontinuous_physical:
      return project(name, Space::discontinuous(mesh, p, Basis::physical), one(f));
    case Kind::continuous:
      return project(name, Space::continuous(mesh, p), one(f));
    case Kind::element_constants:
      break;
  }
  const auto space = Space::discontinuous(mesh, 0);
  RandomStream random("zero or one", 3);
  std::vector<double> c(space->coefficient_count());
  for (double& v : c) v = random.uniform() < 0.5 ? 0.0 : 1.0;
  return Field(name, space, c);
}

class Kinds : public ::testing::TestWithParam<std::tuple<Kind, int, int>> {};

TEST_P(Kinds, ConserveMassAndReproduceConstants) {
  const auto [kind, donor_g, target_g] = GetParam();
  const auto donor = grid_mesh(5, donor_g, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(6, target_g, 1.0, turn(0.3, 0.7, bend(0.1, -0.15)));
  const Formula constant("3.25");
  const Formula wave("1 + sin(3*x)*cos(2*y)");
  const Kind smooth = kind == Kind::element_constants ? Kind::continuous : kind;
  const std::vector<Field> fields = {make_donor(donor, smooth, 2, constant, "constant"),
                                     make_donor(donor, kind, 3, wave, "wave")};
  for (const Continuity continuity : {Continuity::continuous, Continuity::discontinuous}) {
    TransferOptions options = to_continuous(3);
    options.continuity = continuity;
    const TransferResult result = transfer(fields, target, options);
    EXPECT_LE(error_norms(result.fields[0], one(constant)).max, 3.25e-13);
    for (const FieldReport& f : result.report.fields) {
      EXPECT_LE(f.relative_mass_defect, 1e-14) << f.name;
      ASSERT_EQ(f.mass_solve.has_value(), continuity == Continuity::continuous);
      if (!f.mass_solve) continue;
      EXPECT_LE(f.mass_solve->relative_residual, 1e-15) << f.name;
      EXPECT_EQ(f.mass_solve->boundary_mass_change, 0.0);
      EXPECT_EQ(f.mass_solve->dofs, 19U * 19U);
    }
    EXPECT_EQ(result.fields[1].space().continuity(), continuity);
  }
}

INSTANTIATE_TEST_SUITE_P(Donors, Kinds,
                         ::testing::Combine(::testing::Values(Kind::discontinuous_reference,
                                                              Kind::discontinuous_physical,
                                                              Kind::continuous,
                                                              Kind::element_constants),
                                            ::testing::Values(1, 3), ::testing::Values(1, 2)));

// Polynomials in x and y are exact in a physical basis, so the transfer must equal the projection
// of the formula, which field makes by its own quadrature and its own solver.
TEST(ContinuousTransfer, IsTheProjectionOfTheFormula) {
  const Formula poly("1 + 2*x - y + x*y - 3*x^2*y + y^3");
  const auto donor = grid_mesh(4, 3, 1.0, bend(0.15, 0.12));
  const Field f = make_donor(donor, Kind::discontinuous_physical, 3, poly);
  for (const int g : {1, 2, 3}) {
    const auto target = grid_mesh(5, g, 1.0, turn(0.5, 0.65, bend(0.1, -0.15)));
    for (int p = 1; p <= 4; ++p) {
      const Field expected = project("u", Space::continuous(target, p), one(poly));
      const TransferResult result = transfer({&f, 1}, target, to_continuous(p));
      EXPECT_LE(largest_difference(result.fields[0], expected), 1e-12) << "g " << g << " p " << p;
    }
  }
}

class Order : public ::testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(Order, IsDegreePlusOne) {
  const auto [p, keep_boundary] = GetParam();
  const Formula wave("exp(x^2) + sin(2*y)");
  std::array<double, 2> error{};
  for (std::size_t level = 0; level < 2; ++level) {
    const int n = level == 0 ? 6 : 12;
    const int g = std::min(p, 2);
    const auto donor = grid_mesh(n, g, 1.0, bend(0.15, 0.12));
    const auto target = grid_mesh(n, g, 1.0, turn(0.4, 0.7, bend(0.1, -0.15)));
    const Field f = sample("wave", Space::discontinuous(donor, p), one(wave));
    TransferOptions options = to_continuous();
    options.keep_boundary = keep_boundary;
    error[level] = error_norms(transfer({&f, 1}, target, options).fields[0], one(wave)).l2_relative;
  }
  EXPECT_GT(std::log2(error[0] / error[1]), p + 1 - 0.1);
}
INSTANTIATE_TEST_SUITE_P(Degrees, Order,
                         ::testing::Combine(::testing::Values(1, 2, 3, 4), ::testing::Bool()));

class SameField : public ::testing::TestWithParam<int> {};

TEST_P(SameField, ComesBackFromItsMeshAndFromRefinements) {
  const int g = GetParam();
  const Formula wave("exp(x)*sin(2*y)");
  const auto coarse = grid_mesh(3, g, 1.0, bend(0.2, -0.15));
  const auto fine = std::make_shared<const TriangleMesh>(refine_uniform(*coarse));
  for (const int p : {1, g, g + 1}) {
    const Field f = make_donor(coarse, Kind::continuous, p, wave);
    for (const bool keep_boundary : {false, true}) {
      TransferOptions options = to_continuous();
      options.keep_boundary = keep_boundary;
      const auto copy = std::make_shared<const TriangleMesh>(*coarse);
      const TransferResult same = transfer({&f, 1}, copy, options);
      EXPECT_LE(largest_difference(f, same.fields[0]), 1e-12) << "p " << p;
      const TransferResult down = transfer({&f, 1}, fine, options);
      const TransferResult up = transfer(down.fields, coarse, options);
      EXPECT_LE(largest_difference(f, up.fields[0]), 1e-12) << "p " << p;
      EXPECT_LE(up.report.fields[0].relative_mass_defect, keep_boundary ? 1e-13 : 1e-14);
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Degrees, SameField, ::testing::Values(1, 2, 3, 4));

// Two discs cut in different ways, and a target that sticks out: mass is kept by the books.
TEST(ContinuousTransfer, PartialCover) {
  GenerateOptions how;
  how.degree = 2;
  how.size = 0.4;
  how.seed = 1;
  const auto donor = std::make_shared<const TriangleMesh>(generate_disc(1.0, how));
  how.size = 0.35;
  how.seed = 2;
  const auto target = std::make_shared<const TriangleMesh>(generate_disc(1.05, how));
  const Formula wave("2 + x*y");
  const Field f = make_donor(donor, Kind::discontinuous_reference, 2, wave);
  EXPECT_THROW(transfer({&f, 1}, target, to_continuous()), UncoveredError);
  for (const Uncovered uncovered : {Uncovered::extend, Uncovered::zero}) {
    TransferOptions options = to_continuous();
    options.uncovered = uncovered;
    const TransferResult result = transfer({&f, 1}, target, options);
    const FieldReport& report = result.report.fields[0];
    EXPECT_LE(report.relative_mass_defect, 1e-14);
    EXPECT_EQ(report.mass_made > 0.0, uncovered == Uncovered::extend);
    EXPECT_NEAR(report.mass_after, report.mass_before - report.mass_outside + report.mass_made,
                1e-13);
    if (uncovered == Uncovered::extend) {
      EXPECT_LE(error_norms(result.fields[0], one(wave)).max, 1e-2);
    }

    options.keep_boundary = true;
    const TransferResult kept = transfer({&f, 1}, target, options);
    std::vector<double> value(1);
    for (std::size_t e = 0; e < target->element_count(); ++e) {
      for (int side = 0; side < 3; ++side) {
        const auto edge = target->edges(ElementId(e))[static_cast<std::size_t>(side)].edge;
        if (!target->is_boundary(edge)) continue;
        Lambda corner{0, 0, 0};
        corner[static_cast<std::size_t>(side)] = 1.0;
        kept.fields[0].evaluate(ElementId(e), corner, value);
        const Vec2 x = target->control(target->nodes(
            ElementId(e))[static_cast<std::size_t>(bernstein::triangle_corner(2, side))]);
        EXPECT_NEAR(value[0], uncovered == Uncovered::zero ? 0.0 : wave(x[0], x[1]), 1e-2);
      }
    }
  }
}

// A hole in both meshes, cut in different ways.
TEST(ContinuousTransfer, AroundAHole) {
  GenerateOptions how;
  how.degree = 3;
  how.size = 0.45;
  how.seed = 3;
  const auto donor = std::make_shared<const TriangleMesh>(generate_annulus(0.5, 1.0, how));
  how.size = 0.35;
  how.seed = 4;
  const auto target = std::make_shared<const TriangleMesh>(generate_annulus(0.5, 1.0, how));
  const Formula constant("3.25");
  const Formula wave("2 + x*y");
  const std::vector<Field> fields = {
      make_donor(donor, Kind::discontinuous_physical, 2, constant, "constant"),
      make_donor(donor, Kind::discontinuous_physical, 2, wave, "wave")};
  for (const bool keep_boundary : {false, true}) {
    TransferOptions options = to_continuous(3);
    options.uncovered = Uncovered::extend;
    options.keep_boundary = keep_boundary;
    const TransferResult result = transfer(fields, target, options);
    EXPECT_LE(error_norms(result.fields[0], one(constant)).max, 3.25e-13);
    EXPECT_LE(error_norms(result.fields[1], one(wave)).max, 1e-2);
    EXPECT_LE(result.report.fields[0].relative_mass_defect, 1e-14);
    EXPECT_EQ(result.report.fields[1].relative_mass_defect > 1e-14, keep_boundary);
    EXPECT_LE(result.report.fields[1].relative_mass_defect, 1e-3);
  }
}

// A physical polynomial is known exactly at the nodes of the boundary.
TEST(ContinuousTransfer, KeepsTheBoundary) {
  const Formula poly("1 + x^2 - 2*x*y + 3*y");
  const auto donor = grid_mesh(5, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(6, 2, 1.0, turn(0.3, 0.7, bend(0.1, -0.15)));
  const Field f = make_donor(donor, Kind::discontinuous_physical, 2, poly);
  TransferOptions options = to_continuous(2);
  options.keep_boundary = true;
  const TransferResult result = transfer({&f, 1}, target, options);
  const Field interpolant = sample("u", result.fields[0].space_ptr(), one(poly));
  int boundary = 0;
  for (std::size_t e = 0; e < target->element_count(); ++e) {
    const auto dofs = result.fields[0].space().dofs(ElementId(e));
    for (int side = 0; side < 3; ++side) {
      if (!target->is_boundary(target->edges(ElementId(e))[static_cast<std::size_t>(side)].edge))
        continue;
      for (int m = 0; m <= 2; ++m) {
        const auto i = static_cast<std::size_t>(bernstein::triangle_side_index(2, side, m));
        ASSERT_LT(i, dofs.size());
        EXPECT_NEAR(result.fields[0].coefficients(ElementId(e))[i],
                    interpolant.coefficients(ElementId(e))[i], 1e-13);
        ++boundary;
      }
    }
  }
  EXPECT_EQ(boundary, 24 * 3);
  const FieldReport& report = result.report.fields[0];
  const double change =
      report.mass_after - (report.mass_before - report.mass_outside + report.mass_made);
  EXPECT_NEAR(report.mass_solve->boundary_mass_change, change, 1e-14);
  EXPECT_GT(std::abs(change), 1e-9);  // the interpolant of the boundary is not the best one
  EXPECT_LE(std::abs(change), 1e-4);
  EXPECT_NEAR(report.relative_mass_defect, std::abs(change) / integral_abs(f)[0], 1e-14);
}

TEST(ContinuousTransfer, VectorsAndSeveralFieldsEqualOneByOne) {
  const auto donor = grid_mesh(4, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(5, 2, 1.0, bend(-0.1, 0.1));
  const std::vector<Formula> velocity = {Formula("y^2"), Formula("1+x")};
  const Formula density("2+x*y");
  const std::vector<Field> fields = {
      project("velocity", Space::discontinuous(donor, 2), velocity),
      project("density", Space::discontinuous(donor, 1, Basis::physical), one(density))};
  for (const bool keep_boundary : {false, true}) {
    TransferOptions options = to_continuous();
    options.keep_boundary = keep_boundary;
    const TransferResult together = transfer(fields, target, options);
    ASSERT_EQ(together.report.fields.size(), 3U);
    for (std::size_t i = 0; i < 2; ++i) {
      const TransferResult alone = transfer({&fields[i], 1}, target, options);
      EXPECT_TRUE(same_coefficients(alone.fields[0], together.fields[i]));
    }
  }
}

TEST(ContinuousTransfer, SameBitsForAnyNumberOfThreads) {
  const auto donor = grid_mesh(18, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(20, 2, 1.0, bend(-0.1, 0.1));
  const Formula wave("sin(5*x)*y");
  const Field f = make_donor(donor, Kind::discontinuous_reference, 3, wave);
  TransferOptions options = to_continuous();
  options.keep_boundary = true;
  options.threads = 1;
  const TransferResult single = transfer({&f, 1}, target, options);
  EXPECT_GT(single.report.fields[0].mass_solve->iterations, 0);
  options.threads = 4;
  const TransferResult several = transfer({&f, 1}, target, options);
  EXPECT_TRUE(same_coefficients(single.fields[0], several.fields[0]));
}

TEST(ContinuousTransfer, BadOptionsAreRefused) {
  const auto mesh = grid_mesh(2, 2, 1.0, bend(0.1, 0.1));
  const Formula wave("x");
  const Field f = make_donor(mesh, Kind::discontinuous_physical, 1, wave);
  const auto refused = [&](const TransferOptions& options, const Field& donor) {
    try {
      transfer({&donor, 1}, mesh, options);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  TransferOptions options = to_continuous();
  EXPECT_EQ(refused(options, f), "accepted");
  options.basis = Basis::physical;  // not asked for: same_basis
  EXPECT_EQ(refused(options, f), "accepted");
  options.same_basis = false;
  EXPECT_EQ(refused(options, f),
            "transfer: a continuous field cannot use the physical basis: a polynomial in x and y "
            "has a higher degree along a curved edge than the edge has coefficients; use the "
            "reference basis, or a discontinuous field");
  const std::string degree_zero =
      "transfer: field 'u': a continuous field of degree 0 is one constant, expected degree 1 or "
      "more";
  EXPECT_EQ(refused(to_continuous(0), f), degree_zero);
  EXPECT_EQ(refused(to_continuous(), make_donor(mesh, Kind::element_constants, 0, wave)),
            degree_zero);
  TransferOptions discontinuous;
  discontinuous.keep_boundary = true;
  EXPECT_EQ(refused(discontinuous, f),
            "transfer: boundary values are kept by continuous targets only");
}

}  // namespace
}  // namespace bezel
