// Crossings at small angles, and far from the origin: intersect returns their parameters to
// rounding, where residuals in plain arithmetic lose digits by their condition.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/newton_intersection.hpp"
#include "support.hpp"

namespace {

using namespace bezel;
using geometry_test::Points;

constexpr double u = 0x1p-53;
constexpr double polish_condition = 0x1p20;  // as in intersect.cpp

void expect_inside(const Crossing& c) {
  EXPECT_LE(c.s_lo, c.s);
  EXPECT_LE(c.s, c.s_hi);
  EXPECT_LE(c.t_lo, c.t);
  EXPECT_LE(c.t, c.t_hi);
}

// x1 = 2 (4 s^2 - 1) - r, y1 = (2s-1)^2 + 1 + h; x2 = 4 (4 t^2 - 1), y2 = 4 (2t-1)^2 + 1 + h with
// r = 2^-n: three crossings about sqrt r apart, one of them at s = (1 + sqrt r) / 2,
// t = (2 + sqrt r) / 4. h = 1/r makes the condition 2^(2n) instead of 2^n.
TEST(IllConditioned, AlmostTangentParabolas) {
  for (const bool far : {false, true})
    for (int n = 2; n <= (far ? 25 : 40); ++n) {
      SCOPED_TRACE(std::to_string(n) + (far ? " far from the origin" : ""));
      const double r = std::ldexp(1.0, -n), h = far ? 1.0 / r : 0.0;
      const Points a{Vec2{{-2 - r, 2 + h}}, Vec2{{-2 - r, h}}, Vec2{{6 - r, 2 + h}}};
      const Points b{Vec2{{-4, 5 + h}}, Vec2{{-4, -3 + h}}, Vec2{{12, 5 + h}}};
      const double s = (1.0 + std::sqrt(r)) / 2, t = (2.0 + std::sqrt(r)) / 4;
      const CurveIntersections found = intersect(a, b);
      ASSERT_EQ(found.crossings.size(), 3U) << geometry_test::show(a, b, found);
      EXPECT_TRUE(found.tangencies.empty());
      EXPECT_TRUE(found.unresolved.empty());
      // The last one; signs take turns.
      const Crossing& c = found.crossings[2];
      EXPECT_EQ(c.sign, found.crossings[0].sign);
      EXPECT_EQ(c.sign, -found.crossings[1].sign);
      // s and t above carry 2 u; polished ones 2 u more, whatever the condition.
      const double allowed = c.condition > polish_condition ? 4 * u : 4 * u * c.condition + 2 * u;
      EXPECT_NEAR(c.s, s, allowed);
      EXPECT_NEAR(c.t, t, allowed);
      expect_inside(c);
      if (far && n >= 20) {
        EXPECT_GT(c.condition, 1e11);
      }
    }
}

TEST(IllConditioned, LinesAtASmallAngle) {
  double worst_plain = 0.0;
  for (int n = 10; n <= 48; ++n) {
    SCOPED_TRACE(n);
    const double r = std::ldexp(1.0, -n);
    const Points a{Vec2{{0.1, 0.7}}, Vec2{{1.3, 1.9}}};
    const Points b{Vec2{{0.1, 0.7 + r}}, Vec2{{1.3, 1.9 - 2 * r}}};
    // Same abscissae: s = t = d0 / (d0 - d1) with the exact differences at the ends, 2 u in all.
    const double d0 = b[0].y() - a[0].y(), d1 = b[1].y() - a[1].y(), s = d0 / (d0 - d1);
    const CurveIntersections found = intersect(a, b);
    ASSERT_EQ(found.crossings.size(), 1U);
    const Crossing& c = found.crossings[0];
    const double allowed = c.condition > polish_condition ? 2 * u : 4 * u * c.condition;
    EXPECT_NEAR(c.s, s, allowed);
    EXPECT_NEAR(c.t, s, allowed);
    expect_inside(c);
    if (c.condition > polish_condition) {
      const NewtonIntersection plain =
          newton_intersection(a, b, c.s + 0x1p-10, c.t, ResidualForm::plain);
      worst_plain = std::fmax(worst_plain, std::fabs(plain.s - s));
    }
  }
  EXPECT_GT(worst_plain, 1e-6);  // what compensation is for
}

// The same, where curve and parameter are no longer proportional: the second stage of intersect.
TEST(IllConditioned, ParabolasAtASmallAngle) {
  for (int n = 10; n <= 48; ++n) {
    SCOPED_TRACE(n);
    const double r = std::ldexp(1.0, -n);
    const Points a{Vec2{{0.1, 0.7}}, Vec2{{0.6, 1.5}}, Vec2{{1.3, 1.9}}};
    const Points b{Vec2{{0.1, 0.7 + r}}, Vec2{{0.6, 1.5}}, Vec2{{1.3, 1.9 - 2 * r}}};
    // d0 (1-s)^2 = d2 s^2
    const double d0 = b[0].y() - a[0].y(), d2 = a[2].y() - b[2].y();
    const double s = 1.0 / (1.0 + std::sqrt(d2 / d0));
    const CurveIntersections found = intersect(a, b);
    ASSERT_EQ(found.crossings.size(), 1U);
    const Crossing& c = found.crossings[0];
    const double allowed = c.condition > polish_condition ? 4 * u : 4 * u * c.condition + 2 * u;
    EXPECT_NEAR(c.s, s, allowed);
    EXPECT_NEAR(c.t, s, allowed);
    expect_inside(c);
  }
}

}  // namespace
