#include "bezel/geometry/curve_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "support/message_of.hpp"

namespace {

using bezel::Curve;
using bezel::SpeedStatus;
using bezel::Vec2;
using bezel::WindingStatus;
using bezel::test::message_of;
using Points = std::vector<Vec2>;

constexpr double u = 0x1p-53;

const Points parabola{{{0, 0}}, {{1, 2}}, {{2, 0}}};  // y = 2 x - x^2, x = 2 s
const Points cusp{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}};

TEST(CurveShapeTest, HodographAndParts) {
  EXPECT_EQ(bezel::hodograph(parabola), (Points{{{2, 4}}, {{2, -4}}}));
  EXPECT_EQ(bezel::hodograph(Points{{{3, 4}}}), (Points{{{0, 0}}}));
  EXPECT_EQ(bezel::specialize(parabola, 0.0, 0.5), (Points{{{0, 0}}, {{0.5, 1}}, {{1, 1}}}));
  EXPECT_EQ(bezel::specialize(parabola, 1.0, 0.0), (Points{{{2, 0}}, {{1, 2}}, {{0, 0}}}));
  const auto [left, right] = bezel::split(parabola, 0.5);
  EXPECT_EQ(left, (Points{{{0, 0}}, {{0.5, 1}}, {{1, 1}}}));
  EXPECT_EQ(right, (Points{{{1, 1}}, {{1.5, 1}}, {{2, 0}}}));
}

TEST(CurveShapeTest, DegreesAndNodes) {
  const Points line{{{0, 0}}, {{2, 4}}};
  EXPECT_EQ(bezel::elevate(line), (Points{{{0, 0}}, {{1, 2}}, {{2, 4}}}));
  const auto back = bezel::reduce(bezel::elevate(parabola, 3), 3);
  ASSERT_EQ(back.control.size(), 3u);
  const double rounding = 16 * 6 * 3 * u * 2;  // of the contract: degree 5, by 3, largest 2
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(back.control[i].x(), parabola[i].x(), rounding);
    EXPECT_NEAR(back.control[i].y(), parabola[i].y(), rounding);
  }
  EXPECT_LE(back.error_bound, rounding);
  EXPECT_EQ(bezel::reduce(parabola, 0).error_bound, 0.0);
  // The best line for 2 x - x^2 on [0, 2] is y = 2/3: 2/3 away at the ends, where the control
  // points' differences (2/3, 4/3, 2/3) allow 4/3.
  const auto flat = bezel::reduce(parabola);
  EXPECT_NEAR(flat.control[0].y(), 2.0 / 3, 4 * 3 * u * 2);
  EXPECT_NEAR(flat.error_bound, 4.0 / 3, 1e-14);
  EXPECT_EQ(bezel::to_nodes(parabola), (Points{{{0, 0}}, {{1, 1}}, {{2, 0}}}));
  EXPECT_EQ(bezel::from_nodes(Points{{{0, 0}}, {{1, 1}}, {{2, 0}}}), parabola);
}

TEST(CurveShapeTest, FrameOfRegularPoints) {
  const auto top = bezel::frame(parabola, 0.5);
  EXPECT_EQ(top.status, SpeedStatus::regular);
  EXPECT_EQ(top.tangent, (Vec2{{1, 0}}));
  EXPECT_EQ(top.normal, (Vec2{{0, 1}}));
  EXPECT_EQ(top.tangent_before, top.tangent);
  EXPECT_EQ(top.order, 1);
  const auto start = bezel::frame(parabola, 0.0);
  EXPECT_NEAR(start.tangent.x(), 1 / std::sqrt(5.0), 6 * u);
  EXPECT_NEAR(start.tangent.y(), 2 / std::sqrt(5.0), 6 * u);
  // Extended: slope 2 - 2 x at x = 4.
  const auto beyond = bezel::frame(parabola, 2.0);
  EXPECT_NEAR(beyond.tangent.y(), -6 / std::sqrt(37.0), 6 * u);
}

