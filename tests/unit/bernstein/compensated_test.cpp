// Compensated evaluation: exactness, agreement of the paths, documented errors. Reference values
// and bounds: tests/reference and tests/property.

#include "bezel/bernstein/compensated.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/compensated_batch.hpp"
#include "support/simd_targets.hpp"

namespace {

using namespace bezel::bernstein;
using bezel::InputError;
using bezel::Vec2;
using bezel::Vec3;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Doubles = std::vector<double>;
using Span = std::span<const double>;

Doubles values(int n, std::mt19937_64& random) {
  Doubles out(static_cast<std::size_t>(n));
  for (double& x : out)
    x = random() % 16 == 0 ? 0.0
                           : std::ldexp(static_cast<double>(random() >> 11) * 0x1p-53 - 0.5,
                                        static_cast<int>(random() % 20) - 10);
  return out;
}

TEST(Compensated, EndPointsAreExact) {
  std::mt19937_64 random(1);
  for (int d = 0; d <= max_interval_degree; ++d) {
    const Doubles b = values(d + 1, random);
    for (const int K : {1, 2, 3, 4, 5, 20}) {
      EXPECT_EQ(evaluate_compensated(Span(b), 0.0, K), b.front());
      EXPECT_EQ(evaluate_compensated(Span(b), 1.0, K), b.back());
    }
  }
}

// The vector kernels against the scalar one: every degree, points inside and outside [0, 1], full
// groups of vectors, single vectors, and tails.
TEST(Compensated, EveryTargetHasTheScalarBits) {
  std::mt19937_64 random(2);
  for (int d = 0; d <= max_interval_degree; ++d) {
    SCOPED_TRACE(d);
    const Doubles b = values(d + 1, random);
    Doubles s{0.0, 1.0, -0.0, 0x1p-1074, 0x1p-60, 1.0 - 0x1p-53, 0.5, -3.25, 40.0};
    while (s.size() < 77) s.push_back(static_cast<double>(random() >> 11) * 0x1p-52 - 0.5);
    for (const int K : {2, 3, 4}) {
      Doubles expected(s.size()), levels(s.size() * 4), w(b.size() * 4);
      for (std::size_t q = 0; q < s.size(); ++q)
        kernel::compensated_levels(d, b.data(), s[q], K, w.data(), &levels[q * 4]);
      support::on_every_target([&] {
        Doubles found(s.size() * 4);
        if (!compensated_point_levels(d, b.data(), s.data(), s.size(), K, found.data())) return;
        for (std::size_t q = 0; q < s.size(); ++q)
          for (int f = 0; f < K; ++f) {
            const auto F = static_cast<std::size_t>(f);
            EXPECT_EQ(std::bit_cast<std::uint64_t>(found[F * s.size() + q]),
                      std::bit_cast<std::uint64_t>(levels[q * 4 + F]))
                << "K " << K << " level " << f << " s " << s[q];
          }
        Doubles out(s.size());
        evaluate_compensated(b, s, out, K);
        for (std::size_t q = 0; q < s.size(); ++q)
          EXPECT_EQ(out[q], evaluate_compensated(Span(b), s[q], K));
      });
    }
  }
}

TEST(Compensated, CurvesAreTheirCoordinates) {
  std::mt19937_64 random(3);
  const Doubles x = values(7, random), y = values(7, random), z = values(7, random);
  std::vector<Vec2> plane;
  std::vector<Vec3> space;
  for (std::size_t i = 0; i < x.size(); ++i) {
    plane.push_back({{x[i], y[i]}});
    space.push_back({{x[i], y[i], z[i]}});
  }
  for (const int K : {1, 2, 3, 4, 6}) {
    const Vec2 p = evaluate_compensated(std::span<const Vec2>(plane), 0.3, K);
    const Vec3 q = evaluate_compensated(std::span<const Vec3>(space), 0.3, K);
    const Vec3 t = evaluate_derivative_compensated(std::span<const Vec3>(space), 0.3, K);
    EXPECT_EQ(p[0], evaluate_compensated(Span(x), 0.3, K));
    EXPECT_EQ(p[1], evaluate_compensated(Span(y), 0.3, K));
    EXPECT_EQ(q[2], evaluate_compensated(Span(z), 0.3, K));
    EXPECT_EQ(t[1], evaluate_derivative_compensated(Span(y), 0.3, K));
  }
}

TEST(Compensated, DegreeZero) {
  const Doubles b{0.1};
  for (const int K : {1, 2, 3, 4, 7}) {
    EXPECT_EQ(evaluate_compensated(Span(b), 0.7, K), 0.1);
    EXPECT_EQ(evaluate_derivative_compensated(Span(b), 0.7, K), 0.0);
    EXPECT_EQ(evaluate_compensated(0, Span(b), Lambda{0.2, 0.3, 0.5}, K), 0.1);
  }
  EXPECT_EQ(condition_number(b, 0.7), 1.0);
  EXPECT_EQ(error_multiplier(0, 3), 0.0);
}

TEST(Compensated, ConditionNumbers) {
  EXPECT_EQ(condition_number(Doubles{-1.0, 1.0}, 0.75), 2.0);
  EXPECT_EQ(condition_number(Doubles{-1.0, 1.0}, 0.5), HUGE_VAL);
  EXPECT_EQ(condition_number(Doubles{0.0, 0.0}, 0.5), 1.0);
  EXPECT_EQ(condition_number(Doubles{1.0, 1.0}, 2.0), 3.0);  // |1-s| + |s| over 1
  EXPECT_EQ(condition_number(1, Doubles{-1.0, 1.0, 1.0}, Lambda{0.25, 0.25, 0.5}), 2.0);
  EXPECT_EQ(condition_number(1, Doubles{-1.0, 1.0, 1.0}, Lambda{0.5, 0.25, 0.25}), HUGE_VAL);
}

TEST(Compensated, Multipliers) {
  for (int n = 1; n <= 60; ++n) {
    const double N = n;
    EXPECT_EQ(error_multiplier(n, 1), 3 * N);
    EXPECT_EQ(error_multiplier(n, 2), 3 * N * (3 * N + 7) / 2);
    EXPECT_EQ(error_multiplier(n, 3), 3 * N * (3 * N * N + 36 * N + 61) / 2);
    if (n > 40) continue;
    EXPECT_EQ(triangle_error_multiplier(n, 1), 4 * N);
    EXPECT_EQ(triangle_error_multiplier(n, 2), 8 * N * (N - 1) + 36 * N);
  }
}

TEST(Compensated, ErrorBounds) {
  const double u = 0x1p-53;
  const Doubles b{-1.0, 1.0};
  EXPECT_NEAR(compensated_error_bound(b, 0.75, 2) / (0.5 * u + 15 * u * u), 1.0, 1e-11);
  EXPECT_NEAR(compensated_error_bound(b, 0.5, 3) / (150 * u * u * u), 1.0, 1e-11);
  EXPECT_EQ(compensated_error_bound(Doubles{0.0}, 0.5, 2), 0.0);
  const Lambda lambda{0.5, 0.25, 0.25};
  EXPECT_NEAR(compensated_error_bound(1, Doubles{-1.0, 1.0, 1.0}, lambda, 2) / (36 * u * u), 1.0,
              1e-11);
  EXPECT_THAT([&] { compensated_error_bound(b, 0.5, 0); },
              ThrowsMessage<InputError>("found K = 0, expected 1 to 20"));
}

TEST(Compensated, FlopCounts) {
  const double t = 36;
  EXPECT_EQ(compensated_flops(8, 2).fused, 18 * t + 13);
  EXPECT_EQ(compensated_flops(8, 3).fused, 59 * t + 32);
  EXPECT_EQ(compensated_flops(8, 4).fused, 130 * t + 63);
  EXPECT_EQ(compensated_flops(8, 5).fused, 231 * t + 106);
  EXPECT_EQ(compensated_flops(8, 3).two_prods, 5 * t);
  EXPECT_EQ(compensated_flops(8, 2).dekker, (60 + 22 - 34) * t + 13);
}

TEST(Compensated, BadArguments) {
  const Doubles b{1.0, 2.0};
  const double nan = std::nan("");
  EXPECT_THAT([&] { evaluate_compensated(Span(), 0.5, 2); },
              ThrowsMessage<InputError>("found no coefficients, expected at least one"));
  EXPECT_THAT([&] { evaluate_compensated(Span(b), nan, 2); },
              ThrowsMessage<InputError>("parameter is nan, expected a finite value"));
  EXPECT_THAT([&] { evaluate_compensated(Span(b), 0.5, 0); },
              ThrowsMessage<InputError>("found K = 0, expected 1 to 20"));
  EXPECT_THAT([&] { evaluate_compensated(Span(b), 0.5, 21); },
              ThrowsMessage<InputError>("found K = 21, expected 1 to 20"));
  const Doubles with_nan{1.0, nan};
  EXPECT_THAT([&] { evaluate_compensated(Span(with_nan), 0.5, 2); },
              ThrowsMessage<InputError>("coefficient 1 is not finite"));
  const Doubles many(62);
  EXPECT_THAT([&] { evaluate_compensated(Span(many), 0.5, 2); },
              ThrowsMessage<InputError>("degree 61 on the interval, expected 0 to 60"));
  Doubles out(1);
  EXPECT_THAT(
      [&] {
        evaluate_compensated(b, Doubles{0.5, 0.25}, out, 2);
      },
      ThrowsMessage<InputError>("found 1 places for values, expected 2"));
  EXPECT_THAT([&] { evaluate_compensated(b, Doubles{nan}, out, 2); },
              ThrowsMessage<InputError>("parameter 0 is not finite"));
  EXPECT_THAT([&] { compensated_levels(b, 0.5, {}); },
              ThrowsMessage<InputError>("found K = 0, expected 1 to 20"));
  EXPECT_THAT([&] { evaluate_derivative_compensated(Span(b), 0.5, -1); },
              ThrowsMessage<InputError>("found K = -1, expected 1 to 20"));
  EXPECT_THAT([&] { evaluate_compensated(1, Span(b), Lambda{}, 2); },
              ThrowsMessage<InputError>(HasSubstr("expected 3 for degree 1 on the triangle")));
  EXPECT_THAT(
      [&] {
        evaluate_compensated(0, Span(b).first(1), Lambda{nan, 0, 0}, 2);
      },
      ThrowsMessage<InputError>("barycentric 0 is not finite"));
  EXPECT_THAT([&] { evaluate_compensated(0, Span(b).first(1), 0.5, nan, 2); },
              ThrowsMessage<InputError>("coordinate v is nan, expected a finite value"));
  EXPECT_THAT([&] { error_multiplier(61, 2); },
              ThrowsMessage<InputError>("degree 61 on the interval, expected 0 to 60"));
  EXPECT_THAT([&] { compensated_flops(0, 2); }, ThrowsMessage<InputError>(HasSubstr("degree 0")));
}

}  // namespace
