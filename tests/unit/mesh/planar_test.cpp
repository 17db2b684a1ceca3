#include "bezel/mesh/planar.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/mesh/generate.hpp"

namespace bezel {
namespace {

using planar::Triangulation;

Triangulation two_triangles() {
  Triangulation t;
  t.points = {Vec2{{0, 0}}, Vec2{{4, 0}}, Vec2{{4, 1}}, Vec2{{1, 1}}};
  t.triangles = {{0, 1, 2}, {0, 2, 3}};
  t.segments = {{0, 1, 0}, {1, 2, 0}, {2, 3, 0}, {3, 0, 0}};
  t.curves = {{"boundary"}};
  return t;
}

TEST(Planar, SmoothFlipsToDelaunay) {
  auto t = two_triangles();
  ASSERT_TRUE(planar::smooth(t, 4, 0));
  // The circle through 0, 1, 3 leaves 2 outside: the diagonal must be 1-3.
  for (const auto& triangle : t.triangles) {
    EXPECT_NE(std::find(triangle.begin(), triangle.end(), 1), triangle.end());
    EXPECT_NE(std::find(triangle.begin(), triangle.end(), 3), triangle.end());
    const auto at = [&](int i) {
      return t.points[static_cast<std::size_t>(triangle[static_cast<std::size_t>(i)])];
    };
    EXPECT_GT(cross(at(1) - at(0), at(2) - at(0)), 0);
  }
}

TEST(Planar, SmoothCentresAnInnerPointAndKeepsTheFixedOnes) {
  Triangulation t;
  for (int i = 0; i < 6; ++i)
    t.points.push_back(Vec2{{std::cos(i * 1.0471975511965976), std::sin(i * 1.0471975511965976)}});
  t.points.push_back(Vec2{{0.4, 0.3}});
  for (int i = 0; i < 6; ++i)
    t.triangles.push_back({6, i, (i + 1) % 6}), t.segments.push_back({i, (i + 1) % 6, 0});
  const auto before = t.points;
  ASSERT_TRUE(planar::smooth(t, 6, 10));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(t.points[i], before[i]);
  EXPECT_LT(norm(t.points[6]), 1e-3);
  EXPECT_EQ(t.triangles.size(), 6u);
}

TEST(Planar, SmoothRefusesWhatIsNoSurfaceWithThatBoundary) {
  const auto good = two_triangles();
  const std::vector<std::function<void(Triangulation&)>> damages{
      [](auto& t) { t.segments.pop_back(); },  // a side without segment
      [](auto& t) {
        t.segments[2] = {3, 2, 0};
      },  // a segment in the wrong direction
      [](auto& t) {
        t.segments.push_back({0, 2, 0});
      },  // a segment inside
      [](auto& t) {
        t.segments[0] = {1, 3, 0};
      },                                        // a segment that is no side
      [](auto& t) { t.triangles.pop_back(); },  // a hole
      [](auto& t) {
        t.triangles[1] = {0, 3, 2};
      },  // a reversed triangle
      [](auto& t) {
        t.triangles.push_back({0, 1, 2});
      },  // a triangle twice
      [](auto& t) {
        t.points.push_back(Vec2{{1, 0.5}});
      },  // a point outside all triangles
  };
  for (std::size_t i = 0; i < damages.size(); ++i) {
    auto t = good;
    damages[i](t);
    EXPECT_FALSE(planar::smooth(t, t.points.size(), 1)) << "damage " << i;
  }
}

TEST(Planar, CurveRefusesAnElementWithTwoSidesOnACircle) {
  // A square of chords: the corner between two arcs of one circle is flat, its determinant zero.
  Triangulation t;
  t.points = {Vec2{{1, 0}}, Vec2{{0, 1}}, Vec2{{-1, 0}}, Vec2{{0, -1}}};
  t.triangles = {{0, 1, 2}, {0, 2, 3}};
  t.segments = {{0, 1, 0}, {1, 2, 0}, {2, 3, 0}, {3, 0, 0}};
  t.curves = {{"boundary", Vec2{}, 1}};
  RandomStream random("planar_test", 1);
  EXPECT_FALSE(planar::curve(t, 4, 0, random).has_value());
  EXPECT_FALSE(planar::curve(t, 4, 0.1, random).has_value());
  EXPECT_TRUE(planar::curve(t, 1, 0, random).has_value());
}

// Interpolating a smooth function in reference coordinates reaches order g + 1 only when the inner
// control points follow the curved side; with zero inner displacements it stays at 3 [lenoir1986].
TEST(Planar, CurvedElementsKeepTheIsoparametricOrder) {
  const auto f = [](const Vec2& p) { return std::sin(2 * p[0] + 0.3) * std::cos(1.5 * p[1]); };
  const auto error = [&](int g, double size) {
    GenerateOptions options;
    options.degree = g;
    options.size = size;
    options.pattern = Pattern::structured;
    const auto mesh = generate_disc(1, options);
    double worst = 0;
    std::vector<double> values(static_cast<std::size_t>(mesh.nodes_per_element()));
    for (std::size_t e = 0; e < mesh.element_count(); ++e) {
      const auto b = mesh.gather(ElementId(e));
      const auto place = [&](double j, double k) {
        return bernstein::evaluate<Vec2>(g, b, {1 - j - k, j, k});
      };
      for (int n = 0; n < mesh.nodes_per_element(); ++n) {
        const auto index = bernstein::triangle_multi_index(g, n);
        values[static_cast<std::size_t>(n)] =
            f(place(static_cast<double>(index[1]) / g, static_cast<double>(index[2]) / g));
      }
      const auto c = bernstein::from_lagrange<double>(g, values);
      for (int j = 0; j <= 7; ++j)
        for (int k = 0; k <= 7 - j; ++k) {
          const double v = j / 7.0, w = k / 7.0;
          worst = std::max(worst, std::abs(bernstein::evaluate<double>(g, c, {1 - v - w, v, w}) -
                                           f(place(v, w))));
        }
    }
    return worst;
  };
  for (const int g : {1, 2, 3, 4, 5, 6}) {
    const double order = std::log2(error(g, 0.125) / error(g, 0.0625));
    EXPECT_GT(order, g + 1 - 0.3) << "degree " << g;
  }
}

}  // namespace
}  // namespace bezel
