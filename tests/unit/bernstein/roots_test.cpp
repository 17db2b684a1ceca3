// roots() on [0, 1].

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/bernstein/roots.hpp"

namespace {

using namespace bezel::bernstein;
using Doubles = std::vector<double>;

// Product of (s - r), each factor with the coefficients -r, 1 - r.
Doubles with_roots(const Doubles& r) {
  Doubles b{1.0};
  for (const double x : r) b = multiply(b, Doubles{-x, 1.0 - x});
  return b;
}

void expect_ordered(const std::vector<Root>& found) {
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_LE(found[i].lo, found[i].s);
    EXPECT_LE(found[i].s, found[i].hi);
    if (i > 0) {
      EXPECT_LE(found[i - 1].hi, found[i].lo);
    }
  }
}

TEST(Roots, NoneOneTwo) {
  EXPECT_TRUE(roots(Doubles{1.0}).empty());
  EXPECT_TRUE(roots(Doubles{1.0, 2.0, 1.0}).empty());
  EXPECT_TRUE(roots(Doubles{1.0, -0.5, 1.0}).empty());  // variations but no root
  const auto one = roots(Doubles{-1.0, 3.0});
  ASSERT_EQ(one.size(), 1U);
  EXPECT_EQ(one[0].s, 0.25);
  EXPECT_FALSE(one[0].multiple);
  // 1 - 6s + 6s^2: (3 -+ sqrt 3) / 6
  const auto two = roots(Doubles{1.0, -2.0, 1.0});
  ASSERT_EQ(two.size(), 2U);
  EXPECT_NEAR(two[0].s, (3.0 - std::sqrt(3.0)) / 6.0, 0x1p-52);
  EXPECT_NEAR(two[1].s, (3.0 + std::sqrt(3.0)) / 6.0, 0x1p-52);
  expect_ordered(two);
}

TEST(Roots, SimpleRootsAreBracketedByNeighbouringDoubles) {
  const auto found = roots(with_roots({0.1, 0.3, 0.7, 0.9}));
  ASSERT_EQ(found.size(), 4U);
  const Doubles expected{0.1, 0.3, 0.7, 0.9};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(found[i].s, expected[i], 1e-14);
    EXPECT_LE(found[i].hi - found[i].lo, 4.0 * 0x1p-53);
    EXPECT_FALSE(found[i].multiple);
  }
  expect_ordered(found);
}

TEST(Roots, EndPointsAndTheirMultiplicity) {
  const auto simple = roots(Doubles{0.0, 1.0, -1.0, 0.0});
  ASSERT_EQ(simple.size(), 3U);
  EXPECT_EQ(simple[0].s, 0.0);
  EXPECT_FALSE(simple[0].multiple);
  EXPECT_EQ(simple[1].s, 0.5);
  EXPECT_EQ(simple[2].s, 1.0);
  const auto twice = roots(Doubles{0.0, 0.0, 1.0});  // s^2
  ASSERT_EQ(twice.size(), 1U);
  EXPECT_TRUE(twice[0].multiple);
  EXPECT_EQ(twice[0].lo, 0.0);
  EXPECT_EQ(twice[0].hi, 0.0);
  const auto both = roots(Doubles{0.0, 1.0, 0.0, 0.0, 0.0});  // 4 s (1-s)^3
  ASSERT_EQ(both.size(), 2U);
  EXPECT_FALSE(both[0].multiple);
  EXPECT_TRUE(both[1].multiple);
}

TEST(Roots, RootNextToTheEndIsFoundToFullRelativePrecision) {
  for (const double tiny : {1e-3, 1e-12, 1e-100, 1e-300}) {
    const auto found = roots(Doubles{-tiny, 1.0});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_NEAR(found[0].s, tiny / (1.0 + tiny), 0x1p-51 * tiny);
  }
}

TEST(Roots, DoubleRootIsAMarkedCluster) {
  const auto found = roots(Doubles{1.0, -1.0, 1.0});  // (2s - 1)^2
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].multiple);
  EXPECT_NEAR(found[0].s, 0.5, 1e-14);
  EXPECT_LE(found[0].lo, 0.5);
  EXPECT_GE(found[0].hi, 0.5);
}

