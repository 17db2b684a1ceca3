// Transfer with a weight and with a density.

#include <gtest/gtest.h>

#include <cmath>

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

/// [0, 2] x [-1, 1]: x is the distance from the axis x = 0, which is a side.
PlaneMap beside_axis(const PlaneMap& map) {
  return test::moved(map, Vec2{{1.0, 0.0}});
}

/// Integral of the product of all fields (component 0) and x^power, by quadrature.
double integral_of_product(const std::vector<const Field*>& fields, int power) {
  const TriangleRule rule = triangle_rule(40);
  const TriangleMesh& mesh = fields[0]->mesh();
  double sum = 0.0;
  std::vector<double> value(9);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const std::vector<Vec2> control = mesh.gather(ElementId(e));
    for (std::size_t q = 0; q < rule.weight.size(); ++q) {
      const auto at = bernstein::evaluate_gradient<Vec2>(mesh.degree(), control, rule.lambda[q]);
      double product = std::pow(at.value[0], power);
      for (const Field* f : fields) {
        f->evaluate(ElementId(e), rule.lambda[q],
                    {value.data(), static_cast<std::size_t>(f->components())});
        product *= value[0];
      }
      sum += rule.weight[q] * cross(at.du, at.dv) * product;
    }
  }
  return sum;
}

using Parameters = std::tuple<int, Basis, Basis>;
class Weighted : public ::testing::TestWithParam<Parameters> {};

TEST_P(Weighted, ConservesWhatItSaysAndKeepsConstants) {
  const auto [g, from, to] = GetParam();
  const auto donor = grid_mesh(3, g, 1.0, beside_axis(bend(0.15, 0.12)));
  const auto target = grid_mesh(4, g, 1.0, beside_axis(bend(-0.1, 0.1)));
  const Formula density("2 + sin(2*x)*y");
  const std::vector<Formula> velocity = {Formula("exp(x/2)*cos(y)"), Formula("-1.5")};
  const Formula constant("3.25");
  const std::vector<Field> fields = {
      project("velocity", Space::discontinuous(donor, 2, from), velocity),
      project("rho", Space::discontinuous(donor, 1, from), one(density)),
      sample("constant", Space::discontinuous(donor, 0, from), one(constant))};
  for (const bool weight : {false, true}) {
    for (const bool carried : {false, true}) {
      if (!weight && !carried) continue;
      TransferOptions options;
      options.same_basis = false;
      options.basis = to;
      if (weight) options.weight = Formula("x");
      if (carried) options.density = "rho";
      const TransferResult result = transfer(fields, target, options);
      const int power = weight ? 1 : 0;
      ASSERT_EQ(result.report.fields.size(), 4U);
      for (const FieldReport& line : result.report.fields) {
        EXPECT_LE(line.relative_mass_defect, 1e-14) << line.name;
        EXPECT_LE(line.max_element_defect, 1e-15) << line.name;
      }
      // The masses, by a rule of the test's own.
      const auto mass = [&](const std::vector<Field>& of, std::size_t k) {
        std::vector<const Field*> product = {&of[k]};
        if (carried && k != 1) product.push_back(&of[1]);
        return integral_of_product(product, power);
      };
      for (const std::size_t k : {std::size_t{0}, std::size_t{1}, std::size_t{2}}) {
        const double before = mass(fields, k);
        EXPECT_NEAR(mass(result.fields, k), before, 1e-13 * before) << fields[k].name();
        const std::size_t line = k == 0 ? 0 : k + 1;
        EXPECT_NEAR(result.report.fields[line].mass_before, before, 1e-13 * before);
      }
      for (const double c : result.fields[2].coefficients()) EXPECT_NEAR(c, 3.25, 1e-13);
      for (std::size_t i = 1; i < result.fields[0].coefficients().size(); i += 2)
        EXPECT_NEAR(result.fields[0].coefficients()[i], -1.5, 1e-13);
      EXPECT_LE(error_norms(result.fields[0], velocity).l2_relative, 3e-3);
      EXPECT_EQ(result.fields[0].space().uniform_degree(), 2);
      EXPECT_EQ(result.fields[1].space().uniform_degree(), 1);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Bases, Weighted,
                         ::testing::Combine(::testing::Values(1, 2, 3),
                                            ::testing::Values(Basis::reference, Basis::physical),
                                            ::testing::Values(Basis::reference, Basis::physical)));

TEST(Weighted, PhysicalPolynomialsAreExact) {
  const auto donor = grid_mesh(3, 2, 1.0, beside_axis(bend(0.15, 0.12)));
  const auto target = grid_mesh(2, 3, 1.0, beside_axis(bend(-0.1, 0.1)));
  const Formula density("2 + x*y");
  const Formula velocity("1 + x - 3*y^2");
  const auto space = Space::discontinuous(donor, 2, Basis::physical);
  const std::vector<Field> fields = {project("rho", space, one(density)),
                                     project("u", space, one(velocity))};
  TransferOptions options;
  options.weight = Formula("x + x^2");
  options.density = "rho";
  const TransferResult result = transfer(fields, target, options);
  EXPECT_LE(error_norms(result.fields[0], one(density)).l2_relative, 1e-13);
  EXPECT_LE(error_norms(result.fields[1], one(velocity)).l2_relative, 1e-12);
}

TEST(Weighted, ErrorFallsWithOrderDegreePlusOne) {
  const Formula density("2 + sin(2*x)*y");
  const Formula velocity("exp(x/2)*cos(y)");
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    double last = 0.0;
    double order = 0.0;
    for (const int n : {5, 9}) {
      const auto donor = grid_mesh(n, 2, 1.0, beside_axis(bend(0.15, 0.12)));
      const auto target = grid_mesh(n, 2, 1.0, beside_axis(bend(-0.1, 0.1)));
      const auto space = Space::discontinuous(donor, 2, basis);
      const std::vector<Field> fields = {sample("rho", space, one(density)),
                                         sample("u", space, one(velocity))};
      TransferOptions options;
      options.weight = Formula("x");
      options.density = "rho";
      const double error =
          error_norms(transfer(fields, target, options).fields[1], one(velocity)).l2_relative;
      if (last > 0.0) order = std::log(last / error) / std::log(9.0 / 5.0);
      last = error;
    }
    EXPECT_GT(order, 2.7);
  }
}

TEST(Weighted, CoverageIsHandledAsWithoutWeight) {
  const auto donor = grid_mesh(3, 2, 1.0, beside_axis(bend(0.15, 0.12)));
  const auto target = grid_mesh(2, 2, 1.0, [](const Vec2& p) {
    return Vec2{{1.2 + p[0], 0.1 + p[1]}};
  });
  const Formula constant("3.25");
  const Formula density("1 + x");
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    const auto space = Space::discontinuous(donor, 1, basis);
    const std::vector<Field> fields = {sample("u", space, one(constant)),
                                       project("rho", space, one(density))};
    TransferOptions options;
    options.weight = Formula("x");
    EXPECT_THROW((void)transfer(fields, target, options), UncoveredError);
    for (const Uncovered policy : {Uncovered::extend, Uncovered::zero}) {
      options.uncovered = policy;
      const TransferResult result = transfer(fields, target, options);
      const FieldReport& u = result.report.fields[0];
      EXPECT_LE(u.relative_mass_defect, 1e-14);
      EXPECT_GT(u.mass_outside, 0.1);
      if (policy == Uncovered::zero) {
        EXPECT_EQ(u.mass_made, 0.0);
        EXPECT_NEAR(u.mass_after, integral_of_product({&result.fields[0]}, 1), 1e-13);
      } else {
        EXPECT_GT(u.mass_made, 0.1);
        // Far outside its element a mapped product is extended, not the weight.
        EXPECT_LE(error_norms(result.fields[0], one(constant)).max,
                  basis == Basis::physical ? 1e-12 : 1e-3);
      }
    }
  }
}

