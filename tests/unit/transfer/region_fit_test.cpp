#include "bezel/transfer/region_fit.hpp"
#include "bezel/geometry/triangle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/numeric/quadrature.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/mass_rule.hpp"
#include "support/simd_targets.hpp"

namespace bezel::detail {
namespace {

std::vector<Vec2> bent_triangle(int degree, double bend, std::uint64_t seed) {
  RandomStream random("region fit", seed);
  std::vector<Vec2> control;
  for (int k = 0; k <= degree; ++k)
    for (int j = 0; j <= degree - k; ++j)
      control.push_back(Vec2{{0.3 + 1.1 * j / degree + 0.2 * k / degree,
                              -0.2 + 0.1 * j / degree + 0.9 * k / degree}} +
                        Vec2{{random.uniform(-bend, bend), random.uniform(-bend, bend)}});
  return control;
}

/// The sides of a straight triangle as Gauss points.
CurvePoints boundary_of(const std::array<Vec2, 3>& corner, int degree) {
  const IntervalRule rule = gauss_legendre(degree / 2 + 1);
  CurvePoints points;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec2 side = corner[(k + 1) % 3] - corner[k];
    const std::size_t first = points.append(rule.node.size());
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const Vec2 x = corner[k] + side * rule.node[i];
      points.x[first + i] = x[0];
      points.y[first + i] = x[1];
      points.dx[first + i] = side[0] * rule.weight[i];
      points.dy[first + i] = side[1] * rule.weight[i];
    }
  }
  for (std::size_t i = points.count; i < padded_to_lanes(points.count); ++i) {
    points.x[i] = points.x[0];
    points.y[i] = points.y[0];
    points.dx[i] = points.dy[i] = 0.0;
  }
  return points;
}

TEST(FitTable, InterpolatesMonomialsExactly) {
  for (int d = 0; d <= max_fit_degree; ++d) {
    const FitTable& table = fit_table(d);
    EXPECT_EQ(table.count, static_cast<std::size_t>(bernstein::triangle_size(d)));
    std::vector<double> values(table.padded), terms(table.terms);
    for (int b = 0; b <= d; ++b) {
      for (int a = 0; a <= d - b; ++a) {
        for (std::size_t q = 0; q < table.padded; ++q)
          values[q] = std::pow(table.x[q], a) * std::pow(table.y[q], b);
        fit_interpolate(table, 1, values.data(), terms.data());
        const auto own = static_cast<std::size_t>(bernstein::triangle_index(d, a, b));
        for (std::size_t n = 0; n < table.count; ++n)
          EXPECT_NEAR(terms[n], n == own ? 1.0 : 0.0, 4e-15 * std::pow(2.0, d)) << d << a << b;
      }
    }
  }
}

TEST(FitTails, AreTheHighestChebyshevCoefficients) {
  const FitTable& table = fit_table(5);
  std::vector<double> u(table.padded), v(table.padded);
  for (std::size_t q = 0; q < table.padded; ++q) {
    const double x = table.x[q], y = table.y[q];
    u[q] = 0.7 + 2.0 * x + 0.25 * (16 * std::pow(x, 5) - 20 * x * x * x + 5 * x);  // T_5
    v[q] = -1.0 * y + 0.5 * x * (4 * y * y * y - 3 * y);                           // T_1 T_3
  }
  const auto tails = fit_tails(table, u.data(), v.data());
  EXPECT_NEAR(tails[0], 0.25 / 3.0, 1e-15);
  EXPECT_NEAR(tails[1], 0.5 / 3.0, 1e-15);
}

