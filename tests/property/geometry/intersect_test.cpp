// Curve intersection on random input: against polylines, under exchange, scaling and translation,
// and around closed boundaries.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/geometry/curve.hpp"
#include "support.hpp"

namespace {

using bezel::CurveIntersections;
using bezel::intersect;
using bezel::IntersectOptions;
using bezel::RandomStream;
using bezel::Vec2;
using Points = std::vector<Vec2>;
using geometry_test::evaluate;
using geometry_test::random_points;
using geometry_test::show;

constexpr double tolerances[] = {0.0, 1e-13};

struct Hit {
  double s, t, sine;
};

/// Crossings of two polylines of n chords each: an independent answer, good to about 1/n^2 where
/// the angle is not small.
std::vector<Hit> polyline_hits(const Points& a, const Points& b, int n) {
  std::vector<Vec2> p, q;
  for (int i = 0; i <= n; ++i) {
    p.push_back(evaluate(a, static_cast<double>(i) / n));
    q.push_back(evaluate(b, static_cast<double>(i) / n));
  }
  std::vector<Hit> hits;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Vec2 &p0 = p[at(i)], &p1 = p[at(i + 1)], &q0 = q[at(j)], &q1 = q[at(j + 1)];
      if (std::max(p0.x(), p1.x()) < std::min(q0.x(), q1.x()) ||
          std::max(q0.x(), q1.x()) < std::min(p0.x(), p1.x()))
        continue;
      const Vec2 u = p1 - p0, v = q1 - q0, w = q0 - p0;
      const double det = cross(u, v);
      if (det == 0) continue;
      const double x = cross(w, v) / det, y = cross(w, u) / det;
      if (x >= 0 && x < 1 && y >= 0 && y < 1)
        hits.push_back({(i + x) / n, (j + y) / n, std::fabs(det) / (norm(u) * norm(v))});
    }
  return hits;
}

TEST(IntersectProperty, RandomCurvesAgreeWithPolylines) {
  RandomStream random("RandomCurvesAgreeWithPolylines", 1);
  int compared = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const int m = 1 + static_cast<int>(random.below(6)), n = 1 + static_cast<int>(random.below(6));
    const Points a = random_points(random, m), b = random_points(random, n);
    const auto hits = polyline_hits(a, b, 400);
    for (const double tol : tolerances) {
      IntersectOptions options;
      options.coincidence_distance = tol;
      const auto found = intersect(a, b, options);
      EXPECT_TRUE(found.unresolved.empty()) << trial << show(a, b, found);
      EXPECT_TRUE(found.overlaps.empty()) << trial << show(a, b, found);
      const auto inner = [](double s) { return s > 0.01 && s < 0.99; };
      for (const Hit& h : hits) {
        if (h.sine < 0.2 || !inner(h.s) || !inner(h.t)) continue;
        ++compared;
        const auto near =
            std::count_if(found.crossings.begin(), found.crossings.end(), [&](const auto& c) {
              return std::fabs(c.s - h.s) < 3e-3 && std::fabs(c.t - h.t) < 3e-3;
            });
        EXPECT_GE(near, 1) << "missed " << h.s << " " << h.t << " in trial " << trial
                           << show(a, b, found);
      }
      for (const auto& c : found.crossings) {
        EXPECT_LE(norm(evaluate(a, c.s) - evaluate(b, c.t)), 4e-15) << trial;
        if (c.condition > 5 || !inner(c.s) || !inner(c.t)) continue;
        const auto near = std::count_if(hits.begin(), hits.end(), [&](const Hit& h) {
          return std::fabs(c.s - h.s) < 3e-3 && std::fabs(c.t - h.t) < 3e-3;
        });
        EXPECT_GE(near, 1) << "invented " << c.s << " " << c.t << " in trial " << trial
                           << show(a, b, found);
      }
      for (std::size_t i = 1; i < found.crossings.size(); ++i) {
        const auto &p = found.crossings[i - 1], &q = found.crossings[i];
        EXPECT_LE(p.s, q.s);
        EXPECT_TRUE(q.s - p.s > 1e-9 || std::fabs(q.t - p.t) > 1e-9 || p.sign != q.sign)
            << "doubled in " << trial;
      }
    }
  }
  EXPECT_GT(compared, 500);
}

struct LongPoint {
  long double x, y, dx, dy;
};

