#include "bezel/geometry/triangle_intersection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/geometry/triangle.hpp"
#include "support/message_of.hpp"

namespace {

using bezel::CurvedPolygon;
using bezel::difference;
using bezel::intersect;
using bezel::PointInPolygon;
using bezel::TriangleRelation;
using bezel::Vec2;
using bezel::test::message_of;
using Points = std::vector<Vec2>;

const Points unit{{{0, 0}}, {{1, 0}}, {{0, 1}}};
const Points curved{{{0, 0}}, {{0.5, -0.25}}, {{1, 0}}, {{0, 0.5}}, {{0.5, 0.5}}, {{0, 1}}};

Points moved(Points p, double x, double y) {
  for (Vec2& c : p) c += Vec2{{x, y}};
  return p;
}

double total(const std::vector<CurvedPolygon>& polygons) {
  double sum = 0.0;
  for (const CurvedPolygon& p : polygons) sum += area(p);
  return sum;
}

TEST(TriangleIntersectionTest, OfStraightTrianglesKnowsWhereEdgesComeFrom) {
  const auto found = intersect(1, unit, 1, moved(unit, 0.25, 0.25));
  ASSERT_EQ(found.relation, TriangleRelation::overlapping);
  ASSERT_EQ(found.polygons.size(), 1u);
  const CurvedPolygon& p = found.polygons[0];
  ASSERT_EQ(p.size(), 3u);
  EXPECT_EQ(p.vertices().size(), 3u);
  EXPECT_DOUBLE_EQ(area(p), 0.125);
  bool seen = false;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& e = p.edges()[i];
    if (e.triangle != 0) continue;
    seen = true;
    EXPECT_EQ(e.edge, 1);
    EXPECT_DOUBLE_EQ(e.s0, 0.25);
    EXPECT_DOUBLE_EQ(e.s1, 0.75);
    const auto& v = p.vertices()[static_cast<std::size_t>(e.vertex)];
    EXPECT_EQ(v.point, (Vec2{{0.75, 0.25}}));
    EXPECT_EQ(v.place[0], (bezel::BoundaryPlace{1, 0.25}));
    EXPECT_EQ(v.place[1], (bezel::BoundaryPlace{0, 0.5}));
    EXPECT_EQ(p.control(i).front(), v.point);
  }
  EXPECT_TRUE(seen);
}

TEST(TriangleIntersectionTest, OfTheSameTriangle) {
  const Points renumbered{curved[2], curved[4], curved[5], curved[1], curved[3], curved[0]};
  for (const Points& other : {curved, renumbered}) {
    const auto found = intersect(2, curved, 2, other);
    EXPECT_EQ(found.relation, TriangleRelation::same);
    ASSERT_EQ(found.polygons.size(), 1u);
    EXPECT_NEAR(area(found.polygons[0]), bezel::area(found.polygons[0]), 0.0);
    const auto rest = difference(2, curved, 2, other);
    EXPECT_EQ(rest.relation, TriangleRelation::same);
    EXPECT_TRUE(rest.loops.empty());
  }
}

TEST(TriangleIntersectionTest, NeighboursTouchAlongTheirSide) {
  // Side 1 of the unit triangle, reversed, is side 2 of the other.
  const Points other{{{0, 1}}, {{1, 1}}, {{1, 0}}};
  const Points same_side{{{1, 0}}, {{1, 1}}, {{0, 1}}};
  EXPECT_EQ(message_of([&] { (void)intersect(1, unit, 1, other); }),
            "the second triangle's Jacobian determinant is not positive everywhere, expected a "
            "counter-clockwise triangle without folds");
  const auto found = intersect(1, unit, 1, same_side);
  EXPECT_EQ(found.relation, TriangleRelation::touching);
  EXPECT_TRUE(found.polygons.empty());
  const auto rest = difference(1, unit, 1, same_side);
  ASSERT_EQ(rest.loops.size(), 1u);
  EXPECT_DOUBLE_EQ(area(rest.loops[0]), 0.5);
}

TEST(TriangleIntersectionTest, TouchingInACornerOrApart) {
  EXPECT_EQ(intersect(1, unit, 1, moved(unit, 1, 0)).relation, TriangleRelation::touching);
  EXPECT_EQ(intersect(1, unit, 1, moved(unit, 0.5, 0.5)).relation, TriangleRelation::touching);
  EXPECT_EQ(intersect(1, unit, 1, moved(unit, 0.5, 0.5 + 0x1p-53)).relation,
            TriangleRelation::disjoint);
  EXPECT_EQ(intersect(1, unit, 1, moved(unit, 3, 0)).relation, TriangleRelation::disjoint);
  EXPECT_EQ(intersect(1, unit, 1, moved(unit, 0.75, 0.75)).relation, TriangleRelation::disjoint);
}

