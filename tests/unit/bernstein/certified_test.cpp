// Certified evaluation: exact cases, the ends of the range of doubles, documented errors. Hard
// points by the million: tests/property.

#include "bezel/bernstein/certified.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/exact.hpp"
#include "support/simd_targets.hpp"

namespace {

using namespace bezel::bernstein;
using bezel::Dyadic;
using bezel::InputError;
using testing::ThrowsMessage;
using Doubles = std::vector<double>;
constexpr double inf = std::numeric_limits<double>::infinity();

/// p(s) is a double: it is the value. The bound is 0 where that is proven: by exact arithmetic, and
/// of a zero in any case.
void expect_exact(const Doubles& b, double s, double expected) {
  const CertifiedValue x = evaluate_certified(b, s);
  EXPECT_EQ(x.value, expected) << "s " << s;
  if (expected == 0.0 || x.certificate == Certificate::exact)
    EXPECT_EQ(x.error_bound, 0.0) << "s " << s;
  else
    EXPECT_LE(x.error_bound, 1.6 * 0x1p-53 * std::fabs(expected)) << "s " << s;
}
/// So is a coefficient.
void expect_proven(const Doubles& b, double s, double expected) {
  expect_exact(b, s, expected);
  EXPECT_EQ(evaluate_certified(b, s).error_bound, 0.0);
}

/// Faithful and bounded, by Dyadic.
void expect_certified(const Doubles& b, double s) {
  const CertifiedValue x = evaluate_certified(b, s);
  const Dyadic p = ExactPolynomial(b)(Dyadic(s));
  ASSERT_TRUE(std::isfinite(x.value) && std::isfinite(x.error_bound));
  const Dyadic error = Dyadic(x.value) - p;
  EXPECT_FALSE(Dyadic(x.error_bound) < (error.sign() < 0 ? -error : error));
  if (error.sign() != 0) {
    const double other = std::nextafter(x.value, error.sign() < 0 ? inf : -inf);
    EXPECT_EQ((Dyadic(other) - p).sign(), -error.sign());
  }
}

TEST(Certified, EndPointsAreExact) {
  std::mt19937_64 random(1);
  for (int d = 0; d <= max_interval_degree; ++d) {
    Doubles b;
    for (int j = 0; j <= d; ++j)
      b.push_back(std::ldexp(static_cast<double>(random() >> 11) - 0x1p52,
                             static_cast<int>(random() % 1000) - 500));
    expect_proven(b, 0.0, b.front());
    expect_proven(b, -0.0, b.front());
    expect_proven(b, 1.0, b.back());
    const Doubles s{0.0, 1.0, -0.0, 1.0, 0.0};
    Doubles value(5), bound(5, 1.0);
    evaluate_certified(b, s, value, bound);
    EXPECT_EQ(value, (Doubles{b.front(), b.back(), b.front(), b.back(), b.front()}));
    EXPECT_EQ(bound, Doubles(5, 0.0));
  }
}

TEST(Certified, ConstantsAreThemselves) {
  for (const double c : {0.1, -1.0, 0.0, 0x1p-1074, -0x1p-1022, DBL_MAX})
    for (const double s : {0.0, 0.3, 1.0, 0x1p-1074, 1.0 - 0x1p-53, -7.0, 1e300})
      expect_proven({c}, s, c);
}

TEST(Certified, KnownValues) {
  expect_exact({1.0, 2.0}, 0.5, 1.5);
  expect_exact({1.0, 2.0, 4.0}, 0.5, 2.25);
  expect_exact({1.0, 2.0, 4.0}, 3.0, 16.0);  // (s + 1)^2, outside [0, 1]
  expect_exact({1.0, 2.0, 4.0}, -1.0, 0.0);
  expect_exact({1.0, 2.0, 4.0}, -2.0, 1.0);
  expect_exact({1.0, 1.0 + 0x1p-51}, 0.5, 1.0 + 0x1p-52);
}

TEST(Certified, ExactZerosAreProven) {
  expect_exact({0.0, 0.0, -0.0}, 0.3, 0.0);
  expect_exact({-1.0, 1.0}, 0.5, 0.0);
  expect_exact({1.0, -0.75, 0.5, -0.25, 0.0}, 0.5, 0.0);  // (2s-1)^3 (s-1)
  expect_exact({0.0, 1.0, 0.0}, 1.0, 0.0);
  expect_exact({-1.0, 3.0}, 0.25, 0.0);
  for (int d = 1; d <= max_interval_degree; ++d) {  // (2s-1)^d
    Doubles b;
    for (int j = 0; j <= d; ++j) b.push_back((d - j) % 2 == 0 ? 1.0 : -1.0);
    expect_exact(b, 0.5, 0.0);
    // Next to it the value is a power of two of any size, a double or too small for one.
    const CertifiedValue above = evaluate_certified(b, 0.5 + 0x1p-53);
    if (52 * d <= 1074) {
      expect_exact(b, 0.5 + 0x1p-53, std::ldexp(1.0, -52 * d));
    } else {
      EXPECT_TRUE(above.value == 0.0 || above.value == 0x1p-1074) << above.value;
      EXPECT_GT(above.error_bound, 0.0);
    }
    if (53 * d <= 1074)
      expect_exact(b, 0.5 - 0x1p-54, std::ldexp(d % 2 == 0 ? 1.0 : -1.0, -53 * d));
  }
}

TEST(Certified, NearZerosKeepTheirSign) {
  for (const double tiny : {0x1p-80, 0x1p-200, 0x1p-1000, 0x1p-1073}) {
    expect_exact({-1.0, tiny, 1.0}, 0.5, tiny / 2);
    expect_exact({-1.0, -tiny, 1.0}, 0.5, -tiny / 2);
  }
  // Half the smallest double: zero or that, and the bound tells.
  for (const double sign : {1.0, -1.0}) {
    const CertifiedValue x = evaluate_certified(Doubles{-1.0, sign * 0x1p-1074, 1.0}, 0.5);
    EXPECT_TRUE(x.value == 0.0 || x.value == sign * 0x1p-1074) << x.value;
    EXPECT_EQ(x.error_bound, 0x1p-1074);
  }
}

TEST(Certified, SubnormalValues) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 300; ++i) {
    Doubles b;
    for (int j = 0; j <= 1 + i % 12; ++j)
      b.push_back(std::ldexp(static_cast<double>(random() >> 11) - 0x1p52, -1120 + i % 80));
    for (const double s : {0.1, 0.5, 1.0 - 0x1p-53, 0x1p-30, 2.5}) expect_certified(b, s);
  }
  // Powers of s that vanish, with and without coefficients that make up for them.
  expect_exact({0.0, 0.0, 1.0}, 0x1p-537, 0x1p-1074);
  expect_exact({0.0, 0.0, 0x1p1000}, 0x1p-600, 0x1p-200);
  expect_exact({0.0, 0.0, 0.0, 0x1p1000}, 0x1p-600, 0x1p-800);
  expect_certified({0.0, 0x1p-1074}, 1.0 - 0x1p-53);
}

