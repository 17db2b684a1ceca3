#include "bezel/numeric/ratio.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bezel/base/random.hpp"

namespace {

using bezel::compare;
using bezel::Dyadic;
using bezel::Ratio;
using bezel::to_double;

TEST(Ratio, ComparesAcrossDenominators) {
  EXPECT_EQ(compare({1.0, 3.0}, {2.0, 6.0}), 0);
  EXPECT_EQ(compare({1.0, 3.0}, {0x1.5555555555555p-2}), 1);
  EXPECT_EQ(compare({-1.0, 3.0}, {1.0, 3.0}), -1);
}

TEST(Ratio, NearestDouble) {
  EXPECT_EQ(to_double({1.0, 3.0}), 1.0 / 3);
  EXPECT_EQ(to_double({-2.0, 3.0}), -2.0 / 3);
  EXPECT_EQ(to_double({0.0, 7.0}), 0.0);
  // Ties go to the even mantissa.
  const Dyadic one = 1.0;
  EXPECT_EQ(to_double({one + Dyadic(0x1p-53)}), 1.0);
  EXPECT_EQ(to_double({one + Dyadic(0x1p-52) + Dyadic(0x1p-53)}), 1.0 + 0x1p-51);
  EXPECT_EQ(to_double({one + Dyadic(0x1p-53) + Dyadic(0x1p-200)}), 1.0 + 0x1p-52);
  // The division of doubles is correctly rounded, so it is the reference.
  bezel::RandomStream random("Ratio.NearestDouble", 1);
  for (int i = 0; i < 2000; ++i) {
    const double p = random.uniform(-1, 1), q = random.uniform(0.001, 1);
    EXPECT_EQ(to_double({p, q}), p / q) << p << " " << q;
    // Far beyond the doubles.
    EXPECT_EQ(to_double({Dyadic(p).scaled(5000), Dyadic(q).scaled(5003)}), p / q / 8);
  }
}

TEST(Ratio, QuotientOfLongNumbers) {
  EXPECT_EQ(bezel::quotient(Dyadic(3.0).scaled(4000), Dyadic(4.0).scaled(4000)), 0.75);
  EXPECT_EQ(bezel::quotient(Dyadic(-3.0), Dyadic(1.0).scaled(4000)), 0.0);
  EXPECT_EQ(bezel::quotient(Dyadic(-3.0).scaled(4000), Dyadic(1.0)), -HUGE_VAL);
}

TEST(Ratio, FloorQuotient) {
  EXPECT_EQ(bezel::floor_quotient(7.0, 2.0).to_double(), 3.0);
  EXPECT_EQ(bezel::floor_quotient(8.0, 2.0).to_double(), 4.0);
  EXPECT_EQ(bezel::floor_quotient(0.25, 0.5).to_double(), 0.0);
  EXPECT_EQ(bezel::floor_quotient(0.0, 3.0).to_double(), 0.0);
  bezel::RandomStream random("Ratio.FloorQuotient", 1);
  for (int i = 0; i < 500; ++i) {
    const Dyadic q =
        Dyadic(std::floor(random.uniform(0, 0x1p53))).scaled(static_cast<int>(random.below(90)));
    const Dyadic divisor =
        Dyadic(random.uniform(0.1, 1)) + Dyadic(random.uniform(0.1, 1)).scaled(-60);
    const Dyadic rest = divisor * Dyadic(random.uniform(0, 1));
    EXPECT_TRUE(bezel::floor_quotient(q * divisor + rest, divisor) == q);
  }
}

TEST(Ratio, SimplestFractionOfAnInterval) {
  const auto expect = [](const Dyadic& lo, const Dyadic& hi, double num, double den) {
    const auto r = bezel::simplest_between(lo, hi, 100);
    ASSERT_TRUE(r.has_value());
    EXPECT_EQ(compare(*r, {num, den}), 0) << r->num.to_double() << "/" << r->den.to_double();
    EXPECT_EQ(r->den.to_double(), den);
  };
  expect(0.3, 0.4, 1, 3);
  expect(0.4, 0.6, 1, 2);
  expect(0.7, 1.2, 1, 1);
  expect(2.25, 2.75, 5, 2);
  expect(0.75, 0.75, 3, 4);
  expect(0.0, 0.5, 0, 1);
  // Found again from an interval that is narrow for its denominator.
  bezel::RandomStream random("Ratio.SimplestFractionOfAnInterval", 1);
  for (int i = 0; i < 200; ++i) {
    const double den = 1.0 + std::floor(random.uniform(0, 0x1p40));
    const double num = std::floor(random.uniform(0, den));
    const double near = num / den;
    const Dyadic pad = 0x1p-50;
    const auto r = bezel::simplest_between(near < 0x1p-50 ? Dyadic() : Dyadic(near) - pad,
                                           Dyadic(near) + pad, 100);
    ASSERT_TRUE(r.has_value());
    EXPECT_FALSE(Dyadic(den) < r->den);
    // In the interval.
    EXPECT_NEAR(to_double(*r), near, 0x1p-49);
  }
  EXPECT_FALSE(bezel::simplest_between(Dyadic(1.0 / 3), Dyadic(1.0 / 3) + Dyadic(0x1p-120), 10));
}

}  // namespace