TEST(TriangleIntersectionTest, OneInsideTheOther) {
  Points small = unit;
  for (Vec2& p : small) p = 0.25 * p + Vec2{{0.125, 0.125}};
  const auto found = intersect(2, curved, 1, small), exchanged = intersect(1, small, 2, curved);
  EXPECT_EQ(found.relation, TriangleRelation::second_in_first);
  EXPECT_EQ(exchanged.relation, TriangleRelation::first_in_second);
  ASSERT_EQ(found.polygons.size(), 1u);
  EXPECT_EQ(found.polygons[0].edges()[0].triangle, 1);
  EXPECT_DOUBLE_EQ(area(found.polygons[0]), 0.03125);
  const auto rest = difference(2, curved, 1, small);
  ASSERT_EQ(rest.loops.size(), 2u);  // the outer boundary, and the hole's
  EXPECT_GT(area(rest.loops[0]), 0.0);
  EXPECT_DOUBLE_EQ(area(rest.loops[1]), -0.03125);
  EXPECT_TRUE(difference(1, small, 2, curved).loops.empty());
}

TEST(TriangleIntersectionTest, InsideAndTouchingTheBoundary) {
  // Corner 0 shared, corners 1 and 2 on the sides.
  Points half = unit;
  for (Vec2& p : half) p = 0.5 * p;
  const auto found = intersect(1, unit, 1, half);
  EXPECT_EQ(found.relation, TriangleRelation::second_in_first);
  const auto rest = difference(1, unit, 1, half);
  ASSERT_EQ(rest.loops.size(), 1u);
  EXPECT_DOUBLE_EQ(area(rest.loops[0]), 0.375);
  EXPECT_EQ(rest.loops[0].size(), 4u);
}

// Both feet of an arch.
TEST(TriangleIntersectionTest, OfSeveralRegions) {
  const Points arch{{{0, 0}}, {{1, 1}}, {{2, 0}}, {{0.5, 1.5}}, {{1.5, 1.5}}, {{1, 3}}};
  const Points below{{{-1, 0.25}}, {{1, -2}}, {{3, 0.25}}};
  const auto found = intersect(2, arch, 1, below);
  EXPECT_EQ(found.relation, TriangleRelation::overlapping);
  ASSERT_EQ(found.polygons.size(), 2u);
  // Between y = 2 s (1 - s), x = 2 s, and the line x = y / 3, up to y = 1/4.
  const double s = (1 - std::sqrt(0.5)) / 2;
  const double foot = 0.5 * s - (2 * s * s - 4.0 / 3 * s * s * s) - 0.25 * 0.25 / 6;
  EXPECT_NEAR(area(found.polygons[0]), foot, 1e-15);
  EXPECT_NEAR(area(found.polygons[1]), foot, 1e-15);
  const auto rest = difference(2, arch, 1, below), other = difference(1, below, 2, arch);
  EXPECT_EQ(rest.loops.size(), 1u);
  EXPECT_NEAR(total(rest.loops), bezel::area(2, arch) - 2 * foot, 1e-15);
  EXPECT_NEAR(total(other.loops), bezel::area(1, below) - 2 * foot, 5e-15);
}

// The hill's side touches the other's from inside: one region that touches itself, or two.
TEST(TriangleIntersectionTest, RegionsThatTouchInOnePoint) {
  const Points a{{{0, 0}}, {{1, 1}}, {{2, 0}}, {{0, 1}}, {{2, 1}}, {{1, 3}}};
  const Points b{{{2, 1}}, {{1, 0}}, {{0, 1}}, {{2, -1}}, {{0, -1}}, {{1, -2}}};
  bezel::TriangleIntersectOptions options;
  const auto one = intersect(2, a, 2, b, options);
  options.cut_where_touching = true;
  const auto two = intersect(2, a, 2, b, options);
  ASSERT_EQ(one.relation, TriangleRelation::overlapping) << one.reason;
  EXPECT_EQ(one.polygons.size(), 1u);
  EXPECT_EQ(two.polygons.size(), 2u);
  EXPECT_NEAR(total(one.polygons), total(two.polygons), 1e-15);
  EXPECT_GT(total(one.polygons), 0.1);
}