TEST(CurveShapeTest, FrameWhereTheSpeedVanishes) {
  // b'(1/2) = 0 and b''(1/2) = (0, -6).
  const auto at_cusp = bezel::frame(cusp, 0.5);
  EXPECT_EQ(at_cusp.status, SpeedStatus::singular);
  EXPECT_EQ(at_cusp.order, 2);
  EXPECT_EQ(at_cusp.tangent, (Vec2{{0, -1}}));
  EXPECT_EQ(at_cusp.normal, (Vec2{{1, 0}}));
  EXPECT_EQ(at_cusp.tangent_before, (Vec2{{0, 1}}));
  // A little beside it the speed is small, not zero.
  const auto beside = bezel::frame(cusp, 0.5 + 0x1p-52);
  EXPECT_EQ(beside.status, SpeedStatus::regular);
  EXPECT_LT(beside.tangent.y(), -0.999);
  // (s^3, 0): third derivative, the direction does not turn.
  const auto slow = bezel::frame(Points{{{0, 0}}, {{0, 0}}, {{0, 0}}, {{1, 0}}}, 0.0);
  EXPECT_EQ(slow.status, SpeedStatus::singular);
  EXPECT_EQ(slow.order, 3);
  EXPECT_EQ(slow.tangent_before, (Vec2{{1, 0}}));
  for (const Points& c : {Points{{{1, 2}}}, Points(4, Vec2{{1, 2}})}) {
    const auto none = bezel::frame(c, 0.25);
    EXPECT_EQ(none.status, SpeedStatus::point);
    EXPECT_EQ(none.tangent, (Vec2{{0, 0}}));
    EXPECT_EQ(none.order, 0);
  }
}

TEST(CurveShapeTest, Curvature) {
  // y'' / (1 + y'^2)^(3/2) with y'' = -2.
  EXPECT_EQ(bezel::curvature(parabola, 0.5).value, -2.0);
  EXPECT_NEAR(bezel::curvature(parabola, 0.0).value, -2 / std::pow(5.0, 1.5), 16 * u);
  EXPECT_NEAR(bezel::curvature(parabola, 2.0).value, -2 / std::pow(37.0, 1.5), 16 * u);
  const Points line{{{0, 0}}, {{1, 1}}, {{3, 3}}};
  EXPECT_EQ(bezel::curvature(line, 0.3).status, SpeedStatus::regular);
  EXPECT_EQ(bezel::curvature(line, 0.3).value, 0.0);
  EXPECT_EQ(bezel::curvature(cusp, 0.5).status, SpeedStatus::singular);
  EXPECT_TRUE(std::isnan(bezel::curvature(cusp, 0.5).value));
  EXPECT_EQ(bezel::curvature(Points(3, Vec2{{1, 1}}), 0.5).status, SpeedStatus::point);
  // A parabola bent by 2^-60, with ends far away: y'' = 2^-59 at slope 2^-10 or so; exact answer
  // from the closed form of (2 s, 2^-10 s + 2^-60 s^2): cross = 2^-58, |b'|^2 = 4 + (2^-10 +
  // ...)^2.
  const Points bent{{{0, 0}}, {{1, 0x1p-11}}, {{2, 0x1p-10 + 0x1p-60}}};
  const double y1 = 0x1p-10 + 0x1p-60;  // at s = 1/2
  EXPECT_NEAR(bezel::curvature(bent, 0.5).value * std::pow(4 + y1 * y1, 1.5) * 0x1p58, 1.0, 20 * u);
}

TEST(CurveShapeTest, CurvatureAtExtremeScales) {
  for (const int k : {-400, -300, 300, 1000}) {
    Points scaled = parabola;
    for (Vec2& c : scaled) c *= std::ldexp(1.0, k);
    EXPECT_EQ(bezel::curvature(scaled, 0.5).value, -std::ldexp(2.0, -k)) << k;
    EXPECT_EQ(bezel::frame(scaled, 0.25).tangent, bezel::frame(parabola, 0.25).tangent) << k;
  }
  const double largest = std::numeric_limits<double>::max();
  const Points huge{{{-largest, -largest}}, {{largest, largest}}};
  EXPECT_NEAR(bezel::frame(huge, 0.5).tangent.x(), std::sqrt(0.5), 6 * u);
  EXPECT_EQ(bezel::curvature(huge, 0.5).value, 0.0);
}

