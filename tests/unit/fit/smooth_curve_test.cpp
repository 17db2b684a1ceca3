#include "bezel/fit/smooth_curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bezel/base/error.hpp"
#include "support/smooth_curves.hpp"

namespace {

using namespace bezel;
using bezel::testing::ellipse;
using bezel::testing::two_arcs;

template <class Make>
std::string message(const Make& make) {
  try {
    make();
  } catch (const InputError& error) {
    return error.message();
  }
  return "no error";
}

CurveJet<2> line(double t) {
  return {Vec2{{t, 0.0}}, Vec2{{1.0, 0.0}}, Vec2{}};
}

TEST(SmoothCurve, MeasuresLength) {
  const PlaneCurve circle = ellipse(2.0, 2.0, 0.3, 1.8);
  EXPECT_NEAR(circle.length(), 3.0, 3e-15);
  EXPECT_NEAR(circle.length_to(-0.4), 0.9, 2e-15);
  EXPECT_EQ(circle.length_to(-1.0), 0.0);
  EXPECT_NEAR(circle.at_length(0.9), -0.4, 4e-16);
  EXPECT_EQ(circle.at_length(-1.0), -1.0);
  EXPECT_EQ(circle.at_length(4.0), 1.0);
  // 4 a E, E the complete elliptic integral of parameter m = 1 - b^2 / a^2 = 0.99.
  EXPECT_NEAR(ellipse(10.0, 1.0, 0.0, 2.0 * std::numbers::pi).length(), 40.63974180100895, 4e-13);
  EXPECT_NEAR(two_arcs(true).length(), 2.4, 3e-15);
}

TEST(SmoothCurve, LengthAndItsInverse) {
  const PlaneCurve curve = ellipse(10.0, 1.0, 0.0, std::numbers::pi);
  for (int i = 0; i <= 50; ++i) {
    const double s = curve.length() * i / 50.0;
    EXPECT_NEAR(curve.length_to(curve.at_length(s)), s, 1e-14 * curve.length());
  }
}

TEST(SmoothCurve, PiecesAreTheSameCurve) {
  const PlaneCurve whole = two_arcs(true), left = whole.piece(-1.0, 0.0),
                   right = whole.piece(0.0, 0.5);
  EXPECT_NEAR(left.length(), 1.2, 2e-15);
  EXPECT_NEAR(right.length(), 0.6, 2e-15);
  EXPECT_EQ(left(1.0).x, whole(0.0).x);
  EXPECT_EQ(right(-1.0).x, left(1.0).x);
  // Derivatives at the break are each side's: curvature 1 and -3.
  const auto curvature = [](const CurveJet<2>& j) {
    return cross(j.d1, j.d2) / std::pow(norm(j.d1), 3);
  };
  EXPECT_NEAR(curvature(left(1.0)), 1.0, 1e-9);
  EXPECT_NEAR(curvature(right(-1.0)), -3.0, 1e-9);
  EXPECT_TRUE(left.breakpoints().empty());
  const PlaneCurve middle = whole.piece(-0.5, 0.25);
  ASSERT_EQ(middle.breakpoints().size(), 1u);
  EXPECT_NEAR(middle.breakpoints()[0], 1.0 / 3.0, 1e-15);
}

TEST(SmoothCurve, RefusesBadCurves) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message([] { PlaneCurve curve{PlaneCurve::Function()}; }),
            "a curve needs a function, found an empty one");
  EXPECT_EQ(message([&] {
              PlaneCurve curve([&](double t) {
                CurveJet<2> j = line(t);
                if (t > 0.5) j.d2[1] = nan;
                return j;
              });
            }),
            "the curve at t = 0.53125: a point or derivative that is not finite");
  EXPECT_EQ(message([] {
              PlaneCurve curve([](double t) {
                return CurveJet<2>{Vec2{{t * t, t * t * t}}, Vec2{{2.0 * t, 3.0 * t * t}},
                                   Vec2{{2.0, 6.0 * t}}};
              });
            }),
            "the curve at t = 0: speed 0, expected above 1e-12 of the largest, 3.61");
  EXPECT_EQ(message([] {
              PlaneCurve curve(line, {0.5, 0.25});
            }),
            "breakpoint 0.25 of the curve, expected an ascending list inside (-1, 1)");
  EXPECT_EQ(message([] { PlaneCurve curve(line, {1.0}); }),
            "breakpoint 1 of the curve, expected an ascending list inside (-1, 1)");
  EXPECT_EQ(message([] { static_cast<void>(PlaneCurve(line).piece(0.5, 0.5)); }),
            "piece [0.5, 0.5] of a curve on [-1, 1]");
}

}  // namespace
