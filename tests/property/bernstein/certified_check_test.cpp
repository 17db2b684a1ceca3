// The checks of the other tests refuse what is wrong: a test that cannot fail shows nothing.

#include "certified_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cfloat>
#include <cmath>
#include <limits>
#include <vector>

#include "support/exact_values.hpp"
#include "support/hard_polynomials.hpp"

namespace {

using namespace support;
using bezel::bernstein::evaluate_certified;
using testing::HasSubstr;
using Doubles = std::vector<double>;

double moved(double x, int ulps) {
  for (; ulps > 0; --ulps) x = std::nextafter(x, HUGE_VAL);
  for (; ulps < 0; ++ulps) x = std::nextafter(x, -HUGE_VAL);
  return x;
}

TEST(CertifiedCheck, RefusesMovedValuesAndSmallBounds) {
  HardPolynomials source(5, true);
  int inexact = 0;
  for (int i = 0; i < 500; ++i) {
    const Hard hard = source.draw(source.degree(20));
    const Number p = ExactValues(hard.b)(hard.s);
    const CertifiedValue good = evaluate_certified(hard.b, hard.s);
    ASSERT_EQ(complaint(good, p), "") << described(hard.b, hard.s);
    if (std::isinf(good.value)) continue;
    for (const int ulps : {-2, 2}) {
      CertifiedValue bad = good;
      bad.value = moved(bad.value, ulps);
      EXPECT_THAT(complaint(bad, p), HasSubstr("not faithful"));
      bad.error_bound = 4 * good.error_bound + 4 * 0x1p-52 * std::fabs(good.value) + 0x1p-1070;
      EXPECT_THAT(complaint(bad, p), HasSubstr("not faithful"));
      EXPECT_THAT(complaint(bad, p), HasSubstr("the bound is larger than promised"));
    }
    // One side of the exact value is faithful, the other not; both when p is a double.
    const bool above = is_faithful(moved(good.value, 1), p),
               below = is_faithful(moved(good.value, -1), p);
    EXPECT_FALSE(above && below);
    EXPECT_EQ(above || below, compare(Number(good.value), p) != 0);
    // The error itself is a bound, a little less is none.
    const Number error = abs(Number(good.value) - p);
    const double size = static_cast<double>(approximate(error));
    if (size < 0x1p-1000) continue;
    ++inexact;
    CertifiedValue bad = good;
    bad.error_bound = 0.5 * size;
    EXPECT_THAT(complaint(bad, p), HasSubstr("the error is larger than its bound"));
    bad.error_bound = 0.0;
    EXPECT_THAT(complaint(bad, p), HasSubstr("the error is larger than its bound"));
    EXPECT_TRUE(is_bound(good.value, moved(size, 1), p));
    EXPECT_FALSE(is_bound(good.value, moved(size, -1), p));
    // Bounds halved are refused wherever they were not twice too large.
    bad.error_bound = 0.5 * good.error_bound;
    EXPECT_EQ(complaint(bad, p).empty(), bad.error_bound >= size);
  }
  EXPECT_GT(inexact, 200);
}

TEST(CertifiedCheck, RefusesWrongZerosInfinitiesAndNan) {
  const auto exact = Certificate::exact;
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  const Number zero(0.0), tiny(mpz_class(1), -1080), huge(mpz_class(1), 1024);
  EXPECT_EQ(complaint({0.0, 0.0, exact}, zero), "");
  EXPECT_EQ(complaint({-0.0, 0.0, exact}, zero), "");
  EXPECT_NE(complaint({0.0, 0x1p-1074, exact}, zero), "");
  EXPECT_NE(complaint({0x1p-1074, 0x1p-1074, exact}, zero), "");
  EXPECT_EQ(complaint({0.0, 0x1p-1074, exact}, tiny), "");
  EXPECT_NE(complaint({0.0, 0.0, exact}, tiny), "");
  EXPECT_NE(complaint({-0x1p-1074, 0x1p-1074, exact}, tiny), "");
  EXPECT_EQ(complaint({inf, inf, exact}, huge), "");
  EXPECT_NE(complaint({-inf, inf, exact}, huge), "");
  EXPECT_NE(complaint({DBL_MAX, inf, exact}, huge), "");
  EXPECT_NE(complaint({DBL_MAX, 0x1p970, exact}, huge), "");
  EXPECT_NE(complaint({inf, inf, exact}, Number(DBL_MAX)), "");
  EXPECT_NE(complaint({1.0, inf, exact}, Number(1.0)), "");
  EXPECT_NE(complaint({inf, 1.0, exact}, huge), "");
  EXPECT_NE(complaint({nan, 1.0, exact}, Number(1.0)), "");
  EXPECT_NE(complaint({1.0, nan, exact}, Number(1.0)), "");
  EXPECT_NE(complaint({1.0, -1.0, exact}, Number(1.0)), "");
  EXPECT_NE(complaint({1.0, 0.0, Certificate(0)}, Number(1.0)), "");
}

// At powers of two the doubles below are nearer than those above.
TEST(CertifiedCheck, KnowsTheSpacingAtPowersOfTwo) {
  const Number below = Number(1.0) - Number(0x1p-53) - Number(0x1p-70);  // beyond the neighbour
  EXPECT_FALSE(is_faithful(1.0, below));
  EXPECT_TRUE(is_faithful(1.0 - 0x1p-53, below));
  EXPECT_TRUE(is_faithful(1.0, Number(1.0) - Number(0x1p-54)));
  EXPECT_FALSE(is_faithful(1.0 + 0x1p-52, Number(1.0) - Number(0x1p-54)));
  EXPECT_TRUE(is_faithful(1.0 + 0x1p-52, Number(1.0) + Number(0x1p-54)));
  EXPECT_FALSE(is_faithful(1.0 + 0x1p-52, Number(1.0)));
  EXPECT_TRUE(is_nearest(1.0, Number(1.0) + Number(0x1p-53)));  // a tie, to even
  EXPECT_FALSE(is_nearest(1.0 + 0x1p-52, Number(1.0) + Number(0x1p-53)));
  EXPECT_TRUE(is_nearest(0.0, Number(mpz_class(1), -1075)));
  EXPECT_FALSE(is_nearest(0x1p-1074, Number(mpz_class(1), -1075)));
  EXPECT_TRUE(is_nearest(0x1p-1074, Number(mpz_class(3), -1076)));
}

// The integers themselves: values known otherwise.
TEST(ExactValues, KnownValues) {
  const Doubles b{1.0, -0.75, 0.5, -0.25, 0.0};  // (2s-1)^3 (s-1)
  const ExactValues p(b);
  EXPECT_EQ(compare(p(0.5), Number(0.0)), 0);
  EXPECT_EQ(compare(p(0.0), Number(1.0)), 0);
  EXPECT_EQ(compare(p(1.0), Number(0.0)), 0);
  EXPECT_EQ(compare(p(-1.0), Number(54.0)), 0);
  EXPECT_EQ(compare(p(0.25), Number(0.09375)), 0);
  EXPECT_EQ(compare(p(4.0), Number(1029.0)), 0);
  EXPECT_EQ(compare(p.derivative()(0.0), Number(-7.0)), 0);
  EXPECT_EQ(compare(p.derivative()(2.0), Number(81.0)), 0);
  EXPECT_EQ(compare(ExactValues(Doubles{3.0}).derivative()(0.3), Number(0.0)), 0);
  const std::vector<Number> quadratic = numbers(Doubles{0.0, 0.0, 1.0, 1.5, 2.5, 3.0});
  const std::vector<Number> at = numbers(Doubles{0.25, 0.25, 0.5});  // u^2 + 2 u v + 3 v
  EXPECT_EQ(compare(exact_triangle_value(2, quadratic, at), Number(1.8125)), 0);
  EXPECT_EQ(absolute_sum(b, 0.5), 0.5L);
}

}  // namespace
