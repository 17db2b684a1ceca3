#include "bezel/mesh/predicates.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace bezel {
namespace {

TEST(Predicates, Orientation) {
  const Vec2 a{{0, 0}}, b{{1, 0}}, c{{0, 1}};
  EXPECT_EQ(orientation(a, b, c), 1);
  EXPECT_EQ(orientation(a, c, b), -1);
  EXPECT_EQ(orientation(a, b, Vec2{{7, 0}}), 0);
  EXPECT_EQ(orientation(a, a, c), 0);
  // 0.1 + 0.2 is not 0.3: three points of the diagonal, one an ulp off.
  EXPECT_EQ(orientation(Vec2{{0.1, 0.1}}, Vec2{{0.7, 0.7}}, Vec2{{0.3, 0.3}}), 0);
  EXPECT_EQ(orientation(Vec2{{0.1, 0.1}}, Vec2{{0.7, 0.7}}, Vec2{{0.3, 0.1 + 0.2}}), 1);
  EXPECT_EQ(orientation(Vec2{{0.1, 0.1}}, Vec2{{0.7, 0.7}}, Vec2{{0.1 + 0.2, 0.3}}), -1);
}

TEST(Predicates, InCircle) {
  const Vec2 a{{1, 0}}, b{{0, 1}}, c{{-1, 0}};
  EXPECT_EQ(in_circle(a, b, c, Vec2{{0, 0}}), 1);
  EXPECT_EQ(in_circle(a, b, c, Vec2{{0, -1}}), 0);
  EXPECT_EQ(in_circle(a, b, c, Vec2{{0, std::nextafter(-1.0, 0)}}), 1);
  EXPECT_EQ(in_circle(a, b, c, Vec2{{0, std::nextafter(-1.0, -2)}}), -1);
  EXPECT_EQ(in_circle(b, a, c, Vec2{{0, 0}}), -1);
  EXPECT_EQ(in_circle(a, b, c, Vec2{{0x1p-60, -1}}), -1);
}

}  // namespace
}  // namespace bezel