TEST(CurveShapeTest, TightBox) {
  const auto box = bezel::tight_box(parabola);
  EXPECT_EQ(box.lo, (Vec2{{0, 0}}));
  EXPECT_EQ(box.hi, (Vec2{{2, 1}}));  // exact: the extremum is at s = 1/2
  // y = 3 s (1-s)^2: 4/9 at s = 1/3, neither a double: the next double above 4/9.
  const auto bump = bezel::tight_box(Points{{{0, 0}}, {{0, 1}}, {{0, 0}}, {{1, 0}}});
  EXPECT_EQ(bump.lo, (Vec2{{0, 0}}));
  EXPECT_GE(bump.hi.y(), 4.0 / 9);
  EXPECT_LE(bump.hi.y(), std::nextafter(4.0 / 9, 1.0));
  EXPECT_GT(std::fma(9.0, bump.hi.y(), -4.0), 0.0);
  const auto point = bezel::tight_box(Points{{{3, 4}}});
  EXPECT_EQ(point.lo, point.hi);
  const double largest = std::numeric_limits<double>::max();
  const auto huge = bezel::tight_box(Points{{{-largest, 0}}, {{largest, 0}}, {{-largest, 0}}});
  EXPECT_EQ(huge.hi, (Vec2{{0, 0}}));  // -M (1-s)^2 + 2 M s (1-s) - M s^2 = -M (1 - 2 s)^2
}

std::vector<Curve> square(double side) {
  const Points p{{{0, 0}}, {{side, 0}}, {{side, side}}, {{0, side}}};
  std::vector<Curve> chain;
  for (std::size_t i = 0; i < 4; ++i) chain.emplace_back(Points{p[i], p[(i + 1) % 4]});
  return chain;
}

TEST(CurveShapeTest, WindingNumberOfASquare) {
  auto chain = square(3);
  const auto at = [&](double x, double y) { return bezel::winding_number(chain, Vec2{{x, y}}); };
  EXPECT_EQ(at(1, 1).value, 1);
  EXPECT_EQ(at(1, 1).status, WindingStatus::proven);
  EXPECT_EQ(at(0x1p-60, 0x1p-1000).value, 1);
  EXPECT_EQ(at(-0x1p-60, 1).value, 0);
  EXPECT_EQ(at(4, 3).value, 0);  // at the height of the upper side
  EXPECT_EQ(at(-1, 3).value, 0);
  EXPECT_EQ(at(-1, 0).value, 0);  // both lower corners on the ray
  EXPECT_EQ(at(-1, 0).status, WindingStatus::proven);
  EXPECT_EQ(at(1, 0).status, WindingStatus::on_curve);  // s = 1/3 is not a double
  EXPECT_EQ(at(1, 0).curve, 0u);
  EXPECT_EQ(at(3, 1).curve, 1u);
  EXPECT_EQ(at(3, 3).status, WindingStatus::on_curve);
}

TEST(CurveShapeTest, WindingNumberOfOneClosedCurve) {
  // Twice round with a smaller inner loop: limacon-like, symmetric about the x axis.
  const Points drop{{{0, 0}}, {{4, 4}}, {{4, -4}}, {{0, 0}}};  // clockwise
  const std::vector<Curve> chain{Curve(drop)};
  EXPECT_EQ(bezel::winding_number(chain, Vec2{{1, 0}}).value, -1);
  EXPECT_EQ(bezel::winding_number(chain, Vec2{{-1, 0}}).value, 0);
  // x(1/2) = 3, y(1/2) = 0.
  EXPECT_EQ(bezel::winding_number(chain, Vec2{{3, 0}}).status, WindingStatus::on_curve);
  EXPECT_EQ(bezel::winding_number(chain, Vec2{{std::nextafter(3.0, 0.0), 0}}).value, -1);
  EXPECT_EQ(bezel::winding_number(chain, Vec2{{std::nextafter(3.0, 4.0), 0}}).value, 0);
  const std::vector<Curve> twice{Curve(drop), Curve(drop)};
  EXPECT_EQ(bezel::winding_number(twice, Vec2{{1, 0}}).value, -2);
  const std::vector<Curve> point{Curve(Points{{{1, 2}}})};
  EXPECT_EQ(bezel::winding_number(point, Vec2{{1, 2}}).status, WindingStatus::on_curve);
  EXPECT_EQ(bezel::winding_number(point, Vec2{{0, 2}}).value, 0);
}

