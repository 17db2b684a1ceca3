// Delaunay triangulations of random and nearly degenerate points.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bezel/base/random.hpp"
#include "bezel/mesh/delaunay.hpp"
#include "bezel/mesh/predicates.hpp"

namespace bezel {
namespace {

/// Area of the convex hull by the monotone chain.
double hull_area(std::vector<Vec2> p) {
  std::sort(p.begin(), p.end(), [](const Vec2& a, const Vec2& b) { return a.c < b.c; });
  double twice = 0;
  for (const double sign : {1.0, -1.0}) {
    std::vector<Vec2> chain;
    for (const Vec2& q : p) {
      while (chain.size() > 1 &&
             sign * cross(chain.back() - chain[chain.size() - 2], q - chain[chain.size() - 2]) <= 0)
        chain.pop_back();
      chain.push_back(q);
    }
    for (std::size_t i = 0; i + 1 < chain.size(); ++i)
      twice += sign * cross(chain[i] - p[0], chain[i + 1] - p[0]);
  }
  return 0.5 * twice;
}

enum class Kind { uniform, grid, circle, line_and_point, clusters };

std::vector<Vec2> points_of(Kind kind, double perturbation, RandomStream& random) {
  std::vector<Vec2> p;
  const auto noise = [&] { return perturbation * random.uniform(-1, 1); };
  const auto n = static_cast<int>(8 + random.below(60));
  for (int i = 0; i < n; ++i) {
    Vec2 q{};
    switch (kind) {
      case Kind::uniform:
        q = Vec2{{random.uniform(), random.uniform()}};
        break;
      case Kind::grid:
        q = Vec2{{0.1 * (i % 8), 0.1 * (i / 8)}};
        break;
      case Kind::circle:
        q = Vec2{{std::cos(0.7 * i), std::sin(0.7 * i)}};
        break;
      case Kind::line_and_point:
        q = i == 0 ? Vec2{{0.2, 0.5}} : Vec2{{0.01 * i, 0.03 * i}};
        break;
      case Kind::clusters:
        q = Vec2{{double(i % 3), double(i % 2)}} +
            1e-6 * Vec2{{random.uniform(), random.uniform()}};
        break;
    }
    const double x = noise();
    p.push_back(q + Vec2{{x, noise()}});
  }
  return p;
}

TEST(DelaunayProperty, CoversTheHullOnceWithEmptyCircles) {
  RandomStream random("CoversTheHullOnceWithEmptyCircles", 1);
  for (const Kind kind :
       {Kind::uniform, Kind::grid, Kind::circle, Kind::line_and_point, Kind::clusters})
    for (const double perturbation : {0.0, 1e-17, 1e-15, 1e-12, 1e-8, 1e-3, 1e-1})
      for (int round = 0; round < 10; ++round) {
        SCOPED_TRACE(testing::Message()
                     << static_cast<int>(kind) << ' ' << perturbation << ' ' << round);
        const auto p = points_of(kind, perturbation, random);
        const auto triangles = delaunay(p);
        double sum = 0;
        std::map<std::pair<int, int>, int> sides;
        for (const auto& t : triangles) {
          const Vec2 &a = p[static_cast<std::size_t>(t[0])], &b = p[static_cast<std::size_t>(t[1])],
                     &c = p[static_cast<std::size_t>(t[2])];
          ASSERT_EQ(orientation(a, b, c), 1);
          sum += 0.5 * cross(b - a, c - a);
          for (std::size_t s = 0; s < 3; ++s) ++sides[{t[s], t[(s + 1) % 3]}];
          for (const Vec2& q : p) ASSERT_LE(in_circle(a, b, c, q), 0);
        }
        for (const auto& side : sides) EXPECT_EQ(side.second, 1);  // no side twice in one direction
        EXPECT_NEAR(sum, hull_area(p), 1e-12);
      }
}

}  // namespace
}  // namespace bezel
