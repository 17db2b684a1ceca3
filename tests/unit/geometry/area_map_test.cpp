#include "bezel/geometry/area_map.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bezel/base/random.hpp"
#include "bezel/geometry/triangle.hpp"
#include "support/exact_integrals.hpp"

namespace bezel {
namespace {

using Points = std::array<Vec2, 3>;

/// A triangle about 1 long and `width` wide, turned and shifted at random, counter-clockwise.
Points thin_triangle(double width, double shift, RandomStream& random) {
  const double angle = random.uniform(-3.2, 3.2), c = std::cos(angle), s = std::sin(angle);
  const Vec2 to{{random.uniform(-shift, shift), random.uniform(-shift, shift)}};
  const auto place = [&](double x, double y) { return Vec2{{c * x - s * y, s * x + c * y}} + to; };
  return {place(0.0, 0.0), place(1.0, width * random.uniform(-0.4, 0.4)),
          place(random.uniform(-0.2, 1.2), width)};
}

double exact_area(const Points& p) {
  return test::exact_integrals(1, p, 0)[0].hi;
}

TEST(AreaMap, ThinTrianglesHaveTheirAreas) {
  RandomStream random("thin triangles", 1);
  for (const double width : {1.0, 0.1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12}) {
    for (const double shift : {0.0, 1.0, 1e3}) {
      for (int i = 0; i < 100; ++i) {
        const Points p = thin_triangle(width, shift, random);
        const double exact = exact_area(p);
        if (exact == 0.0) continue;  // rounded to a line, far out
        EXPECT_LE(std::abs(0.5 * triangle_cross(p[0], p[1], p[2]) - exact), 1e-14 * std::abs(exact))
            << width << " " << shift;
        EXPECT_LE(std::abs(area(1, p) - exact), 1e-14 * std::abs(exact)) << width << " " << shift;
      }
    }
  }
}

TEST(AreaMap, MakesThinTrianglesRoundAndKeepsAreas) {
  RandomStream random("round triangles", 1);
  for (const double width : {1e-2, 1e-4, 1e-6, 1e-9}) {
    for (int i = 0; i < 100; ++i) {
      const Points p = thin_triangle(width, 1.0, random);
      const AreaMap map = round_map(p);
      ASSERT_FALSE(map.identity);
      EXPECT_LE(std::abs(map.slope), 1.0);
      const Vec2 a = map(p[1]) - map(p[0]), b = map(p[2]) - map(p[0]);
      // As many digits as a round triangle's, by plain arithmetic.
      EXPECT_LE(std::abs(0.5 * cross(a, b) - exact_area(p)), 4e-15 * exact_area(p)) << width;
      EXPECT_GT(cross(a, b), 0.1 * (dot(a, a) + dot(b, b))) << width;
    }
  }
}

TEST(AreaMap, GradientsFollow) {
  RandomStream random("gradients", 1);
  const auto product = [](const Vec2& g, const Vec2& from, const Vec2& to) {
    const auto term = [&](int k) {
      return DoubleDouble(g[k]) * (DoubleDouble(to[k]) - DoubleDouble(from[k]));
    };
    return (term(0) + term(1)).hi;
  };
  for (int i = 0; i < 200; ++i) {
    const Points p = thin_triangle(1e-6, 1.0, random);
    const AreaMap map = round_map(p);
    const Vec2 along = p[1] - p[0];
    // Across the triangle 1, plus something along it.
    const Vec2 g =
        Vec2{{-along.y(), along.x()}} * (1e6 / dot(along, along)) + along * random.uniform(-1, 1);
    EXPECT_NEAR(dot(map.gradient(g), map(p[2]) - map(p[0])), product(g, p[0], p[2]), 4e-15);
    EXPECT_NEAR(dot(map.gradient(g), map(p[1]) - map(p[2])), product(g, p[2], p[1]), 4e-15);
  }
}

// (1) step_back(step(d)) == d up to rounding, in double-double to its own.
// (2) dot(gradient(g), step(d)) == dot(g, d).
TEST(AreaMap, StepsGoThereAndBack) {
  using Exact = Vec<2, DoubleDouble>;
  RandomStream random("steps", 1);
  for (int i = 0; i < 200; ++i) {
    const Points p = thin_triangle(1e-6, 1.0, random);
    const AreaMap map = round_map(p);
    ASSERT_FALSE(map.identity);
    const Exact d{{random.uniform(-1, 1), DoubleDouble(random.uniform(-1, 1), 1e-20)}};
    const Exact g{{random.uniform(-1, 1), random.uniform(-1, 1)}};
    const Exact back = map.step_back(map.step(d)) - d;
    EXPECT_LE(std::abs(back.x().hi), 1e-31);
    EXPECT_LE(std::abs(back.y().hi), 1e-31);
    const DoubleDouble off = dot(map.gradient(g), map.step(d)) - dot(g, d);
    EXPECT_LE(std::abs(off.hi), 1e-25);  // of terms of size 1e6
    const Vec2 plain{{d.x().hi, d.y().hi}};
    EXPECT_LE(norm(map.step_back(map.step(plain)) - plain), 4e-16);
    const Vec2 there = map(p[1]) - map(p[0]);
    const Exact exact =
        map.step(Exact{{DoubleDouble(p[1].x()) - p[0].x(), DoubleDouble(p[1].y()) - p[0].y()}});
    EXPECT_LE(norm(there - Vec2{{exact.x().hi, exact.y().hi}}), 4e-16 * norm(there));
  }
  EXPECT_EQ(AreaMap().step(Vec2{{1, 2}}), (Vec2{{1, 2}}));
  EXPECT_EQ(AreaMap().step_back(Vec2{{1, 2}}), (Vec2{{1, 2}}));
  EXPECT_EQ(AreaMap().gradient(Vec2{{1, 2}}), (Vec2{{1, 2}}));
}

TEST(AreaMap, RoundAndDegenerateShapesStay) {
  const Points round = {Vec2{{0, 0}}, Vec2{{1, 0.1}}, Vec2{{0.3, 0.2}}};
  EXPECT_TRUE(round_map(round).identity);
  EXPECT_EQ(round_map(round)(round[2]), round[2]);
  EXPECT_EQ(round_map(round).rounding(1.0), 0.0);
  const Points line = {Vec2{{0, 0}}, Vec2{{0.5, 0.25}}, Vec2{{2, 1}}};
  EXPECT_TRUE(round_map(line).identity);
  const Points point = {Vec2{{3, 4}}, Vec2{{3, 4}}, Vec2{{3, 4}}};
  EXPECT_TRUE(round_map(point).identity);
  EXPECT_EQ(triangle_cross(line[0], line[1], line[2]), 0.0);
  EXPECT_EQ(triangle_cross(point[0], point[1], point[2]), 0.0);
}

TEST(AreaMap, RoundingOfCoordinatesMovesPointsAsMuchAsToldAndNoMore) {
  const Points p = {Vec2{{1, 1}}, Vec2{{2, 1.5}}, Vec2{{1.5, 1.25 + 0x1p-20}}};
  const AreaMap map = round_map(p);
  ASSERT_FALSE(map.identity);
  const Vec2 next{{p[1].x(), std::nextafter(p[1].y(), 9.0)}};
  const double moved = norm(map(next) - map(p[1]));
  EXPECT_LE(moved, 2.0 * map.rounding(2.0));
  EXPECT_GE(moved, 0.2 * map.rounding(2.0));
}

}  // namespace
}  // namespace bezel
