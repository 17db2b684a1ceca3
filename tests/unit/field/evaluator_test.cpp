// FieldEvaluator of bezel/field/field.hpp.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bezel/field/field.hpp"
#include "checks.hpp"
#include "meshes.hpp"

namespace bezel {
namespace {

using field_test::formulas;
using field_test::MeshPtr;
using field_test::message_of;

std::vector<Vec2> grid(int n, double half) {
  std::vector<Vec2> points;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      points.push_back({half * (2.0 * i / (n - 1) - 1), half * (2.0 * j / (n - 1) - 1)});
  return points;
}

TEST(FieldEvaluator, ReproducesPolynomialsAtPoints) {
  const MeshPtr mesh = field_test::wavy(3, 3);
  const auto f = formulas({"1 + x - 2*y + x*y^2", "y"});
  const FieldEvaluator at(sample("f", Space::discontinuous(mesh, 3, Basis::physical), f));
  const std::vector<Vec2> points = grid(31, 0.85);
  std::vector<double> values(points.size() * 2), slopes(points.size() * 4);
  at.evaluate(points, values);
  at.gradient(points, slopes);
  for (std::size_t q = 0; q < points.size(); ++q) {
    const double x = points[q].x(), y = points[q].y();
    EXPECT_NEAR(values[2 * q], 1 + x - 2 * y + x * y * y, 1e-14);
    EXPECT_NEAR(values[2 * q + 1], y, 1e-14);
    EXPECT_NEAR(slopes[4 * q], 1 + y * y, 1e-13);
    EXPECT_NEAR(slopes[4 * q + 1], -2 + 2 * x * y, 1e-13);
    EXPECT_NEAR(slopes[4 * q + 2], 0, 1e-13);
    EXPECT_NEAR(slopes[4 * q + 3], 1, 1e-13);
  }
}

TEST(FieldEvaluator, PlacesHoldThePoint) {
  const MeshPtr mesh = field_test::wavy(3, 4);
  const FieldEvaluator at(sample("f", Space::discontinuous(mesh, 1), formulas({"x"})));
  for (const Vec2& p : grid(17, 0.85)) {
    const FieldEvaluator::Place place = at.locate(p);
    ASSERT_TRUE(place.element.valid());
    for (const double l : place.lambda) EXPECT_GE(l, -1e-12);
    EXPECT_NEAR(place.lambda[0] + place.lambda[1] + place.lambda[2], 1.0, 4e-16);
    const Vec2 back = bernstein::evaluate<Vec2>(4, mesh->gather(place.element), place.lambda);
    EXPECT_LT(norm(back - p), 1e-14);
  }
}

TEST(FieldEvaluator, OutsideAndNotFiniteAreNan) {
  const FieldEvaluator at(
      sample("f", Space::discontinuous(field_test::straight(2), 2), formulas({"x", "y"})));
  const double nan = std::numeric_limits<double>::quiet_NaN(),
               infinity = std::numeric_limits<double>::infinity();
  const std::vector<Vec2> points{{1.1, 0}, {0, -1.0001}, {nan, 0}, {0, infinity}, {0.1, 0.2}};
  std::vector<double> values(10), slopes(20);
  at.evaluate(points, values);
  at.gradient(points, slopes);
  for (std::size_t i = 0; i < 8; ++i) EXPECT_TRUE(std::isnan(values[i])) << i;
  for (std::size_t i = 0; i < 16; ++i) EXPECT_TRUE(std::isnan(slopes[i])) << i;
  EXPECT_NEAR(values[8], 0.1, 1e-15);
  EXPECT_NEAR(values[9], 0.2, 1e-15);
  EXPECT_FALSE(at.locate({nan, nan}).element.valid());
  EXPECT_FALSE(at.locate({3, 3}).element.valid());
}

TEST(FieldEvaluator, CommonEdgesBelongToTheSmallestElement) {
  // Points of every inner edge, also curved ones: the smaller neighbour answers.
  for (const MeshPtr& mesh :
       {field_test::straight(3), field_test::wavy(3, 2), field_test::wavy(2, 4)}) {
    const FieldEvaluator at(sample("f", Space::discontinuous(mesh, 0), formulas({"x"})));
    for (std::size_t e = 0; e < mesh->edge_count(); ++e) {
      const auto sides = mesh->adjacent(EdgeId(e));
      if (sides.size() != 2) continue;
      std::vector<Vec2> control(static_cast<std::size_t>(mesh->degree() + 1));
      mesh->gather_edge(EdgeId(e), control);
      for (const double s : {0.1, 0.5, 0.7}) {
        const Vec2 p = bernstein::evaluate<Vec2>(std::span<const Vec2>(control), s);
        EXPECT_EQ(at.locate(p).element, std::min(sides[0].element, sides[1].element))
            << "edge " << e << " " << s;
      }
    }
    // Corners of the mesh's elements are found as well, with the smallest element around them.
    std::vector<int> first(mesh->node_count(), -1);
    for (std::size_t e = 0; e < mesh->element_count(); ++e)
      for (int corner = 0; corner < 3; ++corner) {
        const NodeId n = mesh->nodes(ElementId(
            e))[static_cast<std::size_t>(bernstein::triangle_corner(mesh->degree(), corner))];
        if (first[n.index()] < 0) first[n.index()] = static_cast<int>(e);
        EXPECT_EQ(at.locate(mesh->control(n)).element.value, first[n.index()]);
      }
  }
}

TEST(FieldEvaluator, SameBitsForAnyNumberOfThreadsAndMoves) {
  FieldEvaluator first(
      sample("f", Space::continuous(field_test::wavy(3, 2), 3), formulas({"sin(3*x)*y"})));
  const std::vector<Vec2> points = grid(40, 0.9);
  std::vector<double> one(points.size()), many(points.size());
  first.evaluate(points, one, 1);
  const FieldEvaluator at = std::move(first);
  at.evaluate(points, many, 6);
  EXPECT_EQ(one, many);
  EXPECT_EQ(at.field().name(), "f");
}

TEST(FieldEvaluator, Errors) {
  const FieldEvaluator at(
      sample("f", Space::discontinuous(field_test::straight(1), 1), formulas({"x"})));
  const std::vector<Vec2> points(3);
  std::vector<double> out(2);
  EXPECT_EQ(message_of([&] { at.evaluate(points, out); }), "found room for 2 values, expected 3");
  EXPECT_EQ(message_of([&] { at.gradient(points, out); }), "found room for 2 values, expected 6");
}

}  // namespace
}  // namespace bezel
