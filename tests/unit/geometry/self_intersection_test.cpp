#include "bezel/geometry/self_intersection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/interval.hpp"
#include "support/message_of.hpp"

namespace {

using bezel::self_intersections;
using bezel::Vec2;
using bezel::test::message_of;
using Points = std::vector<Vec2>;

constexpr double u = 0x1p-53;

/// Nothing at all but, perhaps, cusps and the joint.
void expect_no_pairs(const bezel::SelfIntersections& found) {
  EXPECT_TRUE(found.pairs.crossings.empty());
  EXPECT_TRUE(found.pairs.tangencies.empty());
  EXPECT_TRUE(found.pairs.overlaps.empty());
  EXPECT_TRUE(found.pairs.unresolved.empty());
}

TEST(SelfIntersectionTest, Loop) {
  // x = 1/2 - 3 t / 2 + 10 t^3, y = 3/4 - 3 t^2 with t = s - 1/2: twice at t = -+ sqrt(0.15).
  const Points loop{{{0, 0}}, {{2, 1}}, {{-1, 1}}, {{1, 0}}};
  const auto found = self_intersections(loop);
  EXPECT_FALSE(found.closed);
  EXPECT_TRUE(found.cusps.empty());
  ASSERT_EQ(found.pairs.crossings.size(), 1u);
  EXPECT_TRUE(found.pairs.unresolved.empty());
  const auto& c = found.pairs.crossings[0];
  EXPECT_TRUE(c.certified);
  EXPECT_LE(std::fabs(c.s - (0.5 - std::sqrt(0.15))), 4 * u * c.condition);
  EXPECT_LE(std::fabs(c.t - (0.5 + std::sqrt(0.15))), 4 * u * c.condition);
  EXPECT_LE(c.s_lo, c.s);
  EXPECT_GE(c.s_hi, c.s);
  EXPECT_NEAR(c.point_a.x(), 0.5, 8 * u);
  EXPECT_NEAR(c.point_a.y(), 0.3, 8 * u);
  // b'(s) = (3, 6 |t|), b'(t) = (3, -6 |t|): clockwise.
  EXPECT_EQ(c.sign, -1);
}

TEST(SelfIntersectionTest, LoopAtBinaryFractions) {
  // 96 (t^3 - t / 16, t^2 - 1/16), t = s - 1/2: at s = 1/4 and 3/4, borders of the halvings.
  const auto found = self_intersections(Points{{{-9, 18}}, {{13, -14}}, {{-13, -14}}, {{9, 18}}});
  ASSERT_EQ(found.pairs.crossings.size(), 1u);
  EXPECT_TRUE(found.pairs.crossings[0].certified);
  EXPECT_EQ(found.pairs.crossings[0].s, 0.25);
  EXPECT_EQ(found.pairs.crossings[0].t, 0.75);
  EXPECT_TRUE(found.pairs.unresolved.empty());
}

TEST(SelfIntersectionTest, Cusp) {
  const auto found = self_intersections(Points{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}});
  ASSERT_EQ(found.cusps.size(), 1u);
  EXPECT_EQ(found.cusps[0].lo, 0.5);
  EXPECT_EQ(found.cusps[0].hi, 0.5);
  EXPECT_TRUE(found.cusps[0].proven);
  expect_no_pairs(found);
}

TEST(SelfIntersectionTest, VanishingSpeedWithoutACusp) {
  // 10 (s^3, s^5): smooth, but at rest in 0.
  const Points right{{{0, 0}}, {{0, 0}}, {{0, 0}}, {{1, 0}}, {{4, 0}}, {{10, 10}}};
  const auto end = self_intersections(right);
  ASSERT_EQ(end.cusps.size(), 1u);
  EXPECT_EQ(end.cusps[0].s, 0.0);
  expect_no_pairs(end);
  const Points whole = bezel::bernstein::specialize(std::span<const Vec2>(right), -1.0, 1.0);
  const auto inner = self_intersections(whole);
  ASSERT_EQ(inner.cusps.size(), 1u);
  EXPECT_EQ(inner.cusps[0].lo, 0.5);
  EXPECT_TRUE(inner.cusps[0].proven);
  expect_no_pairs(inner);
}