TEST(CurveShapeTest, AreaAndCentroid) {
  const auto chain = square(3);
  const auto found = bezel::area_and_centroid(chain);
  EXPECT_NEAR(found.area, 9.0, found.error_bound);
  EXPECT_LE(found.error_bound, 4 * 80 * u * 9);
  ASSERT_TRUE(found.has_centroid);
  EXPECT_NEAR(found.centroid.x(), 1.5, 1e-14);
  EXPECT_NEAR(found.centroid.y(), 1.5, 1e-14);
  // Under the parabola: area 4/3, centroid (1, 2/5); the chain runs clockwise.
  const std::vector<Curve> cap{Curve(parabola), Curve(Points{{{2, 0}}, {{0, 0}}})};
  const auto under = bezel::area_and_centroid(cap);
  EXPECT_NEAR(under.area, -4.0 / 3, under.error_bound);
  EXPECT_NEAR(under.centroid.x(), 1.0, 1e-14);
  EXPECT_NEAR(under.centroid.y(), 0.4, 1e-14);
  // There and back again.
  const std::vector<Curve> flat{Curve(Points{{{0, 0}}, {{1, 1}}}),
                                Curve(Points{{{1, 1}}, {{0, 0}}})};
  EXPECT_FALSE(bezel::area_and_centroid(flat).has_centroid);
  EXPECT_EQ(bezel::area_and_centroid(flat).centroid, (Vec2{{0, 0}}));
}

TEST(CurveShapeTest, BadInput) {
  const Points none, bad{{{0, 0}}, {{NAN, 0}}}, long_one(62);
  EXPECT_EQ(message_of([&] { bezel::hodograph(none); }),
            "the curve has no control points, expected 1 to 61");
  EXPECT_EQ(message_of([&] { bezel::frame(long_one, 0.5); }),
            "the curve has 62 control points, expected 1 to 61");
  EXPECT_EQ(message_of([&] { bezel::tight_box(bad); }),
            "control point 1 of the curve is not finite");
  EXPECT_EQ(message_of([&] { bezel::curvature(parabola, INFINITY); }),
            "the parameter is not finite");
  EXPECT_EQ(message_of([&] { bezel::specialize(parabola, 0, NAN); }),
            "the parameter is not finite");
  EXPECT_EQ(message_of([&] { bezel::split(parabola, 1.5); }),
            "split at 1.500000, expected a parameter from 0 to 1");
  EXPECT_EQ(message_of([&] { bezel::elevate(parabola, 59); }),
            "degree 61 on the interval, expected 0 to 60");
  EXPECT_EQ(message_of([&] { bezel::reduce(parabola, 3); }),
            "reduction by 3 of degree 2, expected 0 to 2");
  EXPECT_EQ(message_of([&] { bezel::winding_number({}, Vec2{}); }),
            "the chain has no curves, expected at least one");
  const std::vector<Curve> open{Curve(parabola), Curve(Points{{{2, 0}}, {{0, 1}}})};
  EXPECT_EQ(message_of([&] { bezel::area_and_centroid(open); }),
            "curve 1 of the chain ends at (0.000000, 1.000000) and curve 0 begins at (0.000000, "
            "0.000000), expected the same point");
  EXPECT_EQ(message_of([&] {
              bezel::winding_number(square(1), Vec2{{NAN, 0}});
            }),
            "the point is not finite");
}

}  // namespace
