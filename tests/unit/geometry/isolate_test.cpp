#include "bezel/geometry/isolate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace {

using bezel::Vec2;
using bezel::geometry_kernel::isolate;
using bezel::geometry_kernel::IsolatedRoot;
using bezel::geometry_kernel::Isolation;
using bezel::geometry_kernel::OpenBox;
using Points = std::vector<Vec2>;

Isolation isolated(const Points& a, const Points& b) {
  Isolation out;
  isolate(a, b, out);
  return out;
}
bool covers(const OpenBox& o, double s, double t) {
  return o.s0 <= s && s <= o.s1 && o.t0 <= t && t <= o.t1;
}
bool covered(const Isolation& x, double s, double t) {
  return std::any_of(x.open.begin(), x.open.end(),
                     [&](const OpenBox& o) { return covers(o, s, t); });
}

const Points cubic{{{0, 0}}, {{1, 2}}, {{2, -1}}, {{3, 1}}};
const Points parabola{{{-1, 1}}, {{0, -1}}, {{1, 1}}};  // y = x^2

TEST(Isolate, OneCrossingOfLines) {
  const Isolation x = isolated({{{0, 0}}, {{4, 1}}}, {{{1, -1}}, {{1, 3}}});
  ASSERT_EQ(x.roots.size(), 1U);
  EXPECT_TRUE(x.open.empty());
  const IsolatedRoot& r = x.roots[0];
  EXPECT_EQ(r.s, 0.25);
  EXPECT_NEAR(r.t, 0.3125, 0x1p-52);
  EXPECT_EQ(r.sign, 1);
  EXPECT_TRUE(r.s_lo < 0.25 && 0.25 < r.s_hi && r.t_lo < 0.3125 && 0.3125 < r.t_hi);
}

TEST(Isolate, SignIsThatOfTheCrossProduct) {
  const Points a{{{0, 0}}, {{1, 0}}}, up{{{0.3, -1}}, {{0.3, 1}}}, down{{{0.3, 1}}, {{0.3, -1}}};
  EXPECT_EQ(isolated(a, up).roots.at(0).sign, 1);
  EXPECT_EQ(isolated(a, down).roots.at(0).sign, -1);
  EXPECT_EQ(isolated(up, a).roots.at(0).sign, -1);
}

TEST(Isolate, TwoRootsWhereALineCutsAParabola) {
  const Isolation x = isolated(parabola, {{{-1, 0.1}}, {{1, 0.1}}, {{3, 0.1}}});
  ASSERT_EQ(x.roots.size(), 2U);
  EXPECT_TRUE(x.open.empty());
  EXPECT_EQ(x.roots[0].sign + x.roots[1].sign, 0);
  for (const IsolatedRoot& r : x.roots)
    EXPECT_NEAR(std::fabs(2 * r.s - 1), std::sqrt(0.1), 0x1p-51);
}

TEST(Isolate, ClearsWhatWasThere) {
  Isolation x = isolated(cubic, cubic);
  EXPECT_FALSE(x.open.empty());
  isolate(Points{{{0, 0}}, {{1, 0}}}, Points{{{0, 1}}, {{1, 1}}}, x);
  EXPECT_TRUE(x.open.empty());
  EXPECT_TRUE(x.roots.empty());
}

// The root lies on the border of four boxes after the first halving, of both curves.
TEST(Isolate, RootOnBordersIsFoundOnce) {
  const Points a{{{-1, -1}}, {{-1, 1}}, {{1, -1}}, {{1, 1}}};
  const Points b{{{-1, 1}}, {{-2, 0}}, {{2, 0}}, {{1, -1}}};
  const Isolation x = isolated(a, b);
  EXPECT_TRUE(x.open.empty());
  ASSERT_EQ(x.roots.size(), 1U);
  EXPECT_NEAR(x.roots[0].s, 0.5, 0x1p-52);
  EXPECT_NEAR(x.roots[0].t, 0.5, 0x1p-52);
}

TEST(Isolate, RootAtAnEndIsAnOpenBoxWithASign) {
  // b starts on a's interior; then in a's corner.
  const Points a{{{0, 0}}, {{4, 0}}}, b{{{1, 0}}, {{1, 1}}, {{2, 3}}};
  for (const Isolation& x : {isolated(a, b), isolated(a, {{{0, 0}}, {{0, 1}}, {{1, 1}}})}) {
    EXPECT_TRUE(x.roots.empty());
    ASSERT_EQ(x.open.size(), 1U);
    EXPECT_EQ(x.open[0].sign, 1);
    EXPECT_EQ(x.open[0].t0, 0.0);
  }
  const Isolation x = isolated(a, b);
  EXPECT_TRUE(covers(x.open[0], 0.25, 0.0));
  EXPECT_NEAR(x.open[0].s, 0.25, 0x1p-52);
  EXPECT_NEAR(x.open[0].t, 0.0, 0x1p-52);
}