TEST(Certified, InfiniteValues) {
  for (const double sign : {1.0, -1.0}) {
    const CertifiedValue x = evaluate_certified(Doubles{0.0, sign * DBL_MAX}, 2.0);
    EXPECT_EQ(x.value, sign * inf);
    EXPECT_EQ(x.error_bound, inf);
    const CertifiedValue y = evaluate_certified(Doubles{sign, 0.0, -sign}, 1e300);  // sign (1-2s)
    EXPECT_EQ(y.value, sign * -2e300);
    const CertifiedValue z = evaluate_certified(Doubles{0.0, 0.0, sign}, 1e300);
    EXPECT_EQ(z.value, sign * inf);
    EXPECT_EQ(z.error_bound, inf);
  }
  // Overflow on the way only: differences of the largest doubles.
  expect_exact({DBL_MAX, -DBL_MAX}, 0.5, 0.0);
  expect_exact({DBL_MAX, DBL_MAX, DBL_MAX}, 0.25, DBL_MAX);
  expect_exact({-DBL_MAX, DBL_MAX, -DBL_MAX, DBL_MAX}, 0.5, 0.0);
  expect_certified({DBL_MAX, -DBL_MAX, DBL_MAX, -DBL_MAX, DBL_MAX}, 0.3);
  for (const double s : {0.1, 0.3, 0.9}) expect_certified(Doubles(40, DBL_MAX), s);
}

TEST(Certified, OutsideTheInterval) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 100; ++i) {
    Doubles b;
    for (int j = 0; j <= i % 20; ++j) b.push_back(static_cast<double>(random() >> 11) - 0x1p52);
    for (const double s : {-0x1p-1074, -1e-20, -0.3, 1.0 + 0x1p-52, 1.7, -40.0, 1e5})
      expect_certified(b, s);
  }
}

TEST(Certified, BatchesHaveTheScalarBits) {
  const Doubles b{1.0, -0.75, 0.5, -0.25, 0x1p-60};
  for (std::size_t count = 0; count < 70; ++count) {
    Doubles s;
    for (std::size_t q = 0; q < count; ++q)
      s.push_back(q % 3 == 0 ? 0.5 + std::ldexp(1.0, -static_cast<int>(q) - 1)
                             : static_cast<double>(q) / 69.0);
    support::on_every_target([&] {
      Doubles value(count), bound(count), alone(count);
      std::vector<Certificate> certificate(count), certificate_alone(count);
      evaluate_certified(b, s, value, bound, certificate);
      evaluate_certified(b, s, alone);
      EXPECT_EQ(alone, value);
      evaluate_certified(b, s, alone, {}, certificate_alone);
      EXPECT_EQ(certificate_alone, certificate);
      EXPECT_EQ(alone, value);
      for (std::size_t q = 0; q < count; ++q) {
        const CertifiedValue x = evaluate_certified(b, s[q]);
        EXPECT_EQ(std::bit_cast<std::uint64_t>(x.value), std::bit_cast<std::uint64_t>(value[q]));
        EXPECT_EQ(x.error_bound, bound[q]);
        EXPECT_EQ(x.certificate, certificate[q]);
      }
    });
  }
}

