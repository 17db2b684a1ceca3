// Evaluation at many points: every SIMD target of this machine and the scalar kernels give the same
// bits.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/numeric/binomial.hpp"
#include "support/simd_targets.hpp"

namespace {

using namespace bezel::bernstein;
using support::on_every_target;
using Doubles = std::vector<double>;

bool same_bits(const Doubles& a, const Doubles& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

Doubles values(std::size_t n, std::mt19937_64& random) {
  Doubles out(n);
  for (double& x : out) {
    const double mantissa = static_cast<double>(random() >> 11) * 0x1p-53 - 0.5;
    x = random() % 16 == 0 ? (random() % 2 == 0 ? 0.0 : 0x1p-1070)
                           : std::ldexp(mantissa, static_cast<int>(random() % 20) - 10);
  }
  return out;
}

Doubles scaled(const Doubles& b) {
  const int d = static_cast<int>(b.size()) - 1;
  Doubles c = b;
  for (int i = 0; i <= d; ++i) c[static_cast<std::size_t>(i)] *= bezel::binomial(d, i);
  return c;
}
Doubles parameters(std::size_t count, std::mt19937_64& random) {
  Doubles s{0.0, 1.0};
  while (s.size() < count) s.push_back(static_cast<double>(random() >> 11) * 0x1p-52 - 0.5);
  return s;
}

TEST(Batch, IntervalBitsAreTheScalarOnesOnEveryTarget) {
  std::mt19937_64 random(42);
  for (int d = 0; d <= max_interval_degree; ++d) {
    SCOPED_TRACE("degree " + std::to_string(d));
    const Doubles b = values(static_cast<std::size_t>(d + 1), random), c = scaled(b);
    const Doubles s = parameters(83, random);  // whole groups of vectors, vectors and a tail
    Doubles expected, casteljau;
    for (const double x : s) {
      expected.push_back(d == 0 ? b[0] : kernel::evaluate_scaled(d, c.data(), 1.0 - x, x));
      casteljau.push_back(evaluate(std::span<const double>(b), x));
    }
    EXPECT_EQ(expected[0], b.front());
    EXPECT_EQ(expected[1], b.back());
    on_every_target([&] {
      Doubles out(s.size(), -1.0);
      evaluate(b, s, out);
      EXPECT_TRUE(same_bits(out, expected));
      evaluate_compensated(b, s, out, 1);
      EXPECT_TRUE(same_bits(out, casteljau));
    });
  }
}

// 600 points: those up to the first aligned place go one by one.
TEST(Batch, PointsOfACurveHaveTheBitsOfTheirCoordinates) {
  std::mt19937_64 random(44);
  for (const int d : {0, 1, 2, 3, 10, 60})
    for (const std::size_t count : {1u, 40u, 600u}) {
      const Doubles bx = values(static_cast<std::size_t>(d + 1), random),
                    by = values(static_cast<std::size_t>(d + 1), random),
                    s = parameters(count + 2, random);
      std::vector<bezel::Vec2> b;
      for (std::size_t i = 0; i < bx.size(); ++i) b.push_back(bezel::Vec2{{bx[i], by[i]}});
      Doubles px(s.size()), py(s.size());
      evaluate(bx, s, px);
      evaluate(by, s, py);
      on_every_target([&] {
        Doubles x(s.size() + 1, -1.0), y(s.size(), -1.0);
        evaluate(b, s, std::span(x).subspan(1), y);
        EXPECT_EQ(x[0], -1.0);
        EXPECT_TRUE(same_bits({x.begin() + 1, x.end()}, px));
        EXPECT_TRUE(same_bits(y, py));
      });
    }
}

TEST(Batch, TriangleBitsAreTheScalarOnesOnEveryTarget) {
  std::mt19937_64 random(43);
  for (int d = 0; d <= max_triangle_degree; ++d) {
    SCOPED_TRACE("degree " + std::to_string(d));
    const Doubles b = values(static_cast<std::size_t>(triangle_size(d)), random);
    Doubles u, v, expected, c = b;
    for (int n = 0; n < triangle_size(d); ++n) {
      const auto [i, j, k] = triangle_multi_index(d, n);
      c[static_cast<std::size_t>(n)] *= bezel::binomial(d, k) * bezel::binomial(d - k, j);
    }
    for (int q = 0; q < 83; ++q) {
      u.push_back(static_cast<double>(random() >> 11) * 0x1p-53);
      v.push_back(static_cast<double>(random() >> 11) * 0x1p-53 - 0.1);
      const Lambda lambda{(1.0 - u.back()) - v.back(), u.back(), v.back()};
      expected.push_back(kernel::evaluate_scaled_triangle(d, c.data(), lambda));
    }
    on_every_target([&] {
      Doubles out(u.size(), -1.0);
      evaluate(d, b, u, v, out);
      EXPECT_TRUE(same_bits(out, expected));
    });
  }
}

TEST(Batch, CornersOfATriangleAreExact) {
  std::mt19937_64 random(45);
  const Doubles u{0, 1, 0}, v{0, 0, 1};
  for (int d = 0; d <= max_triangle_degree; ++d) {
    const Doubles b = values(static_cast<std::size_t>(triangle_size(d)), random);
    Doubles out(3);
    evaluate(d, b, u, v, out);
    for (int corner = 0; corner < 3; ++corner)
      EXPECT_EQ(out[static_cast<std::size_t>(corner)],
                b[static_cast<std::size_t>(triangle_corner(d, corner))]);
  }
}

// C(60, 30) b is no double there, the values are.
TEST(Batch, CoefficientsNearTheLargestDouble) {
  const Doubles b(61, 0x1.8p1023), triangle(static_cast<std::size_t>(triangle_size(40)), -0x1p1020);
  const Doubles s{0.0, 0.25, 0.5, 0.875, 1.0}, zero(5, 0.0);
  Doubles out(5), x(5), y(5);
  evaluate(b, s, out);
  for (const double value : out) EXPECT_NEAR(value / 0x1.8p1023, 1.0, 180 * 0x1p-53);
  std::vector<bezel::Vec2> curve;
  for (const double c : b) curve.push_back(bezel::Vec2{{1.0, c}});
  evaluate(curve, s, x, y);
  EXPECT_EQ(y, out);
  for (const double value : x) EXPECT_NEAR(value, 1.0, 180 * 0x1p-53);
  evaluate(40, triangle, s, zero, out);
  for (const double value : out) EXPECT_NEAR(value / -0x1p1020, 1.0, 120 * 0x1p-53);
}

TEST(Batch, AnyNumberOfPointsIncludingNone) {
  const Doubles b{1.0, -1.0, 3.0}, triangle{0.0, 1.0, 2.0};
  for (std::size_t count = 0; count <= 17; ++count) {
    const Doubles s(count, 0.5);
    Doubles out(count);
    evaluate(b, s, out);
    EXPECT_EQ(out, Doubles(count, 0.5));
    evaluate(1, triangle, s, s, out);
    EXPECT_EQ(out, Doubles(count, 1.5));
  }
}

TEST(Batch, ArgumentsAreChecked) {
  using testing::ThrowsMessage;
  const Doubles b{1.0, 2.0, 3.0}, two{0.1, 0.2}, bad{0.1, std::nan("")};
  Doubles out(3), good(2);
  EXPECT_THAT([&] { evaluate(b, two, out); },
              ThrowsMessage<bezel::InputError>("found 3 places for values, expected 2"));
  EXPECT_THAT([&] { evaluate(b, bad, good); },
              ThrowsMessage<bezel::InputError>("parameter 1 is not finite"));
  const std::vector<bezel::Vec2> curve(3);
  EXPECT_THAT([&] { evaluate(curve, two, good, out); },
              ThrowsMessage<bezel::InputError>("found 3 places for y, expected 2"));
  EXPECT_THAT([&] { evaluate(curve, two, out, good); },
              ThrowsMessage<bezel::InputError>("found 3 places for x, expected 2"));
  EXPECT_THAT([&] { evaluate(curve, bad, good, good); },
              ThrowsMessage<bezel::InputError>("parameter 1 is not finite"));
  EXPECT_THAT([&] { evaluate(1, b, two, out, good); },
              ThrowsMessage<bezel::InputError>("found 3 coordinates v, expected 2"));
  EXPECT_THAT([&] { evaluate(1, b, two, two, out); },
              ThrowsMessage<bezel::InputError>("found 3 places for values, expected 2"));
  EXPECT_THAT([&] { evaluate(1, b, bad, two, good); },
              ThrowsMessage<bezel::InputError>("coordinate u 1 is not finite"));
  EXPECT_THAT([&] { evaluate(1, b, two, bad, good); },
              ThrowsMessage<bezel::InputError>("coordinate v 1 is not finite"));
}

}  // namespace
