// The nearest point of random and degenerate curves against the exact roots of the distance's
// derivative, dense sampling, scaling and symmetry.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/curve_shape.hpp"
#include "property/geometry/support.hpp"
#include "support/exact_roots.hpp"

namespace {

using bezel::foot_point;
using bezel::FootPoint;
using bezel::RandomStream;
using bezel::Vec2;
using geometry_test::evaluate;
using geometry_test::Points;
using geometry_test::random_points;
using support::Polynomial;

constexpr double u = 0x1p-53;

/// 2^shift times the coordinate minus that of p, in powers of s, as integers; shift makes them so.
Polynomial coordinate(const Points& c, double origin, int axis, unsigned long shift) {
  std::vector<mpz_class> b;
  for (const Vec2& q : c) {
    mpq_class x(q[axis]);
    x -= mpq_class(origin);
    mpq_mul_2exp(x.get_mpq_t(), x.get_mpq_t(), shift);
    EXPECT_EQ(x.get_den(), 1);
    b.push_back(x.get_num());
  }
  // C(d, k) times the k-th difference.
  Polynomial a;
  mpz_class binomial = 1;
  const std::size_t d = c.size() - 1;
  for (std::size_t k = 0; k <= d; ++k) {
    a.push_back(binomial * b[0]);
    for (std::size_t i = 0; i + 1 < b.size(); ++i) b[i] = b[i + 1] - b[i];
    b.pop_back();
    binomial = binomial * static_cast<unsigned long>(d - k) / static_cast<unsigned long>(k + 1);
  }
  return a;
}

struct Foot {
  double s, distance;
};
/// The ends and all places where the derivative of the distance vanishes, by exact arithmetic.
std::vector<Foot> exact_feet(const Points& c, const Vec2& p) {
  unsigned long shift = 0;
  for (int axis = 0; axis < 2; ++axis)
    for (const Vec2& q : c) {
      const mpq_class x = mpq_class(q[axis]) - mpq_class(p[axis]);
      shift = std::max(shift, static_cast<unsigned long>(mpz_sizeinbase(x.get_den_mpz_t(), 2) - 1));
    }
  Polynomial f(2 * c.size() - 1);
  for (int axis = 0; axis < 2; ++axis) {
    const Polynomial x = coordinate(c, p[axis], axis, shift);
    for (std::size_t i = 0; i < x.size(); ++i)
      for (std::size_t j = 0; j < x.size(); ++j) f[i + j] += x[i] * x[j];
  }
  support::trim(f);
  std::vector<Foot> feet;
  const auto add = [&](const mpq_class& s) {
    mpq_class value = 0;
    for (std::size_t i = f.size(); i-- > 0;) value = value * s + f[i];
    // The root of a multiple of 4^-shift, to 256 bits.
    mpf_class root(0, 256);
    mpf_set_q(root.get_mpf_t(), value.get_mpq_t());
    root = sqrt(root);
    mpf_div_2exp(root.get_mpf_t(), root.get_mpf_t(), shift);
    feet.push_back({s.get_d(), root.get_d()});
  };
  add(0);
  add(1);
  const Polynomial slope = support::primitive(support::derivative(f));
  if (slope.size() > 1)
    for (const Polynomial& factor : support::squarefree_factors(slope))
      for (support::RealRoot& root : support::roots_in_unit_interval(factor)) {
        root.refine(200);
        add(root.middle());
      }
  return feet;
}

double largest_offset(const Points& c, const Vec2& p) {
  double size = 0;
  for (const Vec2& q : c)
    size = std::max(size, std::max(std::fabs(q.x() - p.x()), std::fabs(q.y() - p.y())));
  return size;
}
/// De Casteljau on the rounded differences to p.
double distance_bound(const Points& c, const Vec2& p) {
  return 4.0 * static_cast<double>(c.size()) * u * largest_offset(c, p);
}
double nearest(const std::vector<Foot>& feet) {
  double best = feet[0].distance;
  for (const Foot& f : feet) best = std::min(best, f.distance);
  return best;
}

/// The distance, and that s belongs to one of the nearest feet.
void check(const Points& c, const Vec2& p, const char* what) {
  SCOPED_TRACE(testing::Message() << what << geometry_test::show(c, {p}, {}));
  const FootPoint found = foot_point(c, p);
  const std::vector<Foot> feet = exact_feet(c, p);
  const double bound = distance_bound(c, p), best = nearest(feet);
  EXPECT_NEAR(found.distance, best, bound);
  // c . c' is known to (4 d + 4) u size times the largest difference of control points, d times.
  Points hodograph;
  double speed = 0;
  const double d = static_cast<double>(c.size()) - 1.0;
  for (std::size_t i = 1; i < c.size(); ++i) {
    hodograph.push_back(d * (c[i] - c[i - 1]));
    speed = std::max(speed, norm(hodograph.back()));
  }
  Points second;
  for (std::size_t i = 1; i < hodograph.size(); ++i)
    second.push_back((d - 1.0) * (hodograph[i] - hodograph[i - 1]));
  bool known = false;
  for (const Foot& f : feet) {
    if (f.distance > best + 2 * bound) continue;
    const Vec2 value = evaluate(c, f.s) - p, first = evaluate(hodograph, f.s);
    const double curvature =
        dot(first, first) + (second.empty() ? 0.0 : dot(value, evaluate(second, f.s)));
    const double error = 4.0 * (d + 1.0) * u * largest_offset(c, p) * speed;
    // Flat minima: what the distance allows.
    const double slack = curvature > 1e-6 * speed * speed ? error / curvature + 2 * u : 1e-2;
    known = known || std::fabs(found.s - f.s) <= slack;
  }
  EXPECT_TRUE(known) << found.s;
  EXPECT_LE(norm(found.point - evaluate(c, found.s)), bound + 8 * d * u);
}

TEST(FootPointProperty, AgreesWithExactArithmetic) {
  RandomStream random("FootPointProperty.AgreesWithExactArithmetic", 1);
  for (int d = 1; d <= 8; ++d)
    for (int trial = 0; trial < 30; ++trial) {
      const Points c = random_points(random, d);
      check(c, random_points(random, 0)[0], "somewhere");
      check(c, evaluate(c, random.uniform()), "on the curve");
      const double off = std::exp2(-50.0 * random.uniform());
      check(c, evaluate(c, random.uniform()) + off * random_points(random, 0)[0], "near the curve");
      check(c, c[static_cast<std::size_t>(random.below(c.size()))], "a control point");
    }
}

/// Where the derivative of the distance has a multiple root, or vanishes nearly everywhere.
TEST(FootPointProperty, DegenerateCurves) {
  const std::vector<std::pair<Points, Vec2>> cases{
      {{{{-1, 1}}, {{0, -1}}, {{1, 1}}}, {{0, 0.5}}},             // centre of curvature
      {{{{-1, 1}}, {{0, -1}}, {{1, 1}}}, {{0, 0}}},               // the vertex itself
      {{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}}, {{0.5, 0.75}}},  // a cusp
      {{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}}, {{0.5, 2}}},     // seen from beyond a cusp
      {{{{0, 0}}, {{2, 0}}, {{0, 0}}}, {{1, 0}}},                 // there and back
      {{{{0, 0}}, {{2, 0}}, {{0, 0}}}, {{0.5, 1}}},
      {{{{0, 0}}, {{1, 2}}, {{-1, 2}}, {{0, 0}}}, {{0, 0}}},        // closed, at its joint
      {{{{0, 0}}, {{2, 1}}, {{-1, 1}}, {{1, 0}}}, {{0.5, 0.625}}},  // a loop
      {{{{3, 4}}, {{3, 4}}, {{3, 4}}}, {{0, 0}}},                   // a point
      {{{{3, 4}}, {{3, 4}}, {{3, 4}}}, {{3, 4}}},
      {{{{0, 0}}, {{0, 0}}, {{0, 0}}, {{1, 1}}}, {{0, 0}}},
      {{{{0, 0}}, {{0, 0}}, {{1, 1}}, {{1, 1}}}, {{1, 0}}},
  };
  for (const auto& [c, p] : cases) {
    const FootPoint found = foot_point(c, p);
    const std::vector<Foot> feet = exact_feet(c, p);
    SCOPED_TRACE(geometry_test::show(c, {p}, {}));
    EXPECT_NEAR(found.distance, nearest(feet), distance_bound(c, p));
    double smallest = 1;
    for (const Foot& f : feet)
      if (f.distance == nearest(feet)) smallest = std::min(smallest, f.s);
    // To the fourth root of rounding where four roots meet.
    EXPECT_NEAR(found.s, smallest, 4e-4);
  }
}