TEST(Roots, ClustersOfHighMultiplicityContainTheRoot) {
  for (const int multiplicity : {3, 5, 9, 20, 40}) {
    const auto found = roots(with_roots(Doubles(static_cast<std::size_t>(multiplicity), 0.5)));
    ASSERT_EQ(found.size(), 1U) << multiplicity;
    EXPECT_TRUE(found[0].multiple);
    EXPECT_LE(found[0].lo, 0.5);
    EXPECT_GE(found[0].hi, 0.5);
  }
}

TEST(Roots, NearlyDoubleRootsAreToldApartOrShownAbsent) {
  // (s - 1/2)^2 - e and + e with exact coefficients.
  for (const double e : {0x1p-10, 0x1p-30, 0x1p-50}) {
    const auto two = roots(Doubles{0.25 - e, -0.25 - e, 0.25 - e});
    ASSERT_EQ(two.size(), 2U) << e;
    EXPECT_NEAR(two[0].s, 0.5 - std::sqrt(e), 1e-15);
    EXPECT_NEAR(two[1].s, 0.5 + std::sqrt(e), 1e-15);
    EXPECT_TRUE(roots(Doubles{0.25 + e, -0.25 + e, 0.25 + e}).empty()) << e;
  }
}

TEST(Roots, TwentyRootsAreAllFound) {
  Doubles r;
  for (int i = 1; i <= 20; ++i) r.push_back(i / 21.0);
  const auto found = roots(with_roots(r));
  ASSERT_EQ(found.size(), 20U);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_NEAR(found[i].s, r[i], 1e-9);
  expect_ordered(found);
}

TEST(Roots, ScaleDoesNotMatter) {
  for (const double scale : {0x1p-1060, 0x1p-500, 1.0, 0x1p1000}) {
    const auto found = roots(Doubles{1.0 * scale, -2.0 * scale, 1.0 * scale});
    ASSERT_EQ(found.size(), 2U) << scale;
    EXPECT_NEAR(found[0].s, (3.0 - std::sqrt(3.0)) / 6.0, 0x1p-52);
  }
}

TEST(Roots, LargestDegree) {
  // s^60 - (1-s)^60 has the one root 1/2.
  Doubles b(61, 0.0);
  b.front() = -1.0;
  b.back() = 1.0;
  const auto found = roots(b);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].s, 0.5);
  EXPECT_FALSE(found[0].multiple);
}

void expect_one(const std::vector<Root>& found, double lo, double hi, int least, int most) {
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].lo, lo);
  EXPECT_EQ(found[0].hi, hi);
  EXPECT_GE(found[0].s, lo);
  EXPECT_LE(found[0].s, hi);
  EXPECT_EQ(found[0].min_multiplicity, least);
  EXPECT_EQ(found[0].max_multiplicity, most);
  EXPECT_EQ(found[0].multiple, least != 1 || most != 1);
}

TEST(Roots, MultiplicitiesAreExactAtDoubles) {
  for (int m = 1; m <= 60; ++m) {
    SCOPED_TRACE(m);
    Doubles half, quarter, end(static_cast<std::size_t>(m) + 1, 0.0);  // (2s-1)^m, (4s-1)^m, s^m
    for (int j = 0; j <= m; ++j) {
      const double sign = (m - j) % 2 == 0 ? 1.0 : -1.0;
      half.push_back(sign);
      quarter.push_back(sign * std::pow(3.0, j));
    }
    expect_one(roots(half), 0.5, 0.5, m, m);
    if (m <= 33) {  // 3^33 < 2^53
      expect_one(roots(quarter), 0.25, 0.25, m, m);
    }
    end.back() = 1.0;
    expect_one(roots(end), 0.0, 0.0, m, m);
    std::swap(end.front(), end.back());
    expect_one(roots(end), 1.0, 1.0, m, m);
  }
}

