#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/geometry/curve.hpp"

namespace {

using bezel::foot_point;
using bezel::Vec2;
using Points = std::vector<Vec2>;

const Points parabola{{{-1, 1}}, {{0, -1}}, {{1, 1}}};  // y = x^2

TEST(FootPointTest, NearestOfSeveral) {
  const auto foot = foot_point(parabola, Vec2{{0, -1}});
  EXPECT_EQ(foot.s, 0.5);
  EXPECT_EQ(foot.distance, 1.0);
  EXPECT_EQ(foot.point, (Vec2{{0, 0}}));
  const auto end = foot_point(parabola, Vec2{{3, 3}});
  EXPECT_EQ(end.s, 1.0);
  EXPECT_EQ(end.point, (Vec2{{1, 1}}));
  EXPECT_EQ(end.distance, std::sqrt(8.0));
}

TEST(FootPointTest, KnownFoot) {
  // From (0, 3/2) to (x, x^2): x^2 = 1 is nearest, the ends; from (0, 3/4): x^2 = 1/4.
  const auto ends = foot_point(parabola, Vec2{{0, 1.5}});
  EXPECT_EQ(ends.s, 0.0);
  EXPECT_EQ(ends.distance, std::sqrt(1.25));
  const auto two = foot_point(parabola, Vec2{{0, 0.75}});
  EXPECT_NEAR(two.s, 0.25, 0x1p-53);  // and 3/4
  EXPECT_NEAR(two.distance, std::sqrt(0.5), 0x1p-53);
}

TEST(FootPointTest, PointsOfTheCurve) {
  // A sum of few bits: the curve passes through it exactly.
  const Points cubic{{{0, 0}}, {{1, 2}}, {{2, -1}}, {{3, 1}}};
  for (const double s : {0.0, 0.125, 0.25, 0.5, 0.75, 1.0}) {
    const auto foot = foot_point(cubic, bezel::Curve(cubic)(s));
    EXPECT_NEAR(foot.s, s, 0x1p-53) << s;
    EXPECT_LE(foot.distance, 0x1p-52) << s;
  }
  const Points loop{{{0, 0}}, {{2, 1}}, {{-1, 1}}, {{1, 0}}};  // closed at its double point
  const auto crossing = foot_point(loop, Vec2{{0.5, 0.3}});
  EXPECT_NEAR(crossing.s, 0.5 - std::sqrt(0.15), 0x1p-52);  // not 0.5 + ...
  EXPECT_NEAR(crossing.distance, 0.0, 1e-16);
}

TEST(FootPointTest, PointsAndLines) {
  const auto point = foot_point(Points{{{3, 4}}}, Vec2{{0, 0}});
  EXPECT_EQ(point.s, 0.0);
  EXPECT_EQ(point.distance, 5.0);
  EXPECT_EQ(foot_point(Points(7, Vec2{{3, 4}}), Vec2{{0, 0}}).distance, 5.0);
  EXPECT_EQ(foot_point(Points(7, Vec2{{3, 4}}), Vec2{{3, 4}}).distance, 0.0);
  const auto line = foot_point(Points{{{0, 0}}, {{4, 0}}}, Vec2{{1, 2}});
  EXPECT_EQ(line.s, 0.25);
  EXPECT_EQ(line.distance, 2.0);
  EXPECT_EQ(line.point, (Vec2{{1, 0}}));
}

TEST(FootPointTest, LargestAndSmallestNumbers) {
  constexpr double largest = std::numeric_limits<double>::max();
  const Points wide{{{-largest, -largest}}, {{largest, -largest}}};
  const auto far = foot_point(wide, Vec2{{0, largest}});
  EXPECT_EQ(far.s, 0.5);
  EXPECT_TRUE(std::isinf(far.distance));  // 2 * largest
  EXPECT_EQ(far.point, (Vec2{{0, -largest}}));
  const auto half = foot_point(wide, Vec2{{0, 0}});
  EXPECT_EQ(half.s, 0.5);
  EXPECT_EQ(half.distance, largest);
  const double least = std::numeric_limits<double>::denorm_min();
  const auto tiny = foot_point(Points{{{0, 0}}, {{4 * least, 0}}}, Vec2{{least, 3 * least}});
  EXPECT_EQ(tiny.s, 0.25);
  EXPECT_EQ(tiny.distance, 3 * least);
}

TEST(FootPointTest, BadInput) {
  const auto message_of = [](const Points& c, const Vec2& p) -> std::string {
    try {
      static_cast<void>(foot_point(c, p));
    } catch (const bezel::InputError& error) {
      return error.what();
    }
    return "no InputError";
  };
  EXPECT_EQ(message_of({}, {}), "the curve has no control points, expected 1 to 61");
  EXPECT_EQ(message_of(Points(62), {}), "the curve has 62 control points, expected 1 to 61");
  EXPECT_EQ(message_of({{{0, 0}}, {{NAN, 0}}}, {}), "control point 1 of the curve is not finite");
  EXPECT_EQ(message_of(parabola, {{INFINITY, 0}}), "the point is not finite");
  EXPECT_EQ(message_of(parabola, {{0, NAN}}), "the point is not finite");
}

}  // namespace
