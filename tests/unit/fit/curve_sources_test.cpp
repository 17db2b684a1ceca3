#include "bezel/fit/curve_sources.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "support/message_of.hpp"
#include "unit/fit/jets.hpp"

namespace bezel {
namespace {

using test::message_of;

constexpr double pi = std::numbers::pi;

std::vector<Formula> formulas(std::initializer_list<const char*> texts) {
  std::vector<Formula> out;
  for (const char* text : texts) out.emplace_back(text, std::vector<std::string>{"t"});
  return out;
}

TEST(FormulaCurve, HasExactDerivativesAndEndPoints) {
  const auto curve = formula_curve<2>(formulas({"cos(t)", "t*sin(3*t)"}), -0.25, 2.5);
  EXPECT_EQ(curve(-1.0).x, (Vec2{{std::cos(-0.25), -0.25 * std::sin(-0.75)}}));
  EXPECT_EQ(curve(1.0).x, (Vec2{{std::cos(2.5), 2.5 * std::sin(7.5)}}));
  const CurveJet<2> jet = curve(0.5);
  const double u = 0.25 * -0.25 + 0.75 * 2.5, h = 1.375;
  EXPECT_NEAR(jet.d1.y(), h * (std::sin(3 * u) + 3 * u * std::cos(3 * u)), 1e-14);
  EXPECT_NEAR(jet.d2.y(), h * h * (6 * std::cos(3 * u) - 9 * u * std::sin(3 * u)), 1e-13);
  expect_consistent_jets(curve, 1e-10);
}

TEST(FormulaCurve, RunsBackwardsAndKeepsBreaksInside) {
  const std::vector<double> breaks = {0.0, 5.0, -0.5, 0.0};
  const auto curve = formula_curve<2>(formulas({"t", "abs(t)^3"}), 1.0, -1.0, breaks);
  EXPECT_EQ(curve(-1.0).x, (Vec2{{1.0, 1.0}}));
  ASSERT_EQ(curve.breakpoints().size(), 2U);
  EXPECT_EQ(curve.breakpoints()[0], 0.0);
  EXPECT_EQ(curve.breakpoints()[1], 0.5);
}

TEST(FormulaCurve, InSpace) {
  expect_consistent_jets(formula_curve<3>(formulas({"cos(t)", "sin(t)", "t/4"}), 0, 4), 1e-10);
}

TEST(FormulaCurve, RefusesBadInput) {
  EXPECT_EQ(message_of([] { return formula_curve<2>(formulas({"t"}), 0, 1); }),
            "found 1 formulas, expected 2");
  const std::vector<Formula> two = {Formula("x"), Formula("y")};
  EXPECT_EQ(message_of([&] { return formula_curve<2>(two, 0, 1); }),
            "found a formula of 2 variables, expected one of a single variable");
  EXPECT_EQ(message_of([] {
              return formula_curve<2>(formulas({"t", "t"}), 2, 2);
            }),
            "found a parameter from 2.000000 to the same, expected an interval");
  EXPECT_NE(message_of([] {
              return formula_curve<2>(formulas({"t", "sqrt(t)"}), -1, 1);
            }),
            "no InputError");
  EXPECT_NE(message_of([] {
              return formula_curve<2>(formulas({"t^3", "t^2"}), -1, 1);
            }),
            "no InputError");
  EXPECT_NE(message_of([] {
              return formula_curve<2>(formulas({"1", "2"}), -1, 1);
            }),
            "no InputError");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(message_of([&] {
              return formula_curve<2>(formulas({"t", "t"}), nan, 1);
            }),
            "no InputError");
}

TEST(PolynomialCurve, IsExactOnSmallIntegers) {
  const std::vector<Vec2> c = {Vec2{{1, 0}}, Vec2{{2, 1}}, Vec2{{0, -3}}, Vec2{{4, 0}}};
  const auto curve = polynomial_curve<2>(c, 0.0, 2.0);  // u = 1 at t = 0, du/dt = 1
  const CurveJet<2> jet = curve(0.0);
  EXPECT_EQ(jet.x, (Vec2{{7, -2}}));
  EXPECT_EQ(jet.d1, (Vec2{{14, -5}}));
  EXPECT_EQ(jet.d2, (Vec2{{24, -6}}));
  EXPECT_NE(message_of([&] { return polynomial_curve<2>(std::span(c).first(1), 0, 1); }),
            "no InputError");
}

TEST(BezierCurve, JetsAreConsistentForEveryDegree) {
  RandomStream random("bezier curves", 1);
  for (int degree = 1; degree <= 12; ++degree) {
    std::vector<Vec2> b;
    std::vector<Vec3> c;
    std::vector<double> w;
    for (int i = 0; i <= degree; ++i) {
      b.push_back(Vec2{{i + random.uniform(-0.3, 0.3), random.uniform(-1, 1)}});
      c.push_back(Vec3{{b.back().x(), b.back().y(), random.uniform(-1, 1)}});
      w.push_back(random.uniform(0.5, 2.0));
    }
    expect_consistent_jets(bezier_curve<2>(b), 1e-9);
    expect_consistent_jets(bezier_curve<3>(c, w), 1e-8);
    EXPECT_EQ(bezier_curve<2>(b)(1.0).x, b.back());
  }
}

// A full circle of three rational quadratics.
struct Circle {
  std::vector<double> knots = {0, 0, 0, 1, 1, 2, 2, 3, 3, 3}, weights;
  std::vector<Vec2> control;
  Circle() {
    for (int i = 0; i < 7; ++i) {
      const double phi = pi / 3 * i, r = i % 2 == 0 ? 1.0 : 2.0;
      control.push_back(Vec2{{r * std::cos(phi), r * std::sin(phi)}});
      weights.push_back(i % 2 == 0 ? 1.0 : 0.5);
    }
  }
};

TEST(NurbsCurve, DrawsACircle) {
  const Circle c;
  const auto curve = nurbs_curve<2>(2, c.knots, c.control, c.weights);
  ASSERT_EQ(curve.breakpoints().size(), 2U);
  for (int i = 0; i <= 100; ++i) {
    const CurveJet<2> jet = curve(-1.0 + 0.02 * i);
    EXPECT_NEAR(norm(jet.x), 1.0, 1e-15);
    EXPECT_NEAR(dot(jet.x, jet.d1), 0.0, 1e-14);
    EXPECT_NEAR(dot(jet.x, jet.d2) + dot(jet.d1, jet.d1), 0.0, 1e-12);
  }
  EXPECT_NEAR(curve.length(), 2 * pi, 1e-13);
}

TEST(NurbsCurve, EqualsItsBezierCurveAndReproducesLines) {
  RandomStream random("b-splines", 1);
  const std::vector<Vec2> b = {Vec2{{0, 0}}, Vec2{{1, 2}}, Vec2{{2, -1}}, Vec2{{3, 1}}};
  const auto one = bezier_curve<2>(b);
  const auto same = nurbs_curve<2>(3, std::vector<double>{2, 2, 2, 2, 5, 5, 5, 5}, b);
  for (const double t : {-1.0, -0.3, 0.4, 1.0}) EXPECT_LE(norm(one(t).x - same(t).x), 1e-15);
  for (int degree = 1; degree <= 6; ++degree) {
    // Control points at the Greville abscissae give x(u) = u.
    std::vector<double> knots;
    const int n = 9;
    for (int i = 0; i < n + degree + 1; ++i) knots.push_back(i + random.uniform(0, 0.8));
    std::vector<Vec2> control;
    for (int i = 0; i < n; ++i) {
      double sum = 0;
      for (int k = 1; k <= degree; ++k) sum += knots[static_cast<std::size_t>(i + k)];
      control.push_back(Vec2{{sum / degree, random.uniform(-1, 1)}});
    }
    const auto curve = nurbs_curve<2>(degree, knots, control);
    const double lo = knots[static_cast<std::size_t>(degree)], hi = knots[9];
    for (int i = 0; i <= 20; ++i) {
      const double t = -1.0 + 0.1 * i;
      const CurveJet<2> jet = curve(t);
      EXPECT_NEAR(jet.x.x(), 0.5 * ((1 - t) * lo + (1 + t) * hi), 1e-13);
      EXPECT_NEAR(jet.d1.x(), 0.5 * (hi - lo), 1e-12);
      EXPECT_NEAR(jet.d2.x(), 0.0, 1e-10);
    }
    // C^(degree-1) at the knots.
    for (const double t : curve.breakpoints()) {
      const CurveJet<2> left = curve(t - 1e-9), right = curve(t + 1e-9);
      EXPECT_LE(norm(left.x - right.x), 1e-7);
      if (degree >= 2) {
        EXPECT_LE(norm(left.d1 - right.d1), 1e-5);
      }
      if (degree >= 3) {
        EXPECT_LE(norm(left.d2 - right.d2), 1e-4);
      }
    }
  }
}

TEST(NurbsCurve, RefusesBadInput) {
  const Circle c;
  const auto with = [&](int degree, std::vector<double> knots, std::vector<double> weights) {
    return message_of([&] { return nurbs_curve<2>(degree, knots, c.control, weights); });
  };
  EXPECT_EQ(with(0, c.knots, {}), "found degree 0 of a B-spline, expected 1 to 30");
  EXPECT_EQ(with(7, c.knots, {}),
            "found 7 control points of a B-spline of degree 7, expected 8 to 10000");
  EXPECT_EQ(with(2, {0, 1}, {}), "found 2 knots, expected 10 (control points + degree + 1)");
  EXPECT_EQ(with(2, {0, 0, 0, 2, 1, 2, 2, 3, 3, 3}, {}), "knot 4 is below the one before it");
  EXPECT_EQ(with(2, {0, 0, 0, 1, 1, 1, 2, 3, 3, 3}, {}),
            "knot 3 stands more than 2 times, expected at most as often as the degree");
  EXPECT_EQ(with(2, {0, 0, 1, 1, 1, 1, 1, 1, 3, 3}, {}),
            "the knots leave no interval, expected knot 2 below knot 7");
  EXPECT_EQ(with(2, c.knots, {1, 1}), "found 2 weights and 7 control points, expected as many");
  EXPECT_EQ(with(2, c.knots, {1, 1, -1, 1, 1, 1, 1}),
            "weight 2 is -1.000000, expected a positive one");
  EXPECT_NE(message_of([] { return bezier_curve<2>(std::vector<Vec2>(1)); }), "no InputError");
  EXPECT_NE(message_of([] { return bezier_curve<2>(std::vector<Vec2>(3)); }),
            "no InputError");  // a point
}

double spline_error(int n, SplineEnds ends) {
  // The upper half of an ellipse, or all of it.
  const bool closed = ends == SplineEnds::closed;
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) {
    const double phi = closed ? 2 * pi * i / n : pi * i / (n - 1);
    points.push_back(Vec2{{2 * std::cos(phi), std::sin(phi)}});
  }
  const auto curve = spline_curve<2>(points, ends);
  double worst = 0;
  for (int i = 0; i <= 4000; ++i) {
    const Vec2 p = curve(-1.0 + i / 2000.0).x;
    worst = std::fmax(worst, std::fabs(std::hypot(0.5 * p.x(), p.y()) - 1.0));
  }
  return worst;
}

TEST(SplineCurve, HasFourthOrder) {
  for (const SplineEnds ends : {SplineEnds::not_a_knot, SplineEnds::closed}) {
    const double order = std::log2(spline_error(40, ends) / spline_error(80, ends));
    EXPECT_GT(order, 3.7);
    EXPECT_LT(order, 4.5);
  }
  const double natural =
      std::log2(spline_error(40, SplineEnds::natural) / spline_error(80, SplineEnds::natural));
  EXPECT_GT(natural, 1.7);
  EXPECT_LT(natural, 2.5);
}

TEST(SplineCurve, PassesThroughItsPointsWithContinuousJets) {
  RandomStream random("splines", 1);
  for (const SplineEnds ends : {SplineEnds::not_a_knot, SplineEnds::natural, SplineEnds::closed})
    for (const std::size_t n : {3U, 4U, 9U}) {
      std::vector<Vec3> p;
      for (std::size_t i = 0; i < n; ++i)
        p.push_back(Vec3{{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)}});
      const auto curve = spline_curve<3>(p, ends, 0.5);
      const bool closed = ends == SplineEnds::closed;
      EXPECT_EQ(curve(-1.0).x, p.front());
      EXPECT_EQ(curve(1.0).x, closed ? p.front() : p.back());
      ASSERT_EQ(curve.breakpoints().size(), closed ? n - 1 : n - 2);
      for (std::size_t i = 0; i < curve.breakpoints().size(); ++i) {
        const double t = curve.breakpoints()[i];
        EXPECT_LE(norm(curve(t).x - p[i + 1]), 1e-13);
        const CurveJet<3> left = curve(t - 1e-7), right = curve(t + 1e-7);
        EXPECT_LE(norm(left.d1 - right.d1), 1e-4);
        EXPECT_LE(norm(left.d2 - right.d2), 1e-3);
      }
      if (closed) {
        EXPECT_LE(norm(curve(-1.0).d1 - curve(1.0).d1), 1e-12);
        EXPECT_LE(norm(curve(-1.0).d2 - curve(1.0).d2), 1e-11);
      }
      if (ends == SplineEnds::natural) {
        EXPECT_LE(norm(curve(-1.0).d2), 1e-12);
      }
    }
  // Two points: a line; three: a parabola in one piece.
  const std::vector<Vec2> p = {Vec2{{0, 0}}, Vec2{{2, 1}}, Vec2{{3, 3}}};
  const auto line = spline_curve<2>(std::span(p).first(2));
  EXPECT_LE(norm(line(0.0).x - Vec2{{1, 0.5}}), 1e-15);
  const auto parabola = spline_curve<2>(p);
  EXPECT_LE(norm(parabola(-0.9).d2 - parabola(0.9).d2), 1e-13);
}