TEST(FitInvert, FindsThePointsOfEveryMap) {
  for (int degree = 1; degree <= 10; ++degree) {
    const auto control = bent_triangle(degree, 0.02, static_cast<std::uint64_t>(degree));
    const MapPolynomial map(degree, control);
    constexpr std::size_t blocks = 3, count = blocks * lanes;
    RandomStream random("fit invert", static_cast<std::uint64_t>(degree));
    std::vector<double> u(count), v(count), x(count), y(count), det(count), s(count), t(count);
    for (std::size_t i = 0; i < count; ++i) {
      u[i] = random.uniform(0, 1);
      v[i] = random.uniform(0, 1 - u[i]);
    }
    fit_map(map, blocks, u.data(), v.data(), x.data(), y.data(), det.data());
    std::vector<double> dx(count, 1.0), dy(count, 0.0);
    ASSERT_TRUE(
        fit_invert(map, blocks, x.data(), y.data(), s.data(), t.data(), dx.data(), dy.data()));
    for (std::size_t i = 0; i < count; ++i) {
      const auto at = bernstein::kernel::evaluate_gradient_unchecked<Vec2, double>(
          degree, control.data(), {1 - u[i] - v[i], u[i], v[i]});
      EXPECT_NEAR(x[i], at.value[0], 1e-15 * degree);
      EXPECT_NEAR(y[i], at.value[1], 1e-15 * degree);
      EXPECT_NEAR(det[i], cross(at.du, at.dv), 1e-14 * degree);
      EXPECT_NEAR(s[i], u[i], 2e-15 * degree);
      EXPECT_NEAR(t[i], v[i], 2e-15 * degree);
      EXPECT_NEAR(at.du[0] * dx[i] + at.dv[0] * dy[i], 1.0, 1e-14 * degree);
      EXPECT_NEAR(at.du[1] * dx[i] + at.dv[1] * dy[i], 0.0, 1e-14 * degree);
    }
  }
}

TEST(FitInvert, SaysWhenAPointHasNoPlace) {
  // x = u - u^2 / 2 or so never gets beyond its fold.
  const std::vector<Vec2> control = {{{0, 0}},   {{0.5, 0}},   {{0.5, 0}},
                                     {{0, 0.5}}, {{0.5, 0.5}}, {{0, 1}}};
  const MapPolynomial map(2, control);
  std::vector<double> x(lanes, 0.3), y(lanes, 0.2), u(lanes), v(lanes);
  x[3] = 40.0;
  EXPECT_FALSE(fit_invert(map, 1, x.data(), y.data(), u.data(), v.data(), nullptr, nullptr));
}

TEST(FitMoments, AreThoseOfTheTriangle) {
  for (int degree = 0; degree <= max_fit_moments; ++degree) {
    const CurvePoints boundary = boundary_of({Vec2{{0, 0}}, Vec2{{1, 0}}, Vec2{{0, 1}}}, degree);
    std::vector<double> moments(fit_rows(degree));
    fit_moments(degree, boundary, {{0.0, 0.0}, {1.0, 1.0}}, moments.data());
    for (int b = 0; b <= degree; ++b) {
      for (int a = 0; a <= degree - b; ++a) {
        // a! b! / (a + b + 2)!
        const double exact =
            std::exp(std::lgamma(a + 1.0) + std::lgamma(b + 1.0) - std::lgamma(a + b + 3.0));
        EXPECT_NEAR(
            moments[static_cast<std::size_t>(b) * fit_stride(degree) + static_cast<std::size_t>(a)],
            exact, 1e-15)
            << degree << " " << a << " " << b;
      }
    }
  }
}