TEST(Roots, MultiplicityBetweenDoublesIsBounded) {
  // (3s-1)^m, exact: nothing tells m roots at 1/3 from fewer with complex ones around.
  const double below = 1.0 / 3.0, above = std::nextafter(below, 1.0);
  for (const int m : {1, 2, 3, 4, 7, 20, 41}) {
    SCOPED_TRACE(m);
    Doubles b;
    for (int j = 0; j <= m; ++j) b.push_back(((m - j) % 2 == 0 ? 1.0 : -1.0) * std::ldexp(1.0, j));
    expect_one(roots(b), below, above, m % 2, m);
    EXPECT_EQ(roots(b)[0].s, below);
  }
}

TEST(Roots, NearMissesOneUnitApart) {
  // b0 b2 = b1^2 - 1 with b1 = 1 - 2^53: roots 1/2 and (B-1) / (2B), not quite one unit below.
  const double B = 0x1p53 - 3.0;
  const auto two = roots(Doubles{B - 1.0, -B, B + 1.0});
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[0].lo, 0.5 - 0x1p-53);
  EXPECT_EQ(two[0].hi, 0.5 - 0x1p-54);
  EXPECT_EQ(two[0].s, two[0].hi);
  EXPECT_EQ(two[1].lo, 0.5);
  EXPECT_EQ(two[1].hi, 0.5);
  for (const Root& root : two) {
    EXPECT_FALSE(root.multiple);
    EXPECT_GT(root.condition, 0x1p52);
    EXPECT_LT(root.condition, 0x1p55);
  }
  // Fibonacci numbers: F(n)^2 - F(n-1) F(n+1) = +-1 by turns: two roots a few units apart, or none.
  double f[80] = {0.0, 1.0};
  for (int n = 2; n < 80; ++n) f[n] = f[n - 1] + f[n - 2];
  int found[2] = {0, 0};
  for (int n = 60; n < 77; ++n) {
    const auto r = roots(Doubles{f[n - 1], -f[n], f[n + 1]});
    EXPECT_EQ(r.size(), n % 2 == 0 ? 0U : 2U) << n;
    ++found[r.empty() ? 0 : 1];
    for (const Root& root : r) EXPECT_FALSE(root.multiple);
  }
  EXPECT_GE(found[0], 8);
  EXPECT_GE(found[1], 8);
}

TEST(Roots, TwoSimpleRootsBetweenTheSameDoubles) {
  // d (d-1) (1-s)^d ((2t - 1)^2 - e t^d) with t = s / (1-s): roots at t = 1/2 -+ 2^(-d/2-1)
  // sqrt(e).
  const int d = 40;
  const auto b = [](double last) {
    Doubles c(d + 1, 0.0);
    c[0] = d * (d - 1);
    c[1] = -4.0 * (d - 1);
    c[2] = 8.0;
    c[d] = last;
    return c;
  };
  const double below = 1.0 / 3.0, above = std::nextafter(below, 1.0);
  const auto three = roots(b(-0x1p-80));  // two 2^-66 apart, and one next to 1
  ASSERT_EQ(three.size(), 3U);
  for (int i = 0; i < 2; ++i) {
    const Root& root = three[static_cast<std::size_t>(i)];
    EXPECT_FALSE(root.multiple);
    EXPECT_EQ(root.s, below);
    EXPECT_EQ(root.lo, below);
    EXPECT_EQ(root.hi, above);
    EXPECT_EQ(root.min_multiplicity, 1);
    EXPECT_EQ(root.max_multiplicity, 1);
  }
  EXPECT_GT(three[2].s, 0.5);
  EXPECT_TRUE(roots(b(0x1p-80)).empty());
  // 2^-138 apart, or as close to a root: more than 64 bits further down than doubles.
  for (const double sign : {-1.0, 1.0}) {
    auto cluster = roots(b(sign * 0x1p-224));
    ASSERT_EQ(cluster.size(), sign < 0.0 ? 2U : 1U);
    cluster.resize(1);
    expect_one(cluster, below, above, 0, 2);
  }
}