/// Arcs that keep their distance to p to 1e-2 ... 1e-16: the work is bounded, the distance right.
TEST(FootPointProperty, ArcsAboutThePoint) {
  for (const double angle : {0.5, 1.5, 3.0, 6.0})
    for (int d = 2; d <= 14; ++d) {
      Points nodes;
      for (int i = 0; i <= d; ++i) {
        const double a = angle * i / d + 0.3;
        nodes.push_back(Vec2{{std::cos(a), std::sin(a)}});
      }
      const Points c = bezel::from_nodes(nodes);
      const Vec2 centre{{0, 0}};
      const FootPoint found = foot_point(c, centre);
      EXPECT_NEAR(found.distance, nearest(exact_feet(c, centre)), distance_bound(c, centre))
          << angle << " " << d;
    }
}

TEST(FootPointProperty, EquallyNearTakesTheSmallestParameter) {
  RandomStream random("FootPointProperty.EquallyNearTakesTheSmallestParameter", 1);
  for (int trial = 0; trial < 400; ++trial) {
    // Symmetrical about x = 0, p on the axis: feet in pairs s and 1 - s.
    const int d = 1 + trial % 8;
    Points c = random_points(random, d);
    for (std::size_t i = 0, j = c.size() - 1; i < j; ++i, --j) c[j] = Vec2{{-c[i].x(), c[i].y()}};
    if (d % 2 == 0) c[c.size() / 2] = Vec2{{0, c[c.size() / 2].y()}};
    const Vec2 p{{0, random.uniform(-2, 2)}};
    EXPECT_LE(foot_point(c, p).s, 0.5 + 1e-3) << trial;
  }
}

