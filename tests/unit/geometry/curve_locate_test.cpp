#include "bezel/geometry/curve_locate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "support/message_of.hpp"

namespace {

using bezel::CurveLocation;
using bezel::locate;
using bezel::Vec2;
using bezel::test::message_of;
using Points = std::vector<Vec2>;

const Points parabola{{{0, 0}}, {{1, 2}}, {{2, 0}}};  // y = 2 x - x^2, x = 2 s
const Points loop{{{0, 0}}, {{2, 1}}, {{-1, 1}}, {{1, 0}}};

TEST(CurveLocateTest, ExactlyOn) {
  for (const double s : {0.0, 0.125, 0.5, 1.0}) {
    const auto found = locate(parabola, Vec2{{2 * s, 4 * s - 4 * s * s}});
    ASSERT_EQ(found.status, CurveLocation::on) << s;
    ASSERT_EQ(found.contacts.size(), 1u) << s;
    EXPECT_EQ(found.contacts[0].s, s);
    EXPECT_EQ(found.contacts[0].lo, s);
    EXPECT_EQ(found.contacts[0].hi, s);
    EXPECT_EQ(found.contacts[0].distance_bound, 0.0);
    EXPECT_TRUE(found.contacts[0].proven);
  }
}

TEST(CurveLocateTest, ExactlyOnALine) {
  const auto found = locate(Points{{{0, 0}}, {{3, 9}}}, Vec2{{1, 3}});  // s = 1/3
  ASSERT_EQ(found.status, CurveLocation::on);
  ASSERT_EQ(found.contacts.size(), 1u);
  EXPECT_EQ(found.contacts[0].hi, std::nextafter(found.contacts[0].lo, 1.0));
  EXPECT_LT(std::fma(3.0, found.contacts[0].lo, -1.0), 0.0);
  EXPECT_GT(std::fma(3.0, found.contacts[0].hi, -1.0), 0.0);
  // To and fro along an axis, x = 8 s (1-s): met at two places, 1/2 -+ sqrt(1/8).
  const auto twice = locate(Points{{{0, 5}}, {{4, 5}}, {{0, 5}}}, Vec2{{1, 5}});
  EXPECT_EQ(twice.status, CurveLocation::on);
  ASSERT_EQ(twice.contacts.size(), 2u);
  EXPECT_NEAR(twice.contacts[0].s, 0.5 - std::sqrt(0.125), 0x1p-52);
  EXPECT_NEAR(twice.contacts[1].s, 0.5 + std::sqrt(0.125), 0x1p-52);
  EXPECT_TRUE(twice.contacts[0].proven && twice.contacts[1].proven);
}

TEST(CurveLocateTest, ADoublePointHasTwoContacts) {
  // 96 (t^3 - t / 16, t^2 - 1/16) with t = s - 1/2: at the origin for s = 1/4 and 3/4.
  const Points integers{{{-9, 18}}, {{13, -14}}, {{-13, -14}}, {{9, 18}}};
  const auto found = locate(integers, Vec2{{0, 0}});
  ASSERT_EQ(found.status, CurveLocation::on);
  ASSERT_EQ(found.contacts.size(), 2u);
  EXPECT_EQ(found.contacts[0].s, 0.25);
  EXPECT_EQ(found.contacts[1].s, 0.75);
}

TEST(CurveLocateTest, WhatCannotBeProvenIsUndecided) {
  // x = (3 s - 1)(s + 1), y = (3 s - 1)(2 - s): both vanish at 1/3, which is no double.
  const auto found = locate(Points{{{-1, -2}}, {{0, 1.5}}, {{4, 2}}}, Vec2{{0, 0}});
  EXPECT_EQ(found.status, CurveLocation::undecided);
  ASSERT_EQ(found.contacts.size(), 1u);
  EXPECT_FALSE(found.contacts[0].proven);
  EXPECT_LT(found.contacts[0].lo, 1.0 / 3 + 0x1p-54);
  EXPECT_EQ(found.contacts[0].hi, std::nextafter(found.contacts[0].lo, 1.0));
  EXPECT_LT(found.contacts[0].distance_bound, 1e-14);
  // Within a tolerance it is on the curve.
  EXPECT_EQ(locate(Points{{{-1, -2}}, {{0, 1.5}}, {{4, 2}}}, Vec2{{0, 0}}, 1e-12).status,
            CurveLocation::on);
}

TEST(CurveLocateTest, OffWithALowerBound) {
  for (const double tolerance : {0.0, 1e-9, 0.1, 0.25}) {
    const auto found = locate(parabola, Vec2{{1, 1.5}}, tolerance);  // distance 1/2
    EXPECT_EQ(found.status, CurveLocation::off);
    EXPECT_TRUE(found.contacts.empty());
    EXPECT_GE(found.distance_lower_bound, 0.24999);
    EXPECT_LE(found.distance_lower_bound, 0.5);
  }
  // Off by the last place, where distances are lost in rounding.
  const auto beside = locate(parabola, Vec2{{1, std::nextafter(1.0, 2.0)}});
  EXPECT_EQ(beside.status, CurveLocation::off);
  EXPECT_EQ(beside.distance_lower_bound, 0.0);
  // Just outside of the tolerance, and just inside.
  const double d = 0.5;
  EXPECT_EQ(locate(parabola, Vec2{{1, 1.5}}, d * (1 - 1e-12)).status, CurveLocation::off);
  EXPECT_EQ(locate(parabola, Vec2{{1, 1.5}}, d * (1 + 1e-12)).status, CurveLocation::on);
}

TEST(CurveLocateTest, ContactsWithinATolerance) {
  // The double point: y = 3 s (1-s) = 3/10 there, at s = 1/2 -+ sqrt(0.15).
  const double a = 0.5 - std::sqrt(0.15), b = 0.5 + std::sqrt(0.15);
  for (const double tolerance : {1e-3, 1e-6, 1e-10}) {
    const auto found = locate(loop, Vec2{{0.5, 0.3}}, tolerance);
    EXPECT_EQ(found.status, CurveLocation::on);
    ASSERT_EQ(found.contacts.size(), 2u) << tolerance;
    for (const std::size_t i : {0u, 1u}) {
      const double s = i == 0 ? a : b;
      const auto& contact = found.contacts[i];
      EXPECT_TRUE(contact.proven);
      EXPECT_LE(contact.lo, s);
      EXPECT_GE(contact.hi, s);
      EXPECT_LE(contact.distance_bound, tolerance);
      // Speed there: x' = 30 t^2 - 3/2 = 3, y' = 3 - 6 s = 6 t: sqrt(9 + 36 * 0.15) = 3.79.
      EXPECT_NEAR((contact.hi - contact.lo) * std::sqrt(14.4), 2 * tolerance, 0.08 * tolerance);
    }
  }
  // All of a short curve.
  const auto all = locate(parabola, Vec2{{1, 0}}, 10.0);
  ASSERT_EQ(all.contacts.size(), 1u);
  EXPECT_EQ(all.contacts[0].lo, 0.0);
  EXPECT_EQ(all.contacts[0].hi, 1.0);
}

TEST(CurveLocateTest, PointsAndExtremes) {
  const Points point{{{1, 2}}}, folded(5, Vec2{{1, 2}});
  for (const Points& c : {point, folded}) {
    const auto on = locate(c, Vec2{{1, 2}});
    EXPECT_EQ(on.status, CurveLocation::on);
    ASSERT_EQ(on.contacts.size(), 1u);
    EXPECT_EQ(on.contacts[0].hi, 1.0);  // everywhere
    EXPECT_EQ(locate(c, Vec2{{1, 3}}).status, CurveLocation::off);
    EXPECT_EQ(locate(c, Vec2{{1, 3}}, 1.5).status, CurveLocation::on);
  }
  const double largest = std::numeric_limits<double>::max();
  const Points huge{{{-largest, -largest}}, {{largest, largest}}};
  EXPECT_EQ(locate(huge, Vec2{{0, 0}}).contacts.at(0).s, 0.5);
  EXPECT_EQ(locate(huge, Vec2{{largest, -largest}}, 1.0).status, CurveLocation::off);
  EXPECT_EQ(locate(huge, Vec2{{0, 0}}, 1e300).status, CurveLocation::on);
  const Points small{{{-0x1p-1074, 0}}, {{0x1p-1074, 0}}};
  EXPECT_EQ(locate(small, Vec2{{0, 0}}).status, CurveLocation::on);
  EXPECT_EQ(locate(small, Vec2{{0, 0x1p-1074}}).status, CurveLocation::off);
}

TEST(CurveLocateTest, BadInput) {
  EXPECT_EQ(message_of([] { (void)locate(Points{}, Vec2{}); }),
            "the curve has no control points, expected 1 to 61");
  EXPECT_EQ(message_of([] { (void)locate(parabola, Vec2{{NAN, 0}}); }), "the point is not finite");
  EXPECT_EQ(message_of([] { (void)locate(parabola, Vec2{}, -1.0); }),
            "tolerance -1.000000, expected a finite distance of at least 0");
  EXPECT_EQ(message_of([] { (void)locate(parabola, Vec2{}, INFINITY); }),
            "tolerance inf, expected a finite distance of at least 0");
}

}  // namespace
