#include "bezel/geometry/quick_crossing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "bezel/base/random.hpp"

namespace bezel::geometry_kernel {
namespace {

Meeting meet(const std::vector<Vec2>& a, const std::vector<Vec2>& b, QuickCrossing& out,
             double distance = 0.0) {
  return meet_quickly(cache_curve(a), cache_curve(b), distance, out);
}

TEST(QuickCrossing, StraightEdges) {
  QuickCrossing c{};
  const std::vector<Vec2> a = {{{0, 0}}, {{2, 0}}};
  EXPECT_EQ(meet(a, {{{0.5, -1}}, {{0.5, 3}}}, c), Meeting::crossing);
  EXPECT_EQ(c.s, 0.25);
  EXPECT_EQ(c.t, 0.25);
  EXPECT_EQ(c.sign, 1);
  EXPECT_EQ(c.gap, 0.0);
  EXPECT_EQ(meet(a, {{{0.5, 3}}, {{0.5, -1}}}, c), Meeting::crossing);
  EXPECT_EQ(c.sign, -1);
  EXPECT_EQ(meet(a, {{{0.5, 1e-12}}, {{0.7, 1}}}, c), Meeting::none);
  EXPECT_EQ(meet(a, {{{0.5, 1e-12}}, {{0.7, 1}}}, c, 1e-11), Meeting::unclear);
  EXPECT_EQ(meet(a, {{{0.5, 0}}, {{0.7, 1}}}, c), Meeting::unclear);       // an end on the edge
  EXPECT_EQ(meet(a, {{{0, -1}}, {{0, 1}}}, c), Meeting::unclear);          // through an end
  EXPECT_EQ(meet(a, {{{0, -0.001}}, {{2, 0.001}}}, c), Meeting::unclear);  // nearly parallel
  EXPECT_EQ(meet(a, a, c), Meeting::unclear);
}

TEST(QuickCrossing, APointIsUnclearOrApart) {
  QuickCrossing c{};
  const std::vector<Vec2> a = {{{0, 0}}, {{2, 0}}}, p = {{{1, 0}}, {{1, 0}}};
  EXPECT_EQ(meet(a, p, c), Meeting::unclear);
  EXPECT_EQ(meet(p, p, c), Meeting::unclear);
  EXPECT_EQ(meet(a, {{{1, 0}}}, c), Meeting::unclear);
}

// Against the exact method: what is decided is right, and most pairs are decided.
TEST(QuickCrossing, AgreesWithTheExactMethod) {
  for (const auto& [m, n] : {std::array{1, 1}, {2, 2}, {3, 3}, {1, 2}, {3, 2}, {5, 4}, {10, 10}}) {
    RandomStream random("quick crossing", static_cast<std::uint64_t>(100 * m + n));
    int decided = 0;
    const int runs = 2000;
    for (int run = 0; run < runs; ++run) {
      const auto edge = [&](int degree) {
        const Vec2 from{{random.uniform(-1, 1), random.uniform(-1, 1)}};
        const Vec2 to{{random.uniform(-1, 1), random.uniform(-1, 1)}};
        std::vector<Vec2> p;
        for (int i = 0; i <= degree; ++i) {
          p.push_back(from + (to - from) * (double(i) / degree));
          if (i > 0 && i < degree)
            p.back() += Vec2{{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)}};
        }
        return p;
      };
      const std::vector<Vec2> a = edge(m), b = edge(n);
      QuickCrossing c{};
      const Meeting meeting = meet(a, b, c);
      if (meeting == Meeting::unclear) continue;
      ++decided;
      const CurveIntersections exact = intersect(a, b);
      ASSERT_TRUE(exact.tangencies.empty() && exact.overlaps.empty() && exact.unresolved.empty());
      if (meeting == Meeting::none) {
        EXPECT_TRUE(exact.crossings.empty()) << m << n << " run " << run;
        continue;
      }
      ASSERT_EQ(exact.crossings.size(), 1U) << m << n << " run " << run;
      const Crossing& truth = exact.crossings.front();
      EXPECT_EQ(c.sign, truth.sign);
      const double allowed = (8 + std::max(m, n)) * 0x1p-53 * (1.0 + truth.condition);
      EXPECT_NEAR(c.s, truth.s, allowed);
      EXPECT_NEAR(c.t, truth.t, allowed);
      EXPECT_LE(c.gap, 1e-13);
    }
    EXPECT_GE(decided, m == 1 && n == 1 ? runs * 95 / 100 : runs / 2) << m << n;
  }
}

// Two crossings are never taken for one or none.
TEST(QuickCrossing, ADoubleCrossingIsNotDecided) {
  QuickCrossing c{};
  const std::vector<Vec2> line = {{{0, 0}}, {{1, 0}}};
  for (const double height : {0.3, 0.1, 0.01, 1e-3, 1e-6, 1e-9}) {
    const std::vector<Vec2> arch = {{{0.1, -height}}, {{0.5, 3 * height}}, {{0.9, -height}}};
    EXPECT_EQ(meet(line, arch, c), Meeting::unclear) << height;
    EXPECT_EQ(meet(arch, line, c), Meeting::unclear) << height;
  }
}

TEST(QuickCrossing, SlopesOfTheCache) {
  const CurveCache straight = cache_curve(std::vector<Vec2>{{{0, 0}}, {{1, 1}}});
  EXPECT_EQ(straight.slope_lo, 0.0);
  EXPECT_EQ(straight.slope_hi, 0.0);
  // y = x (1 - x) has slopes 1 - 2 x: 1.5 at -1/4, -1.5 at 5/4.
  const std::vector<Vec2> parabola = {{{0, 0}}, {{0.5, 0.5}}, {{1, 0}}};
  const CurveCache bent = cache_curve(parabola);
  EXPECT_NEAR(bent.slope_lo, -1.5, 1e-15);
  EXPECT_NEAR(bent.slope_hi, 1.5, 1e-15);
  EXPECT_EQ(bent.diameter, bent.box.diameter());
  const std::vector<Vec2> hook = {{{0, 0}}, {{2, 1}}, {{1, 0}}};
  EXPECT_EQ(cache_curve(hook).slope_hi, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace bezel::geometry_kernel
