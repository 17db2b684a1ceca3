#include "bezel/geometry/curve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "support/message_of.hpp"

namespace {

using bezel::Curve;
using bezel::intersect;
using bezel::Vec2;
using bezel::test::message_of;
using Points = std::vector<Vec2>;

TEST(CurveTest, EvaluatesItsEndsAndDerivative) {
  const Curve c({{{0, 0}}, {{1, 2}}, {{2, 0}}});
  EXPECT_EQ(c.degree(), 2);
  EXPECT_EQ(c(0.0), (Vec2{{0, 0}}));
  EXPECT_EQ(c(1.0), (Vec2{{2, 0}}));
  EXPECT_EQ(c(0.5), (Vec2{{1, 1}}));
  EXPECT_EQ(c.derivative(0.5), (Vec2{{2, 0}}));
  EXPECT_EQ(c.box().hi, (Vec2{{2, 2}}));
}

TEST(CurveTest, LengthOfAParabola) {
  // y = 2 x - x^2 on [0, 2]: length = sqrt(5) + asinh(2) / 2.
  const Curve c({{{0, 0}}, {{1, 2}}, {{2, 0}}});
  EXPECT_NEAR(c.length(), std::sqrt(5.0) + 0.5 * std::asinh(2.0), 1e-14);
  EXPECT_EQ(Curve({{{1, 1}}, {{4, 5}}}).length(), 5.0);
  EXPECT_EQ(Curve(Points(1)).length(), 0.0);
}

TEST(CurveTest, LengthOfACusp) {
  // (s^2, s^3): length ((13)^1.5 - 8) / 27, with a vanishing derivative at s = 0.
  const double third = 1.0 / 3;
  const Curve c({{{0, 0}}, {{0, 0}}, {{third, 0}}, {{1, 1}}});
  EXPECT_NEAR(c.length(), (std::pow(13.0, 1.5) - 8) / 27, 1e-13);
}

TEST(CurveTest, BadInput) {
  EXPECT_EQ(message_of([] { Curve c(Points{}); }),
            "the curve has no control points, expected 1 to 61");
  EXPECT_EQ(message_of([] { Curve c(Points(62)); }),
            "the curve has 62 control points, expected 1 to 61");
  EXPECT_EQ(message_of([] {
              Curve c({{{0, 0}}, {{NAN, 0}}});
            }),
            "control point 1 of the curve is not finite");
  const Points line{{{0, 0}}, {{1, 1}}};
  bezel::IntersectOptions options;
  options.coincidence_distance = -1;
  EXPECT_EQ(message_of([&] { intersect(line, line, options); }),
            "the coincidence distance must be finite and not negative");
}

TEST(IntersectTest, TwoLines) {
  const Points a{{{0, 0}}, {{2, 2}}}, b{{{0, 2}}, {{2, 0}}};
  const auto found = intersect(a, b);
  ASSERT_EQ(found.crossings.size(), 1u);
  EXPECT_EQ(found.crossings[0].s, 0.5);
  EXPECT_EQ(found.crossings[0].t, 0.5);
  EXPECT_EQ(found.crossings[0].sign, -1);  // b goes right-down: from left to right of a
  EXPECT_TRUE(found.crossings[0].certified);
  EXPECT_TRUE(found.tangencies.empty() && found.overlaps.empty() && found.unresolved.empty());
}

TEST(IntersectTest, IdenticalAndReversedCurvesOverlap) {
  const Points a{{{0, 0}}, {{1, 2}}, {{2, -1}}, {{3, 1}}};
  const Points reversed(a.rbegin(), a.rend());
  const auto same = intersect(a, a), back = intersect(a, reversed);
  ASSERT_EQ(same.overlaps.size(), 1u);
  EXPECT_EQ(same.overlaps[0].s0, 0.0);
  EXPECT_EQ(same.overlaps[0].s1, 1.0);
  EXPECT_EQ(same.overlaps[0].t0, 0.0);
  EXPECT_EQ(same.overlaps[0].t1, 1.0);
  ASSERT_EQ(back.overlaps.size(), 1u);
  EXPECT_EQ(back.overlaps[0].t0, 1.0);
  EXPECT_EQ(back.overlaps[0].t1, 0.0);
  EXPECT_TRUE(same.crossings.empty() && back.crossings.empty());
}

TEST(IntersectTest, ReusedStorageIsClearedFirst) {
  const Points a{{{0, 0}}, {{2, 2}}}, b{{{0, 2}}, {{2, 0}}}, c{{{5, 5}}, {{6, 6}}};
  bezel::CurveIntersections out;
  intersect(a, b, {}, out);
  EXPECT_EQ(out.crossings.size(), 1u);
  intersect(a, c, {}, out);
  EXPECT_TRUE(out.crossings.empty());
}

TEST(IntersectTest, CachedCurvesGiveTheSameAnswer) {
  const Points a{{{0, 0}}, {{1, 2}}, {{2, -1}}, {{3, 1}}}, b{{{0, 1}}, {{2, -1}}, {{3, 0.5}}};
  const auto plain = intersect(a, b);
  bezel::CurveIntersections cached;
  intersect(bezel::cache_curve(a), bezel::cache_curve(b), {}, cached);
  ASSERT_FALSE(plain.crossings.empty());
  ASSERT_EQ(plain.crossings.size(), cached.crossings.size());
  for (std::size_t i = 0; i < plain.crossings.size(); ++i) {
    EXPECT_EQ(plain.crossings[i].s, cached.crossings[i].s);
    EXPECT_EQ(plain.crossings[i].t, cached.crossings[i].t);
  }
}

TEST(IntersectTest, AnEndPointWithinTheDistanceIsOnTheOtherCurve) {
  bezel::IntersectOptions options;
  options.coincidence_distance = 1e-3;
  const Points line{{{0, 0}}, {{4, 0}}};
  // Ends just short of the line, just past it, and near its end point.
  for (const double y : {5e-4, -5e-4}) {
    const Points up{{{1, y}}, {{1, 1}}};
    const auto found = intersect(line, up, options);
    ASSERT_EQ(found.crossings.size(), 1u);
    EXPECT_EQ(found.crossings[0].s, 0.25);
    EXPECT_EQ(found.crossings[0].t, 0.0);
    EXPECT_EQ(found.crossings[0].sign, 1);
  }
  const Points corner{{{4.0005, 5e-4}}, {{5, 1}}};
  const auto found = intersect(line, corner, options);
  ASSERT_EQ(found.crossings.size(), 1u);
  EXPECT_EQ(found.crossings[0].s, 1.0);
  EXPECT_EQ(found.crossings[0].t, 0.0);
  const Points beyond{{{1, 2e-3}}, {{1, 1}}};
  EXPECT_TRUE(intersect(line, beyond, options).crossings.empty());
}

TEST(IntersectTest, AShallowCrossingIsAnOverlapOnlyWithinTheBand) {
  // Within 1e-12 of each other for 0.4 < s < 0.6; straight and bent.
  for (const double bend : {0.0, 0.1}) {
    const Points a{{{0, 0}}, {{0.5, bend}}, {{1, 0}}};
    const Points b{{{0, -5e-12}}, {{0.5, bend}}, {{1, 5e-12}}};
    bezel::IntersectOptions options;
    const auto sharp = intersect(a, b, options);
    ASSERT_EQ(sharp.crossings.size(), 1u);
    EXPECT_EQ(sharp.crossings[0].sign, 1);
    EXPECT_NEAR(sharp.crossings[0].s, 0.5, 1e-4);  // condition 1e11
    options.coincidence_distance = 1e-12;
    const auto found = intersect(a, b, options);
    ASSERT_EQ(found.overlaps.size(), 1u) << bend;
    EXPECT_TRUE(found.crossings.empty());
    EXPECT_NEAR(found.overlaps[0].s0, 0.4, 2e-3);
    EXPECT_NEAR(found.overlaps[0].s1, 0.6, 2e-3);
    EXPECT_LE(found.overlaps[0].gap, 1.01e-12);
  }
  // Straight lines of degree 1 alike.
  const Points p{{{0, 0}}, {{1, 0}}}, q{{{0, -5e-12}}, {{1, 5e-12}}};
  bezel::IntersectOptions band;
  band.coincidence_distance = 1e-12;
  EXPECT_EQ(intersect(p, q).crossings.size(), 1u);
  EXPECT_EQ(intersect(p, q, band).overlaps.size(), 1u);
}

TEST(IntersectTest, ACuspOnTheOtherCurve) {
  const Points cusp{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}};
  const auto across = intersect(cusp, Points{{{-1, 0.75}}, {{2, 0.75}}});
  ASSERT_EQ(across.tangencies.size(), 1u);
  EXPECT_EQ(across.tangencies[0].s, 0.5);
  EXPECT_EQ(across.tangencies[0].t, 0.5);
  EXPECT_EQ(across.tangencies[0].order, 2);
  const auto along = intersect(cusp, Points{{{0.5, 0}}, {{0.5, 2}}});
  ASSERT_EQ(along.tangencies.size(), 1u);
  EXPECT_EQ(along.tangencies[0].s, 0.5);
  EXPECT_EQ(along.tangencies[0].t, 0.375);
  EXPECT_EQ(along.tangencies[0].order, 3);
  EXPECT_EQ(across.tangencies[0].sign, 0);
  EXPECT_EQ(along.tangencies[0].sign, 1);  // the curve comes from the left of the line
}

