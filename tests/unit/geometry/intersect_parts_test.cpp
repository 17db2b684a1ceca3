// The pieces of the intersection of curves and triangles that have no public name.

#include <gtest/gtest.h>

#include <span>
#include <stdexcept>
#include <vector>

#include "bezel/geometry/inline_list.hpp"
#include "bezel/geometry/intersect_collinear.hpp"
#include "bezel/geometry/intersect_exact.hpp"
#include "bezel/geometry/triangle_arrangement.hpp"
#include "bezel/geometry/triangle_assembly.hpp"
#include "bezel/geometry/tube.hpp"

namespace {

using namespace bezel::geometry_kernel;
using bezel::CurvedPolygon;
using bezel::Dyadic;
using bezel::Ratio;
using bezel::Vec2;
using Points = std::vector<Vec2>;

TEST(InlineList, MovesToTheHeapAndBack) {
  InlineList<int, 3> list;
  EXPECT_TRUE(list.empty());
  for (int i = 0; i < 10; ++i) {
    list.push_back(i);
    ASSERT_EQ(list.size(), static_cast<std::size_t>(i) + 1);
    for (int j = 0; j <= i; ++j) EXPECT_EQ(list[static_cast<std::size_t>(j)], j);
    EXPECT_EQ(list.back(), i);
    list.push_back(list[0]);  // an entry of its own, while it grows
    EXPECT_EQ(list.back(), 0);
    list.pop_back();
  }
  const InlineList<int, 3> copy = list;
  for (int i = 9; i >= 0; --i) {
    EXPECT_EQ(list.back(), i);
    list.pop_back();
    for (int j = 0; j < i; ++j) EXPECT_EQ(list[static_cast<std::size_t>(j)], j);
  }
  EXPECT_EQ(copy.size(), 10U);
  EXPECT_EQ(copy.at(9), 9);
  EXPECT_THROW(static_cast<void>(copy.at(10)), std::out_of_range);
  EXPECT_THROW(static_cast<void>(list.at(0)), std::out_of_range);
}

TEST(CoincidenceMap, GoesThereAndBack) {
  // b runs along a backwards, three times as fast: t = 1 - 3 (s - 1/3).
  const Points line{{{0, 0}}, {{6, 3}}}, back{{{6, 3}}, {{4, 2}}};
  const auto contact =
      verify_contact(ExactCurve(line, 0), ExactCurve(back, 0), Ratio{1.0}, Ratio{0.0});
  ASSERT_TRUE(contact);
  const auto change = coincide(*contact);
  ASSERT_TRUE(change);
  const CoincidenceMap map(*contact, *change);
  for (const double s : {0.0, 0.25, 2.0 / 3.0, 1.0}) {
    const Ratio t = map.forward(Ratio{s});
    EXPECT_EQ(compare(map.backward(t), Ratio{s}), 0);
    EXPECT_EQ(compare(t, Ratio{Dyadic(3.0) - Dyadic(3.0) * Dyadic(s)}), 0);
  }
  double lo = 0, hi = 0;
  map.image(0.5, 1.0, lo, hi);
  EXPECT_LE(lo, 0.0);
  EXPECT_GT(lo, -1e-14);
  EXPECT_GE(hi, 1.5);
  EXPECT_LT(hi, 1.5 + 1e-14);
}

TEST(Collinear, OverlapsAndPoints) {
  const Points a{{{0, 0}}, {{2, 1}}}, b{{{6, 3}}, {{1, 0.5}}}, beyond{{{2, 1}}, {{4, 2}}},
      off{{{0, 0}}, {{2, 1 + 0x1p-52}}};
  EXPECT_TRUE(collinear(a, b));
  EXPECT_FALSE(collinear(a, off));
  bezel::CurveIntersections out;
  intersect_collinear(a, b, out);
  ASSERT_EQ(out.overlaps.size(), 1U);
  EXPECT_EQ(out.overlaps[0].s0, 0.5);
  EXPECT_EQ(out.overlaps[0].s1, 1.0);
  EXPECT_EQ(out.overlaps[0].t0, 1.0);
  EXPECT_NEAR(out.overlaps[0].t1, 0.8, 1e-15);
  out = {};
  intersect_collinear(a, beyond, out);
  EXPECT_TRUE(out.overlaps.empty());
  ASSERT_EQ(out.crossings.size(), 1U);
  EXPECT_EQ(out.crossings[0].s, 1.0);
  EXPECT_EQ(out.crossings[0].t, 0.0);
}

/// All common points by the second stage alone.
Resolution resolved(const Points& a, const Points& b, bool swapped) {
  const ExactCurve c(a, 0), d(b, 0);
  int nodes = 10000;
  Resolution out;
  TubeSearch search(swapped ? d : c, swapped ? c : d, swapped, nodes, out);
  EXPECT_TRUE(search.graph(0.0, 1.0));
  search.run(0.0, 1.0);
  EXPECT_LT(nodes, 10000);
  return out;
}

TEST(Tube, FindsCrossingsAndContacts) {
  // y = x^2 and y = x / 2 + 1/2 on [-1, 1] meet at -1/2 and at the common end 1.
  const Points parabola{{{-1, 1}}, {{0, -1}}, {{1, 1}}}, line{{{-1, 0}}, {{1, 1}}},
      tangent{{{-1, 0}}, {{1, 0}}};
  const Resolution two = resolved(parabola, line, false);
  EXPECT_TRUE(two.undecided.empty());
  ASSERT_EQ(two.roots.size(), 2U);
  for (const ResolvedRoot& root : two.roots) {
    EXPECT_EQ(root.order, 1);
    EXPECT_EQ(root.s, root.t);
    EXPECT_EQ(root.sign, root.s < 0.5 ? 1 : -1);
    EXPECT_EQ(root.s, root.s < 0.5 ? 0.25 : 1.0);
  }
  for (const bool swapped : {false, true}) {
    // The straight curve is the graph in either order of the curves.
    const Resolution one =
        swapped ? resolved(tangent, parabola, true) : resolved(parabola, tangent, false);
    EXPECT_TRUE(one.undecided.empty());
    ASSERT_EQ(one.roots.size(), 1U);
    EXPECT_EQ(one.roots[0].order, 2);
    EXPECT_EQ(one.roots[0].s, 0.5);
    EXPECT_EQ(one.roots[0].contact_sign, 0);
  }
  // Nothing in common, however near.
  const Points below{{{-1, -0x1p-60}}, {{1, -0x1p-60}}};
  EXPECT_TRUE(resolved(parabola, below, false).roots.empty());
  // No graph: it turns back.
  const ExactCurve a(line, 0), b(Points{{{0, 0}}, {{1, 0}}, {{0, 0}}}, 0);
  int nodes = 1;
  Resolution out;
  EXPECT_FALSE(TubeSearch(a, b, false, nodes, out).graph(0.0, 1.0));
}

TEST(Arrangement, PartsKnowTheirPlaceAndAreJoined) {
  const Points lower{{{0, 0}}, {{4, 0}}, {{0, 4}}}, upper{{{1, 1}}, {{5, 1}}, {{1, 5}}};
  TriangleSides a, b;
  a.assign(1, lower);
  b.assign(1, upper);
  EXPECT_EQ(a.corner(1), lower[1]);
  Arrangement arrangement;
  ASSERT_TRUE(arrangement.build(a, b, 0.0));
  ASSERT_EQ(arrangement.joints().size(), 2U);  // (3, 1) and (1, 3)
  for (const int k : {0, 1}) {
    const std::span<const BoundaryPart> parts = arrangement.parts(k);
    ASSERT_EQ(parts.size(), 2U);
    EXPECT_EQ(parts[0].to, parts[1].from);
    EXPECT_EQ(parts[1].to, parts[0].from);
    EXPECT_NE(parts[0].place == PartClass::inside, parts[1].place == PartClass::inside);
    EXPECT_NE(parts[0].place == PartClass::outside, parts[1].place == PartClass::outside);
  }
  Assembly assembly;
  std::vector<CurvedPolygon> spare, common, rest;
  ASSERT_TRUE(assembly.run(arrangement, Operation::intersection, false, spare, common));
  ASSERT_TRUE(assembly.run(arrangement, Operation::difference, false, spare, rest));
  ASSERT_EQ(common.size(), 1U);
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_NEAR(area(common[0]), 2.0, 1e-14);
  EXPECT_NEAR(area(rest[0]), 6.0, 1e-14);
  std::vector<CurvedPolygon> whole;
  assembly.whole(a, 0, false, spare, whole);
  assembly.whole(a, 0, true, spare, whole);
  ASSERT_EQ(whole.size(), 2U);
  EXPECT_NEAR(area(whole[0]), 8.0, 1e-14);
  EXPECT_NEAR(area(whole[1]), -8.0, 1e-14);
}

}  // namespace
