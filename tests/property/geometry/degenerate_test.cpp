// Curve pairs made for trouble, with answers known exactly.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "support.hpp"

namespace {

using bezel::intersect;
using bezel::IntersectOptions;
using bezel::Vec2;
using Points = std::vector<Vec2>;
using geometry_test::evaluate;
using geometry_test::part;
using geometry_test::show;

Points exchanged(Points c) {
  for (Vec2& p : c) p = Vec2{{p.y(), p.x()}};
  return c;
}
Points moved(Points c, const Vec2& by) {
  for (Vec2& p : c) p += by;
  return c;
}
Points scaled(Points c, double by) {
  for (Vec2& p : c) p *= by;
  return c;
}
Points elevated(const Points& c) {
  const std::size_t n = c.size();
  Points result(n + 1);
  for (std::size_t i = 0; i <= n; ++i) {
    const double x = static_cast<double>(i) / static_cast<double>(n);
    if (i > 0) result[i] += x * c[i - 1];
    if (i < n) result[i] += (1 - x) * c[i];
  }
  return result;
}
Points reversed(Points c) {
  std::reverse(c.begin(), c.end());
  return c;
}
std::size_t total(const bezel::CurveIntersections& found) {
  return found.crossings.size() + found.tangencies.size() + found.overlaps.size() +
         found.unresolved.size();
}
IntersectOptions within(double tol) {
  IntersectOptions options;
  options.coincidence_distance = tol;
  return options;
}

const Points wave{{{-3, -3}}, {{-1, 15}}, {{1, -15}}, {{3, 3}}};
const Points parabola{{{-1, 1}}, {{0, -1}}, {{1, 1}}};  // y = x^2 on [-1, 1]

void expect_nine(const Points& a, const Points& b, const IntersectOptions& options) {
  const auto found = intersect(a, b, options);
  ASSERT_EQ(found.crossings.size(), 9u) << show(a, b, found);
  EXPECT_EQ(total(found), 9u) << show(a, b, found);
  int signs = 0;
  for (const auto& c : found.crossings) {
    EXPECT_TRUE(c.certified);
    EXPECT_NE(c.sign, 0);
    signs += c.sign;
  }
  EXPECT_EQ(std::abs(signs), 1);
}

TEST(DegenerateTest, NineHits) {
  for (const double tol : {0.0, 1e-13}) {
    const Points tight = part(wave, -1.0 / 16, 17.0 / 16);
    for (const Points& c : {wave, tight}) {
      const Points other = exchanged(c);
      expect_nine(c, other, within(tol));
      const Vec2 far{{0x1p20, 0x1p20}};
      expect_nine(moved(c, far), moved(other, far), within(tol * 1e4));
      expect_nine(scaled(c, 0x1p-300), scaled(other, 0x1p-300), within(tol * 0x1p-300));
    }
  }
}

TEST(DegenerateTest, NearTangentLine) {
  for (int k = 4; k <= 26; ++k) {
    const double y = std::ldexp(1.0, -2 * k), half = std::ldexp(1.0, -(k + 1));
    const Points line{{{-1, y}}, {{1, y}}}, below{{{-1, -y}}, {{1, -y}}};
    for (const bool swap : {false, true}) {
      const auto found = swap ? intersect(line, parabola) : intersect(parabola, line);
      ASSERT_EQ(found.crossings.size(), 2u) << k << show(parabola, line, found);
      EXPECT_EQ(total(found), 2u) << k << show(parabola, line, found);
      EXPECT_EQ(found.crossings[0].sign, -found.crossings[1].sign);
      // Parameters within 4 u cond; the condition is that of the double root that splits.
      const double error = 4 * 0x1p-53 * std::ldexp(1.0, k);
      EXPECT_NEAR(found.crossings[0].s, 0.5 - half, error) << k;
      EXPECT_NEAR(found.crossings[1].s, 0.5 + half, error) << k;
      const auto none = swap ? intersect(below, parabola) : intersect(parabola, below);
      EXPECT_EQ(total(none), 0u) << k << show(parabola, below, none);
    }
  }
}

TEST(DegenerateTest, ContactOfOrderTwoThreeFour) {
  const Points axis{{{-1, 0}}, {{1, 0}}};
  const auto two = intersect(parabola, axis);
  ASSERT_EQ(two.tangencies.size(), 1u) << show(parabola, axis, two);
  EXPECT_EQ(total(two), 1u);
  EXPECT_EQ(two.tangencies[0].order, 2);
  EXPECT_EQ(two.tangencies[0].s, 0.5);
  EXPECT_EQ(two.tangencies[0].t, 0.5);
  // y = x^3 on [-1, 1]: they cross, though tangent.
  const Points cubic{{{-1, -1}}, {{-1.0 / 3, 1}}, {{1.0 / 3, -1}}, {{1, 1}}};
  const auto three = intersect(cubic, axis);
  ASSERT_EQ(three.tangencies.size(), 1u) << show(cubic, axis, three);
  EXPECT_EQ(total(three), 1u);
  EXPECT_EQ(three.tangencies[0].order, 3);
  EXPECT_EQ(three.tangencies[0].s, 0.5);
  // The axis passes from left to right of the cubic; the sign is that of cross(a', b') nearby.
  EXPECT_EQ(three.tangencies[0].sign, -1);
  const Points back(cubic.rbegin(), cubic.rend()), axis_back(axis.rbegin(), axis.rend());
  // x^2 and x^2 + x^3: neither is straight.
  const Points square{{{-3, 9}}, {{0, -9}}, {{3, 9}}};
  const Points with_cube{{{-3, -18}}, {{-1, 24}}, {{1, -30}}, {{3, 36}}};
  const Points square_back(square.rbegin(), square.rend()),
      with_cube_back(with_cube.rbegin(), with_cube.rend());
  const auto sign = [](const Points& a, const Points& b) {
    const auto found = intersect(a, b);
    EXPECT_EQ(found.tangencies.size(), 1u) << show(a, b, found);
    return found.tangencies.empty() ? 0 : found.tangencies[0].sign;
  };
  for (const auto& [a, a_back, b, b_back] :
       {std::array{cubic, back, axis, axis_back},
        std::array{with_cube, with_cube_back, square, square_back}}) {
    EXPECT_EQ(sign(a, b), -1);
    EXPECT_EQ(sign(b, a), 1);
    EXPECT_EQ(sign(a_back, b), 1);
    EXPECT_EQ(sign(a, b_back), 1);
    EXPECT_EQ(sign(a_back, b_back), -1);
    EXPECT_EQ(sign(b_back, a), -1);
  }
  EXPECT_EQ(two.tangencies[0].sign, 0);
  // y = x^4 on [-1, 1].
  const Points quartic{{{-1, 1}}, {{-0.5, -1}}, {{0, 1}}, {{0.5, -1}}, {{1, 1}}};
  const auto four = intersect(quartic, axis);
  ASSERT_EQ(four.tangencies.size(), 1u) << show(quartic, axis, four);
  EXPECT_EQ(total(four), 1u);
  EXPECT_EQ(four.tangencies[0].order, 4);
  EXPECT_EQ(four.tangencies[0].s, 0.5);
}

TEST(DegenerateTest, ShearedParabolasMeetOnce) {
  for (int k = 4; k <= 50; ++k) {
    // y = x^2 + 2^-k (x - 1/4): exact in double up to k = 50.
    const double e = std::ldexp(1.0, -k);
    const Points other{{{-1, 1 - 1.25 * e}}, {{0, -1 - 0.25 * e}}, {{1, 1 + 0.75 * e}}};
    const auto found = intersect(parabola, other);
    ASSERT_EQ(found.crossings.size(), 1u) << k << show(parabola, other, found);
    EXPECT_EQ(total(found), 1u) << k << show(parabola, other, found);
    EXPECT_EQ(found.crossings[0].sign, 1) << k;
    const double error = 4 * 0x1p-53 * std::ldexp(1.0, k);
    EXPECT_NEAR(found.crossings[0].s, 0.625, error) << k;
    EXPECT_NEAR(found.crossings[0].t, 0.625, error) << k;
  }
}

void expect_overlap(const Points& a, const Points& b, const IntersectOptions& options, double s0,
                    double s1, double t0, double t1) {
  const auto found = intersect(a, b, options);
  ASSERT_EQ(found.overlaps.size(), 1u) << show(a, b, found);
  EXPECT_EQ(total(found), 1u) << show(a, b, found);
  EXPECT_NEAR(found.overlaps[0].s0, s0, 1e-14) << show(a, b, found);
  EXPECT_NEAR(found.overlaps[0].s1, s1, 1e-14) << show(a, b, found);
  EXPECT_NEAR(found.overlaps[0].t0, t0, 1e-14) << show(a, b, found);
  EXPECT_NEAR(found.overlaps[0].t1, t1, 1e-14) << show(a, b, found);
}

TEST(DegenerateTest, Overlaps) {
  const Points c{{{0, 0}}, {{1, 2}}, {{2, -1}}, {{3, 1}}};
  for (const double tol : {0.0, 1e-13}) {
    const auto options = within(tol);
    expect_overlap(c, c, options, 0, 1, 0, 1);
    expect_overlap(c, reversed(c), options, 0, 1, 1, 0);
    // Rounded control points are another curve: the same only within a distance.
    if (tol > 0) expect_overlap(c, elevated(elevated(c)), options, 0, 1, 0, 1);
    expect_overlap(c, elevated(c), options, 0, 1, 0, 1);
    expect_overlap(c, part(c, 0.25, 1.25), options, 0.25, 1, 0, 0.75);
    expect_overlap(c, reversed(part(c, 0.25, 1.25)), options, 0.25, 1, 1, 0.25);
    expect_overlap(c, part(c, 0.25, 0.75), options, 0.25, 0.75, 0, 1);
    expect_overlap(part(c, 0.25, 0.75), elevated(c), options, 0, 1, 0.25, 0.75);
    expect_overlap(parabola, part(parabola, -0.5, 1.5), options, 0, 1, 0.25, 0.75);
    // A straight line with an uneven parameter: x = s^2 on the line y = x / 2.
    const Points straight{{{0, 0}}, {{2, 1}}}, uneven{{{0, 0}}, {{0, 0}}, {{2, 1}}};
    expect_overlap(straight, uneven, options, 0, 1, 0, 1);
  }
}

TEST(DegenerateTest, EndsThatOnlyTouch) {
  for (const double tol : {0.0, 1e-13}) {
    // A smooth joint: the second continues the first; both lie on one algebraic curve, or not.
    const Points c{{{0, 0}}, {{1, 2}}, {{2, -1}}, {{3, 1}}};
    const Points next{{{3, 1}}, {{4, 3}}, {{5, 0}}};
    for (const Points& d : {part(c, 1, 2), next}) {
      const auto found = intersect(c, d, within(tol));
      ASSERT_EQ(found.crossings.size(), 1u) << show(c, d, found);
      EXPECT_EQ(found.crossings[0].s, 1.0);
      EXPECT_EQ(found.crossings[0].t, 0.0);
    }
    // An end point on the other's interior, coming from one side.
    const Points line{{{0, 0}}, {{4, 0}}}, up{{{1, 0}}, {{1, 1}}, {{2, 3}}};
    const auto tee = intersect(line, up, within(tol));
    ASSERT_EQ(tee.crossings.size(), 1u) << show(line, up, tee);
    EXPECT_EQ(total(tee), 1u);
    EXPECT_EQ(tee.crossings[0].s, 0.25);
    EXPECT_EQ(tee.crossings[0].t, 0.0);
    EXPECT_EQ(tee.crossings[0].sign, 1);
  }
}

TEST(DegenerateTest, LoopAndCusp) {
  const Points loop{{{0, 0}}, {{2, 1}}, {{-1, 1}}, {{1, 0}}};
  const Points cusp{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}};
  for (const double tol : {0.0, 1e-13}) {
    // Symmetric about x = 1/2; the line passes through the loop's two strands and its double
    // point's column.
    const Points across{{{-1, 0.5}}, {{2, 0.5}}};
    const auto found = intersect(loop, across, within(tol));
    EXPECT_EQ(found.crossings.size(), 2u) << show(loop, across, found);
    EXPECT_EQ(total(found), 2u);
    const auto below = intersect(cusp, across, within(tol));
    EXPECT_EQ(below.crossings.size(), 2u) << show(cusp, across, below);
    EXPECT_EQ(total(below), 2u);
    // Through the cusp point (1/2, 3/4) itself: never silently nothing.
    const Points through{{{-1, 0.75}}, {{2, 0.75}}}, upright{{{0.5, 0}}, {{0.5, 2}}};
    EXPECT_GE(total(intersect(cusp, through, within(tol))), 1u);
    EXPECT_GE(total(intersect(cusp, upright, within(tol))), 1u);
    // With themselves.
    for (const Points& c : {loop, cusp}) {
      const auto self = intersect(c, c, within(tol));
      ASSERT_EQ(self.overlaps.size(), 1u) << show(c, c, self);
      EXPECT_EQ(self.overlaps[0].s0, 0.0);
      EXPECT_EQ(self.overlaps[0].s1, 1.0);
    }
  }
}