/// Powers of two change nothing, until subnormal numbers lose bits.
TEST(FootPointProperty, ScalesExactly) {
  RandomStream random("FootPointProperty.ScalesExactly", 1);
  for (int trial = 0; trial < 100; ++trial) {
    const Points c = random_points(random, 1 + trial % 6, 40);
    const Vec2 p = random_points(random, 0, 40)[0];
    const FootPoint one = foot_point(c, p);
    for (const int k : {-1000, -500, -199, 199, 500, 1000, 1020}) {
      Points scaled;
      for (const Vec2& q : c) scaled.push_back(std::ldexp(1.0, k) * q);
      const FootPoint found = foot_point(scaled, std::ldexp(1.0, k) * p);
      EXPECT_EQ(found.s, one.s) << trial << " " << k;
      EXPECT_EQ(found.distance, std::ldexp(one.distance, k)) << trial << " " << k;
    }
  }
}

/// Any doubles, from subnormal to the largest: finite answers, as near as any sample.
TEST(FootPointProperty, WildDoubles) {
  RandomStream random("FootPointProperty.WildDoubles", 1);
  constexpr double largest = std::numeric_limits<double>::max();
  const auto wild = [&](std::uint64_t kind) {
    if (kind == 0) return random.below(2) == 0 ? largest : -largest;
    if (kind == 1) return 0.0;
    for (;;) {
      const double x = std::bit_cast<double>(random.next());
      if (std::isfinite(x)) return kind == 2 ? x : std::copysign(std::sqrt(std::fabs(x)), x);
    }
  };
  const auto point = [&] {
    const double x = wild(random.below(5)), y = wild(random.below(5));
    return Vec2{{x, y}};
  };
  for (int trial = 0; trial < 1500; ++trial) {
    const int d = trial % 50 == 0 ? 60 : static_cast<int>(random.below(9));
    Points c;
    for (int i = 0; i <= d; ++i) c.push_back(point());
    const Vec2 p = random.below(4) == 0 ? c[0] : point();
    const FootPoint found = foot_point(c, p);
    SCOPED_TRACE(testing::Message() << trial << geometry_test::show(c, {p}, {}));
    ASSERT_TRUE(found.s >= 0 && found.s <= 1);
    ASSERT_TRUE(std::isfinite(found.point.x()) && std::isfinite(found.point.y()));
    ASSERT_GE(found.distance, 0.0);
    // In quarters, in extended range and precision.
    long double size = 0;
    std::vector<std::array<long double, 2>> q;
    for (const Vec2& b : c) {
      q.push_back(
          {static_cast<long double>(b.x()) - p.x(), static_cast<long double>(b.y()) - p.y()});
      size = std::max({size, std::fabs(q.back()[0]), std::fabs(q.back()[1])});
    }
    const long double bound = 8 * (d + 2) * u * size + 0x1p-1070L;
    for (int i = 0; i <= 64; ++i) {
      auto w = q;
      const long double s = i / 64.0L;
      for (std::size_t n = w.size() - 1; n > 0; --n)
        for (std::size_t k = 0; k < n; ++k)
          for (std::size_t a = 0; a < 2; ++a) w[k][a] = (1 - s) * w[k][a] + s * w[k + 1][a];
      const long double sample = std::hypot(w[0][0], w[0][1]) + bound;
      if (std::isfinite(found.distance))
        ASSERT_LE(found.distance, sample) << i;
      else  // beyond the doubles
        ASSERT_GT(sample, largest) << i;
    }
    if (d <= 4 && trial % 5 == 0 && std::isfinite(found.distance)) {
      const double exact = nearest(exact_feet(c, p));
      EXPECT_LE(std::fabs(found.distance - exact), bound);
    }
  }
}

}  // namespace
