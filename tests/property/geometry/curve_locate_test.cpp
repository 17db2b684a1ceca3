// Points near and on random curves of degree 1 to 10, against dense sampling and exact values.
#include "bezel/geometry/curve_locate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bezel/bernstein/exact.hpp"
#include "property/geometry/support.hpp"

namespace {

using bezel::CurveLocateResult;
using bezel::CurveLocation;
using bezel::Dyadic;
using bezel::locate;
using bezel::RandomStream;
using bezel::Vec2;
using geometry_test::evaluate;
using geometry_test::Points;
using geometry_test::random_points;

constexpr double u = 0x1p-53;

/// The value at s exactly, rounded once.
Vec2 exact_point(const Points& c, double s) {
  Vec2 out;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> b;
    for (const Vec2& p : c) b.push_back(p[axis]);
    out[axis] = bezel::bernstein::ExactPolynomial(b)(Dyadic(s)).to_double();
  }
  return out;
}

TEST(CurveLocateProperty, VerdictsAgreeWithSampling) {
  RandomStream random("CurveLocateProperty.Sampling", 1);
  int counts[3] = {};
  for (int run = 0; run < 4000; ++run) {
    const int degree = 1 + static_cast<int>(random.below(10));
    const Points c = random_points(random, degree);
    const double tolerance = std::pow(10.0, random.uniform(-9, -0.5));
    Vec2 p{{random.uniform(), random.uniform()}};
    if (run % 2 == 0) {  // near the curve, at up to twice the tolerance
      const double angle = random.uniform(0, 6.3), r = random.uniform(0, 2) * tolerance;
      p = evaluate(c, random.uniform()) + r * Vec2{{std::cos(angle), std::sin(angle)}};
    }
    const auto found = locate(c, p, tolerance);
    ++counts[static_cast<int>(found.status)];
    const double slack = 8 * degree * u;  // of the test's own evaluation
    if (found.status == CurveLocation::off) {
      EXPECT_TRUE(found.contacts.empty());
      EXPECT_GT(found.distance_lower_bound, tolerance) << run;
    }
    double nearest = 1e300;
    const int n = 2000;
    for (int k = 0; k <= n; ++k) {
      const double s = k / static_cast<double>(n), distance = norm(evaluate(c, s) - p);
      nearest = std::min(nearest, distance);
      if (found.status == CurveLocation::off) {
        ASSERT_GE(distance, found.distance_lower_bound - slack) << run << ' ' << s;
      }
      const bool covered =
          std::any_of(found.contacts.begin(), found.contacts.end(),
                      [&](const bezel::CurveContact& x) { return x.lo <= s && s <= x.hi; });
      if (distance <= tolerance - slack) {
        ASSERT_TRUE(covered) << run << ' ' << s;
      }
      if (distance > (1 + 1.0 / 32) * tolerance + 1e-12) {
        ASSERT_FALSE(covered) << run << ' ' << s;
      }
    }
    // The step's chord stays within 2 d (d-1) / 8 n^2 of the curve.
    if (found.status == CurveLocation::off && nearest > 3 * tolerance) {
      EXPECT_GE(found.distance_lower_bound, 0.49 * (nearest - 2.0 * degree / n)) << run;
    }
    for (std::size_t i = 0; i < found.contacts.size(); ++i) {
      const auto& x = found.contacts[i];
      EXPECT_TRUE(x.lo <= x.s && x.s <= x.hi);
      if (i > 0) {
        EXPECT_LT(found.contacts[i - 1].hi, x.lo);
      }
      EXPECT_LE(norm(evaluate(c, x.s) - p), x.distance_bound + slack) << run;
      EXPECT_EQ(x.proven, x.distance_bound <= tolerance);
    }
  }
  EXPECT_GT(counts[0], 1000);
  EXPECT_GT(counts[1], 1000);
  EXPECT_EQ(counts[2], 0);
}

TEST(CurveLocateProperty, ScalingTranslationReversal) {
  RandomStream random("CurveLocateProperty.Maps", 1);
  for (int run = 0; run < 1000; ++run) {
    const Points c = random_points(random, 1 + static_cast<int>(random.below(10)), 30);
    const Vec2 p = random_points(random, 0, 30)[0];
    const double tolerance =
        run % 3 == 0 ? 0.0 : std::ldexp(1.0, -static_cast<int>(random.below(12)));
    const auto found = locate(c, p, tolerance);
    const double scale = std::ldexp(1.0, static_cast<int>(random.below(1200)) - 600);
    Points mapped, reversed(c.rbegin(), c.rend());
    const Vec2 shift{{1 << 8, -(1 << 8)}};
    for (const Vec2& q : c) mapped.push_back(scale * (q + shift));
    const auto same = locate(mapped, scale * (p + shift), scale * tolerance);
    const auto back = locate(reversed, p, tolerance);
    EXPECT_EQ(found.status, same.status) << run;
    EXPECT_EQ(found.status, back.status) << run;
    EXPECT_NEAR(same.distance_lower_bound / scale, found.distance_lower_bound, 1e-9);
    ASSERT_EQ(found.contacts.size(), same.contacts.size());
    ASSERT_EQ(found.contacts.size(), back.contacts.size());
    for (std::size_t i = 0; i < found.contacts.size(); ++i) {
      EXPECT_EQ(found.contacts[i].lo, same.contacts[i].lo);
      EXPECT_EQ(found.contacts[i].hi, same.contacts[i].hi);
      const auto& mirror = back.contacts[found.contacts.size() - 1 - i];
      EXPECT_EQ(found.contacts[i].lo, 1 - mirror.hi) << run;
    }
  }
}

TEST(CurveLocateProperty, ExactIncidence) {
  RandomStream random("CurveLocateProperty.Exact", 1);
  for (int run = 0; run < 1500; ++run) {
    const int degree = 1 + static_cast<int>(random.below(10));
    // Integers below 2^8 and s = k / 16: the points are doubles.
    Points c;
    for (int i = 0; i <= degree; ++i)
      c.push_back(
          Vec2{{static_cast<double>(random.below(256)), static_cast<double>(random.below(256))}});
    const double s = static_cast<double>(random.below(17)) / 16;
    const Vec2 p = exact_point(c, s);
    const auto found = locate(c, p);
    ASSERT_EQ(found.status, CurveLocation::on) << run;
    EXPECT_TRUE(std::any_of(
        found.contacts.begin(), found.contacts.end(),
        [&](const bezel::CurveContact& x) { return x.lo == s && x.hi == s && x.proven; }))
        << run;
    // The same curve moved by one part in 2^53 of a control point that counts.
    if (s == 0.0 || s == 1.0 || degree == 1) continue;  // a line may move along itself
    Points moved = c;
    moved[1][0] = std::nextafter(c[1][0], 1000.0);
    const auto beside = locate(moved, p);
    // Off, unless another branch passes through p: then that was there before.
    EXPECT_EQ(beside.status, found.contacts.size() > 1 ? beside.status : CurveLocation::off) << run;
  }
}

TEST(CurveLocateProperty, DoubledPrecisionCannotTellButExactCan) {
  // Rounded points of random curves are hardly ever on them: off, though nothing in doubles tells.
  RandomStream random("CurveLocateProperty.Rounded", 1);
  for (int run = 0; run < 500; ++run) {
    const Points c = random_points(random, 2 + static_cast<int>(random.below(9)));
    const double s = random.uniform();
    const Vec2 p = exact_point(c, s);
    EXPECT_EQ(locate(c, p).status, CurveLocation::off) << run;
    EXPECT_EQ(locate(c, p, 1e-12).status, CurveLocation::on) << run;
  }
}

}  // namespace