TEST(DegenerateTest, PointCurves) {
  const Points point{{{0.5, 0.25}}}, line{{{0, 0}}, {{1, 0.5}}}, off{{{0.5, 0.3}}};
  const Points still{{{0.5, 0.25}}, {{0.5, 0.25}}, {{0.5, 0.25}}};
  const auto on = intersect(line, point);
  ASSERT_EQ(on.crossings.size(), 1u) << show(line, point, on);
  EXPECT_EQ(on.crossings[0].s, 0.5);
  EXPECT_EQ(total(intersect(line, off)), 0u);
  EXPECT_EQ(intersect(line, still).unresolved.size(), 0u);
  EXPECT_GE(intersect(line, still).crossings.size(), 1u);
  EXPECT_EQ(total(intersect(point, point)), 1u);
}

/// Two curves near a common vertex: every edge that ends there gets the same parameter on a crossed
/// edge, bit for bit.
TEST(DegenerateTest, FootParametersDependOnTheVertexOnly) {
  bezel::RandomStream random("FootParametersDependOnTheVertexOnly", 1);
  int hits = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    const int degree = 1 + static_cast<int>(random.below(4));
    const Points edge = geometry_test::random_points(random, degree);
    const double s = random.uniform(0.05, 0.95);
    const Vec2 vertex =
        evaluate(edge, s) + Vec2{{random.uniform(-5e-14, 5e-14), random.uniform(-5e-14, 5e-14)}};
    double seen = -1;
    for (int k = 0; k < 6; ++k) {
      Points other = geometry_test::random_points(random, 1 + static_cast<int>(random.below(3)));
      const bool last = k % 2 == 1;
      (last ? other.back() : other.front()) = vertex;
      const auto found =
          k < 3 ? intersect(edge, other, within(1e-13)) : intersect(other, edge, within(1e-13));
      double here = -1;
      for (const auto& c : found.crossings) {
        const double own = k < 3 ? c.t : c.s, on_edge = k < 3 ? c.s : c.t;
        if (own == (last ? 1.0 : 0.0) && std::fabs(on_edge - s) < 1e-9) here = on_edge;
      }
      ASSERT_GE(here, 0.0) << trial << " " << s << show(edge, other, found);
      if (seen >= 0) {
        EXPECT_EQ(here, seen) << trial;
      }
      seen = here;
      ++hits;
    }
  }
  EXPECT_EQ(hits, 12000);
}

}  // namespace
