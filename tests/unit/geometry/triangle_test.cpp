#include "bezel/geometry/triangle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "support/message_of.hpp"

namespace {

using bezel::check_validity;
using bezel::Lambda;
using bezel::Location;
using bezel::Validity;
using bezel::Vec2;
using bezel::test::message_of;
using Points = std::vector<Vec2>;

const Points unit{{{0, 0}}, {{1, 0}}, {{0, 1}}};
/// b(s, t) = [(1-s-t)^2 + s^2, s^2 + t^2], folded over itself [hermes2018, fig. 2.2].
const Points inverted{{{1, 0}}, {{0, 0}}, {{1, 1}}, {{0, 0}}, {{0, 0}}, {{0, 1}}};
/// Valid, with curved sides.
const Points curved{{{0, 0}}, {{0.5, -0.1}}, {{1, 0}}, {{0.1, 0.5}}, {{0.6, 0.6}}, {{0, 1}}};

TEST(JacobianTest, OfAStraightTriangleIsTwiceItsArea) {
  const Points t{{{0, 0}}, {{2, 0}}, {{0, 3}}};
  EXPECT_EQ(bezel::jacobian_determinant(1, t), std::vector<double>{6.0});
}

TEST(JacobianTest, OfTheFoldedTriangle) {
  // det = 4 (s^2 - s t - t^2 - s + t) up to sign [hermes2018, sec. 2.2]; value at a few places.
  const auto det = bezel::jacobian_determinant(2, inverted);
  const auto at = [&](double s, double t) {
    const double l = 1 - s - t;
    return l * l * det[0] + 2 * l * s * det[1] + s * s * det[2] + 2 * l * t * det[3] +
           2 * s * t * det[4] + t * t * det[5];
  };
  for (const double s : {0.0, 0.25, 0.5})
    for (const double t : {0.0, 0.125, 0.5}) {
      const double xs = -2 * (1 - s - t) + 2 * s, xt = -2 * (1 - s - t), ys = 2 * s, yt = 2 * t;
      EXPECT_NEAR(at(s, t), xs * yt - xt * ys, 1e-15);
    }
}

TEST(ValidityTest, StraightTrianglesBySign) {
  EXPECT_EQ(check_validity(1, unit).status, Validity::valid);
  EXPECT_EQ(check_validity(1, Points{{{0, 0}}, {{0, 1}}, {{1, 0}}}).status, Validity::inverted);
  EXPECT_EQ(check_validity(1, Points{{{0, 0}}, {{1, 1}}, {{2, 2}}}).status, Validity::inverted);
}

TEST(ValidityTest, CurvedAndFolded) {
  const auto good = check_validity(2, curved);
  EXPECT_EQ(good.status, Validity::valid);
  EXPECT_GT(good.det, 0);
  const auto bad = check_validity(2, inverted);
  EXPECT_EQ(bad.status, Validity::inverted);
  EXPECT_LT(bad.det, 0);
}

TEST(LocateTest, InsideOutsideAndOnTheBoundary) {
  const auto middle = bezel::locate(2, curved, Vec2{{0.3, 0.3}});
  EXPECT_EQ(middle.status, Location::inside);
  EXPECT_LT(middle.residual, 1e-15);
  EXPECT_EQ(bezel::locate(2, curved, Vec2{{2, 2}}).status, Location::outside);
  EXPECT_EQ(bezel::locate(2, curved, Vec2{{0.5, -0.06}}).status,
            Location::outside);  // in the hull only
  EXPECT_EQ(bezel::locate(2, curved, Vec2{{0.5, -0.05}}).status, Location::inside);  // on side 0
  const auto corner = bezel::locate(2, curved, Vec2{{1, 0}});
  EXPECT_EQ(corner.status, Location::inside);
  EXPECT_NEAR(corner.lambda[1], 1.0, 1e-14);
}

TEST(InvertTest, AlsoOutside) {
  const auto found = bezel::invert(1, unit, Vec2{{2, -0.5}}, Lambda{1.0 / 3, 1.0 / 3, 1.0 / 3});
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.lambda[1], 2.0);
  EXPECT_EQ(found.lambda[2], -0.5);
}

TEST(AreaTest, StraightCurvedAndFarAway) {
  EXPECT_EQ(bezel::area(1, unit), 0.5);
  // 1/2 + parabola segments: 2/3 chord * height, outwards on sides 0 and 1, inwards on side 2.
  // Heights: side 0: 0.05 out; side 1: |(0.1, 0.1)| / 2 out on chord sqrt(2); side 2: 0.05 in.
  EXPECT_NEAR(bezel::area(2, curved), 0.5 + 2.0 / 3 * 0.05 + 2.0 / 3 * 0.1 - 2.0 / 3 * 0.05, 1e-15);
  Points far = unit;
  for (Vec2& p : far) p += Vec2{{0x1p30, -0x1p30}};
  EXPECT_EQ(bezel::area(1, far), 0.5);
}

TEST(MomentTest, OfTheUnitTriangle) {
  // integral x^a y^b = a! b! / (a+b+2)!
  EXPECT_NEAR(bezel::moment(1, unit, 0, 0), 0.5, 1e-15);
  EXPECT_NEAR(bezel::moment(1, unit, 1, 0), 1.0 / 6, 1e-16);
  EXPECT_NEAR(bezel::moment(1, unit, 3, 2), 6.0 * 2 / 5040, 1e-17);
  EXPECT_NEAR(bezel::moment(2, curved, 0, 0), bezel::area(2, curved), 1e-15);
}

TEST(TriangleTest, BadInput) {
  EXPECT_EQ(message_of([] { bezel::area(0, unit); }),
            "the triangle's degree is 0, expected 1 to 40");
  EXPECT_EQ(message_of([] { bezel::area(2, unit); }),
            "a triangle of degree 2 has 6 control points, found 3");
  Points broken = unit;
  broken[2] = Vec2{{0, INFINITY}};
  EXPECT_EQ(message_of([&] { static_cast<void>(check_validity(1, broken)); }),
            "control point 2 of the triangle is not finite");
  EXPECT_EQ(message_of([&] {
              static_cast<void>(bezel::locate(1, unit, Vec2{{NAN, 0}}));
            }),
            "the point to locate is not finite");
  EXPECT_EQ(message_of([&] {
              static_cast<void>(bezel::locate(1, unit, Vec2{{0, 0}}, 1.5));
            }),
            "the barycentric tolerance must be in [0, 1)");
  EXPECT_EQ(message_of([&] { bezel::moment(1, unit, 20, 1); }),
            "the moment's exponents are 20 and 1, expected a, b >= 0 and a + b <= 20");
}

}  // namespace