TEST(IntersectTest, TouchingAStraightCurveWithAnUnevenParameter) {
  // The line x = -1 is run through twice; the parabola touches it at (-1, 1.25), where the line's
  // parameters are irrational: 8 t - 8 t^2 = 1.25.
  const Points parabola{{{-3, -2}}, {{1, 4}}, {{-3, -1}}}, line{{{-1, 0}}, {{-1, 4}}, {{-1, 0}}};
  for (const bool exchange : {false, true}) {
    const auto found = exchange ? intersect(line, parabola) : intersect(parabola, line);
    ASSERT_EQ(found.tangencies.size(), 2u);
    EXPECT_TRUE(found.crossings.empty() && found.overlaps.empty() && found.unresolved.empty());
    double sum = 0;
    for (const auto& c : found.tangencies) {
      EXPECT_EQ(c.order, 2);
      EXPECT_EQ(exchange ? c.t : c.s, 0.5);
      const double t = exchange ? c.s : c.t;
      EXPECT_NEAR(8 * t * (1 - t), 1.25, 1e-14);
      sum += t;
    }
    EXPECT_NEAR(sum, 1.0, 1e-15);
  }
}

TEST(IntersectTest, CurvesOnOneLine) {
  // s^2 (2, 1) has the line's points at other parameters; the last curve turns back at 3/4.
  const Points line{{{0, 0}}, {{2, 1}}}, slow{{{0, 0}}, {{0, 0}}, {{2, 1}}};
  const auto whole = intersect(line, slow);
  ASSERT_EQ(whole.overlaps.size(), 1u);
  EXPECT_TRUE(whole.crossings.empty() && whole.tangencies.empty() && whole.unresolved.empty());
  EXPECT_EQ(whole.overlaps[0].s0, 0.0);
  EXPECT_EQ(whole.overlaps[0].s1, 1.0);
  EXPECT_EQ(whole.overlaps[0].t0, 0.0);
  EXPECT_EQ(whole.overlaps[0].t1, 1.0);
  const Points turning{{{0, 0}}, {{6, 3}}, {{4, 2}}};  // 12 s - 8 s^2 in x
  const auto twice = intersect(Points{{{4.25, 2.125}}, {{8, 4}}}, turning);
  ASSERT_EQ(twice.overlaps.size(), 2u);
  for (const auto& o : twice.overlaps) {
    EXPECT_EQ(std::min(o.s0, o.s1), 0.0);
    EXPECT_NEAR(o.s1, 1.0 / 15, 1e-16);  // x = 4.5
    EXPECT_EQ(o.t1, 0.75);
    EXPECT_NEAR(std::fabs(o.t0 - 0.75), std::sqrt(0.25 / 8), 1e-15);
  }
  const auto touching = intersect(line, Points{{{2, 1}}, {{3, 1.5}}, {{5, 2.5}}});
  ASSERT_EQ(touching.crossings.size(), 1u);
  EXPECT_EQ(touching.crossings[0].s, 1.0);
  EXPECT_EQ(touching.crossings[0].t, 0.0);
  EXPECT_TRUE(touching.overlaps.empty() && touching.unresolved.empty());
}

}  // namespace