// Nothing beyond the ends of the arrays is touched, whatever the tail.
TEST(Certified, BatchesStayInTheirArrays) {
  const Doubles b{1.0, -2.0, 3.0};
  for (std::size_t count = 0; count < 40; ++count) {
    Doubles s(count, 0.3), value(count + 8, 77.0), bound(count + 8, 77.0);
    std::vector<Certificate> certificate(count + 8, Certificate(9));
    evaluate_certified(b, s, std::span(value).first(count), std::span(bound).first(count),
                       std::span(certificate).first(count));
    for (std::size_t q = count; q < count + 8; ++q) {
      EXPECT_EQ(value[q], 77.0);
      EXPECT_EQ(bound[q], 77.0);
      EXPECT_EQ(certificate[q], Certificate(9));
    }
    for (std::size_t q = 0; q < count; ++q) EXPECT_NE(value[q], 77.0);
  }
}

TEST(Certified, BadArguments) {
  const Doubles b{1.0, 2.0}, none, many(62), s{0.5, 0.25};
  const double nan = std::nan("");
  const Doubles with_nan{1.0, nan}, with_infinity{-inf, 1.0};
  EXPECT_THAT([&] { evaluate_certified(none, 0.5); },
              ThrowsMessage<InputError>("found no coefficients, expected at least one"));
  EXPECT_THAT([&] { evaluate_certified(many, 0.5); },
              ThrowsMessage<InputError>("degree 61 on the interval, expected 0 to 60"));
  EXPECT_THAT([&] { evaluate_certified(with_nan, 0.5); },
              ThrowsMessage<InputError>("coefficient 1 is not finite"));
  EXPECT_THAT([&] { evaluate_certified(with_infinity, 0.5); },
              ThrowsMessage<InputError>("coefficient 0 is not finite"));
  EXPECT_THAT([&] { evaluate_certified(b, nan); },
              ThrowsMessage<InputError>("parameter is nan, expected a finite value"));
  EXPECT_THAT([&] { evaluate_certified(b, -inf); },
              ThrowsMessage<InputError>("parameter is -inf, expected a finite value"));
  Doubles two(2), three(3);
  std::vector<Certificate> one(1);
  EXPECT_THAT([&] { evaluate_certified(none, s, two); },
              ThrowsMessage<InputError>("found no coefficients, expected at least one"));
  EXPECT_THAT([&] { evaluate_certified(none, none, std::span<double>()); },
              ThrowsMessage<InputError>("found no coefficients, expected at least one"));
  EXPECT_THAT([&] { evaluate_certified(many, s, two); },
              ThrowsMessage<InputError>("degree 61 on the interval, expected 0 to 60"));
  EXPECT_THAT([&] { evaluate_certified(with_nan, s, two); },
              ThrowsMessage<InputError>("coefficient 1 is not finite"));
  EXPECT_THAT(
      [&] {
        evaluate_certified(b, Doubles{0.5, inf}, two);
      },
      ThrowsMessage<InputError>("parameter 1 is not finite"));
  EXPECT_THAT([&] { evaluate_certified(b, s, three); },
              ThrowsMessage<InputError>("found 3 places for values, expected 2"));
  EXPECT_THAT([&] { evaluate_certified(b, s, std::span<double>()); },
              ThrowsMessage<InputError>("found 0 places for values, expected 2"));
  EXPECT_THAT([&] { evaluate_certified(b, s, two, three); },
              ThrowsMessage<InputError>(testing::HasSubstr("found 3 places for")));
  EXPECT_THAT([&] { evaluate_certified(b, s, two, {}, one); },
              ThrowsMessage<InputError>("found 1 places for certificates, expected 2"));
}

TEST(Certified, EmptyBatch) {
  const Doubles b{1.0, 2.0}, none;
  Doubles nothing;
  std::vector<Certificate> no_certificates;
  EXPECT_NO_THROW(evaluate_certified(b, none, nothing));
  EXPECT_NO_THROW(evaluate_certified(b, none, nothing, nothing, no_certificates));
  Doubles one(1);
  EXPECT_THROW(evaluate_certified(b, none, nothing, one), InputError);
}

}  // namespace