TEST(SplineCurve, RefusesBadInput) {
  const std::vector<Vec2> p = {Vec2{{0, 0}}, Vec2{{1, 0}}, Vec2{{1, 0}}, Vec2{{2, 1}}};
  EXPECT_EQ(message_of([&] { return spline_curve<2>(p); }),
            "point 2 equals the one before it, expected different points");
  EXPECT_EQ(message_of([&] { return spline_curve<2>(std::span(p).first(1)); }),
            "found 1 points of a spline, expected 2 to 10000");
  EXPECT_EQ(message_of([&] { return spline_curve<2>(std::span(p).first(2), SplineEnds::closed); }),
            "found 2 points of a spline, expected 3 to 10000");
  EXPECT_EQ(message_of([&] { return spline_curve<2>(p, SplineEnds::natural, 2.0); }),
            "found an exponent of 2.000000, expected 0 to 1");
}

TEST(CurveMotion, ReversesTurnsAndShifts) {
  const std::vector<double> breaks = {0.25};
  const auto curve = formula_curve<2>(formulas({"t", "exp(t)"}), 0.0, 1.0, breaks);
  const auto back = reversed(curve);
  EXPECT_EQ(back(-1.0).x, curve(1.0).x);
  EXPECT_EQ(back(0.25).d1, -curve(-0.25).d1);
  EXPECT_EQ(back.breakpoints()[0], 0.5);
  expect_consistent_jets(back, 1e-10);
  const auto turned = moved(curve, 2.0, 0.5 * pi, Vec2{{1, -1}});
  EXPECT_LE(norm(turned(0.0).x - Vec2{{1 - 2 * curve(0.0).x.y(), -1 + 2 * curve(0.0).x.x()}}),
            1e-15);
  expect_consistent_jets(turned, 1e-10);
  EXPECT_NE(message_of([&] { return moved(curve, 0.0, 0.0, Vec2{}); }), "no InputError");
}

}  // namespace
}  // namespace bezel
