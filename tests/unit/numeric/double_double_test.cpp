#include "bezel/numeric/double_double.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using bezel::DoubleDouble;
__extension__ using Wide = __int128;

Wide integer(const DoubleDouble& a) {
  return static_cast<Wide>(a.hi) + static_cast<Wide>(a.lo);
}

TEST(DoubleDouble, IntegersUpTo104BitsAreExact) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 5000; ++i) {
    const auto a = static_cast<std::int64_t>(random() >> 13) - (std::int64_t{1} << 50);
    const auto b = static_cast<std::int64_t>(random() >> 13) - (std::int64_t{1} << 50);
    const DoubleDouble x(static_cast<double>(a)), y(static_cast<double>(b));
    const DoubleDouble product = x * y;
    EXPECT_TRUE(integer(product) == Wide{a} * b);
    EXPECT_TRUE(integer(product + x) == Wide{a} * b + a);
    EXPECT_TRUE(integer(product - y) == Wide{a} * b - b);
  }
}

TEST(DoubleDouble, DivisionUndoesMultiplicationToItsStatedError) {
  std::mt19937_64 random(4);
  double worst = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const DoubleDouble a(1.0 + static_cast<double>(random() >> 12) * 0x1p-52,
                         static_cast<double>(random() >> 12) * 0x1p-106);
    const DoubleDouble b(1.0 + static_cast<double>(random() >> 12) * 0x1p-52,
                         -static_cast<double>(random() >> 12) * 0x1p-106);
    const DoubleDouble rest = (a / b) * b - a;
    worst = std::fmax(worst, std::fabs(rest.hi / a.hi));
  }
  EXPECT_LE(worst, 20.0 * 0x1p-106);  // 15 u^2 of the division, 5 u^2 of the product
}

TEST(DoubleDouble, ThirdHasThirtyTwoDigits) {
  const DoubleDouble third = DoubleDouble(1.0) / DoubleDouble(3.0);
  EXPECT_EQ(third.hi, 1.0 / 3.0);
  EXPECT_EQ(third.lo, 0x1.5555555555555p-56);
  EXPECT_LE(std::fabs((third * DoubleDouble(3.0) - DoubleDouble(1.0)).hi), 0x1p-104);
}

TEST(DoubleDouble, CancellationKeepsTheLowPart) {
  const DoubleDouble a(1.0, 0x1p-80);
  EXPECT_EQ((a - DoubleDouble(1.0)).hi, 0x1p-80);
  EXPECT_EQ(abs(-a), a);
  EXPECT_EQ(double(a), 1.0);
}

TEST(DoubleDouble, HighPartIsTheRoundedValue) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 5000; ++i) {
    const DoubleDouble a(static_cast<double>(random() >> 11)),
        b(static_cast<double>(random() >> 11));
    for (const DoubleDouble& x : {a + b, a - b, a * b, a / b}) EXPECT_EQ(x.hi, x.hi + x.lo);
  }
}

}  // namespace
