#include "bezel/transfer/accumulate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "hwy/targets.h"
#include "support/simd_targets.hpp"

namespace bezel::detail {
namespace {

struct Points {
  explicit Points(std::size_t n) {
    RandomStream random("accumulate", n);
    const std::size_t padded = padded_to_lanes(n);
    for (std::size_t i = 0; i < padded; ++i) {
      weight.push_back(i < n ? random.uniform(-1, 1) : 0.0);
      for (std::vector<double>* a : {&tu, &tv, &du, &dv}) a->push_back(random.uniform(-0.2, 0.8));
    }
  }
  PointBlock block() const {
    return {weight.data(), tu.data(), tv.data(), du.data(), dv.data(), weight.size() / lanes};
  }
  std::vector<double> weight, tu, tv, du, dv;
};

struct Sums {
  Sums(int target, int components)
      : product(static_cast<std::size_t>(bernstein::triangle_size(target) * components), 0.0),
        basis(static_cast<std::size_t>(bernstein::triangle_size(target)), 0.0),
        mass(static_cast<std::size_t>(components), 0.0) {}
  bool operator==(const Sums&) const = default;
  std::vector<double> product, basis, mass;
};

std::vector<double> coefficients(int degree, int components) {
  RandomStream random("scaled", static_cast<std::uint64_t>(degree));
  std::vector<double> c(static_cast<std::size_t>(bernstein::triangle_size(degree) * components));
  for (double& x : c) x = random.uniform(-1, 1);
  return c;
}

TEST(Accumulate, EqualsTheSumsTermByTerm) {
  for (int target = 0; target <= 10; ++target) {
    for (const int donor : {0, 1, 2, 3, 5, 10, target}) {
      const int components = 1 + (target + donor) % 5;
      const Points points(37);
      const auto c = coefficients(donor, components);
      Sums sums(target, components);
      accumulate(target, donor, components, c.data(), points.block(), sums.product.data(),
                 sums.basis.data(), sums.mass.data());
      Sums expected(target, components);
      std::vector<double> phi(expected.basis.size());
      std::vector<double> value(static_cast<std::size_t>(components));
      const auto factors = multinomials(target);
      for (std::size_t q = 0; q < points.weight.size(); ++q) {
        const double w = points.weight[q];
        bernstein::basis(target, {1 - points.tu[q] - points.tv[q], points.tu[q], points.tv[q]},
                         phi);
        evaluate_scaled(donor, components, c.data(), points.du[q], points.dv[q], value.data());
        for (std::size_t k = 0; k < value.size(); ++k) {
          expected.mass[k] += w * value[k];
          for (std::size_t n = 0; n < phi.size(); ++n) {
            expected.product[n * value.size() + k] += w * value[k] * phi[n] / factors[n];
          }
        }
        for (std::size_t n = 0; n < phi.size(); ++n) expected.basis[n] += w * phi[n] / factors[n];
      }
      for (std::size_t i = 0; i < sums.product.size(); ++i)
        EXPECT_NEAR(sums.product[i], expected.product[i], 1e-11);
      for (std::size_t i = 0; i < sums.basis.size(); ++i)
        EXPECT_NEAR(sums.basis[i], expected.basis[i], 1e-12);
      for (std::size_t i = 0; i < sums.mass.size(); ++i)
        EXPECT_NEAR(sums.mass[i], expected.mass[i], 1e-11);
    }
  }
}

TEST(Accumulate, SameBitsOnEverySimdTarget) {
  const std::int64_t all = hwy::SupportedTargets();
  for (const int degree : {0, 1, 2, 3, 4, 7}) {
    const Points points(41);
    const auto c = coefficients(degree, 2);
    std::vector<Sums> seen;
    for (std::int64_t bit = 1; bit > 0 && bit <= all; bit <<= 1) {
      if ((all & bit) == 0) continue;
      hwy::SetSupportedTargetsForTest(bit);
      seen.emplace_back(degree, 2);
      accumulate(degree, degree, 2, c.data(), points.block(), seen.back().product.data(),
                 seen.back().basis.data(), seen.back().mass.data());
    }
    hwy::SetSupportedTargetsForTest(0);
    ASSERT_FALSE(seen.empty());
    for (const Sums& s : seen) EXPECT_EQ(s, seen.front()) << "degree " << degree;
  }
}

TEST(Accumulate, BasisAndMultinomialsSumToOneAndPowersOfThree) {
  for (int d = 0; d <= 10; ++d) {
    std::vector<double> phi(static_cast<std::size_t>(bernstein::triangle_size(d)));
    basis_at(d, 0.3, 0.45, phi.data());
    double sum = 0.0;
    for (const double x : phi) sum += x;
    EXPECT_NEAR(sum, 1.0, 1e-15);
    double total = 0.0;
    for (const double m : multinomials(d)) total += m;
    EXPECT_EQ(total, std::pow(3.0, d));
  }
}

TEST(MapPoints, EqualTheMapPointByPoint) {
  for (int degree = 1; degree <= 10; ++degree) {
    RandomStream random("map points", static_cast<std::uint64_t>(degree));
    std::vector<Vec2> control(static_cast<std::size_t>(bernstein::triangle_size(degree)));
    for (Vec2& p : control) p = Vec2{{random.uniform(-1, 1), random.uniform(-1, 1)}};
    constexpr std::size_t blocks = 3;
    std::vector<double> u(blocks * lanes), v(blocks * lanes);
    for (std::size_t i = 0; i < u.size(); ++i) {
      u[i] = random.uniform(0, 1);
      v[i] = random.uniform(0, 1) * (1 - u[i]);
    }
    std::vector<std::vector<double>> seen;
    support::on_every_target([&] {
      std::vector<double> out(3 * u.size());
      map_points(degree, control.data(), blocks, u.data(), v.data(), out.data(),
                 out.data() + u.size(), out.data() + 2 * u.size());
      seen.push_back(out);
      EXPECT_EQ(seen.back(), seen.front());
    });
    for (std::size_t i = 0; i < u.size(); ++i) {
      const auto map = bernstein::kernel::evaluate_gradient_unchecked<Vec2, double>(
          degree, control.data(), {1 - u[i] - v[i], u[i], v[i]});
      EXPECT_NEAR(seen[0][i], map.value[0], 1e-14);
      EXPECT_NEAR(seen[0][u.size() + i], map.value[1], 1e-14);
      EXPECT_NEAR(seen[0][2 * u.size() + i], cross(map.du, map.dv), 1e-12 * degree);
    }
  }
}

}  // namespace
}  // namespace bezel::detail