std::string message_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& e) {
    return e.what();
  } catch (const NumericsError& e) {
    return std::string("numerics: ") + e.what();
  }
  return "no error";
}

TEST(WeightedErrors, NameWhatIsWrong) {
  const auto donor = grid_mesh(2, 1, 1.0, test::same_place);
  const auto space = Space::discontinuous(donor, 1);
  const Formula constant("1");
  const Field u = sample("u", space, one(constant));
  const std::vector<Formula> two = {constant, constant};
  const std::vector<Field> fields = {u, sample("v", space, two)};
  const auto message = [&](const char* weight, const char* density) {
    TransferOptions options;
    if (*weight != '\0') options.weight = Formula(weight);
    options.density = density;
    return message_of([&] { (void)transfer(fields, donor, options); });
  };
  EXPECT_EQ(message("x", ""),
            "weight 'x' is negative in triangle 0 of the donor mesh: -1, expected 0 or more");
  EXPECT_EQ(message("0", ""), "weight '0' is zero on all of triangle 0 of the donor mesh");
  const std::string no_polynomial =
      " is no polynomial of degree 0 to 4 on the donor mesh: the "
      "nearest one misses it by ";
  for (const char* text : {"1+sin(x)", "2+x^5"}) {
    const std::string start = std::string("weight '") + text + "'" + no_polynomial;
    EXPECT_EQ(message(text, "").substr(0, start.size()), start);
  }
  EXPECT_EQ(message("", "w"), "transfer: the density 'w' is none of the fields that are moved");
  EXPECT_EQ(message("", "v"), "transfer: the density 'v' has 2 components, expected 1");
  EXPECT_EQ(message("2+x^4", ""), "no error");

  TransferOptions options;
  options.weight = Formula("1+x^2");
  const std::vector<Field> mixed = {
      u, sample("p", Space::discontinuous(donor, 1, Basis::physical), one(constant))};
  EXPECT_EQ(message_of([&] { (void)transfer(mixed, donor, options); }),
            "transfer: field 'p' is written in other coordinates than field 'u', expected one "
            "basis for all fields of a weighted transfer");
  const Field high = sample("h", Space::discontinuous(donor, 9), one(constant));
  EXPECT_EQ(message_of([&] { (void)transfer(std::span(&high, 1), donor, options); }),
            "transfer: field 'h' times weight has degree 11, expected at most 10");
  const Formula sign("x");
  const std::vector<Field> negative = {u, sample("rho", space, one(sign))};
  TransferOptions carried;
  carried.density = "rho";
  EXPECT_EQ(message_of([&] { (void)transfer(negative, donor, carried); }),
            "numerics: target triangle 0: weight and transferred density are not positive there, "
            "so no field can be recovered");
}

}  // namespace
}  // namespace bezel