TEST(SelfIntersectionTest, None) {
  expect_no_pairs(self_intersections(Points{{{0, 0}}, {{1, 1}}, {{0, 2}}, {{1, 3}}}));  // S
  expect_no_pairs(self_intersections(Points{{{0, 0}}, {{1, 2}}, {{2, 0}}}));
  expect_no_pairs(self_intersections(Points{{{0, 0}}, {{3, 1}}}));
  expect_no_pairs(self_intersections(Points{{{0, 0}}, {{1, 1}}, {{2, 2}}, {{3, 3}}}));
  expect_no_pairs(self_intersections(Points{{{0, 3}}, {{0, 3}}, {{0, 3}}, {{2, 6}}}));
  const auto point = self_intersections(Points{{{2, 1}}});
  EXPECT_TRUE(point.closed);
  EXPECT_TRUE(point.cusps.empty());
  expect_no_pairs(point);
  expect_no_pairs(self_intersections(Points(5, Vec2{{1, 1}})));
}

TEST(SelfIntersectionTest, NearlyACusp) {
  // (t^3 - e t, t^2) with e = 4^-k: a loop between t = -+ 2^-k; e < 0: none.
  for (int k = 2; k <= 12; ++k) {
    const double e = std::ldexp(1.0, -2 * k);
    for (const double a : {e, -e}) {
      // Monomials in s, t = s - 1/2: x = s^3 - 3/2 s^2 + (3/4 - a) s + (a/2 - 1/8), times 24; y
      // likewise: all integers over 4^k.
      const double x0 = 24 * (0.5 * a - 0.125), x1 = 8 * (0.75 - a), x2 = -12, x3 = 24;
      const Points c{{{x0, 6}},
                     {{x0 + x1, 6 - 8}},
                     {{x0 + 2 * x1 + x2, 6 - 16 + 8}},
                     {{x0 + 3 * x1 + 3 * x2 + x3, 6}}};
      const auto found = self_intersections(c);
      EXPECT_TRUE(found.cusps.empty()) << k;
      EXPECT_TRUE(found.pairs.unresolved.empty()) << k << ' ' << a;
      ASSERT_EQ(found.pairs.crossings.size(), a > 0 ? 1u : 0u) << k;
      if (a < 0) continue;
      const auto& crossing = found.pairs.crossings[0];
      EXPECT_TRUE(crossing.certified);
      EXPECT_LE(std::fabs(crossing.s - (0.5 - std::ldexp(1.0, -k))), 4 * u * crossing.condition);
      EXPECT_LE(std::fabs(crossing.t - (0.5 + std::ldexp(1.0, -k))), 4 * u * crossing.condition);
    }
  }
}

TEST(SelfIntersectionTest, ClosedCurves) {
  // A drop with a corner at the joint, and a smooth joint.
  const auto drop = self_intersections(Points{{{0, 0}}, {{4, 4}}, {{4, -4}}, {{0, 0}}});
  EXPECT_TRUE(drop.closed);
  expect_no_pairs(drop);
  // Without speed at the joint.
  const auto rest = self_intersections(Points{{{3, 2}}, {{3, 2}}, {{4, 4}}, {{3, 4}}, {{3, 2}}});
  EXPECT_EQ(rest.cusps.size(), 1u);
  expect_no_pairs(rest);
  const auto smooth = self_intersections(
      Points{{{0, 0}}, {{1, 0}}, {{3, 2}}, {{0, 4}}, {{-3, 2}}, {{-1, 0}}, {{0, 0}}});
  EXPECT_TRUE(smooth.closed);
  EXPECT_TRUE(smooth.cusps.empty());
  expect_no_pairs(smooth);
  // A figure of eight, begun away from the crossing: x = 100 s r (s - r) (s^2 - 3 s r + r^2) with
  // r = 1 - s, and y symmetric: s = (5 - sqrt(5)) / 10 meets 1 - s.
  const auto eight = self_intersections(
      Points{{{0, 4}}, {{-20, 4}}, {{40, -8}}, {{-40, -8}}, {{20, 4}}, {{0, 4}}});
  EXPECT_TRUE(eight.closed);
  EXPECT_TRUE(eight.pairs.unresolved.empty());
  ASSERT_EQ(eight.pairs.crossings.size(), 1u);
  EXPECT_TRUE(eight.pairs.crossings[0].certified);
  EXPECT_NEAR(eight.pairs.crossings[0].s, (5 - std::sqrt(5.0)) / 10,
              4 * u * eight.pairs.crossings[0].condition);
}

