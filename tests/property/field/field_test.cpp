// Identities of fields on random curved meshes with random coefficients.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "../../unit/field/checks.hpp"
#include "../../unit/field/meshes.hpp"
#include "bezel/base/random.hpp"
#include "bezel/field/field.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel {
namespace {

using field_test::MeshPtr;

MeshPtr random_mesh(RandomStream& random, int n, int g) {
  const double amplitude = random.uniform(0.0, 0.1);
  const double a = random.uniform(0.5, 3.0), b = random.uniform(0.5, 3.0),
               c = random.uniform(0.0, 6.0);
  return field_test::square(n, g, [=](const Vec2& p) {
    return Vec2{p.x() + amplitude * std::sin(a * p.y() + c),
                p.y() + amplitude * std::cos(b * p.x() - c)};
  });
}

Lambda random_lambda(RandomStream& random) {
  double s = random.uniform(), t = random.uniform();
  if (s + t > 1) s = 1 - s, t = 1 - t;
  // Now and then a corner or an edge.
  const std::uint64_t kind = random.below(8);
  if (kind == 0) return {0.0, s, 1 - s};
  if (kind == 1) return {1.0, 0.0, 0.0};
  return {1 - s - t, s, t};
}

Field random_field(RandomStream& random, const std::shared_ptr<const Space>& space,
                   int components = 1) {
  std::vector<double> dofs(space->dof_count() * static_cast<std::size_t>(components));
  for (double& x : dofs) x = random.uniform(-1, 1);
  return Field("f", space, space->expand(dofs, components), components);
}

std::vector<std::shared_ptr<const Space>> spaces(const MeshPtr& mesh, int d) {
  std::vector<std::shared_ptr<const Space>> all{Space::discontinuous(mesh, d),
                                                Space::discontinuous(mesh, d, Basis::physical)};
  if (d > 0) all.push_back(Space::continuous(mesh, d));
  return all;
}

class FieldProperties : public testing::TestWithParam<int> {};

TEST_P(FieldProperties, RangeEnclosesEveryValue) {
  RandomStream random("field.range", static_cast<std::uint64_t>(GetParam()));
  const int g = 1 + GetParam() % 5;
  const MeshPtr mesh = random_mesh(random, 2, g);
  for (int d = 0; d <= 10; d += 1 + static_cast<int>(random.below(3)))
    for (const auto& space : spaces(mesh, d)) {
      const Field field = random_field(random, space);
      const bernstein::Range loose = value_range(field, 0, 0.0),
                             range = value_range(field, 0, 1e-2);
      EXPECT_LE(loose.lo, range.lo) << "seed " << GetParam();
      EXPECT_GE(loose.hi, range.hi) << "seed " << GetParam();
      constexpr int fine = 100;
      std::vector<Lambda> lattice;
      for (int k = 0; k <= fine; ++k)
        for (int j = 0; j + k <= fine; ++j)
          lattice.push_back({(fine - j - k) / double(fine), j / double(fine), k / double(fine)});
      std::vector<double> values(lattice.size());
      double lo = 1e9, hi = -1e9;
      for (std::size_t e = 0; e < mesh->element_count(); ++e) {
        field.evaluate(ElementId(e), lattice, values);
        lo = std::min(lo, *std::min_element(values.begin(), values.end()));
        hi = std::max(hi, *std::max_element(values.begin(), values.end()));
      }
      EXPECT_LE(range.lo, lo + 1e-14) << "seed " << GetParam() << " degree " << d;
      EXPECT_GE(range.hi, hi - 1e-14) << "seed " << GetParam() << " degree " << d;
      // Sharp: each end within the tolerance of the true one, which the lattice misses by at most
      // h^2/8 times the second derivative, 4 d (d-1) (a physical polynomial varies g times as
      // fast).
      const double missed = 4.0 * d * (d - 1) * g * g / (8.0 * fine * fine);
      EXPECT_LT(range.hi - hi, 1e-2 * (loose.hi - loose.lo) + missed + 1e-12) << d << " " << g;
      EXPECT_LT(lo - range.lo, 1e-2 * (loose.hi - loose.lo) + missed + 1e-12) << d << " " << g;
    }
}

TEST_P(FieldProperties, IntegralsAgreeWithQuadratureAndBoundEachOther) {
  RandomStream random("field.integral", static_cast<std::uint64_t>(GetParam()));
  const int g = 1 + GetParam() % 4;
  const MeshPtr mesh = random_mesh(random, 2, g);
  const int d = static_cast<int>(random.below(7));
  for (const auto& space : spaces(mesh, d)) {
    const Field field = random_field(random, space, 2);
    const std::vector<double> parts = element_integrals(field);
    const TriangleRule rule = triangle_rule(d * g + 2 * g);
    double square = 0.0;
    for (std::size_t e = 0; e < mesh->element_count(); ++e) {
      std::array<double, 2> total{};
      for (std::size_t q = 0; q < rule.weight.size(); ++q) {
        const auto map =
            bernstein::evaluate_gradient<Vec2>(g, mesh->gather(ElementId(e)), rule.lambda[q]);
        std::array<double, 2> value{};
        field.evaluate(ElementId(e), rule.lambda[q], value);
        for (std::size_t k = 0; k < 2; ++k)
          total[k] += rule.weight[q] * value[k] * cross(map.du, map.dv);
      }
      for (std::size_t k = 0; k < 2; ++k)
        EXPECT_NEAR(parts[2 * e + k], total[k], 1e-14) << "seed " << GetParam();
      square += std::abs(total[0]) + std::abs(total[1]);
    }
    // |integral| <= integral_abs <= sqrt(area * components) * L2 norm.
    const std::vector<double> sum = integral(field), absolute = integral_abs(field);
    double area_total = 0.0;
    for (std::size_t e = 0; e < mesh->element_count(); ++e)
      area_total += area(g, mesh->gather(ElementId(e)));
    EXPECT_LE(std::abs(sum[0]) + std::abs(sum[1]), square + 1e-14);
    EXPECT_LE(square, (absolute[0] + absolute[1]) * (1 + 1e-2));
    EXPECT_LE(absolute[0] + absolute[1], std::sqrt(2 * area_total) * l2_norm(field) * (1 + 1e-2));
  }
}

TEST_P(FieldProperties, EvaluatorFindsWhatTheElementSays) {
  // Inverse of the map: the value at the image of a reference point, found through the plane.
  RandomStream random("field.evaluator", static_cast<std::uint64_t>(GetParam()));
  const int g = 1 + GetParam() % 5;
  const MeshPtr mesh = random_mesh(random, 3, g);
  const Field field = random_field(random, Space::continuous(mesh, 3));
  const FieldEvaluator at(field);
  for (std::size_t e = 0; e < mesh->element_count(); ++e)
    for (int i = 0; i < 20; ++i) {
      const Lambda lambda = random_lambda(random);
      const Vec2 p = bernstein::evaluate<Vec2>(g, mesh->gather(ElementId(e)), lambda);
      double expected = 0.0, found = 0.0;
      field.evaluate(ElementId(e), lambda, {&expected, 1});
      at.evaluate(std::span<const Vec2>(&p, 1), {&found, 1});
      EXPECT_NEAR(found, expected, 1e-12) << "seed " << GetParam() << " element " << e;
    }
}

TEST_P(FieldProperties, SampleThenSampleAgain) {
  // Sampling is linear and keeps the fields of the space: f + 2 g sampled = sample(f) + 2
  // sample(g).
  RandomStream random("field.sample", static_cast<std::uint64_t>(GetParam()));
  const MeshPtr mesh = random_mesh(random, 2, 1 + GetParam() % 3);
  const auto all = field_test::formulas({"sin(2*x)+y", "exp(y)*x", "sin(2*x)+y+2*(exp(y)*x)"});
  for (const auto& space : spaces(mesh, 1 + static_cast<int>(random.below(8)))) {
    const Field field = GetParam() % 2 == 0 ? sample("f", space, all) : project("f", space, all);
    for (std::size_t i = 0; i < space->coefficient_count(); ++i)
      EXPECT_NEAR(field.coefficients()[3 * i] + 2 * field.coefficients()[3 * i + 1],
                  field.coefficients()[3 * i + 2], 2e-11)
          << "seed " << GetParam();
  }
}

TEST_P(FieldProperties, PhysicalMassMatricesAreWellConditioned) {
  // On the frames of element_frame() the condition stays within a moderate factor per degree of the
  // reference one, C(2d+2, d), for elements of every thinness: that is what the frames are for.
  RandomStream random("field.condition", static_cast<std::uint64_t>(GetParam()));
  const double thin = std::pow(10.0, -random.uniform(0, 4)), angle = random.uniform(0, 6);
  const int g = 1 + GetParam() % 4;
  const double amplitude = random.uniform(0.0, 0.08);
  const MeshPtr mesh = field_test::square(2, g, [&](const Vec2& p) {
    const double x = p.x() + amplitude * std::sin(3 * p.y()),
                 y = thin * (p.y() + amplitude * std::cos(3 * p.x()));
    return Vec2{std::cos(angle) * x - std::sin(angle) * y,
                std::sin(angle) * x + std::cos(angle) * y};
  });
  for (int d = 1; d <= 8; ++d) {
    const auto space = Space::discontinuous(mesh, d, Basis::physical);
    const int n = bernstein::triangle_size(d);
    const TriangleRule rule = triangle_rule(2 * d * g + 2 * g - 2);
    double reference = 1.0;  // C(2d+2, d)
    for (int i = 1; i <= d; ++i) reference = reference * (d + 2 + i) / i;
    for (std::size_t e = 0; e < mesh->element_count(); ++e) {
      Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
      Eigen::VectorXd b(n);
      for (std::size_t q = 0; q < rule.weight.size(); ++q) {
        const auto map =
            bernstein::evaluate_gradient<Vec2>(g, mesh->gather(ElementId(e)), rule.lambda[q]);
        bernstein::basis(d, space->frame(ElementId(e)).lambda(map.value),
                         {b.data(), static_cast<std::size_t>(n)});
        mass += rule.weight[q] * cross(map.du, map.dv) * b * b.transpose();
      }
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(mass, Eigen::EigenvaluesOnly);
      const double condition = eigen.eigenvalues()(n - 1) / eigen.eigenvalues()(0);
      EXPECT_LT(condition, 2.0 * reference * std::pow(2.5, d))
          << "seed " << GetParam() << " degree " << d;
      EXPECT_GT(condition, 0.9 * reference);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FieldProperties, testing::Range(0, 12));

}  // namespace
}  // namespace bezel
