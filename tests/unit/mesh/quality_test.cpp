#include "bezel/mesh/quality.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bezel/mesh/generate.hpp"

namespace bezel {
namespace {

std::vector<NodeId> ids(std::initializer_list<int> values) {
  std::vector<NodeId> out;
  for (const int v : values) out.emplace_back(v);
  return out;
}

TEST(Quality, OfTwoStraightTriangles) {
  // A right isosceles triangle and one with angles atan(1/2), atan(2), 90 degrees.
  const std::vector<Vec2> control{Vec2{{0, 0}}, Vec2{{1, 0}}, Vec2{{0, 1}}, Vec2{{0, -2}}};
  const auto q = mesh_quality(TriangleMesh(1, control, ids({0, 1, 2, 3, 1, 0})));
  const double degrees = 180 / 3.141592653589793;
  EXPECT_NEAR(q.min_angle, std::atan(0.5) * degrees, 1e-13);
  EXPECT_EQ(q.min_angle_element, ElementId(1));
  EXPECT_NEAR(q.max_angle, 90, 1e-13);
  EXPECT_DOUBLE_EQ(q.min_edge, 1);
  EXPECT_DOUBLE_EQ(q.max_edge, std::sqrt(5.0));
  EXPECT_DOUBLE_EQ(q.mean_edge, (1 + 1 + std::sqrt(2.0) + 2 + std::sqrt(5.0)) / 5);
  EXPECT_DOUBLE_EQ(q.min_jacobian_ratio, 1);
}

TEST(Quality, OfACurvedTriangle) {
  // det at the control points of x = u, y = v + 0.6 u v' ... : the middle of side 0 raised by h.
  const double h = 0.125;
  const std::vector<Vec2> control{Vec2{{0, 0}},   Vec2{{0.5, h}},   Vec2{{1, 0}},
                                  Vec2{{0, 0.5}}, Vec2{{0.5, 0.5}}, Vec2{{0, 1}}};
  // y = v + 2 h u (1 - u - v), x = u: det = 1 - 2 h u, from 1 down to 1 - 2 h.
  const auto q = mesh_quality(TriangleMesh(2, control, ids({0, 1, 2, 3, 4, 5})));
  EXPECT_NEAR(q.min_jacobian_ratio, 1 - 2 * h, 1e-15);
  EXPECT_EQ(q.min_jacobian_element, ElementId(0));
}

TEST(Quality, OfAClockwiseTriangle) {
  const std::vector<Vec2> control{Vec2{{0, 0}}, Vec2{{1, 0}}, Vec2{{0, 1}}};
  const auto q = mesh_quality(TriangleMesh(1, control, ids({0, 2, 1})));
  EXPECT_NEAR(q.min_angle, -90, 1e-13);
  EXPECT_LT(q.min_jacobian_ratio, 0);
  EXPECT_TRUE(q.min_jacobian_element.valid());
}

TEST(Quality, WithoutElementsIsZero) {
  const auto q = mesh_quality(TriangleMesh(2, {}, {}));
  EXPECT_EQ(q.max_edge, 0);
  EXPECT_FALSE(q.min_angle_element.valid());
}

}  // namespace
}  // namespace bezel