TEST(SelfIntersectionTest, TouchesItself) {
  // 2560 (t (t^2 - 1/16)^2, t^2), t = s - 1/2: both branches touch the y axis at s = 1/4 and 3/4.
  const auto found = self_intersections(
      Points{{{-45, 640}}, {{69, 128}}, {{-89, -128}}, {{89, -128}}, {{-69, 128}}, {{45, 640}}});
  EXPECT_TRUE(found.pairs.crossings.empty());
  EXPECT_TRUE(found.pairs.unresolved.empty());
  ASSERT_EQ(found.pairs.tangencies.size(), 1u);
  // From a signed distance known to rounding: parameters to its square root.
  EXPECT_NEAR(found.pairs.tangencies[0].s, 0.25, 0x1p-24);
  EXPECT_NEAR(found.pairs.tangencies[0].t, 0.75, 0x1p-24);
}

TEST(SelfIntersectionTest, ARoundedCuspStaysOpenInASmallBox) {
  // Control points of the cusp on [1/10, 1], rounded: a cusp at 4/9 or a tiny loop or neither.
  const Points cusp{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}};
  const auto found =
      self_intersections(bezel::bernstein::specialize(std::span<const Vec2>(cusp), 0.1, 1.0));
  EXPECT_TRUE(found.pairs.crossings.empty());
  ASSERT_EQ(found.pairs.unresolved.size(), 1u);
  const auto& box = found.pairs.unresolved[0];
  EXPECT_LE(box.s_lo, 4.0 / 9);
  EXPECT_GE(box.t_hi, 4.0 / 9);
  EXPECT_LE(box.t_hi - box.s_lo, 0x1p-20);
}

TEST(SelfIntersectionTest, LoopsOfAnySize) {
  for (const double scale : {5e-324, 0x1p-900, 0x1p-300, 0x1p300, 0x1p1022}) {
    const Points loop{{{0, 0}}, {{2 * scale, scale}}, {{-scale, scale}}, {{scale, 0}}};
    const auto found = self_intersections(loop);
    EXPECT_TRUE(found.pairs.unresolved.empty()) << scale;
    ASSERT_EQ(found.pairs.crossings.size(), 1u) << scale;
    EXPECT_TRUE(found.pairs.crossings[0].certified) << scale;
    EXPECT_NEAR(found.pairs.crossings[0].s, 0.5 - std::sqrt(0.15), 1e-15) << scale;
  }
}

TEST(SelfIntersectionTest, TracedTwiceIsUnresolved) {
  // To and fro: (8 s (1-s), 5) meets itself for every s < 1/2.
  const auto found = self_intersections(Points{{{0, 5}}, {{4, 5}}, {{0, 5}}});
  EXPECT_TRUE(found.closed);
  ASSERT_EQ(found.cusps.size(), 1u);
  EXPECT_EQ(found.cusps[0].s, 0.5);
  EXPECT_FALSE(found.pairs.unresolved.empty());
}

TEST(SelfIntersectionTest, BadInput) {
  EXPECT_EQ(message_of([] { (void)self_intersections(Points{}); }),
            "the curve has no control points, expected 1 to 61");
  EXPECT_EQ(message_of([] {
              (void)self_intersections(Points{{{0, 0}}, {{0, INFINITY}}});
            }),
            "control point 1 of the curve is not finite");
}

}  // namespace
