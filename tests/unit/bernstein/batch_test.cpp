// Evaluation at many points: every SIMD target of this machine and the scalar functions give the
// same bits.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/triangle.hpp"
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

TEST(Batch, IntervalBitsAreTheScalarOnesOnEveryTarget) {
  std::mt19937_64 random(42);
  for (int d = 0; d <= max_interval_degree; ++d) {
    SCOPED_TRACE("degree " + std::to_string(d));
    const Doubles b = values(static_cast<std::size_t>(d + 1), random);
    Doubles s, expected;
    for (int q = 0; q < 19; ++q) {  // whole vectors of every width and a tail
      s.push_back(q == 0   ? 0.0
                  : q == 1 ? 1.0
                           : static_cast<double>(random() >> 11) * 0x1p-52 - 0.5);
      expected.push_back(evaluate(std::span<const double>(b), s.back()));
    }
    on_every_target([&] {
      Doubles out(s.size(), -1.0);
      evaluate(b, s, out);
      EXPECT_TRUE(same_bits(out, expected));
    });
  }
}

TEST(Batch, TriangleBitsAreTheScalarOnesOnEveryTarget) {
  std::mt19937_64 random(43);
  for (int d = 0; d <= max_triangle_degree; ++d) {
    SCOPED_TRACE("degree " + std::to_string(d));
    const Doubles b = values(static_cast<std::size_t>(triangle_size(d)), random);
    Doubles u, v, expected;
    for (int q = 0; q < 19; ++q) {
      u.push_back(static_cast<double>(random() >> 11) * 0x1p-53);
      v.push_back(static_cast<double>(random() >> 11) * 0x1p-53 - 0.1);
      const Lambda lambda{(1.0 - u.back()) - v.back(), u.back(), v.back()};
      expected.push_back(evaluate(d, std::span<const double>(b), lambda));
    }
    on_every_target([&] {
      Doubles out(u.size(), -1.0);
      evaluate(d, b, u, v, out);
      EXPECT_TRUE(same_bits(out, expected));
    });
  }
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
