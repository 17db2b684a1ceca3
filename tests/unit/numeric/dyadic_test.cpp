#include "bezel/numeric/dyadic.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "bezel/base/error.hpp"

namespace {

using bezel::Dyadic;

constexpr double infinity = std::numeric_limits<double>::infinity();

double any(std::mt19937_64& random, int exponents) {
  const double mantissa = 1.0 + static_cast<double>(random() >> 12) * 0x1p-52;
  const int e = static_cast<int>(random() % static_cast<unsigned>(2 * exponents)) - exponents;
  return (random() % 2 == 0 ? 1.0 : -1.0) * std::ldexp(mantissa, e);
}

TEST(Dyadic, EveryDoubleComesBack) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const double x = any(random, 1020);
    EXPECT_EQ(Dyadic(x).to_double(), x);
    EXPECT_EQ(Dyadic(x).sign(), x > 0 ? 1 : -1);
  }
  for (const double x : {0.0, 0x1p-1074, -0x1p-1074, 0x1.8p-1073, 1.7976931348623157e308, 1.0})
    EXPECT_EQ(Dyadic(x).to_double(), x);
  EXPECT_EQ(Dyadic(-0.0), Dyadic());
  EXPECT_EQ(Dyadic().sign(), 0);
}

TEST(Dyadic, SumsAndProductsRoundToTheMachines) {
  std::mt19937_64 random(2);
  for (const int exponents : {3, 60, 200, 500}) {
    for (int i = 0; i < 5000; ++i) {
      const double a = any(random, exponents), b = any(random, exponents);
      EXPECT_EQ((Dyadic(a) + Dyadic(b)).to_double(), a + b);
      EXPECT_EQ((Dyadic(a) - Dyadic(b)).to_double(), a - b);
      EXPECT_EQ((Dyadic(a) * Dyadic(b)).to_double(), a * b);
      EXPECT_EQ(Dyadic(a) < Dyadic(b), a < b);
      EXPECT_EQ((Dyadic(a) * Dyadic(b) + Dyadic(-b)).to_double(), std::fma(a, b, -b));
    }
  }
}

TEST(Dyadic, RingLaws) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 3000; ++i) {
    Dyadic a(any(random, 300)), b(any(random, 300)), c(any(random, 300));
    a = a * b + c;
    EXPECT_EQ(a + b, b + a);
    EXPECT_EQ((a + b) + c, a + (b + c));
    EXPECT_EQ((a + b) * c, a * c + b * c);
    EXPECT_EQ((a * b) * c, a * (b * c));
    EXPECT_EQ(a - a, Dyadic());
    EXPECT_EQ(a + -a, Dyadic());
    EXPECT_EQ(a * Dyadic(), Dyadic());
    EXPECT_EQ(Dyadic() - a, -a);
    EXPECT_EQ((a + b) - b, a);
  }
}

TEST(Dyadic, CarriesAndBorrowsRunThroughManyLimbs) {
  const Dyadic one(1.0), high(0x1p500), tiny(0x1p-500);
  EXPECT_EQ((high - tiny) + tiny, high);
  EXPECT_EQ((high - one) + one, high);
  EXPECT_EQ((high + tiny) - high, tiny);
  EXPECT_EQ((high - tiny) * (high + tiny), high * high - tiny * tiny);
}

TEST(Dyadic, ScalingIsAProductWithAPowerOfTwo) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Dyadic x = Dyadic(any(random, 200)) * Dyadic(any(random, 200));
    const int bits = static_cast<int>(random() % 400) - 200;
    EXPECT_EQ(x.scaled(bits), x * Dyadic(std::ldexp(1.0, bits)));
    EXPECT_EQ(x.scaled(bits).scaled(-bits), x);
  }
  EXPECT_EQ(Dyadic().scaled(100000), Dyadic());
}

TEST(Dyadic, Exponent) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 2000; ++i) {
    const double x = any(random, 200);
    if (x == 0.0) continue;
    EXPECT_EQ(Dyadic(x).exponent(), std::ilogb(x));
    EXPECT_EQ((-Dyadic(x)).scaled(12345).exponent(), std::ilogb(x) + 12345);
  }
  EXPECT_EQ(Dyadic(0x1p-1074).exponent(), -1074);
  EXPECT_EQ((Dyadic(1.0).scaled(700) - Dyadic(1.0)).exponent(), 699);
  EXPECT_EQ(Dyadic().exponent(), 0);
}

TEST(Dyadic, RoundsToNearestEven) {
  const Dyadic ulp(0x1p-52), one(1.0);
  EXPECT_EQ((one + ulp.scaled(-1)).to_double(), 1.0);                  // tie to even
  EXPECT_EQ((one + ulp + ulp.scaled(-1)).to_double(), 1.0 + 0x1p-51);  // tie to even, up
  EXPECT_EQ((one + ulp.scaled(-1) + Dyadic(0x1p-1000)).to_double(), 1.0 + 0x1p-52);
  EXPECT_EQ((one - ulp.scaled(-2)).to_double(), 1.0);
  EXPECT_EQ((one - ulp.scaled(-2) - Dyadic(0x1p-1000)).to_double(), 1.0 - 0x1p-53);
}

TEST(Dyadic, SubnormalsUnderflowAndOverflow) {
  const Dyadic least(0x1p-1074);
  EXPECT_EQ(least.scaled(-1).to_double(), 0.0);  // tie to even
  EXPECT_EQ((least.scaled(-1) + least.scaled(-300)).to_double(), 0x1p-1074);
  EXPECT_EQ((least + least.scaled(-1)).to_double(), 0x1p-1073);
  EXPECT_EQ(least.scaled(-2).to_double(), 0.0);
  EXPECT_TRUE(std::signbit((-least).scaled(-5).to_double()));
  const Dyadic largest(1.7976931348623157e308);
  EXPECT_EQ((largest + Dyadic(0x1p969)).to_double(), 1.7976931348623157e308);
  EXPECT_EQ((largest + Dyadic(0x1p970)).to_double(), infinity);
  EXPECT_EQ((-largest).scaled(1).to_double(), -infinity);
  EXPECT_EQ(Dyadic(0x1.fffffffffffffp-1022).scaled(-1).to_double(), 0x1p-1022);
}

TEST(Dyadic, OnlyFiniteNumbers) {
  for (const double x : {infinity, -infinity, std::nan("")})
    EXPECT_THAT([x] { return Dyadic(x); }, testing::ThrowsMessage<bezel::InputError>(
                                               testing::HasSubstr("expected a finite value")));
}

}  // namespace
