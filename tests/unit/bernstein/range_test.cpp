// range() on the interval and on the triangle.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/ceiling.hpp"
#include "bezel/bernstein/triangle.hpp"

namespace {

using namespace bezel::bernstein;
using Doubles = std::vector<double>;

TEST(Range, WithoutToleranceItIsTheCoefficients) {
  const Range r = range(Doubles{1.0, -1.0, 3.0});
  EXPECT_EQ(r.lo, -1.0);
  EXPECT_EQ(r.hi, 3.0);
  EXPECT_EQ(range(Doubles{2.0}, 1e-3).lo, 2.0);
}

// 1 - 4s + 6s^2: minimum 1/3 at s = 1/3, maximum 3 at the end.
TEST(Range, TightensToTheTolerance) {
  for (double tol = 1.0; tol > 1e-14; tol *= 0.1) {
    const Range r = range(Doubles{1.0, -1.0, 3.0}, tol);
    EXPECT_LE(r.lo, 1.0 / 3.0);
    EXPECT_GE(r.lo, 1.0 / 3.0 - tol - 1e-14);
    EXPECT_GE(r.hi, 3.0);
    EXPECT_LE(r.hi, 3.0 + tol);
  }
}

TEST(Range, LineAndConstantAreExactAtOnce) {
  const Range line = range(Doubles{-2.0, 5.0}, 1e-12);
  EXPECT_EQ(line.lo, -2.0);
  EXPECT_EQ(line.hi, 5.0);
  const Range constant = range(Doubles(30, 0.1), 1e-30);
  EXPECT_EQ(constant.lo, 0.1);
  EXPECT_EQ(constant.hi, 0.1);
}

// Chebyshev polynomials oscillate between -1 and 1.
TEST(Range, ChebyshevStaysWithinOne) {
  for (const int n : {3, 8, 15, 20}) {
    Doubles previous{1.0}, current{-1.0, 1.0};
    for (int k = 1; k < n; ++k) {
      Doubles next = multiply(Doubles{-2.0, 2.0}, current);
      const Doubles low = elevate(std::span<const double>(previous), 2);
      for (std::size_t i = 0; i < next.size(); ++i) next[i] -= low[i];
      previous = current;
      current = next;
    }
    double size = 0.0;
    for (const double c : current) size = std::fmax(size, std::fabs(c));
    // 64 n u max|b| of range() and 8 n u max|b| of the recurrence above.
    const double rounding = 72.0 * n * 0x1p-53 * size;
    const Range r = range(current, 1e-9);
    EXPECT_NEAR(r.lo, -1.0, 1e-9 + rounding) << n;
    EXPECT_NEAR(r.hi, 1.0, 1e-9 + rounding) << n;
  }
}

// u v (1-u-v) has the maximum 1/27 at the centroid: a bubble of degree 3 with one coefficient 1/6.
TEST(Range, TriangleBubble) {
  Doubles bubble(10, 0.0);
  bubble[static_cast<std::size_t>(triangle_index(3, 1, 1))] = 1.0 / 6.0;
  EXPECT_EQ(range(3, bubble).hi, 1.0 / 6.0);
  for (double tol = 1e-1; tol > 1e-12; tol *= 0.1) {
    const Range r = range(3, bubble, tol);
    EXPECT_GE(r.hi, 1.0 / 27.0 - 1e-17);
    EXPECT_LE(r.hi, 1.0 / 27.0 + tol + 1e-15);
    EXPECT_EQ(r.lo, 0.0);
  }
}

TEST(Range, EnclosesSamplesOfRoughTriangles) {
  for (int seed = 0; seed < 20; ++seed) {
    const int d = 1 + seed % 9;
    Doubles b;
    for (int n = 0; n < triangle_size(d); ++n) b.push_back(std::sin(37.0 * n + seed));
    const Range r = range(d, b, 1e-6);
    double lo = 1e9, hi = -1e9;
    for (int i = 0; i <= 60; ++i)
      for (int j = 0; i + j <= 60; ++j) {
        const double x = evaluate(d, std::span<const double>(b),
                                  Lambda{(60 - i - j) / 60.0, i / 60.0, j / 60.0});
        EXPECT_GE(x, r.lo - 1e-14);
        EXPECT_LE(x, r.hi + 1e-14);
        lo = std::fmin(lo, x);
        hi = std::fmax(hi, x);
      }
    EXPECT_LE(lo - r.lo, 0.02);  // samples 1/60 apart see the extremes roughly
    EXPECT_LE(r.hi - hi, 0.02);
  }
}

TEST(Range, SubnormalAndHugeCoefficients) {
  const Range tiny = range(Doubles{0x1p-1074, -0x1p-1073, 0x1p-1074}, 1e-300);
  EXPECT_LE(tiny.lo, 0.0);
  EXPECT_GE(tiny.lo, -0x1p-1073);
  EXPECT_EQ(tiny.hi, 0x1p-1074);
  const Range huge = range(Doubles{1e308, -1e308, 1e308}, 1e300);
  EXPECT_LE(huge.lo, 0.0);
  EXPECT_GE(huge.lo, -2e300);
  EXPECT_EQ(huge.hi, 1e308);
}

// 27 u v w, a bump of height 1 with a coefficient 4.5.
Doubles bump() {
  Doubles b(10, 0.0);
  b[static_cast<std::size_t>(bezel::bernstein::triangle_index(3, 1, 1))] = 4.5;
  return b;
}

TEST(UpperBound, IsAsSharpAsTheComparisonNeeds) {
  using bezel::bernstein::upper_bound;
  EXPECT_EQ(upper_bound(3, bump(), 5.0, 0.0), 4.5);  // the coefficients suffice
  EXPECT_LE(upper_bound(3, bump(), 1.25, 0.0), 1.25);
  EXPECT_GE(upper_bound(3, bump(), 1.25, 0.0), 1.0);
  // Above the ceiling to a thousandth of the excess, at it to the tolerance.
  EXPECT_GE(upper_bound(3, bump(), 0.5, 0.0), 1.0);
  EXPECT_LE(upper_bound(3, bump(), 0.5, 0.0), 1.0005);
  EXPECT_GE(upper_bound(3, bump(), 1.0, 1e-12), 1.0);
  EXPECT_LE(upper_bound(3, bump(), 1.0, 1e-12), 1.0 + 1.1e-12);
}

TEST(UpperBound, HoldsWhenTheSearchEnds) {
  // 1 - (u - w)^2 is 1 along a whole line: no subdivision is fine enough.
  const Doubles ridge{0.0, 1.0, 1.0, 2.0, 1.0, 0.0};
  const double b = bezel::bernstein::upper_bound(2, ridge, 0.999999999, 0.0, 50);
  EXPECT_GE(b, 1.0);
  EXPECT_LE(b, 1.02);
}

TEST(UpperBound, ArgumentsAreChecked) {
  using bezel::bernstein::upper_bound;
  EXPECT_THROW(upper_bound(1, Doubles{1.0, 2.0}, 0.0, 0.0), bezel::InputError);
  EXPECT_THROW(upper_bound(1, Doubles{1.0, 2.0, 3.0}, std::nan(""), 0.0), bezel::InputError);
  EXPECT_THAT(
      [] {
        upper_bound(1, Doubles{1.0, 2.0, 3.0}, 0.5, -1.0);
      },
      testing::ThrowsMessage<bezel::InputError>(
          "upper bound: found ceiling 0.500000 and tolerance -1.000000, expected a number and at "
          "least 0"));
}

TEST(Range, ToleranceIsChecked) {
  EXPECT_THAT(
      [] {
        range(Doubles{1.0, 2.0}, -1.0);
      },
      testing::ThrowsMessage<bezel::InputError>(
          "range tolerance is -1.000000, expected at least 0"));
  EXPECT_THROW(range(1, Doubles{1.0, 2.0, 3.0}, std::nan("")), bezel::InputError);
}

}  // namespace
