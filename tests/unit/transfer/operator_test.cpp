#include "bezel/transfer/operator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "bezel/base/atomic_file.hpp"
#include "bezel/numeric/quadrature.hpp"
#include "support/meshes.hpp"
#include "support/message_of.hpp"

namespace bezel {
namespace {

using test::bend;
using test::grid_mesh;
using test::message_of;
using test::turn;

Field random_field(const std::shared_ptr<const Space>& space, const char* stream,
                   int components = 1) {
  RandomStream random(stream, 1);
  std::vector<double> c(space->coefficient_count() * static_cast<std::size_t>(components));
  for (double& x : c) x = random.uniform() - 0.5;
  return Field("u", space, std::move(c), components);
}

double largest(std::span<const double> values) {
  double m = 0.0;
  for (const double x : values) m = std::max(m, std::abs(x));
  return m;
}

double largest_difference(const Field& a, const Field& b) {
  double m = 0.0;
  for (std::size_t i = 0; i < a.coefficients().size(); ++i)
    m = std::max(m, std::abs(a.coefficients()[i] - b.coefficients()[i]));
  return m;
}

/// Of the values, at 15 points of each element: coefficients are worse conditioned.
double largest_value_difference(const Field& a, const Field& b) {
  std::vector<double> c(a.coefficients().begin(), a.coefficients().end());
  for (std::size_t i = 0; i < c.size(); ++i) c[i] -= b.coefficients()[i];
  const Field difference("difference", a.space_ptr(), std::move(c), a.components());
  double m = 0.0;
  std::vector<double> value(static_cast<std::size_t>(a.components()));
  for (std::size_t e = 0; e < a.mesh().element_count(); ++e) {
    for (int n = 0; n < 15; ++n) {
      const auto at = bernstein::triangle_multi_index(4, n);
      difference.evaluate(ElementId(e), {at[0] / 4.0, at[1] / 4.0, at[2] / 4.0}, value);
      m = std::max(m, largest(value));
    }
  }
  return m;
}

/// Integral of the product of two fields on one mesh, all components; exact.
double inner(const Field& a, const Field& b) {
  const TriangleRule rule = triangle_rule(30);
  double sum = 0.0;
  std::vector<double> va(static_cast<std::size_t>(a.components()));
  std::vector<double> vb(va.size());
  for (std::size_t e = 0; e < a.mesh().element_count(); ++e) {
    const std::vector<Vec2> control = a.mesh().gather(ElementId(e));
    for (std::size_t q = 0; q < rule.weight.size(); ++q) {
      const auto at =
          bernstein::evaluate_gradient<Vec2>(a.mesh().degree(), control, rule.lambda[q]);
      a.evaluate(ElementId(e), rule.lambda[q], va);
      b.evaluate(ElementId(e), rule.lambda[q], vb);
      for (std::size_t c = 0; c < va.size(); ++c)
        sum += rule.weight[q] * cross(at.du, at.dv) * va[c] * vb[c];
    }
  }
  return sum;
}

/// Meshes that lie in each other in part: every target policy has something to do.
struct Meshes {
  explicit Meshes(int g)
      : donor(grid_mesh(3, g, 1.0, bend(0.15, 0.12))),
        target(grid_mesh(4, g, 1.0, turn(0.3, 0.8, bend(0.1, -0.15)))) {}
  std::shared_ptr<const TriangleMesh> donor, target;
};

using Parameters = std::tuple<int, int, Basis, Basis>;
class Operator : public ::testing::TestWithParam<Parameters> {};

TEST_P(Operator, EqualsTransferAndItsAdjoint) {
  const auto [g, p, from, to] = GetParam();
  const Meshes meshes(g);
  const auto space = Space::discontinuous(meshes.donor, p, from);
  const std::vector<Field> fields = {
      random_field(space, "operator", 2),
      Field("constant", space, std::vector<double>(space->coefficient_count(), 3.25))};
  for (const Uncovered policy : {Uncovered::extend, Uncovered::zero}) {
    TransferOptions options;
    options.degree = std::min(p, 3);
    options.same_basis = false;
    options.basis = to;
    options.uncovered = policy;
    const TransferResult expected = transfer(fields, meshes.target, options);
    const TransferOperator move(space, meshes.target, options);
    const TransferResult found = move.transfer(fields);
    // Both are rounded by a few u times the condition of the mass matrix (56 at degree 3), relative
    // to the result, which on partly covered elements is larger than the field.
    const double allowed = options.degree < 3 ? 1e-14 : 4.0 * 56.0 * 0x1p-53;
    for (std::size_t i = 0; i < fields.size(); ++i) {
      EXPECT_LE(largest_value_difference(expected.fields[i], found.fields[i]),
                allowed * largest(expected.fields[i].coefficients()));
    }
    if (policy == Uncovered::extend) {
      for (const double c : found.fields[1].coefficients()) EXPECT_NEAR(c, 3.25, 1e-13);
    }
    ASSERT_EQ(found.report.fields.size(), expected.report.fields.size());
    for (std::size_t i = 0; i < found.report.fields.size(); ++i) {
      const FieldReport& a = found.report.fields[i];
      const FieldReport& b = expected.report.fields[i];
      EXPECT_LE(a.relative_mass_defect, 1e-14);
      EXPECT_LE(a.max_element_defect, 1e-15);
      EXPECT_NEAR(a.mass_outside, b.mass_outside, 1e-14 * (1.0 + std::abs(b.mass_before)));
      EXPECT_NEAR(a.mass_made, b.mass_made, 1e-15);
    }
    EXPECT_EQ(found.report.pairs, expected.report.pairs);
    EXPECT_EQ(found.report.outside_area, expected.report.outside_area);

    const Field g_field = random_field(move.target_space(), "operator adjoint", 2);
    const Field back = move.apply_adjoint(g_field);
    const double scale = std::sqrt(inner(fields[0], fields[0]) * inner(g_field, g_field));
    EXPECT_NEAR(inner(found.fields[0], g_field), inner(fields[0], back), 1e-14 * scale);
  }
}

std::string name_of(const ::testing::TestParamInfo<Parameters>& tested) {
  const auto [g, p, from, to] = tested.param;
  return "g" + std::to_string(g) + "p" + std::to_string(p) + "basis" +
         std::to_string(static_cast<int>(from)) + std::to_string(static_cast<int>(to));
}
constexpr auto both = std::array{Basis::reference, Basis::physical};
INSTANTIATE_TEST_SUITE_P(Bases, Operator,
                         ::testing::Combine(::testing::Values(1, 2), ::testing::Values(0, 1, 3),
                                            ::testing::ValuesIn(both), ::testing::ValuesIn(both)),
                         name_of);
INSTANTIATE_TEST_SUITE_P(Higher, Operator,
                         ::testing::Values(Parameters{3, 5, Basis::reference, Basis::physical},
                                           Parameters{3, 5, Basis::physical, Basis::reference}),
                         name_of);

TEST(TransferOperator, DegreesMayVaryAndContinuousFieldsAreTakenByElement) {
  const Meshes meshes(2);
  std::vector<int> degrees(meshes.donor->element_count());
  for (std::size_t e = 0; e < degrees.size(); ++e) degrees[e] = static_cast<int>(e % 4);
  const auto varying = Space::discontinuous(meshes.donor, degrees, Basis::reference);
  const auto continuous = Space::continuous(meshes.donor, 2, Basis::reference);
  RandomStream random("operator continuous", 1);
  std::vector<double> dofs(continuous->dof_count());
  for (double& x : dofs) x = random.uniform();
  TransferOptions options;
  options.uncovered = Uncovered::extend;
  for (const Field& f : {random_field(varying, "operator degrees"),
                         Field("v", continuous, continuous->expand(dofs))}) {
    const TransferOperator move(f.space_ptr(), meshes.target, options);
    const Field expected = transfer(std::span(&f, 1), meshes.target, options).fields[0];
    EXPECT_LE(largest_difference(expected, move.apply(f)),
              3e-14 * largest(expected.coefficients()));
    const Field other = random_field(move.target_space(), "operator other");
    const Field back = move.apply_adjoint(other);
    EXPECT_EQ(back.space().continuity(), Continuity::discontinuous);
    EXPECT_NEAR(inner(move.apply(f), other), inner(f, back), 1e-14);
  }
}

TEST(TransferOperator, OneTargetElementOverManyDonors) {
  const auto donor = grid_mesh(12, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(1, 1, 0.9, test::same_place);
  const auto space = Space::discontinuous(donor, 2);
  const Field f = random_field(space, "operator many");
  const TransferOperator move(space, target);
  EXPECT_GT(move.block_count(), 250U);
  const Field expected = transfer(std::span(&f, 1), target).fields[0];
  EXPECT_LE(largest_difference(expected, move.apply(f)), 1e-14);
}

TEST(TransferOperator, SameBitsForAnyNumberOfThreads) {
  const auto donor = grid_mesh(14, 2, 1.0, bend(0.15, 0.12));
  const auto target = grid_mesh(13, 2, 1.0, bend(-0.1, 0.1));
  const auto space = Space::discontinuous(donor, 1);
  const Field f = random_field(space, "operator threads", 3);
  TransferOptions single;
  single.threads = 1;
  const TransferOperator one(space, target, single);
  TransferOptions several;
  several.threads = 4;
  const TransferOperator four(space, target, several);
  EXPECT_EQ(largest_difference(one.apply(f, 1), four.apply(f, 4)), 0.0);
  const Field g = random_field(one.target_space(), "operator threads adjoint");
  EXPECT_EQ(largest_difference(
                one.apply_adjoint(g, 1),
                four.apply_adjoint(Field("g", four.target_space(),
                                         {g.coefficients().begin(), g.coefficients().end()}),
                                   4)),
            0.0);
}

TEST(TransferOperator, TheMatrixFileIsTheOperator) {
  const Meshes meshes(2);
  const auto space = Space::discontinuous(meshes.donor, 2);
  TransferOptions options;
  options.uncovered = Uncovered::extend;
  options.degree = 1;
  const TransferOperator move(space, meshes.target, options);
  const Field f = random_field(space, "operator matrix");
  const auto path = std::filesystem::temp_directory_path() / "bezel_operator_test.mtx";
  move.write_matrix_market(path.string());
  std::istringstream file(read_file(path.string()));
  std::filesystem::remove(path);
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, "%%MatrixMarket matrix coordinate real general");
  while (file.peek() == '%') std::getline(file, line);
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::size_t entries = 0;
  file >> rows >> columns >> entries;
  ASSERT_EQ(rows, move.target_space()->coefficient_count());
  ASSERT_EQ(columns, space->coefficient_count());
  std::vector<double> product(rows, 0.0);
  std::size_t read = 0;
  std::size_t i = 0;
  std::size_t j = 0;
  double value = 0.0;
  std::pair<std::size_t, std::size_t> last{0, 0};
  for (; file >> i >> j >> value; ++read) {
    ASSERT_TRUE(i >= 1 && i <= rows && j >= 1 && j <= columns);
    ASSERT_LT(last, std::pair(i, j)) << "each entry once, by row and column";
    last = {i, j};
    product[i - 1] += value * f.coefficients()[j - 1];
  }
  EXPECT_EQ(read, entries);
  const Field expected = move.apply(f);
  for (std::size_t n = 0; n < rows; ++n)
    EXPECT_NEAR(product[n], expected.coefficients()[n], 1e-14) << "row " << n;
}

TEST(TransferOperator, SpacesAreComparedByValue) {
  const Meshes meshes(2);
  const Meshes copies(2);
  TransferOptions options;
  options.uncovered = Uncovered::zero;
  for (const Basis basis : both) {
    const TransferOperator move(Space::discontinuous(meshes.donor, 1, basis), meshes.target,
                                options);
    EXPECT_TRUE(move.accepts(*Space::discontinuous(copies.donor, 1, basis)));
    EXPECT_FALSE(move.accepts(*Space::discontinuous(copies.donor, 2, basis)));
    EXPECT_FALSE(move.accepts(*Space::discontinuous(meshes.target, 1, basis)));
  }
}

TEST(TransferOperatorErrors, NameWhatIsWrong) {
  const Meshes meshes(1);
  const auto space = Space::discontinuous(meshes.donor, 1);
  TransferOptions options;
  EXPECT_THROW(TransferOperator(space, meshes.target, options), UncoveredError);
  options.uncovered = Uncovered::zero;
  EXPECT_EQ(message_of([&] { TransferOperator(nullptr, meshes.target, options); }),
            "transfer operator: no donor space given");
  EXPECT_EQ(message_of([&] { TransferOperator(space, nullptr, options); }),
            "transfer operator: no target mesh given");
  options.degree = 12;
  EXPECT_EQ(message_of([&] { TransferOperator(space, meshes.target, options); }),
            "transfer operator: degree 12 is not supported, expected 0 to 10");
  options.degree = -1;
  const TransferOperator move(space, meshes.target, options);
  const Field other = random_field(Space::discontinuous(meshes.donor, 2), "operator errors");
  EXPECT_EQ(message_of([&] { (void)move.apply(other); }),
            "transfer operator: field 'u' lives on another space than the operator was made for, "
            "expected the same mesh, degree and basis");
  EXPECT_EQ(message_of([&] { (void)move.apply_adjoint(other); }),
            "transfer operator: field 'u' does not live on the operator's target space, expected "
            "the same mesh, degree and basis");
  EXPECT_THROW(move.write_matrix_market("no/such/folder/x.mtx"), InputError);
  EXPECT_THROW(TransferOperator(space, meshes.target, options, [](double) { return false; }),
               Interrupted);
}

/// Steep enough for the projection to leave the donor's range.
Field steps(const std::shared_ptr<const Space>& space) {
  RandomStream random("steps", 1);
  std::vector<double> c(space->coefficient_count());
  for (std::size_t e = 0; e < space->mesh()->element_count(); ++e) {
    const double value = random.uniform() < 0.5 ? 0.0 : 1.0;
    const auto n = static_cast<std::size_t>(bernstein::triangle_size(space->degree(ElementId(e))));
    std::fill_n(c.begin() + static_cast<std::ptrdiff_t>(space->offset(ElementId(e))), n, value);
  }
  return Field("steps", space, std::move(c));
}

TEST(TransferOperator, KeepsBoundsAsTransferDoes) {
  for (const Basis basis : {Basis::physical, Basis::reference}) {
    for (const int g : {1, 3}) {
      const auto donor = grid_mesh(6, g, 1.0, bend(0.1, 0.08));
      const auto target = grid_mesh(5, g, 0.7, turn(0.4, 0.9));
      const Field f = steps(Space::discontinuous(donor, 2, basis));
      const TransferOperator op(f.space_ptr(), target);
      const TransferResult free = op.transfer({&f, 1});
      EXPECT_LT(free.report.fields[0].min_after, -0.05);
      EXPECT_GT(free.report.fields[0].max_after, 1.05);
      for (const Bounds& bounds : {Bounds::between(0.0, 1.0), Bounds::local()}) {
        TransferOptions options;
        options.bounds = bounds;
        const TransferResult expected = transfer({&f, 1}, target, options);
        const TransferResult found = op.transfer({&f, 1}, bounds);
        const FieldReport& line = found.report.fields[0];
        EXPECT_LT(largest_value_difference(found.fields[0], expected.fields[0]), 1e-11);
        // Local ranges may exceed the true ones by the rounding of a composition.
        const double over = bounds.kind == Bounds::Kind::local ? 2e-13 : 1e-15;
        EXPECT_GE(line.min_after, -over);
        EXPECT_LE(line.max_after, 1.0 + over);
        EXPECT_LT(line.relative_mass_defect, 1e-14);
        EXPECT_EQ(line.bounds.elements_limited, expected.report.fields[0].bounds.elements_limited);
        EXPECT_GT(line.bounds.elements_limited, 0);
        const Field applied = op.apply(f, bounds);
        EXPECT_EQ(largest_difference(applied, found.fields[0]), 0.0);
      }
      // Bounds of one call are none of the next.
      EXPECT_EQ(largest_difference(op.apply(f), free.fields[0]), 0.0);
    }
  }
}

TEST(TransferOperator, SaysWhatIsWrongWithBounds) {
  const auto donor = grid_mesh(3, 1, 1.0, bend(0.0, 0.0));
  const Field f = steps(Space::discontinuous(donor, 1, Basis::physical));
  const TransferOperator op(f.space_ptr(), grid_mesh(3, 1, 0.5, turn(0.3, 1.0)));
  EXPECT_THROW((void)op.apply(f, Bounds::between(1.0, 0.0)), InputError);
  EXPECT_THROW((void)op.apply(f, Bounds::between(std::nan(""), 1.0)), InputError);
  EXPECT_THROW((void)op.apply(f, Bounds::between(2.0, 3.0)), NumericsError);
  TransferOptions zero;
  zero.uncovered = Uncovered::zero;
  const TransferOperator wide(f.space_ptr(), grid_mesh(3, 1, 1.5, turn(0.3, 1.0)), zero);
  EXPECT_THROW((void)wide.apply(f, Bounds::between(0.5, 2.0)), InputError);
}

}  // namespace
}  // namespace bezel