LongPoint evaluate_long(const Points& c, long double s) {
  std::vector<long double> x, y;
  for (const Vec2& p : c) {
    x.push_back(p.x());
    y.push_back(p.y());
  }
  const auto degree = static_cast<long double>(c.size() - 1);
  for (std::size_t d = c.size() - 1; d > 1; --d)
    for (std::size_t i = 0; i < d; ++i) {
      x[i] = (1 - s) * x[i] + s * x[i + 1];
      y[i] = (1 - s) * y[i] + s * y[i + 1];
    }
  return {(1 - s) * x[0] + s * x[1], (1 - s) * y[0] + s * y[1], degree * (x[1] - x[0]),
          degree * (y[1] - y[0])};
}

/// Parameters against Newton in 64-bit precision from the same control points: 4 u condition.
TEST(IntersectProperty, ParametersAreAccurateToTheirCondition) {
  RandomStream random("ParametersAreAccurateToTheirCondition", 1);
  double worst = 0;
  int compared = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    const Points a = random_points(random, 1 + static_cast<int>(random.below(5)));
    const Points b = random_points(random, 1 + static_cast<int>(random.below(5)));
    for (const auto& c : intersect(a, b).crossings) {
      long double s = c.s, t = c.t;
      for (int i = 0; i < 8; ++i) {
        const LongPoint p = evaluate_long(a, s), q = evaluate_long(b, t);
        const long double fx = p.x - q.x, fy = p.y - q.y, det = q.dx * p.dy - q.dy * p.dx;
        s += (fx * q.dy - fy * q.dx) / det;
        t += (fx * p.dy - fy * p.dx) / det;
      }
      const double error = std::max(std::fabs(static_cast<double>(s - c.s)),
                                    std::fabs(static_cast<double>(t - c.t)));
      worst = std::max(worst, error / (0x1p-53 * c.condition));
      ++compared;
    }
  }
  EXPECT_GT(compared, 1000);
  EXPECT_LE(worst, 4.0);
}

TEST(IntersectProperty, ExchangeScalingAndTranslation) {
  RandomStream random("ExchangeScalingAndTranslation", 1);
  for (int trial = 0; trial < 1000; ++trial) {
    const int m = 1 + static_cast<int>(random.below(5)), n = 1 + static_cast<int>(random.below(5));
    // Coordinates with 30 bits, so that the translation below is exact.
    const Points a = random_points(random, m, 30), b = random_points(random, n, 30);
    for (const double tol : tolerances) {
      IntersectOptions options;
      options.coincidence_distance = tol;
      const auto found = intersect(a, b, options), swapped = intersect(b, a, options);
      ASSERT_EQ(found.crossings.size(), swapped.crossings.size())
          << trial << show(a, b, found) << show(b, a, swapped);
      EXPECT_EQ(found.tangencies.size(), swapped.tangencies.size()) << trial;
      EXPECT_EQ(found.overlaps.size(), swapped.overlaps.size()) << trial;
      for (const auto& c : found.crossings) {
        const double slack = 1e-14 * std::max(1.0, c.condition);
        const auto mirrored =
            std::count_if(swapped.crossings.begin(), swapped.crossings.end(), [&](const auto& d) {
              return std::fabs(d.s - c.t) <= slack && std::fabs(d.t - c.s) <= slack &&
                     d.sign == -c.sign;
            });
        EXPECT_EQ(mirrored, 1) << trial << show(a, b, found) << show(b, a, swapped);
      }
      for (const double scale : {0x1p-300, 0x1p200}) {
        Points sa = a, sb = b;
        for (Vec2& p : sa) p *= scale;
        for (Vec2& p : sb) p *= scale;
        options.coincidence_distance = tol * scale;
        const auto scaled = intersect(sa, sb, options);
        ASSERT_EQ(scaled.crossings.size(), found.crossings.size())
            << trial << " " << scale << show(a, b, found) << show(sa, sb, scaled);
        for (std::size_t i = 0; i < found.crossings.size(); ++i) {
          EXPECT_EQ(scaled.crossings[i].s, found.crossings[i].s) << trial;
          EXPECT_EQ(scaled.crossings[i].t, found.crossings[i].t) << trial;
        }
      }
      Points ta = a, tb = b;
      for (Vec2& p : ta) p += Vec2{{0x1p20, -0x1p20}};
      for (Vec2& p : tb) p += Vec2{{0x1p20, -0x1p20}};
      options.coincidence_distance =
          tol == 0 ? 0 : 1e-9;  // above the rounding of the moved coordinates
      const auto moved = intersect(ta, tb, options);
      ASSERT_EQ(moved.crossings.size(), found.crossings.size())
          << trial << show(a, b, found) << show(ta, tb, moved);
    }
  }
}

