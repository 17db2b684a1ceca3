// roots() on [0, 1].

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/interval.hpp"

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

TEST(Roots, ZeroPolynomialIsAnInputError) {
  EXPECT_THAT(
      [] {
        roots(Doubles{0.0, -0.0, 0.0});
      },
      testing::ThrowsMessage<bezel::InputError>(
          "the polynomial is zero everywhere, expected one with finitely many roots"));
}

}  // namespace
