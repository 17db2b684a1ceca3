#include "bezel/mesh/delaunay.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"

namespace bezel {
namespace {

double area(const std::vector<Vec2>& p, const std::array<int, 3>& t) {
  const auto at = [&](int i) {
    return p[static_cast<std::size_t>(t[static_cast<std::size_t>(i)])];
  };
  return 0.5 * cross(at(1) - at(0), at(2) - at(0));
}

std::vector<Vec2> random_points(int n, std::uint64_t seed) {
  RandomStream random("delaunay_test", seed);
  std::vector<Vec2> points;
  for (int i = 0; i < n; ++i) {
    const double x = random.uniform();
    points.push_back(Vec2{{x, random.uniform()}});
  }
  return points;
}

std::string message_of(const std::vector<Vec2>& points) {
  try {
    delaunay(points);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Delaunay, OneTriangleComesOutCounterClockwise) {
  const std::vector<Vec2> points{Vec2{{0.1, 0.1}}, Vec2{{0.2, 1.3}}, Vec2{{1.7, 0.4}}};
  const auto triangles = delaunay(points);
  ASSERT_EQ(triangles.size(), 1u);
  EXPECT_GT(area(points, triangles[0]), 0);
}

TEST(Delaunay, NoPointLiesInsideACircumcircle) {
  for (const int n : {4, 5, 10, 60}) {
    const auto p = random_points(n, static_cast<std::uint64_t>(n));
    const auto triangles = delaunay(p);
    for (const auto& t : triangles) {
      ASSERT_GT(area(p, t), 0);
      const Vec2 &a = p[static_cast<std::size_t>(t[0])], &b = p[static_cast<std::size_t>(t[1])],
                 &c = p[static_cast<std::size_t>(t[2])];
      for (const Vec2& q : p) {
        const Vec2 x = a - q, y = b - q, z = c - q;
        const double in_circle =
            dot(x, x) * cross(y, z) + dot(y, y) * cross(z, x) + dot(z, z) * cross(x, y);
        EXPECT_LT(in_circle, 1e-13);
      }
    }
  }
}

TEST(Delaunay, GridsAreCoveredOnceDespiteCocircularPoints) {
  for (const double h : {1.0, 0.1, 1.0 / 3})
    for (const int m : {1, 2, 9, 30}) {
      std::vector<Vec2> p;
      for (int j = 0; j <= m; ++j)
        for (int i = 0; i <= m; ++i) p.push_back(Vec2{{0.1 + h * i, 7.7 + h * j}});
      const auto triangles = delaunay(p);
      EXPECT_EQ(triangles.size(), static_cast<std::size_t>(2 * m * m));
      double sum = 0;
      for (const auto& t : triangles) {
        EXPECT_NEAR(area(p, t), 0.5 * h * h, 1e-13);
        sum += area(p, t);
      }
      EXPECT_NEAR(sum, m * h * m * h, 1e-11);
    }
}

TEST(Delaunay, ScaleAndOffsetDoNotMatter) {
  const auto p = random_points(200, 1);
  const auto expected = delaunay(p);
  for (const double scale : {0x1p-500, 0x1p-30, 0x1p40, 0x1p600}) {
    auto q = p;
    for (Vec2& x : q) x *= scale;
    std::set<std::array<int, 3>> found;
    for (const auto& t : delaunay(q)) found.insert(t);
    EXPECT_EQ(found, (std::set<std::array<int, 3>>(expected.begin(), expected.end()))) << scale;
  }
  auto moved = p;
  for (Vec2& x : moved) x += Vec2{{1e6, -1e6}};
  double sum = 0;
  for (const auto& t : delaunay(moved)) sum += area(moved, t);
  double hull = 0;
  for (const auto& t : expected) hull += area(p, t);
  EXPECT_NEAR(sum, hull, 1e-9);
}

TEST(Delaunay, RepeatedPointsAreInNoTriangle) {
  auto p = random_points(30, 2);
  p.push_back(p[3]);
  const auto triangles = delaunay(p);
  int uses = 0;
  for (const auto& t : triangles)
    for (const int v : t)
      if (v == 3 || v == 30) uses |= v == 3 ? 1 : 2;
  EXPECT_TRUE(uses == 1 || uses == 2);
}

TEST(Delaunay, IsReproducible) {
  const auto p = random_points(500, 3);
  EXPECT_EQ(delaunay(p), delaunay(p));
}

TEST(DelaunayBadInput, Messages) {
  EXPECT_EQ(message_of({}), "found 0 points, expected at least 3");
  EXPECT_EQ(message_of({Vec2{{0, 0}}, Vec2{{1, 0}}}), "found 2 points, expected at least 3");
  EXPECT_EQ(message_of({Vec2{{0, 0}}, Vec2{{1, std::nan("")}}, Vec2{{1, 0}}}),
            "point 1: found y = nan, expected a finite value");
  EXPECT_EQ(message_of({Vec2{{0, 0}}, Vec2{{0.125, 0.375}}, Vec2{{0.25, 0.75}}, Vec2{{0.5, 1.5}}}),
            "found points on one line, expected points that span an area");
  EXPECT_EQ(message_of({Vec2{{1, 2}}, Vec2{{1, 2}}, Vec2{{1, 2}}}),
            "found points on one line, expected points that span an area");
}

}  // namespace
}  // namespace bezel