/// Around two closed curved triangles b enters a as often as it leaves.
TEST(IntersectProperty, ClosedBoundariesCrossAnEvenNumberOfTimes) {
  RandomStream random("ClosedBoundariesCrossAnEvenNumberOfTimes", 1);
  for (int trial = 0; trial < 2000; ++trial) {
    const int g = 1 + static_cast<int>(random.below(4));
    std::vector<Points> boundary[2];
    for (auto& sides : boundary) {
      Points corners(3);
      for (Vec2& p : corners) p = Vec2{{random.uniform(), random.uniform()}};
      for (std::size_t k = 0; k < 3; ++k) {
        Points side;
        for (int i = 0; i <= g; ++i) {
          const double x = static_cast<double>(i) / g;
          Vec2 p = (1 - x) * corners[k] + x * corners[(k + 1) % 3];
          if (i > 0 && i < g) p += Vec2{{random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2)}};
          side.push_back(p);
        }
        side.front() = corners[k];
        side.back() = corners[(k + 1) % 3];
        sides.push_back(side);
      }
    }
    for (const double tol : tolerances) {
      IntersectOptions options;
      options.coincidence_distance = tol;
      int signs = 0, count = 0;
      for (const Points& a : boundary[0])
        for (const Points& b : boundary[1]) {
          const auto found = intersect(a, b, options);
          for (const auto& c : found.crossings) {
            EXPECT_NE(c.sign, 0);
            signs += c.sign;
            ++count;
          }
          EXPECT_TRUE(found.overlaps.empty() && found.unresolved.empty());
        }
      EXPECT_EQ(signs, 0) << trial << " degree " << g << " tol " << tol;
      EXPECT_EQ(count % 2, 0) << trial;
    }
  }
}

/// Curves moved by a jitter stay overlapped while it is well below the coincidence distance, and
/// what is reported for any jitter is a consistent picture.
TEST(IntersectProperty, JitteredCopies) {
  RandomStream random("JitteredCopies", 1);
  IntersectOptions options;
  options.coincidence_distance = 1e-13;
  for (int exponent = -17; exponent <= -1; ++exponent) {
    const double jitter = std::pow(10.0, exponent);
    for (int trial = 0; trial < 300; ++trial) {
      const int g = 1 + static_cast<int>(random.below(3));
      Points a;
      for (int i = 0; i <= g; ++i)
        a.push_back(
            Vec2{{static_cast<double>(i) / g, i % g == 0 ? 0.0 : random.uniform(-0.2, 0.2)}});
      Points b = a;
      for (Vec2& p : b) p += Vec2{{jitter * random.uniform(-1, 1), jitter * random.uniform(-1, 1)}};
      const bool reversed = random.below(2) == 1;
      if (reversed) std::reverse(b.begin(), b.end());
      const auto found = intersect(a, b, options);
      EXPECT_TRUE(found.unresolved.empty()) << jitter << show(a, b, found);
      if (exponent <= -14) {
        ASSERT_EQ(found.overlaps.size(), 1u) << jitter << show(a, b, found);
        EXPECT_EQ(found.overlaps[0].s0, 0.0);
        EXPECT_EQ(found.overlaps[0].s1, 1.0);
        EXPECT_EQ(found.overlaps[0].t0, reversed ? 1.0 : 0.0);
        EXPECT_EQ(found.overlaps[0].t1, reversed ? 0.0 : 1.0);
        EXPECT_TRUE(found.crossings.empty() && found.tangencies.empty()) << show(a, b, found);
      }
      if (exponent >= -4) {
        EXPECT_TRUE(found.overlaps.empty()) << jitter << show(a, b, found);
      }
      // The ends of an overlap are where the distance passes 1e-13, known to 1/32 of it.
      for (const auto& o : found.overlaps) {
        EXPECT_LT(o.s0, o.s1);
        EXPECT_EQ(o.t0 > o.t1, reversed);
        EXPECT_LE(norm(evaluate(a, o.s0) - evaluate(b, o.t0)), 1.04e-13) << show(a, b, found);
        EXPECT_LE(norm(evaluate(a, o.s1) - evaluate(b, o.t1)), 1.04e-13) << show(a, b, found);
        for (const auto& c : found.crossings)
          EXPECT_TRUE(c.s < o.s0 || c.s > o.s1) << jitter << show(a, b, found);
      }
      for (std::size_t i = 1; i < found.overlaps.size(); ++i)
        EXPECT_LT(found.overlaps[i - 1].s1, found.overlaps[i].s0) << jitter << show(a, b, found);
    }
  }
}

