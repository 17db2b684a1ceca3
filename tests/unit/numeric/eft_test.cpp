#include "bezel/numeric/eft.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using bezel::fast_two_sum;
using bezel::two_prod;
using bezel::two_sum;

double any(std::mt19937_64& random, int exponents) {
  const double mantissa = 1.0 + static_cast<double>(random() >> 12) * 0x1p-52;
  const int exponent =
      static_cast<int>(random() % static_cast<unsigned>(2 * exponents)) - exponents;
  return (random() % 2 == 0 ? 1.0 : -1.0) * std::ldexp(mantissa, exponent);
}

TEST(Eft, TwoSumKnownValues) {
  EXPECT_EQ(two_sum(1.0, 0x1p-60).value, 1.0);
  EXPECT_EQ(two_sum(1.0, 0x1p-60).error, 0x1p-60);
  EXPECT_EQ(two_sum(0x1p-60, 1.0).error, 0x1p-60);
  EXPECT_EQ(two_sum(0.1, 0.2).value, 0.1 + 0.2);
  EXPECT_EQ(two_sum(0.1, 0.2).error, -0x1p-55);
  static_assert(two_sum(1.0, 0x1p-60).error == 0x1p-60);
  static_assert(fast_two_sum(1.0, 0x1p-60).error == 0x1p-60);
}

// The exact sum of doubles within 60 binary places fits 113 or 128 bits: compare in __float128-free
// integers.
TEST(Eft, TwoSumIsExactAgainstIntegers) {
  __extension__ using Wide = __int128;
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double a = std::trunc(any(random, 60)), b = std::trunc(any(random, 60));
    const auto s = two_sum(a, b);
    EXPECT_EQ(s.value, a + b);
    EXPECT_TRUE(static_cast<Wide>(s.value) + static_cast<Wide>(s.error) ==
                static_cast<Wide>(a) + static_cast<Wide>(b));
    const bool a_is_larger = std::fabs(a) >= std::fabs(b);
    const auto f = a_is_larger ? fast_two_sum(a, b) : fast_two_sum(b, a);
    EXPECT_EQ(f.value, s.value);
    EXPECT_EQ(f.error, s.error);
  }
}

TEST(Eft, TwoSumIsExactForSubnormals) {
  const auto s = two_sum(0x1p-1074, 1.0);
  EXPECT_EQ(s.value, 1.0);
  EXPECT_EQ(s.error, 0x1p-1074);
}

TEST(Eft, TwoProdIsExactAgainstIntegers) {
  __extension__ using Wide = __int128;
  std::mt19937_64 random(2);
  for (int i = 0; i < 20000; ++i) {
    const double a = std::trunc(any(random, 53)), b = std::trunc(any(random, 53));
    const auto p = two_prod(a, b);
    EXPECT_EQ(p.value, a * b);
    EXPECT_TRUE(static_cast<Wide>(p.value) + static_cast<Wide>(p.error) ==
                static_cast<Wide>(a) * static_cast<Wide>(b));
  }
}

TEST(Eft, TwoProdKnownValues) {
  const auto p = two_prod(1.0 + 0x1p-52, 1.0 - 0x1p-52);
  EXPECT_EQ(p.value, 1.0);
  EXPECT_EQ(p.error, -0x1p-104);
}

}  // namespace
