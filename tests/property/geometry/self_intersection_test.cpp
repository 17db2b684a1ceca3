// Self-intersections of random curves of degree 2 to 10 against crossings of dense polylines, under
// reversal, scaling and translation, and at the exact places of constructed cusps.
#include "bezel/geometry/self_intersection.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "property/geometry/support.hpp"

namespace {

using bezel::RandomStream;
using bezel::self_intersections;
using bezel::SelfIntersections;
using bezel::Vec2;
using geometry_test::evaluate;
using geometry_test::Points;
using geometry_test::random_points;

constexpr double u = 0x1p-53;

struct Pair {
  double s, t;
};

/// Proper crossings of two segments of a polyline of n pieces, neighbours left out.
std::vector<Pair> polyline_crossings(const Points& c, int n) {
  std::vector<Vec2> p;
  for (int k = 0; k <= n; ++k) p.push_back(evaluate(c, k / static_cast<double>(n)));
  std::vector<Pair> out;
  for (std::size_t i = 0; i + 1 < p.size(); ++i)
    for (std::size_t j = i + 2; j + 1 < p.size(); ++j) {
      const Vec2 a = p[i + 1] - p[i], b = p[j + 1] - p[j], d = p[j] - p[i];
      const double det = cross(a, b);
      if (det == 0) continue;
      const double x = cross(d, b) / det, y = cross(d, a) / det;
      if (x >= 0 && x < 1 && y >= 0 && y < 1)
        out.push_back({(static_cast<double>(i) + x) / n, (static_cast<double>(j) + y) / n});
    }
  return out;
}

TEST(SelfIntersectionProperty, RandomCurvesAgainstPolylines) {
  RandomStream random("SelfIntersectionProperty.Polylines", 1);
  int with = 0, several = 0, compared = 0;
  for (int run = 0; run < 1500; ++run) {
    const int degree = 2 + run % 9;
    const Points c = random_points(random, degree);
    const auto found = self_intersections(c);
    EXPECT_FALSE(found.closed);
    EXPECT_TRUE(found.cusps.empty()) << run;
    EXPECT_TRUE(found.pairs.unresolved.empty()) << run << geometry_test::show(c, {}, found.pairs);
    for (const auto& x : found.pairs.crossings) {
      EXPECT_TRUE(x.certified) << run;
      EXPECT_LT(x.s, x.t);
      EXPECT_LE(norm(evaluate(c, x.s) - evaluate(c, x.t)), 16 * degree * u) << run;
    }
    with += found.pairs.crossings.empty() ? 0 : 1;
    several += found.pairs.crossings.size() > 1 ? 1 : 0;
    // Parabolas have none.
    EXPECT_TRUE(degree > 2 || found.pairs.crossings.empty());
    // A polyline may miss loops smaller than its steps and shallow pairs, but not clear ones; and
    // it must not see what was not found.
    const int n = 300;
    const auto seen = polyline_crossings(c, n);
    const auto clear = [&](const bezel::Crossing& x) {
      return x.t - x.s > 0.05 && x.condition < 200 && x.s > 0.02 && x.t < 0.98;
    };
    for (const auto& x : found.pairs.crossings)
      if (clear(x)) {
        EXPECT_TRUE(std::any_of(seen.begin(), seen.end(), [&](const Pair& p) {
          return std::fabs(p.s - x.s) < 0.02 && std::fabs(p.t - x.t) < 0.02;
        })) << run;
      }
    for (const Pair& p : seen) {
      if (p.t - p.s < 0.05 || p.s < 0.02 || p.t > 0.98) continue;
      const Vec2 a = evaluate(c, p.s + 1e-3) - evaluate(c, p.s - 1e-3),
                 b = evaluate(c, p.t + 1e-3) - evaluate(c, p.t - 1e-3);
      if (std::fabs(cross(a, b)) < 0.1 * norm(a) * norm(b) || norm(a) < 4e-4 || norm(b) < 4e-4)
        continue;
      ++compared;
      EXPECT_TRUE(std::any_of(found.pairs.crossings.begin(), found.pairs.crossings.end(),
                              [&](const bezel::Crossing& x) {
                                return std::fabs(p.s - x.s) < 0.02 && std::fabs(p.t - x.t) < 0.02;
                              }))
          << run << ' ' << p.s << ' ' << p.t;
    }
  }
  EXPECT_GT(with, 300);
  EXPECT_GT(several, 50);
  EXPECT_GT(compared, 300);
}

TEST(SelfIntersectionProperty, ReversalScalingTranslation) {
  RandomStream random("SelfIntersectionProperty.Maps", 1);
  int crossings = 0;
  for (int run = 0; run < 1000; ++run) {
    const Points c = random_points(random, 3 + static_cast<int>(random.below(7)), 30);
    const auto found = self_intersections(c);
    const double scale = std::ldexp(1.0, static_cast<int>(random.below(1600)) - 800);
    Points mapped;
    for (const Vec2& q : c) mapped.push_back(scale * (q + Vec2{{1 << 8, -(1 << 8)}}));
    const auto same = self_intersections(mapped);
    const auto back = self_intersections(Points(c.rbegin(), c.rend()));
    ASSERT_EQ(found.pairs.crossings.size(), same.pairs.crossings.size()) << run;
    ASSERT_EQ(found.pairs.crossings.size(), back.pairs.crossings.size()) << run;
    EXPECT_TRUE(same.pairs.unresolved.empty() && back.pairs.unresolved.empty()) << run;
    for (const auto& x : found.pairs.crossings) {
      ++crossings;
      // Rounding is relative to the coordinates: up to 257 times larger after the translation.
      const auto close = [&](double s, double t, int sign, double factor) {
        return std::fabs(s - x.s) <= factor * u * x.condition &&
               std::fabs(t - x.t) <= factor * u * x.condition && sign == x.sign;
      };
      EXPECT_TRUE(
          std::any_of(same.pairs.crossings.begin(), same.pairs.crossings.end(),
                      [&](const bezel::Crossing& y) { return close(y.s, y.t, y.sign, 8.0 * 257); }))
          << run;
      // Reversed, (s, t) is (1 - t, 1 - s): both tangents and their order turn round.
      EXPECT_TRUE(std::any_of(
          back.pairs.crossings.begin(), back.pairs.crossings.end(),
          [&](const bezel::Crossing& y) { return close(1 - y.t, 1 - y.s, -y.sign, 8.0); }))
          << run;
    }
  }
  EXPECT_GT(crossings, 200);
}

TEST(SelfIntersectionProperty, CuspsAtBinaryFractions) {
  // Hodographs (s - r)^2 p(s) + (s - r) q with r = k / 8: an ordinary cusp at r, built exactly.
  RandomStream random("SelfIntersectionProperty.Cusps", 1);
  for (int run = 0; run < 300; ++run) {
    const double r = static_cast<double>(1 + random.below(7)) / 8;
    const auto integer = [&] { return static_cast<double>(random.below(17)) - 8; };
    // Derivative, monomials in x = s - r: a x + b x^2, so the cubic has a cusp at r; integrated and
    // shifted to s, times 6 for control points that are doubles.
    const Vec2 a{{integer(), integer()}}, b{{integer(), integer()}};
    if (cross(a, b) == 0) continue;
    const auto value = [&](double x, double y, double z) {
      // Blossom of a x^2 / 2 + b x^3 / 3, times 6, with arguments relative to r.
      return (x * y + y * z + z * x) * a + 2.0 * x * y * z * b;
    };
    const double lo = -r, hi = 1 - r;
    const Points c{value(lo, lo, lo), value(lo, lo, hi), value(lo, hi, hi), value(hi, hi, hi)};
    const auto found = self_intersections(c);
    ASSERT_EQ(found.cusps.size(), 1u) << run;
    EXPECT_EQ(found.cusps[0].lo, r);
    EXPECT_EQ(found.cusps[0].hi, r);
    EXPECT_TRUE(found.cusps[0].proven);
    // A cubic with a cusp has no double point besides it.
    EXPECT_TRUE(found.pairs.crossings.empty() && found.pairs.unresolved.empty())
        << run << geometry_test::show(c, {}, found.pairs);
  }
}

}  // namespace
