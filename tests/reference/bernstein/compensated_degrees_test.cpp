// Compensated values and derivatives at every degree against exact integers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "bezel/bernstein/compensated.hpp"
#include "support/exact_values.hpp"
#include "support/hard_polynomials.hpp"

namespace {

using namespace bezel::bernstein;
using bezel::Vec2;
using bezel::Vec3;
using support::ExactValues;
using support::Hard;
using support::HardPolynomials;
using support::Number;
using Doubles = std::vector<double>;
using Span = std::span<const double>;
constexpr long double u = 0x1p-53L, slack = 1.0L + 0x1p-40L;

long double distance(double value, const Number& p) {
  return support::approximate(support::abs(Number(value) - p));
}
long double size(const Number& p) {
  return std::fabs(support::approximate(p));
}
long double power(int K) {
  return std::ldexp(1.0L, -53 * K);
}
Doubles differences(const Doubles& b) {
  // Rounded: their p~ is off by u of itself.
  Doubles out;
  for (std::size_t j = 0; j + 1 < b.size(); ++j) out.push_back(b[j + 1] - b[j]);
  return out;
}

// What a term below 2^-960 loses to underflow is not in the bounds: 2^20 operations of 2^-1074.
constexpr long double underflow = 0x1p-1050L;

struct Multipliers {
  long double value[7], derivative[7];
  explicit Multipliers(int d) {
    for (int K = 1; K <= 6; ++K) {
      value[K] = static_cast<long double>(error_multiplier(d, K)) * power(K);
      derivative[K] = static_cast<long double>(error_multiplier(std::max(d - 1, 0), K)) * power(K);
    }
  }
};

void check_value(const Doubles& b, double s, const Multipliers& m, const Number& p) {
  const long double absolute = support::absolute_sum(b, s);
  for (int K = 1; K <= 6; ++K) {
    const double value = evaluate_compensated(Span(b), s, K);
    EXPECT_LE(distance(value, p), (u * size(p) + m.value[K] * absolute) * slack + underflow)
        << "degree " << b.size() - 1 << " K " << K << " s " << s;
  }
}

void check_derivative(const Doubles& b, double s, const Multipliers& m, const Number& p) {
  const auto d = static_cast<long double>(b.size() - 1);
  const long double absolute = b.size() == 1 ? 0.0L : d * support::absolute_sum(differences(b), s);
  for (int K = 1; K <= 6; ++K) {
    const double value = evaluate_derivative_compensated(Span(b), s, K);
    const long double differences_rounded = K == 1 ? u * absolute : 0.0L;
    EXPECT_LE(
        distance(value, p),
        (3 * u * size(p) + m.derivative[K] * absolute + differences_rounded) * slack + underflow)
        << "degree " << b.size() - 1 << " K " << K << " s " << s;
  }
}

TEST(CompensatedDegrees, ValuesAndDerivatives) {
  for (int d = 0; d <= max_interval_degree; ++d) {
    HardPolynomials source(static_cast<std::uint64_t>(d), false);
    const Multipliers m(d);
    for (int polynomial = 0; polynomial < 4; ++polynomial) {
      Hard hard{source.coefficients(d), source.unit()};
      if (d > 0 && polynomial == 1) hard = source.near_root(d);
      if (d > 0 && polynomial == 2) hard = source.cancelled(d);
      const ExactValues p(hard.b), derivative = p.derivative();
      for (const double s : {hard.s, 0.0, -0.0, 0x1p-1074, 0x1p-1022, 0x1p-60, 0x1p-20, 0.25, 0.1,
                             0.5, 0.5 + 0x1p-53, 2.0 / 3.0, 1.0 - 0x1p-30, 1.0 - 0x1p-53, 1.0,
                             1.0 + 0x1p-52, -0.375, 1.7}) {
        check_value(hard.b, s, m, p(s));
        check_derivative(hard.b, s, m, derivative(s));
      }
      if (HasFailure()) return;
    }
  }
}

TEST(CompensatedDegrees, DegreeZeroIsTheCoefficient) {
  for (const double s : {0.0, -0.0, 0x1p-1074, 1.0 - 0x1p-53, 0.5, 3.0, -1e300})
    for (const double c : {0.1, 0x1p-1074, -1.7e308, 0.0})
      for (int K = 1; K <= max_precision; ++K) {
        EXPECT_EQ(evaluate_compensated(Span(Doubles{c}), s, K), c);
        EXPECT_EQ(evaluate_derivative_compensated(Span(Doubles{c}), s, K), 0.0);
      }
}

// The ends are exact, the derivative there the difference of two coefficients rounded, times d
// rounded.
TEST(CompensatedDegrees, Ends) {
  for (int d = 1; d <= max_interval_degree; ++d) {
    HardPolynomials source(static_cast<std::uint64_t>(100 + d), false);
    const Doubles b = source.coefficients(d);
    const auto n = static_cast<std::size_t>(d);
    for (int K = 1; K <= 6; ++K) {
      EXPECT_EQ(evaluate_compensated(Span(b), 0.0, K), b[0]);
      EXPECT_EQ(evaluate_compensated(Span(b), -0.0, K), b[0]);
      EXPECT_EQ(evaluate_compensated(Span(b), 1.0, K), b[n]);
      EXPECT_EQ(evaluate_derivative_compensated(Span(b), 0.0, K), d * (b[1] - b[0]));
      EXPECT_EQ(evaluate_derivative_compensated(Span(b), 1.0, K), d * (b[n] - b[n - 1]));
    }
  }
}

TEST(CompensatedDegrees, Curves) {
  for (int d = 0; d <= max_interval_degree; d += 5) {
    HardPolynomials source(static_cast<std::uint64_t>(200 + d), false);
    const Doubles x = source.coefficients(d), y = source.coefficients(d),
                  z = source.coefficients(d);
    std::vector<Vec2> plane;
    std::vector<Vec3> space;
    for (std::size_t j = 0; j < x.size(); ++j) {
      plane.push_back({{x[j], y[j]}});
      space.push_back({{x[j], y[j], z[j]}});
    }
    const Multipliers m(d);
    const std::vector<const Doubles*> coordinates{&x, &y, &z};
    for (const double s : {0.0, 0.3, 0.7, 1.0, 1.0 - 0x1p-53, source.unit()})
      for (int K = 1; K <= 6; ++K) {
        const Vec2 p2 = evaluate_compensated(std::span<const Vec2>(plane), s, K);
        const Vec3 p3 = evaluate_compensated(std::span<const Vec3>(space), s, K);
        const Vec2 t2 = evaluate_derivative_compensated(std::span<const Vec2>(plane), s, K);
        const Vec3 t3 = evaluate_derivative_compensated(std::span<const Vec3>(space), s, K);
        for (int i = 0; i < 3; ++i) {
          const Doubles& b = *coordinates[static_cast<std::size_t>(i)];
          const Number p = ExactValues(b)(s), t = ExactValues(b).derivative()(s);
          const long double value =
              (u * size(p) + m.value[K] * support::absolute_sum(b, s)) * slack;
          const long double of_differences =
              d == 0 ? 0.0L : d * support::absolute_sum(differences(b), s);
          const long double derivative =
              (3 * u * size(t) + (m.derivative[K] + (K == 1 ? u : 0.0L)) * of_differences) * slack;
          EXPECT_LE(distance(p3[i], p), value);
          EXPECT_LE(distance(t3[i], t), derivative);
          if (i < 2) {
            EXPECT_LE(distance(p2[i], p), value);
            EXPECT_LE(distance(t2[i], t), derivative);
          }
        }
      }
  }
}

// The levels themselves: their exact sum, before any rounding, at K up to the largest.
TEST(CompensatedDegrees, LevelsOfEveryPrecision) {
  for (const int d : {1, 2, 3, 5, 8, 13, 21, 40, 60}) {
    HardPolynomials source(static_cast<std::uint64_t>(300 + d), false);
    for (int polynomial = 0; polynomial < 3; ++polynomial) {
      const Hard hard =
          polynomial == 0 ? Hard{source.coefficients(d), source.unit()} : source.cancelled(d);
      const double s = std::clamp(hard.s, 0x1p-4, 1 - 0x1p-4);
      const Number p = ExactValues(hard.b)(s);
      Doubles levels(12);
      compensated_levels(hard.b, s, levels);
      Number missing = p;
      for (int K = 1; K <= 12; ++K) {
        // The last of K levels is summed plainly; the error of that is of the next order.
        Doubles here(static_cast<std::size_t>(K));
        compensated_levels(hard.b, s, here);
        for (std::size_t f = 0; f < here.size(); ++f)
          EXPECT_EQ(here[f], levels[f]) << d << " " << K;
        missing = missing - Number(levels[static_cast<std::size_t>(K) - 1]);
        EXPECT_LE(std::fabs(support::approximate(missing)),
                  static_cast<long double>(error_multiplier(d, K)) * power(K) *
                          support::absolute_sum(hard.b, s) * slack +
                      underflow)
            << "degree " << d << " K " << K;
      }
    }
  }
}

TEST(CompensatedDegrees, ConditionNumbers) {
  for (int d = 0; d <= max_interval_degree; ++d) {
    HardPolynomials source(static_cast<std::uint64_t>(400 + d), false);
    const long double within = 4 * 0x1p-53L * (d + 2);
    for (int i = 0; i < 6; ++i) {
      const Hard hard =
          d == 0 || i % 2 == 0 ? Hard{source.coefficients(d), source.unit()} : source.cancelled(d);
      const Number p = ExactValues(hard.b)(hard.s);
      const long double absolute = support::absolute_sum(hard.b, hard.s);
      if (absolute == 0.0L) continue;
      EXPECT_NEAR(static_cast<double>(absolute_value_sum(hard.b, hard.s) / absolute), 1.0,
                  static_cast<double>(within));
      const double found = condition_number(hard.b, hard.s);
      if (p.sign() == 0)
        EXPECT_EQ(found, HUGE_VAL);
      else
        EXPECT_NEAR(static_cast<double>(found / (absolute / size(p))), 1.0,
                    static_cast<double>(within));
    }
  }
}

}  // namespace
