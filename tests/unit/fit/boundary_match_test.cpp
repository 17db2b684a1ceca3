#include "bezel/fit/boundary_match.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bezel/fit/curve_shapes.hpp"

namespace bezel {
namespace {

constexpr double pi = std::numbers::pi, tolerance = 1e-9;

Vec2 on_circle(double angle) {
  return Vec2{{std::cos(angle), std::sin(angle)}};
}

// Its angle is pi (t + 1).
std::vector<fit::CurveFeet> circle() {
  return {fit::CurveFeet(ellipse_arc(Vec2{}, 1.0, 1.0, 0.0, 2.0 * pi))};
}

TEST(CurveFeet, FindsEveryParameterOfAPoint) {
  const fit::CurveFeet feet = circle()[0];
  EXPECT_TRUE(feet.closed(tolerance));
  for (const double angle : {0.1, 1.0, 3.0, 5.9}) {
    const std::vector<double> found = feet.feet(on_circle(angle), tolerance);
    ASSERT_EQ(found.size(), 1U) << angle;
    EXPECT_NEAR(found[0], angle / pi - 1.0, 1e-14);
  }
  EXPECT_EQ(feet.feet(on_circle(0.0), tolerance), (std::vector<double>{-1.0, 1.0}));  // the seam
  EXPECT_TRUE(feet.feet(1.001 * on_circle(1.0), tolerance).empty());
  EXPECT_EQ(feet.feet(1.001 * on_circle(1.0), 0.01).size(), 1U);
  // A figure of eight passes its middle twice.
  const fit::CurveFeet eight(SmoothCurve<2>([](double t) {
    const double s = pi * (t + 0.2);
    return CurveJet<2>{Vec2{{std::sin(s), std::sin(2 * s)}},
                       Vec2{{pi * std::cos(s), 2 * pi * std::cos(2 * s)}},
                       Vec2{{-pi * pi * std::sin(s), -4 * pi * pi * std::sin(2 * s)}}};
  }));
  const std::vector<double> middle = eight.feet(Vec2{}, tolerance);
  ASSERT_EQ(middle.size(), 2U);
  EXPECT_NEAR(middle[0], -0.2, 1e-14);
  EXPECT_NEAR(middle[1], 0.8, 1e-14);
}

TEST(FindPart, TakesTheShorterWayThroughTheSeamToo) {
  const auto curves = circle();
  const auto along = fit::find_part(curves, on_circle(0.5), on_circle(1.5), tolerance);
  ASSERT_TRUE(along.has_value());
  EXPECT_FALSE(along->seam);
  EXPECT_FALSE(along->reversed);
  EXPECT_NEAR(along->length, 1.0, 1e-12);
  const auto back = fit::find_part(curves, on_circle(1.5), on_circle(0.5), tolerance);
  ASSERT_TRUE(back.has_value());
  EXPECT_TRUE(back->reversed);
  for (const bool reversed : {false, true}) {
    const Vec2 a = on_circle(reversed ? 0.3 : -0.4), b = on_circle(reversed ? -0.4 : 0.3);
    const auto seam = fit::find_part(curves, a, b, tolerance);
    ASSERT_TRUE(seam.has_value());
    EXPECT_TRUE(seam->seam);
    EXPECT_EQ(seam->reversed, reversed);
    EXPECT_NEAR(seam->length, 0.7, 1e-12);
    const SmoothCurve<2> part = fit::cut(curves[0].curve(), *seam);
    EXPECT_NEAR(part.length(), 0.7, 1e-12);
    for (const double t : {-1.0, -0.3, 0.0, 0.9, 1.0})
      EXPECT_LT(norm(part(t).x - on_circle(-0.4 + 0.35 * (t + 1.0))), 1e-14) << t;
    ASSERT_EQ(part.breakpoints().size(), 1U);  // the seam
    EXPECT_NEAR(part.breakpoints()[0], 0.4 / 0.35 - 1.0, 1e-14);
  }
}

TEST(FindPart, RefusesWhatIsFarOrNotOnTheCurve) {
  const auto curves = circle();
  EXPECT_FALSE(fit::find_part(curves, on_circle(0.5), 1.1 * on_circle(1.5), tolerance));
  EXPECT_FALSE(fit::find_part(curves, on_circle(0.5), on_circle(0.5), tolerance));
  // The ends of an open arc are near each other; the way along it is more than 4 times as long.
  const std::vector<fit::CurveFeet> open = {
      fit::CurveFeet(ellipse_arc(Vec2{}, 1.0, 1.0, 0.2, 2.0 * pi))};
  EXPECT_FALSE(open[0].closed(tolerance));
  EXPECT_FALSE(fit::find_part(open, on_circle(0.2), on_circle(0.0), tolerance));
  // Of two curves through both points the shorter.
  std::vector<fit::CurveFeet> both = circle();
  both.emplace_back(ellipse_arc(Vec2{}, 1.0, 0.1, 0.0, pi));
  const auto found = fit::find_part(both, on_circle(0.0), on_circle(pi), tolerance);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->curve, 1U);
}

}  // namespace
}  // namespace bezel
