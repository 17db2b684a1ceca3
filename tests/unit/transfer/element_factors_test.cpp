#include "bezel/transfer/element_factors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/transfer/mass_rule.hpp"
#include "support/meshes.hpp"
#include "support/slow_projection.hpp"

namespace bezel::detail {
namespace {

using test::Real;

/// Integrals of w phi_i phi_j and of w phi_i on one element, in long double.
struct Slow {
  Slow(const Space& space, ElementId e, const Field* weight)
      : size(static_cast<std::size_t>(bernstein::triangle_size(space.degree(e)))),
        mass(size * size, 0),
        integral(size, 0) {
    const int p = space.degree(e), g = space.mesh()->degree();
    const test::SlowElement element(space, e);
    const TriangleRule rule = triangle_rule(2 * p + 2 * (g - 1) + 2 * g);
    std::vector<Real> phi;
    for (std::size_t q = 0; q < rule.weight.size(); ++q) {
      const auto& l = rule.lambda[q];
      const auto at = element.map(l[1], l[2]);
      double w = 1.0;
      if (weight != nullptr) weight->evaluate(e, l, {&w, 1});
      const Real measure = Real(rule.weight[q]) * test::cross(at.du, at.dv) * Real(w);
      test::slow_basis(p, l[1], l[2], phi);
      for (std::size_t i = 0; i < size; ++i) {
        integral[i] += measure * phi[i];
        for (std::size_t j = 0; j < size; ++j) mass[i * size + j] += measure * phi[i] * phi[j];
      }
    }
  }
  std::size_t size;
  std::vector<Real> mass, integral;
};

// 1 to 18 elements: the last block of eight is partly filled, also with one element alone.
TEST(ElementFactors, EqualTheMatricesOfTheElementsOneByOne) {
  for (const int g : {1, 2, 3}) {
    for (const int n : {1, 2, 3}) {
      const auto mesh = test::grid_mesh(n, g, 1.0, test::bend(0.1, 0.1));
      const Formula two_and_more("2 + x");
      const Field weight =
          sample("w", Space::discontinuous(mesh, 1, Basis::physical), {&two_and_more, 1});
      for (const int p : {1, 2, 4, 6}) {
        const auto space = Space::continuous(mesh, p);
        for (const Field* w : {static_cast<const Field*>(nullptr), &weight}) {
          const ElementFactors factors(*space, w, 1);
          const std::size_t size = factors.size(), count = mesh->element_count();
          ASSERT_EQ(factors.element_count(), count);
          ASSERT_EQ(factors.block_count(), (count + 7) / 8);
          std::vector<double> v(factors.block_count() * size * ElementFactors::width, 0.0);
          RandomStream random("element factors", static_cast<std::uint64_t>(100 * g + 10 * n + p));
          for (std::size_t e = 0; e < count; ++e)
            for (std::size_t i = 0; i < size; ++i) v[factors.place(e, i)] = random.uniform(-1, 1);
          const std::vector<double> start = v;
          const std::size_t one_block = size * ElementFactors::width;
          for (std::size_t b = 0; b < factors.block_count(); ++b)
            factors.multiply(b, v.data() + b * one_block);
          std::vector<double> matrix(size * size);
          for (std::size_t e = 0; e < count; ++e) {
            const Slow slow(*space, ElementId(e), w);
            factors.matrix(e, matrix);
            for (std::size_t i = 0; i < size; ++i) {
              Real product = 0;
              for (std::size_t j = 0; j < size; ++j) {
                product += slow.mass[i * size + j] * Real(start[factors.place(e, j)]);
                EXPECT_NEAR(matrix[i * size + j], static_cast<double>(slow.mass[i * size + j]),
                            4e-15);
              }
              EXPECT_NEAR(v[factors.place(e, i)], static_cast<double>(product), 1e-14)
                  << g << " " << n << " " << p << " " << e;
              EXPECT_NEAR(factors.integrals()[e * size + i], static_cast<double>(slow.integral[i]),
                          4e-15);
              EXPECT_NEAR(factors.diagonal()[factors.place(e, i)],
                          static_cast<double>(slow.mass[i * size + i]), 4e-15);
            }
          }
          for (std::size_t b = 0; b < factors.block_count(); ++b)
            factors.divide(b, v.data() + b * one_block);
          // The condition is at most 3432 for the triangle itself (degree 6), here a few times
          // that.
          for (std::size_t e = 0; e < count; ++e)
            for (std::size_t i = 0; i < size; ++i)
              EXPECT_NEAR(v[factors.place(e, i)], start[factors.place(e, i)], 4e-12);
        }
      }
    }
  }
}

TEST(ElementFactors, NamesTheTriangleThatHasNoMatrix) {
  // A triangle without area among others.
  const auto mesh = std::make_shared<const TriangleMesh>(
      1, std::vector<Vec2>{{{0, 0}}, {{1, 0}}, {{0, 1}}, {{2, 0}}},
      std::vector<NodeId>{NodeId(0), NodeId(1), NodeId(2), NodeId(0), NodeId(1), NodeId(3)});
  const auto space = Space::discontinuous(mesh, 1);
  const Formula one("1");
  const Field weight = sample("w", Space::discontinuous(mesh, 0), {&one, 1});
  try {
    const ElementFactors factors(*space, &weight, 1);
    FAIL();
  } catch (const NumericsError& error) {
    EXPECT_NE(std::string(error.what()).find("triangle 1"), std::string::npos) << error.what();
  }
}

TEST(Cholesky, FactorsAndRefuses) {
  std::vector<double> a = {4, 99, 99, 2, 5, 99, -2, 1, 6};
  ASSERT_TRUE(cholesky(3, a));
  EXPECT_EQ(a[0], 2.0);
  EXPECT_EQ(a[3], 1.0);
  EXPECT_EQ(a[4], 2.0);
  EXPECT_EQ(a[6], -1.0);
  EXPECT_EQ(a[7], 1.0);
  EXPECT_EQ(a[8], 2.0);
  std::vector<double> indefinite = {1, 0, 2, 1};
  EXPECT_FALSE(cholesky(2, indefinite));
  std::vector<double> not_a_number = {std::nan("")};
  EXPECT_FALSE(cholesky(1, not_a_number));
}

TEST(MassRule, PlacesAndJacobiansAreThoseOfTheMap) {
  for (int g = 1; g <= 10; ++g) {
    const auto mesh = test::grid_mesh(1, g, 1.0, test::bend(0.05, 0.05));
    const auto space = Space::discontinuous(mesh, 1);
    const test::SlowElement element(*space, ElementId(1));
    const MassRule rule = make_mass_rule(g, 7);
    const auto control = mesh->gather(ElementId(1));
    double area = 0.0;
    for (std::size_t q = 0; q < rule.weight.size(); ++q) {
      const auto at = element.map(rule.place[q][0], rule.place[q][1]);
      const MassPoint point = mass_point(rule, control, q);
      EXPECT_NEAR(point.x[0], static_cast<double>(at.x.x), 2e-15);
      EXPECT_NEAR(point.x[1], static_cast<double>(at.x.y), 2e-15);
      EXPECT_NEAR(point.det, static_cast<double>(test::cross(at.du, at.dv)), 1e-13);
      area += rule.weight[q];
    }
    EXPECT_NEAR(area, 0.5, 1e-15);
  }
}

}  // namespace
}  // namespace bezel::detail