// Sides cross within rounding of a corner of each triangle, where the crossings' parameters are
// rounded to the corner. Taken for one joint, an inner triangle was reported.
TEST(TriangleIntersectionTest, CrossingsRoundedToACornerAreNotTakenForOne) {
  // Neighbours in a mesh that was sheared by rounding only: they share a sliver of 1e-34.
  const Points sheared{{{0x1.999b38ef45b2fp-54, -1}},
                       {{0x1.0000000000001p-1, -1}},
                       {{1, -1}},
                       {{0x1.cdf63a1a50365p-4, -0x1.825560bb055c4p-2}},
                       {{0x1.2d393d601e83cp-1, -0x1.f70efb3a43dcp-2}},
                       {{-0x1.ea27eda6fea03p-6, 0x1.f6aa7d13ea8efp-4}}};
  const Points plain{{{-1, 0}},
                     {{-0x1.0f513f6d37f5p-1, -0x1.3d408a8486654p-5}},
                     {{-0x1.ea27eda6feap-6, 0x1.f6aa7d13ea8efp-4}},
                     {{-1, 0.5}},
                     {{-0x1.3086f9a6e4c3ep-1, 0x1.d28c9f1af4122p-2}},
                     {{-1, 1}}};
  // A corner inside the other triangle by 1e-17.
  const Points left{{{0, -1}},        {{0, -0.75}},    {{0, -0.5}},
                    {{-0.25, -0.75}}, {{-0.25, -0.5}}, {{-0.5, -0.5}}};
  const Points right{{{-0x1.3be7d7d4578fep-57, -1}},
                     {{0.25, -1}},
                     {{0.5, -1}},
                     {{0.25, -0.75}},
                     {{0.5, -0.75}},
                     {{0.5, -0.5}}};
  // A corner on a side, and a crossing 1e-48 beside it.
  const Points corner{{{-0.505, -0.505}}, {{0, -0.505}}, {{0x1p-158, 0x1p-158}}};
  const Points side{{{1.01, -1.01}}, {{1.01, 0}}, {{0, 0}}};
  const auto common = [](int degree, const Points& a, const Points& b) {
    return total(intersect(degree, a, degree, b).polygons);
  };
  for (const auto& [degree, a, b] :
       {std::tuple(2, sheared, plain), std::tuple(2, left, right), std::tuple(1, corner, side)}) {
    EXPECT_LE(std::abs(common(degree, a, b)), 1e-17);
    EXPECT_LE(std::abs(common(degree, b, a)), 1e-17);
    double rest = 0.0;
    for (const CurvedPolygon& p : difference(degree, a, degree, b).loops) rest += area(p);
    EXPECT_NEAR(rest, bezel::area(degree, a), 1e-16);
  }
}

// A corner on a side so near to its end that the parameter there, rounded, would be the end's.
TEST(TriangleIntersectionTest, ACornerBesideACornerIsNotTakenForIt) {
  const Points cubic{{{-0x1.fffffffffffffp-1, -0x1.fffffffffffffp-2}},
                     {{-0x1.b798ac1f7ae7ep-1, -0x1.feceb41d5d513p-2}},
                     {{-0x1.6f31583ef5cfap-1, -0x1.fd9d683abaa23p-2}},
                     {{-0x1.26ca045e70b78p-1, -0x1.fc6c1c5817f32p-2}},
                     {{-1, -0x1.5555555555556p-2}},
                     {{-0x1.b798ac1f7ae7dp-1, -0x1.54240972b2a65p-2}},
                     {{-0x1.6f31583ef5cfap-1, -0x1.52f2bd900ff78p-2}},
                     {{-1, -0x1.5555555555559p-3}},
                     {{-0x1.b798ac1f7ae7dp-1, -0x1.52f2bd900ff75p-3}},
                     {{-1, 0x1.db74d5d36d63cp-56}}};
  const Points straight{{{-1, 0}}, {{-0x1.8bf74aaff3167p-2, 0x1.01c9f1d3f4066p-1}}, {{-1, 0.5}}};
  EXPECT_LE(total(intersect(3, cubic, 1, straight).polygons), 1e-17);
  EXPECT_LE(total(intersect(1, straight, 3, cubic).polygons), 1e-17);
  const Points along{cubic[9], cubic[7], cubic[4], cubic[0]};  // from the corner down
  const Points side{{{-1, 0.5}}, {{-1, 0}}};
  const bezel::CurveIntersections found = bezel::intersect(along, side);
  ASSERT_EQ(found.crossings.size(), 1U);
  EXPECT_EQ(found.crossings[0].s, 0.0);
  EXPECT_EQ(found.crossings[0].t, 1.0 - 0x1p-53);  // 1 - 5e-17 rounds to 1
}

TEST(TriangleIntersectionTest, StorageIsReused) {
  bezel::TriangleIntersector intersector;
  bezel::TriangleIntersections out;
  const Points other = moved(curved, 0.25, 0.25);
  intersector.intersect(2, curved, 2, other, out);
  const double first = total(out.polygons);
  intersector.intersect(1, unit, 1, moved(unit, 3, 3), out);
  EXPECT_TRUE(out.polygons.empty());
  intersector.intersect(2, curved, 2, other, out);
  ASSERT_EQ(out.polygons.size(), 1u);
  EXPECT_EQ(total(out.polygons), first);
}

TEST(TriangleIntersectionTest, BadInput) {
  Points nan = unit;
  nan[1] = Vec2{{std::numeric_limits<double>::quiet_NaN(), 0}};
  EXPECT_EQ(message_of([&] { (void)intersect(1, unit, 1, nan); }),
            "control point 1 of the triangle is not finite");
  EXPECT_EQ(message_of([&] { (void)intersect(2, unit, 1, unit); }),
            "a triangle of degree 2 has 6 control points, found 3");
  EXPECT_EQ(message_of([&] { (void)intersect(1, unit, 0, unit); }),
            "the triangle's degree is 0, expected 1 to 40");
  bezel::TriangleIntersectOptions options;
  options.coincidence_distance = -1.0;
  EXPECT_EQ(message_of([&] { (void)intersect(1, unit, 1, unit, options); }),
            "the coincidence distance must be finite and not negative");
}

}  // namespace
