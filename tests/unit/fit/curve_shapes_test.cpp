#include "bezel/fit/curve_shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bezel/base/error.hpp"
#include "support/message_of.hpp"
#include "unit/fit/jets.hpp"

namespace bezel {
namespace {

using test::message_of;

constexpr double pi = std::numbers::pi;

TEST(EllipseArc, LiesOnTheEllipseAndCloses) {
  const auto arc = ellipse_arc(Vec2{{1, 2}}, 3.0, 0.5, -0.5, 2.0, 0.25);
  expect_consistent_jets(arc, 1e-10);
  for (int i = 0; i <= 20; ++i) {
    const Vec2 p = arc(-1.0 + 0.1 * i).x - Vec2{{1, 2}};
    const double x = std::cos(0.25) * p.x() + std::sin(0.25) * p.y();
    const double y = std::cos(0.25) * p.y() - std::sin(0.25) * p.x();
    EXPECT_NEAR(x * x / 9 + 4 * y * y, 1.0, 4e-15);
  }
  const auto circle = ellipse_arc(Vec2{}, 1.0, 1.0, 0.0, 2 * pi);
  EXPECT_EQ(circle(-1.0).x, circle(1.0).x);
  EXPECT_EQ(circle(0.5).x, (Vec2{{0.0, -1.0}}));
  EXPECT_NEAR(circle.length(), 2 * pi, 1e-13);
}

TEST(SuperellipseArc, LiesOnTheSuperellipse) {
  for (const double n : {2.0, 2.5, 3.0, 4.0, 7.5}) {
    const auto arc = superellipse_arc(2.0, 0.5, n, 0.0, 2 * pi);
    EXPECT_EQ(arc.breakpoints().size(), n == 2.0 || n == 4.0 ? 0U : 3U);
    for (int i = 0; i <= 40; ++i) {
      const Vec2 p = arc(-1.0 + 0.05 * i).x;
      EXPECT_NEAR(std::pow(std::fabs(p.x() / 2), n) + std::pow(std::fabs(2 * p.y()), n), 1.0,
                  2e-15 * n);
    }
    expect_consistent_jets(superellipse_arc(2.0, 0.5, n, 0.2, 1.2), 1e-9);
  }
}

TEST(Clothoid, HasFresnelCoordinatesAndConstantSpeed) {
  // x = int cos(pi s^2 / 2), y = int sin(pi s^2 / 2) to s = 1 and 5 [abramowitz1964, table 7.7].
  const auto one = clothoid(Vec2{}, 0.0, 0.0, pi, 1.0);
  EXPECT_NEAR(one(1.0).x.x(), 0.7798934003768228, 4e-16);
  EXPECT_NEAR(one(1.0).x.y(), 0.4382591473903548, 4e-16);
  const auto five = clothoid(Vec2{}, 0.0, 0.0, 5 * pi, 5.0);
  EXPECT_NEAR(five(1.0).x.x(), 0.5636311887, 1e-10);
  EXPECT_NEAR(five(1.0).x.y(), 0.4991913819, 1e-10);
  const auto inflected = clothoid(Vec2{{1, 1}}, 0.3, -3.0, 4.0, 2.0);
  expect_consistent_jets(inflected, 1e-10);
  for (int i = 0; i <= 20; ++i) EXPECT_NEAR(norm(inflected(-1 + 0.1 * i).d1), 1.0, 1e-15);
  EXPECT_NEAR(inflected.length(), 2.0, 1e-14);
}

TEST(Naca4, HasTheThicknessOfTheDefinition) {
  const double c = 0.2969, d = -0.1260, e = -0.3516, f = 0.2843;
  for (const TrailingEdge edge : {TrailingEdge::blunt, TrailingEdge::sharp}) {
    const double g = edge == TrailingEdge::blunt ? -0.1015 : -0.1036;
    const auto upper = naca4("0012", AerofoilPart::upper, edge);
    const auto lower = naca4("0012", AerofoilPart::lower, edge);
    const auto all = naca4("0012", AerofoilPart::all, edge, 2.0);
    expect_consistent_jets(upper, 1e-10);
    expect_consistent_jets(all, 1e-10);
    for (int i = 0; i <= 20; ++i) {
      const double t = -1 + 0.1 * i, a = 0.5 * (1 + t), x = a * a;
      const double y = 0.6 * (c * a + x * (d + x * (e + x * (f + x * g))));
      EXPECT_NEAR(upper(t).x.x(), x, 1e-16);
      EXPECT_NEAR(upper(t).x.y(), y, 1e-16);
      EXPECT_EQ(lower(t).x, (Vec2{{upper(t).x.x(), -upper(t).x.y()}}));
      // The parameters differ by up to u; the curve's speed is 4.
      EXPECT_NEAR(norm(all(-a).x - 2.0 * upper(t).x), 0.0, 8 * 0x1p-53);
      EXPECT_NEAR(norm(all(a).x - 2.0 * lower(t).x), 0.0, 8 * 0x1p-53);
    }
    EXPECT_EQ(all(-1.0).x == all(1.0).x, edge == TrailingEdge::sharp);
  }
}

TEST(Naca4, BendsRoundItsCamberLine) {
  // 2412: camber 0.02 at 0.4; the mean of points on both sides at equal x/chord is the camber line.
  const auto upper = naca4("2412", AerofoilPart::upper), lower = naca4("2412", AerofoilPart::lower);
  for (const double x : {0.1, 0.25, 0.4, 0.7, 1.0}) {
    const double t = 2 * std::sqrt(x) - 1;
    const Vec2 mean = 0.5 * (upper(t).x + lower(t).x);
    EXPECT_NEAR(mean.x(), x, 1e-15);
    const double line =
        x < 0.4 ? 0.02 / 0.16 * (0.8 * x - x * x) : 0.02 / 0.36 * (0.2 + 0.8 * x - x * x);
    EXPECT_NEAR(mean.y(), line, 1e-15);
  }
  ASSERT_EQ(upper.breakpoints().size(), 1U);
  const double t = upper.breakpoints()[0];
  EXPECT_NEAR(t, 2 * std::sqrt(0.4) - 1, 1e-15);
  EXPECT_LE(norm(upper(t - 1e-12).x - upper(t + 1e-12).x), 1e-11);
  const Vec2 before = upper(t - 1e-12).d1, after = upper(t + 1e-12).d1;
  // As the definition has it: the thickness grows across a line whose slope has a kink.
  EXPECT_NEAR(std::fabs(cross(before, after)) / dot(before, after), 2.96e-4, 1e-6);
  expect_consistent_jets(naca4("2412"), 1e-9);
  EXPECT_EQ(naca4("2412").breakpoints().size(), 3U);
}

TEST(Shapes, RefuseBadInput) {
  EXPECT_EQ(message_of([] { return naca4("012"); }),
            "found NACA '012', expected four digits such as 0012");
  EXPECT_EQ(message_of([] { return naca4("0000"); }),
            "found NACA '0000', expected a thickness of 01 to 40 percent");
  EXPECT_EQ(message_of([] { return naca4("2012"); }),
            "found NACA '2012', expected camber and its place (the first two digits) both 0 or "
            "both not");
  EXPECT_EQ(message_of([] { return ellipse_arc(Vec2{}, 1, 0, 0, 1); }),
            "the second half axis is 0.000000, expected a positive one");
  EXPECT_EQ(
      message_of([] { return ellipse_arc(Vec2{}, 1, 1, 0, 7); }),
      "found angles from 0.000000 to 7.000000, expected at most one turn, within a million of 0");
  EXPECT_NE(message_of([] { return superellipse_arc(1, 1, 3, 1e18, 1e18 + 512); }),
            "no InputError");
  EXPECT_NE(message_of([] { return superellipse_arc(1, 1, 1.5, 0, 1); }), "no InputError");
  EXPECT_NE(message_of([] { return clothoid(Vec2{}, 0, 0, 1e6, 1); }), "no InputError");
  EXPECT_NE(message_of([] { return clothoid(Vec2{}, 0, 0, 1, -1); }), "no InputError");
  EXPECT_NE(message_of([] { return ellipse_arc(Vec2{{NAN, 0}}, 1, 1, 0, 1); }), "no InputError");
}

}  // namespace
}  // namespace bezel
