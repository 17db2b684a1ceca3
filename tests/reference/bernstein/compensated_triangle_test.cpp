// Compensated values on the triangle at every degree against exact integers.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "bezel/bernstein/compensated.hpp"
#include "support/exact_values.hpp"
#include "support/hard_polynomials.hpp"

namespace {

using namespace bezel::bernstein;
using support::exact_triangle_value;
using support::HardPolynomials;
using support::Number;
using Doubles = std::vector<double>;
using Span = std::span<const double>;
constexpr long double u = 0x1p-53L, slack = 1.0L + 0x1p-40L;

long double distance(double value, const Number& p) {
  return support::approximate(support::abs(Number(value) - p));
}

std::vector<Number> absolute(std::vector<Number> values) {
  for (Number& x : values) x = support::abs(x);
  return values;
}

Lambda random_point(HardPolynomials& source) {
  const double a = source.unit(), b = source.unit() * (1.0 - a);
  return {1.0 - a - b, a, b};
}

/// A product of d linear forms, some of which vanish at x: near x all is cancelled.
Doubles product_of_lines(int d, const Lambda& x, HardPolynomials& source) {
  Doubles b{1.0};
  const int through_x = 1 + source.below(d);
  for (int m = 1; m <= d; ++m) {
    Lambda a{source.mantissa(), source.mantissa(), source.mantissa()};
    if (m <= through_x) {
      double along = 0.0, norm = 0.0;
      for (std::size_t i = 0; i < 3; ++i) along += a[i] * x[i], norm += x[i] * x[i];
      for (std::size_t i = 0; i < 3; ++i) a[i] -= along / norm * x[i];
    }
    Doubles next(static_cast<std::size_t>(triangle_size(m)));
    for (int k = 0; k <= m; ++k)
      for (int j = 0; j <= m - k; ++j) {
        const auto old = [&](int row, int column) {
          return b[static_cast<std::size_t>(triangle_index(m - 1, column, row))];
        };
        const int i = m - j - k;
        double sum = 0.0;
        if (i > 0) sum += i * a[0] * old(k, j);
        if (j > 0) sum += j * a[1] * old(k, j - 1);
        if (k > 0) sum += k * a[2] * old(k - 1, j);
        next[static_cast<std::size_t>(triangle_index(m, j, k))] = sum / m;
      }
    b = next;
  }
  return b;
}

struct Case {
  Doubles b;
  Lambda at;
};

std::vector<Case> cases(int d, HardPolynomials& source) {
  const auto size = triangle_size(d);
  std::vector<Case> out;
  out.push_back({source.coefficients(size - 1), random_point(source)});
  out.push_back({source.coefficients(size - 1), Lambda{0.25, 0.5, 0.25}});
  out.push_back({source.coefficients(size - 1), Lambda{0.0, 1.0, 0.0}});
  out.push_back({source.coefficients(size - 1), Lambda{0x1p-30, 1.0 - 0x1p-30, 0.0}});
  out.push_back({source.coefficients(size - 1), Lambda{-0.25, 1.5, -0.25}});
  if (d == 0) return out;
  for (int i = 0; i < 4; ++i) {
    const Lambda x = i == 0 ? Lambda{0.5, 0.25, 0.25} : random_point(source);
    Lambda near = x;
    for (double& l : near) l += std::ldexp(source.unit() - 0.5, -4 - source.below(50));
    out.push_back({product_of_lines(d, x, source), near});
  }
  return out;
}

TEST(CompensatedTriangle, AtExactBarycentrics) {
  std::array<long double, 4> largest{};
  for (int d = 0; d <= max_triangle_degree; ++d) {
    HardPolynomials source(static_cast<std::uint64_t>(d), false);
    const long double multiplier[] = {0.0L, triangle_error_multiplier(d, 1),
                                      triangle_error_multiplier(d, 2),
                                      triangle_error_multiplier(d, 3)};
    for (const Case& c : cases(d, source)) {
      const auto b = support::numbers(c.b), lambda = support::numbers(c.at);
      const Number p = exact_triangle_value(d, b, lambda);
      const long double size = std::fabs(support::approximate(p));
      const long double all =
          support::approximate(exact_triangle_value(d, absolute(b), absolute(lambda)));
      for (int K = 1; K <= 3; ++K) {
        const long double second = std::ldexp(multiplier[K] * all, -53 * K) * slack;
        const long double error = distance(evaluate_compensated(d, Span(c.b), c.at, K), p);
        EXPECT_LE(error, u * size * slack + second) << "degree " << d << " K " << K;
        // The levels before they are added up and rounded: nothing hides behind the first term.
        const auto k = static_cast<std::size_t>(K);
        Doubles work(c.b.size() * k), levels(k);
        kernel::compensated_triangle_levels(d, c.b.data(), {c.at[0], c.at[1], c.at[2], 0.0, 0.0}, K,
                                            work.data(), levels.data());
        Number missing = p;
        for (const double x : levels) missing = missing - Number(x);
        const long double before = std::fabs(support::approximate(missing));
        EXPECT_LE(before, second) << "degree " << d << " K " << K;
        if (second > 0.0L) largest[k] = std::max(largest[k], before / second);
      }
      EXPECT_NEAR(static_cast<double>(absolute_value_sum(d, c.b, c.at) - all), 0.0,
                  static_cast<double>(4 * (d + 1) * u * all));
      const double condition = condition_number(d, c.b, c.at);
      if (p.sign() == 0)
        EXPECT_EQ(condition, all == 0.0L ? 1.0 : HUGE_VAL);
      else
        EXPECT_NEAR(static_cast<double>(condition / (all / size)), 1.0, 4 * (d + 2) * 0x1p-53);
    }
    if (HasFailure()) return;
  }
  for (const std::size_t K : {1U, 2U, 3U}) {
    std::string name = "largest_share_K";
    name += std::to_string(K);
    RecordProperty(name, std::to_string(largest[K]));
    EXPECT_GT(largest[K], std::pow(0.1L, static_cast<int>(K) + 1)) << K;  // errors are seen
  }
}

// 1 - u - v is not a double: it is taken exactly.
TEST(CompensatedTriangle, AtCoordinates) {
  for (int d = 0; d <= max_triangle_degree; ++d) {
    HardPolynomials source(static_cast<std::uint64_t>(100 + d), false);
    const long double multiplier[] = {0.0L, triangle_error_multiplier(d, 1),
                                      triangle_error_multiplier(d, 2),
                                      triangle_error_multiplier(d, 3)};
    for (const Case& c : cases(d, source)) {
      // Two coordinates of quite different sizes among them, so that 1-u-v needs three doubles.
      for (const auto& [x, y] : {std::pair(c.at[1], c.at[2]), std::pair(c.at[1] * 0x1p-40, c.at[2]),
                                 std::pair(c.at[1], std::ldexp(c.at[2], -60))}) {
        const auto b = support::numbers(c.b);
        const std::vector<Number> lambda{Number(1.0) - Number(x) - Number(y), Number(x), Number(y)};
        const Number p = exact_triangle_value(d, b, lambda);
        const long double size = std::fabs(support::approximate(p));
        const long double all =
            support::approximate(exact_triangle_value(d, absolute(b), absolute(lambda)));
        for (int K = 2; K <= 3; ++K)
          EXPECT_LE(distance(evaluate_compensated(d, Span(c.b), x, y, K), p),
                    (u * size + std::ldexp(multiplier[K] * all, -53 * K)) * slack)
              << "degree " << d << " K " << K << " at " << x << " " << y;
      }
    }
    if (HasFailure()) return;
  }
}

TEST(CompensatedTriangle, CurvedPatchesAreTheirCoordinates) {
  HardPolynomials source(7, false);
  const int d = 5;
  const Doubles x = source.coefficients(triangle_size(d) - 1),
                y = source.coefficients(triangle_size(d) - 1),
                z = source.coefficients(triangle_size(d) - 1);
  std::vector<bezel::Vec2> plane;
  std::vector<bezel::Vec3> space;
  for (std::size_t n = 0; n < x.size(); ++n) {
    plane.push_back({{x[n], y[n]}});
    space.push_back({{x[n], y[n], z[n]}});
  }
  const Lambda at{0.2, 0.3, 0.5};
  for (int K = 1; K <= 4; ++K) {
    const auto p = evaluate_compensated(d, std::span<const bezel::Vec2>(plane), at, K);
    const auto q = evaluate_compensated(d, std::span<const bezel::Vec3>(space), at, K);
    const auto r = evaluate_compensated(d, std::span<const bezel::Vec3>(space), 0.3, 0.5, K);
    EXPECT_EQ(p[0], evaluate_compensated(d, Span(x), at, K));
    EXPECT_EQ(p[1], evaluate_compensated(d, Span(y), at, K));
    EXPECT_EQ(q[2], evaluate_compensated(d, Span(z), at, K));
    EXPECT_EQ(r[2], evaluate_compensated(d, Span(z), 0.3, 0.5, K));
  }
}

}  // namespace