/// Graphs y = f(x) and y = f(x) + e h(x), e from 1e-17 to 1, b on its own interval, either way
/// round: the events must tell the story of the sign of h, which is known.
TEST(IntersectProperty, PerturbedGraphs) {
  RandomStream random("PerturbedGraphs", 1);
  constexpr double tol = 1e-13;
  int overlaps = 0, crossings = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const int degree = 1 + static_cast<int>(random.below(4));
    const double scale = std::pow(10.0, random.uniform(-17, 0));
    // h has roots where its random Bernstein coefficients change sign; sometimes a double one.
    std::vector<double> f, h;
    for (int i = 0; i <= degree; ++i) {
      f.push_back(random.uniform(-0.2, 0.2));
      h.push_back(scale * random.uniform(-1, 1));
    }
    if (degree == 2 && random.below(3) == 0) {
      const double r = random.uniform();
      h = {scale * r * r, -scale * r * (1 - r), scale * (1 - r) * (1 - r)};
    }
    double x0 = 0, x1 = 1;  // b's interval of a's parameter
    const auto kind = random.below(4);
    if (kind == 1) x0 = random.uniform(-0.5, 0.5), x1 = random.uniform(0.6, 1.5);
    if (kind == 2) x1 = random.uniform(0.2, 1);
    if (kind == 3) x0 = 0.25, x1 = 0.75;
    Points a, whole;
    for (int i = 0; i <= degree; ++i) {
      const auto k = static_cast<std::size_t>(i);
      a.push_back(Vec2{{static_cast<double>(i) / degree, f[k]}});
      whole.push_back(Vec2{{static_cast<double>(i) / degree, f[k] + h[k]}});
    }
    Points b = kind == 0 ? whole : geometry_test::part(whole, x0, x1);
    const bool reversed = random.below(2) == 1;
    if (reversed) std::reverse(b.begin(), b.end());
    IntersectOptions options;
    options.coincidence_distance = tol;
    const auto found = intersect(a, b, options);
    const auto gap = [&](double s) { return evaluate(whole, s).y() - evaluate(a, s).y(); };
    EXPECT_TRUE(found.unresolved.empty()) << trial << show(a, b, found);
    overlaps += static_cast<int>(found.overlaps.size());
    crossings += static_cast<int>(found.crossings.size());
    for (std::size_t i = 0; i < found.overlaps.size(); ++i) {
      const auto& o = found.overlaps[i];
      EXPECT_EQ(o.t0 > o.t1, reversed) << trial << show(a, b, found);
      for (int k = 0; k <= 10; ++k) {
        // Vertical distance is at most 1.95 times the perpendicular one at these slopes, |f'|
        // <= 1.6. < 1.3).
        EXPECT_LE(std::fabs(gap(o.s0 + (o.s1 - o.s0) * k / 10)), 1.95 * 1.04 * tol)
            << trial << show(a, b, found);
      }
      for (const auto& c : found.crossings)
        EXPECT_FALSE(c.s >= o.s0 && c.s <= o.s1) << trial << show(a, b, found);
      if (i > 0) {
        EXPECT_LT(found.overlaps[i - 1].s1, o.s0) << trial << show(a, b, found);
      }
    }
    // Between samples clear of the band, the signs of the crossings add up, unless an overlap lies
    // between.
    const double lo = std::max(0.0, x0), hi = std::min(1.0, x1);
    double last = -1;
    for (int k = 1; k < 60; ++k) {
      const double s = lo + (hi - lo) * k / 60;
      if (std::fabs(gap(s)) < 2 * tol) continue;
      if (last >= 0) {
        int sum = 0, unknown = 0;
        for (const auto& c : found.crossings)
          if (c.s > last && c.s < s) {
            sum += reversed ? -c.sign : c.sign;
            unknown += c.sign == 0;
          }
        bool overlap = false;
        for (const auto& o : found.overlaps) overlap = overlap || (o.s1 > last && o.s0 < s);
        const int expected = (gap(s) > 0) - (gap(last) > 0);
        if (!overlap && unknown == 0) {
          EXPECT_EQ(sum, expected)
              << trial << " between " << last << " and " << s << show(a, b, found);
        }
      }
      last = s;
    }
  }
  EXPECT_GT(overlaps, 1000);
  EXPECT_GT(crossings, 1000);
}

}  // namespace
