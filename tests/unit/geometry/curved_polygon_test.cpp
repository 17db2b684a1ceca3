#include "bezel/geometry/curved_polygon.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "support/message_of.hpp"

namespace {

using bezel::CurvedPolygon;
using bezel::PointInPolygon;
using bezel::Vec2;
using bezel::test::message_of;

/// Under the parabola y = 4 x (1 - x), over [0, 1].
CurvedPolygon segment(double x = 0.0, double y = 0.0) {
  const Vec2 p{{x, y}}, q{{x + 1, y}};
  return CurvedPolygon({{p, {}}, {q, {}}}, {{0, 0, 0.0, 1.0, 0}, {0, 1, 0.0, 1.0, 1}},
                       {p, q, q, Vec2{{x + 0.5, y + 2}}, p}, {0, 2, 5});
}

TEST(CurvedPolygonTest, Measures) {
  const CurvedPolygon p = segment();
  EXPECT_NEAR(area(p), 2.0 / 3, 1e-15);
  EXPECT_NEAR(centroid(p).x(), 0.5, 1e-15);
  EXPECT_NEAR(centroid(p).y(), 0.4, 1e-15);
  EXPECT_NEAR(moment(p, 0, 0), 2.0 / 3, 1e-15);
  EXPECT_NEAR(moment(p, 1, 0), 1.0 / 3, 1e-15);
  // Integrals of x^a y^b over 0 <= y <= 4 x (1 - x): 4^(b+1) (a+b+1)! (b+1)! / ((b+1) (a+2b+3)!).
  EXPECT_NEAR(moment(p, 0, 1), 4.0 / 15, 1e-15);
  EXPECT_NEAR(moment(p, 2, 3), 32.0 / 1155, 1e-15);
  const CurvedPolygon far = segment(0x1p20, -0x1p20);
  EXPECT_NEAR(area(far), 2.0 / 3, 1e-9);
  EXPECT_NEAR(centroid(far).x(), 0x1p20 + 0.5, 1e-9);
}

TEST(CurvedPolygonTest, Contains) {
  const CurvedPolygon p = segment();
  EXPECT_EQ(contains(p, {{0.5, 0.5}}), PointInPolygon::inside);
  EXPECT_EQ(contains(p, {{0.5, 1.0}}), PointInPolygon::boundary);
  EXPECT_EQ(contains(p, {{0.5, 1.0 - 0x1p-53}}), PointInPolygon::inside);
  EXPECT_EQ(contains(p, {{0.5, 1.0 + 0x1p-52}}), PointInPolygon::outside);
  EXPECT_EQ(contains(p, {{0.3, 0.0}}), PointInPolygon::boundary);
  EXPECT_EQ(contains(p, {{0.3, -0x1p-1074}}), PointInPolygon::outside);
  EXPECT_EQ(contains(p, {{0.0, 0.0}}), PointInPolygon::boundary);
  EXPECT_EQ(contains(p, {{2.0, 0.0}}), PointInPolygon::outside);
}

TEST(CurvedPolygonTest, BadInput) {
  const Vec2 p{{0, 0}}, q{{1, 0}};
  EXPECT_EQ(message_of([&] {
              CurvedPolygon({{p, {}}, {q, {}}}, {{0, 0, 0, 1, 0}, {0, 1, 0, 1, 1}}, {p, q, p, p},
                            {0, 2, 4});
            }),
            "curved polygon: edge 1 does not begin and end at its joints");
  EXPECT_EQ(message_of([&] {
              CurvedPolygon({{p, {}}}, {{0, 0, 0, 1, 1}}, {p, q, p}, {0, 3});
            }),
            "curved polygon: edge 0 begins at joint 1, there are 1");
  EXPECT_EQ(message_of([&] {
              CurvedPolygon({{p, {}}}, {{0, 0, 0, 1, 0}}, {p, q, p}, {0, 2});
            }),
            "curved polygon: the edges' control points do not fill the 3 given");
  EXPECT_EQ(message_of([&] { (void)area(CurvedPolygon()); }),
            "the curved polygon has no edges, expected at least one");
  EXPECT_EQ(message_of([&] { (void)moment(segment(), -1, 0); }),
            "the moment's exponents are -1 and 0, expected a, b >= 0 and (a + b + 2) times the "
            "degree 2 at most 400");
  EXPECT_EQ(message_of([&] {
              (void)contains(segment(), {{std::numeric_limits<double>::infinity(), 0}});
            }),
            "the point is not finite");
  const CurvedPolygon flat({{p, {}}, {q, {}}}, {{0, 0, 0, 1, 0}, {0, 1, 0, 1, 1}}, {p, q, q, p},
                           {0, 2, 4});
  EXPECT_EQ(message_of([&] { (void)centroid(flat); }),
            "the curved polygon's area is zero to rounding, it has no centroid");
}

}  // namespace
