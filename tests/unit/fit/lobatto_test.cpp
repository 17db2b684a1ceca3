#include "bezel/fit/lobatto.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "bezel/geometry/curve.hpp"

namespace {

using bezel::LobattoBasis;
using bezel::Vec2;
using bezel::Vec3;

constexpr double u = 0x1p-53;

TEST(LobattoBasis, NodesAreSymmetricAndWeightsSumToTwo) {
  for (int d = 1; d <= 60; ++d) {
    const LobattoBasis basis(d);
    double sum = 0.0;
    for (std::size_t i = 0; i <= std::size_t(d); ++i) {
      EXPECT_EQ(basis.nodes()[i], -basis.nodes()[std::size_t(d) - i]);
      sum += basis.weights()[i];
    }
    EXPECT_NEAR(sum, 2.0, 4 * d * u);
    EXPECT_EQ(basis.nodes().front(), -1.0);
    EXPECT_EQ(basis.nodes().back(), 1.0);
  }
}

TEST(LobattoBasis, DifferentiatesPowersExactlyToRounding) {
  for (const int d : {1, 2, 3, 7, 12, 20, 30}) {
    const LobattoBasis basis(d);
    for (int power = 0; power <= d; ++power)
      for (int i = 0; i <= d; ++i) {
        double slope = 0.0, size = 0.0;
        for (int k = 0; k <= d; ++k) {
          const double term =
              basis.derivative(i, k) * std::pow(basis.nodes()[std::size_t(k)], power);
          slope += term;
          size += std::fabs(term);
        }
        const double x = basis.nodes()[std::size_t(i)];
        const double exact = power == 0 ? 0.0 : power * std::pow(x, power - 1);
        // Each entry has d + 3 roundings, the diagonal one those of its row.
        EXPECT_NEAR(slope, exact, 4.0 * (d + 4) * u * (size + d * d)) << d << " " << power;
      }
  }
}

TEST(LobattoBasis, ValuesAndDerivativesAgreeWithTheInterpolant) {
  bezel::RandomStream random("LobattoBasis.Values", 1);
  for (const int d : {1, 4, 11, 30}) {
    const LobattoBasis basis(d);
    std::vector<Vec3> nodal;
    for (int i = 0; i <= d; ++i)
      nodal.push_back(Vec3{{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}});
    std::vector<double> row(std::size_t(d) + 1);
    for (int trial = 0; trial < 20; ++trial) {
      const double xi = trial == 0 ? basis.nodes()[1] : random.uniform(-1, 1);
      basis.values(xi, row);
      Vec3 sum;
      double total = 0.0;
      for (std::size_t k = 0; k < row.size(); ++k) {
        sum += row[k] * nodal[k];
        total += row[k];
      }
      EXPECT_NEAR(total, 1.0, 100 * u);
      const Vec3 p = basis.evaluate<3>(nodal, xi);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(p[c], sum[c], 40 * d * u);
      // A central difference: its error is h^2 / 6 |p'''|, of rounding u / h.
      const double h = 1e-5;
      const Vec3 slope = basis.derivative<3>(nodal, xi);
      const Vec3 difference =
          (0.5 / h) * (basis.evaluate<3>(nodal, xi + h) - basis.evaluate<3>(nodal, xi - h));
      const double third = std::pow(double(d), 6);
      EXPECT_NEAR(slope[0], difference[0], h * h * third + 1e-9) << d;
    }
  }
}

TEST(LobattoBasis, BernsteinCoefficientsGiveTheSameCurve) {
  bezel::RandomStream random("LobattoBasis.Bernstein", 1);
  for (const int d : {1, 2, 3, 8, 15, 30}) {
    const LobattoBasis basis(d);
    std::vector<Vec2> nodal;
    for (int i = 0; i <= d; ++i)
      nodal.push_back(Vec2{{random.uniform(-1, 1), random.uniform(-1, 1)}});
    const std::vector<Vec2> control = basis.to_bernstein<2>(nodal);
    EXPECT_EQ(control.front(), nodal.front());
    EXPECT_EQ(control.back(), nodal.back());
    double largest = 1.0;
    for (const Vec2& c : control) largest = std::max({largest, std::fabs(c[0]), std::fabs(c[1])});
    // Random values need coefficients up to 0.4 2^d; de Casteljau's error is 3 d u of those.
    EXPECT_LE(largest, std::ldexp(1.0, d));
    const bezel::Curve curve(control);
    for (const double xi : {-0.97, -0.3, 0.0, 0.61}) {
      const Vec2 p = basis.evaluate<2>(nodal, xi), q = curve(0.5 * (1.0 + xi));
      for (int c = 0; c < 2; ++c) EXPECT_NEAR(p[c], q[c], 3 * d * u * largest) << d;
    }
  }
}

TEST(LobattoBasis, BernsteinCoefficientsOfASmoothCurveAreAccurateAtDegree30) {
  // exp on [-1, 1]: the Bernstein coefficients of its interpolant tend to it, so they stay near
  // [1/e, e]; the rounding of the values alone, 1 u each, moves them by up to 0.4 2^30 u.
  const LobattoBasis basis(30);
  std::vector<Vec2> nodal;
  for (const double xi : basis.nodes()) nodal.push_back(Vec2{{xi, std::exp(xi)}});
  const std::vector<Vec2> control = basis.to_bernstein<2>(nodal);
  for (int i = 0; i <= 30; ++i) {
    EXPECT_NEAR(control[std::size_t(i)][0], -1.0 + 2.0 * i / 30.0, 0.4 * std::ldexp(u, 30));
    EXPECT_NEAR(control[std::size_t(i)][1], std::exp(-1.0 + 2.0 * i / 30.0), 0.1);
  }
}

TEST(LobattoBasis, RefusesBadInput) {
  EXPECT_THROW(LobattoBasis(0), bezel::InputError);
  EXPECT_THROW(LobattoBasis(101), bezel::InputError);
  EXPECT_THROW(LobattoBasis(3).to_bernstein<2>(std::vector<Vec2>(3)), bezel::InputError);
}

}  // namespace