TEST(Isolate, RootJustBeyondAnEndIsNone) {
  const Points a{{{0, 0}}, {{4, 0}}};
  EXPECT_TRUE(isolated(a, {{{1, 0x1p-40}}, {{1, 1}}, {{2, 3}}}).open.empty());
  EXPECT_TRUE(isolated(a, {{{1, 0x1p-40}}, {{1, 1}}, {{2, 3}}}).roots.empty());
  EXPECT_EQ(isolated(a, {{{1, -0x1p-40}}, {{1, 1}}, {{2, 3}}}).roots.size(), 1U);
}

TEST(Isolate, TouchingStaysOpen) {
  const Isolation x = isolated(parabola, {{{-1, 0}}, {{1, 0}}});
  EXPECT_TRUE(x.roots.empty());
  EXPECT_TRUE(covered(x, 0.5, 0.5));
  EXPECT_LE(x.open.size(), 8U);
}

TEST(Isolate, CoincidentCurvesLeaveFewBoxes) {
  const Points back(cubic.rbegin(), cubic.rend());
  const Points line{{{0, 0}}, {{1, 1}}}, longer{{{-1, -1}}, {{2, 2}}};
  const Isolation same = isolated(cubic, cubic), opposite = isolated(cubic, back);
  const Isolation lines = isolated(line, longer);
  for (int i = 0; i <= 64; ++i) {
    const double s = i / 64.0;
    EXPECT_TRUE(covered(same, s, s));
    EXPECT_TRUE(covered(opposite, s, 1 - s));
    EXPECT_TRUE(covered(lines, s, (1 + s) / 3));
  }
  for (const Isolation* x : {&same, &opposite, &lines}) {
    EXPECT_TRUE(x->roots.empty());
    EXPECT_LE(x->open.size(), 64U);
  }
}

TEST(Isolate, CuspOnTheOtherCurveStaysOpen) {
  const Points cusp{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}};
  const Isolation x = isolated(cusp, {{{-1, 0.75}}, {{2, 0.75}}});
  EXPECT_TRUE(x.roots.empty());
  EXPECT_TRUE(covered(x, 0.5, 0.5));
}

TEST(Isolate, PointCurves) {
  const Points point{{{0.5, 0.25}}}, resting(4, Vec2{{0.5, 0.25}}), line{{{0, 0}}, {{1, 0.5}}};
  for (const Points& p : {point, resting}) {
    const Isolation on = isolated(line, p), off = isolated(line, {{{0.5, 0.3}}});
    EXPECT_TRUE(on.roots.empty());
    EXPECT_TRUE(covered(on, 0.5, 0.0));
    EXPECT_TRUE(covered(on, 0.5, 1.0));
    EXPECT_LE(on.open.size(), 4U);
    EXPECT_TRUE(off.roots.empty());
    EXPECT_TRUE(off.open.empty());
    const Isolation itself = isolated(p, p);
    EXPECT_TRUE(covered(itself, 0, 0) && covered(itself, 1, 1) && covered(itself, 0, 1));
  }
}

// Products of these coordinates vanish; what decides is not tiny or is left open.
TEST(Isolate, SubnormalExtents) {
  const double d = 0x1p-1074, big = 0x1p-300;
  const Points a{{{big, 0}}, {{big, d}}}, b{{{big, d}}, {{big, 0}}};
  const Isolation x = isolated(a, b);
  EXPECT_TRUE(x.roots.empty());
  EXPECT_TRUE(covered(x, 0.5, 0.5));
  // A subnormal chord across a long one.
  const Isolation y = isolated({{{0, -d}}, {{0, d}}}, {{{-1, 0}}, {{1, 0}}});
  EXPECT_TRUE(y.roots.size() == 1 || covered(y, 0.5, 0.5));
}

TEST(Isolate, HoldsAtTheEndsOfTheAllowedRange) {
  for (const double scale : {0x1p-300, 0x1p299}) {
    Points a = parabola, b{{{-1, 0.1}}, {{1, 0.1}}, {{3, 0.1}}};
    for (Points* c : {&a, &b})
      for (Vec2& p : *c) p *= scale / 3;
    const Isolation x = isolated(a, b);
    EXPECT_EQ(x.roots.size(), 2U);
    EXPECT_TRUE(x.open.empty());
  }
}

// A large degree: sin- and cosine-like control polygons.
TEST(Isolate, DegreeSixty) {
  Points a, b;
  for (int i = 0; i <= 60; ++i) {
    const double x = i / 60.0;
    a.push_back(Vec2{{x, 0.5 + 0.4 * x}});
    b.push_back(Vec2{{0.2 + x * x * 0.7, 1 - x}});
  }
  const Isolation x = isolated(a, b);
  ASSERT_EQ(x.roots.size(), 1U);
  EXPECT_TRUE(x.open.empty());
  EXPECT_EQ(x.roots[0].sign, -1);
}

}  // namespace