TEST(FitAdd, IsTheIntegralOfTheInterpolantTimesTheMonomials) {
  const std::array<Vec2, 3> corner = {Vec2{{0.2, 0.3}}, Vec2{{0.7, 0.35}}, Vec2{{0.3, 0.8}}};
  const std::array<double, 2> centre = {1.0 / 3.0, 1.0 / 3.0};
  for (int degree = 0; degree <= 11; ++degree) {
    for (const int fit : {0, 1, 3, 6}) {
      const FitTable& table = fit_table(fit);
      const CurvePoints boundary = boundary_of(corner, fit + degree);
      const FitFrame frame = fit_frame(boundary);
      RandomStream random("fit add", static_cast<std::uint64_t>(20 * degree + fit));
      std::vector<double> terms(2 * table.terms, 0.0);
      for (std::size_t c = 0; c < 2; ++c)
        for (std::size_t n = 0; n < table.count; ++n)
          terms[c * table.terms + n] = random.uniform(-1, 1);
      const TriangleRule rule = triangle_rule(fit + degree);
      std::vector<std::vector<double>> seen;
      support::on_every_target([&] {
        std::vector<double> moments(fit_rows(fit + degree) + 2 * lanes);
        fit_moments(fit + degree, boundary, frame, moments.data());
        std::vector<double> sums(3 * fit_rows(degree), 0.0);
        fit_add(table, degree, 2, terms.data(), moments.data(), frame, centre, sums.data());
        seen.push_back(sums);
        for (std::size_t c = 0; c < 3; ++c)
          for (std::size_t b = 0; b <= static_cast<std::size_t>(degree); ++b)
            for (std::size_t a = 0; a + b <= static_cast<std::size_t>(degree); ++a) {
              const std::size_t at = c * fit_rows(degree) + b * fit_stride(degree) + a;
              EXPECT_EQ(seen.back()[at], seen.front()[at]);
            }
      });
      for (int b = 0; b <= degree; ++b) {
        for (int a = 0; a <= degree - b; ++a) {
          double exact[3] = {};
          const double area = cross(corner[1] - corner[0], corner[2] - corner[0]);
          for (std::size_t q = 0; q < rule.weight.size(); ++q) {
            const auto& l = rule.lambda[q];
            const Vec2 x = l[0] * corner[0] + l[1] * corner[1] + l[2] * corner[2];
            const double m = rule.weight[q] * area * std::pow(x[0] - centre[0], a) *
                             std::pow(x[1] - centre[1], b);
            const double s = (x[0] - frame.centre[0]) / frame.half[0];
            const double t = (x[1] - frame.centre[1]) / frame.half[1];
            for (int k = 0, n = 0; k <= fit; ++k)
              for (int j = 0; j <= fit - k; ++j, ++n)
                for (std::size_t c = 0; c < 2; ++c)
                  exact[c] += m * terms[c * table.terms + static_cast<std::size_t>(n)] *
                              std::pow(s, j) * std::pow(t, k);
            exact[2] += m;
          }
          for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(
                seen[0][c * fit_rows(degree) + static_cast<std::size_t>(b) * fit_stride(degree) +
                        static_cast<std::size_t>(a)],
                exact[c], 2e-15)
                << degree << " " << fit << " " << a << " " << b;
        }
      }
    }
  }
}

TEST(MassMatrices, ByTablesAndByPointsAgree) {
  for (int g = 1; g <= 4; ++g) {
    for (int p = 0; p <= 8; ++p) {
      const auto control = bent_triangle(g, 0.02, static_cast<std::uint64_t>(g));
      const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
      std::vector<double> mass(n * n), integrals(n);
      const MappedMass table(g, p);
      table.compute(control, mass, integrals);
      std::vector<double> other_mass(n * n), other_integrals(n);
      table.compute_from(jacobian_determinant(g, control), other_mass, other_integrals);
      for (std::size_t i = 0; i < n; ++i) {
        EXPECT_NEAR(other_integrals[i], integrals[i], 1e-15);
        for (std::size_t j = 0; j <= i; ++j)
          EXPECT_NEAR(other_mass[i * n + j], mass[i * n + j], 1e-15);
      }

      const MassRule rule = make_mass_rule(g, 2 * p + 2 * (g - 1));
      const std::size_t padded = padded_to_lanes(rule.weight.size());
      std::vector<double> u(padded), v(padded), w(padded);
      for (std::size_t q = 0; q < rule.weight.size(); ++q) {
        u[q] = rule.place[q][0];
        v[q] = rule.place[q][1];
        w[q] = rule.weight[q] * mass_point(rule, control, q).det;
      }
      std::vector<double> products(n * (n + 1) / 2), plain(n);
      fit_products(p, padded, w.data(), u.data(), v.data(), products.data(), plain.data());
      const auto factors = multinomials(p);
      std::size_t at = 0;
      for (std::size_t i = 0; i < n; ++i) {
        EXPECT_NEAR(integrals[i], plain[i] * factors[i], 1e-15);
        for (std::size_t j = 0; j <= i; ++j, ++at)
          EXPECT_NEAR(mass[i * n + j], products[at] * factors[i] * factors[j], 1e-15)
              << g << " " << p;
      }
    }
  }
}

}  // namespace
}  // namespace bezel::detail
