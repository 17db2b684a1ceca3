#include "bezel/numeric/quadrature.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/numeric/double_double.hpp"
#include "bezel/numeric/sum.hpp"

namespace {

using bezel::DoubleDouble;
using bezel::gauss_legendre;
using bezel::gauss_lobatto;
using bezel::IntervalRule;
using bezel::triangle_rule;
using bezel::TriangleRule;

// Legendre polynomials 0..n at 2x - 1, in double-double: an orthogonal basis sees every degree
// equally, where high monomials see only the end point.
std::vector<DoubleDouble> legendre(int n, double x) {
  const DoubleDouble y = DoubleDouble(2.0) * DoubleDouble(x) - DoubleDouble(1.0);
  std::vector<DoubleDouble> p{DoubleDouble(1.0), y};
  for (int k = 1; k < n; ++k) {
    const auto i = static_cast<std::size_t>(k);
    p.push_back((DoubleDouble(2.0 * k + 1.0) * y * p[i] - DoubleDouble(k) * p[i - 1]) /
                DoubleDouble(k + 1.0));
  }
  return p;
}

// sum of weight P_k: 1 for k = 0, else 0. A node off by e moves P_k by at most e |P_k'|; with nodes
// and weights rounded correctly the sums stay below a few u in practice; 16 u is the budget for n =
// 200.
void check_exactness(const IntervalRule& rule, int degree) {
  std::vector<DoubleDouble> moment(static_cast<std::size_t>(degree + 1), DoubleDouble(0.0));
  for (std::size_t q = 0; q < rule.node.size(); ++q) {
    const auto p = legendre(degree, rule.node[q]);
    for (std::size_t k = 0; k < moment.size(); ++k)
      moment[k] += DoubleDouble(rule.weight[q]) * p[k];
  }
  moment[0] -= DoubleDouble(1.0);
  for (std::size_t k = 0; k < moment.size(); ++k)
    EXPECT_LE(std::fabs(moment[k].hi), 16.0 * 0x1p-53) << rule.size() << " points, degree " << k;
}

TEST(Quadrature, KnownGaussLegendre) {
  EXPECT_EQ(gauss_legendre(1).node, std::vector<double>{0.5});
  EXPECT_EQ(gauss_legendre(1).weight, std::vector<double>{1.0});
  const IntervalRule three = gauss_legendre(3);
  EXPECT_DOUBLE_EQ(three.node[0], 0.5 - std::sqrt(0.15));
  EXPECT_EQ(three.node[1], 0.5);
  EXPECT_DOUBLE_EQ(three.weight[0], 5.0 / 18.0);
  EXPECT_DOUBLE_EQ(three.weight[1], 4.0 / 9.0);
}

// Nodes and weights of 5 points on [-1, 1] have closed forms; 1 ulp.
TEST(Quadrature, FivePointsAreWithinOneUlp) {
  const IntervalRule rule = gauss_legendre(5);
  const long double outer = std::sqrt(5.0L + 2.0L * std::sqrt(10.0L / 7.0L)) / 3.0L;
  const long double weight = (322.0L - 13.0L * std::sqrt(70.0L)) / 900.0L;
  const auto node = static_cast<double>((1.0L - outer) / 2.0L);
  EXPECT_LE(std::fabs(rule.node[0] - node), std::nextafter(node, 1.0) - node);
  EXPECT_EQ(rule.weight[0], static_cast<double>(weight / 2.0L));
}

TEST(Quadrature, GaussLegendreIsExactAscendingAndSymmetricForEverySize) {
  for (int n = 1; n <= 200; ++n) {
    const IntervalRule rule = gauss_legendre(n);
    ASSERT_EQ(rule.size(), n);
    if (n <= 40 || n % 20 == 0) check_exactness(rule, 2 * n - 1);
    for (std::size_t q = 0; q < rule.node.size(); ++q) {
      EXPECT_GT(rule.weight[q], 0.0);
      EXPECT_GT(rule.node[q], q == 0 ? 0.0 : rule.node[q - 1]);
      EXPECT_LT(rule.node[q], 1.0);
      const std::size_t mirror = rule.node.size() - 1 - q;
      EXPECT_EQ(rule.weight[q], rule.weight[mirror]);
      EXPECT_LE(std::fabs(rule.node[q] + rule.node[mirror] - 1.0), 0x1p-53);
    }
  }
}

TEST(Quadrature, GaussLobattoIsExactAscendingAndHasTheEndPoints) {
  for (int n = 2; n <= 200; ++n) {
    const IntervalRule rule = gauss_lobatto(n);
    ASSERT_EQ(rule.size(), n);
    EXPECT_EQ(rule.node.front(), 0.0);
    EXPECT_EQ(rule.node.back(), 1.0);
    if (n <= 40 || n % 20 == 0) check_exactness(rule, 2 * n - 3);
    for (std::size_t q = 0; q < rule.node.size(); ++q) {
      EXPECT_GT(rule.weight[q], 0.0);
      if (q > 0) {
        EXPECT_GT(rule.node[q], rule.node[q - 1]);
      }
    }
  }
}

TEST(Quadrature, GaussLegendreIsNotExactOneDegreeHigher) {
  const IntervalRule rule = gauss_legendre(4);
  double moment = 0.0;
  for (std::size_t q = 0; q < 4; ++q) moment += rule.weight[q] * legendre(8, rule.node[q])[8].hi;
  EXPECT_GT(std::fabs(moment), 1e-3);
}

// integral of l0^a l1^b l2^c = a! b! c! / (a+b+c+2)!
double monomial_integral(int a, int b, int c) {
  double value = 1.0;
  for (int i = 1; i <= c; ++i) value *= static_cast<double>(i) / (a + b + i);
  for (int i = 1; i <= b; ++i) value *= static_cast<double>(i) / (a + i);
  return value / ((a + b + c + 1.0) * (a + b + c + 2.0));
}

TEST(Quadrature, TriangleRulesAreExactPositiveAndInside) {
  for (int degree = 0; degree <= 80; ++degree) {
    const TriangleRule rule = triangle_rule(degree);
    std::vector<double> terms(rule.weight.size());
    for (std::size_t q = 0; q < terms.size(); ++q) {
      EXPECT_GT(rule.weight[q], 0.0);
      double total = 0.0;
      for (const double l : rule.lambda[q]) {
        EXPECT_GT(l, 0.0);
        total += l;
      }
      EXPECT_NEAR(total, 1.0, 0x1p-52);
    }
    const int step = degree <= 12 ? 1 : degree / 6;
    for (int a = 0; a <= degree; a += step)
      for (int b = 0; a + b <= degree; b += step) {
        const int c = degree - a - b;
        for (std::size_t q = 0; q < terms.size(); ++q) {
          const auto& l = rule.lambda[q];
          terms[q] = rule.weight[q] * std::pow(l[0], a) * std::pow(l[1], b) * std::pow(l[2], c);
        }
        // Nodes rounded to u move l^a by a u: the budget is (degree + 8) u relative to the
        // integral.
        const double truth = monomial_integral(a, b, c);
        EXPECT_NEAR(bezel::sum(terms), truth, (degree + 8.0) * 0x1p-53 * truth * 2.0)
            << "degree " << degree << ", " << a << " " << b << " " << c;
      }
  }
}

TEST(Quadrature, LowDegreesUseFewPoints) {
  const std::vector<int> expected{1, 1, 3, 6, 6, 7, 12, 15, 16, 19, 25};
  for (int degree = 0; degree <= 10; ++degree)
    EXPECT_EQ(triangle_rule(degree).size(), expected[static_cast<std::size_t>(degree)]);
}

// A rule that is symmetric has, with every node, its permutations.
TEST(Quadrature, LowDegreesAreSymmetric) {
  for (int degree = 0; degree <= 10; ++degree) {
    const TriangleRule rule = triangle_rule(degree);
    for (std::size_t q = 0; q < rule.weight.size(); ++q) {
      const std::array<double, 3> turned{rule.lambda[q][1], rule.lambda[q][2], rule.lambda[q][0]};
      const std::array<double, 3> mirrored{rule.lambda[q][1], rule.lambda[q][0], rule.lambda[q][2]};
      for (const auto& image : {turned, mirrored}) {
        const auto found = std::find(rule.lambda.begin(), rule.lambda.end(), image);
        ASSERT_NE(found, rule.lambda.end()) << degree;
        EXPECT_EQ(rule.weight[static_cast<std::size_t>(found - rule.lambda.begin())],
                  rule.weight[q]);
      }
    }
  }
}

TEST(Quadrature, SizesAreChecked) {
  using testing::ThrowsMessage;
  EXPECT_THAT(
      [] { gauss_legendre(0); },
      ThrowsMessage<bezel::InputError>("gauss-legendre rule with 0 points, expected 1 to 200"));
  EXPECT_THAT([] { gauss_lobatto(1); }, ThrowsMessage<bezel::InputError>(
                                            "gauss-lobatto rule with 1 points, expected 2 to 200"));
  EXPECT_THAT(
      [] { gauss_legendre(201); },
      ThrowsMessage<bezel::InputError>("gauss-legendre rule with 201 points, expected 1 to 200"));
  EXPECT_THAT([] { triangle_rule(81); },
              ThrowsMessage<bezel::InputError>("triangle rule of degree 81, expected 0 to 80"));
  EXPECT_THROW(triangle_rule(-1), bezel::InputError);
}

}  // namespace