TEST(Roots, TinyRoots) {
  // To the last bit, down to the smallest double: -a + (1+a) s has the root a / (1 + a).
  for (const double a : {1e-3, 1e-12, 1e-100, 1e-300, 0x1p-1022, 3 * 0x1p-1074}) {
    const auto found = roots(Doubles{-a, 1.0});
    ASSERT_EQ(found.size(), 1U);
    EXPECT_FALSE(found[0].multiple);
    if (a < 1e-20) {
      EXPECT_EQ(found[0].s, a);  // a - a^2 rounds to a
    }
    EXPECT_EQ(found[0].hi, std::nextafter(found[0].lo, 1.0));
    EXPECT_NEAR(found[0].condition, 2.0, 1e-2);
  }
  // Several together: (s - a) (s - 2a) (s - 3a) up to rounding, a = 2^-1000 / 3 ... in units of a.
  const double a = 0x1p-340 / 3;
  const auto three = roots(Doubles{-6 * a * a * a, 11 * a * a / 3, -2 * a, 1.0});
  ASSERT_EQ(three.size(), 3U);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(three[static_cast<std::size_t>(i)].s / a, i + 1, 1e-13);
  // The distance to the next double below half of the smallest one: 0 is the nearest.
  const auto least = roots(Doubles{-0x1p-1074, 4.0});
  ASSERT_EQ(least.size(), 1U);
  EXPECT_EQ(least[0].s, 0.0);
  EXPECT_EQ(least[0].lo, 0.0);
  EXPECT_EQ(least[0].hi, 0x1p-1074);
}

TEST(Roots, CoefficientsOfEverySize) {
  // Scaling the largest to 1 makes the others underflow; the signs are those of the exact ones.
  const auto found = roots(Doubles{-0x1p-1074, 0x1p-1074, 0x1p1000});
  ASSERT_EQ(found.size(), 1U);
  // -1 + 4 s + 2^2074 s^2 ... in units of 2^-1074: s = 2^-1037 to the last bit.
  EXPECT_EQ(found[0].s, 0x1p-1037);
  const auto ends = roots(Doubles{0x1p-1074, -0x1p1023, 0x1p-1074});
  ASSERT_EQ(ends.size(), 2U);
  EXPECT_EQ(ends[0].lo, 0.0);
  EXPECT_EQ(ends[1].hi, 1.0);
  EXPECT_FALSE(ends[0].multiple);
  EXPECT_FALSE(ends[1].multiple);
}

TEST(RootCondition, KnownValues) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NEAR(root_condition(Doubles{-1.0, 3.0}, 0.25), 1.5, 1e-6);  // 1.5 / (0.25 * 4)
  EXPECT_EQ(root_condition(Doubles{1.0, -1.0, 1.0}, 0.5), infinity);
  EXPECT_EQ(root_condition(Doubles{0.0, 1.0}, 0.0), infinity);
  EXPECT_EQ(root_condition(Doubles{3.0}, 0.5), infinity);
  EXPECT_EQ(root_condition(Doubles{0.0, 0.0}, 0.5), infinity);
  for (const double scale : {0x1p-1000, 0x1p1000})
    EXPECT_EQ(root_condition(Doubles{-scale, 3 * scale}, 0.25),
              root_condition(Doubles{-1.0, 3.0}, 0.25));
  EXPECT_THROW(root_condition(Doubles{}, 0.5), bezel::InputError);
  EXPECT_THAT([] { root_condition(Doubles{1.0}, NAN); },
              testing::ThrowsMessage<bezel::InputError>("root is nan, expected a finite value"));
}

TEST(Roots, BadCoefficients) {
  EXPECT_THAT([] { roots(Doubles{}); }, testing::ThrowsMessage<bezel::InputError>(
                                            "found no coefficients, expected at least one"));
  EXPECT_THAT([] { roots(Doubles(62, 1.0)); }, testing::ThrowsMessage<bezel::InputError>(
                                                   "degree 61 on the interval, expected 0 to 60"));
  EXPECT_THAT(
      [] {
        roots(Doubles{1.0, NAN});
      },
      testing::ThrowsMessage<bezel::InputError>("coefficient 1 is not finite"));
}

TEST(Roots, ZeroPolynomialIsAnInputError) {
  EXPECT_THAT(
      [] {
        roots(Doubles{0.0, -0.0, 0.0});
      },
      testing::ThrowsMessage<bezel::InputError>(
          "the polynomial is zero everywhere, expected one with finitely many roots"));
}

}  // namespace
