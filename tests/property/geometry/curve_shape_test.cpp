// Shape of random curves of degree 1 to 10 (and of all degrees, rarer): against exact arithmetic,
// dense sampling, reversal, scaling and translation.
#include "bezel/geometry/curve_shape.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bezel/bernstein/exact.hpp"
#include "property/geometry/support.hpp"

namespace {

using bezel::Curve;
using bezel::Dyadic;
using bezel::RandomStream;
using bezel::Vec2;
using bezel::WindingStatus;
using bezel::bernstein::ExactPolynomial;
using geometry_test::evaluate;
using geometry_test::Points;
using geometry_test::random_points;

constexpr double u = 0x1p-53;

ExactPolynomial coordinate(const Points& c, int axis) {
  std::vector<double> b;
  for (const Vec2& p : c) b.push_back(p[axis]);
  return ExactPolynomial(b);
}

Points reversed(Points c) {
  std::reverse(c.begin(), c.end());
  return c;
}

/// Dyadic numbers as long doubles times 2^e, for closed forms 11 bits beyond double.
long double wide(const Dyadic& x, std::int64_t e) {
  const Dyadic y = x.scaled(-e);
  const double hi = y.to_double();
  return static_cast<long double>(hi) + static_cast<long double>((y - Dyadic(hi)).to_double());
}

/// Degree 1 to 10, sometimes far from the origin, nearly straight or almost cusped.
Points trouble(RandomStream& random, int degree) {
  Points c = random_points(random, degree);
  switch (random.below(5)) {
    case 0:
      for (Vec2& p : c) p += Vec2{{1024, -4096}};
      break;
    case 1: {  // nearly straight
      const double bend = std::ldexp(1.0, -static_cast<int>(random.below(60)));
      for (Vec2& p : c) p = Vec2{{p.x(), 0.25 * p.x() + bend * p.y()}};
      break;
    }
    case 2:  // nearly no speed at the start
      if (degree >= 2) c[1] = c[0] + std::ldexp(1.0, -static_cast<int>(random.below(60))) * c[1];
      break;
    default:
      break;
  }
  return c;
}

TEST(CurveShapeProperty, FrameAndCurvatureAreExactToRounding) {
  RandomStream random("CurveShapeProperty.FrameAndCurvature", 1);
  double worst_tangent = 0, worst_curvature = 0;
  for (int run = 0; run < 20000; ++run) {
    const int degree = run % 50 == 0 ? 1 + static_cast<int>(random.below(60))
                                     : 1 + static_cast<int>(random.below(10));
    const Points c = trouble(random, degree);
    const double s = random.below(8) == 0    ? static_cast<double>(random.below(5)) / 4
                     : random.below(20) == 0 ? random.uniform(-1, 2)
                                             : random.uniform();
    const ExactPolynomial x1 = coordinate(c, 0).derivative(), y1 = coordinate(c, 1).derivative();
    const Dyadic dx = x1(Dyadic(s)), dy = y1(Dyadic(s));
    const Dyadic turn = dx * y1.derivative()(Dyadic(s)) - dy * x1.derivative()(Dyadic(s));
    if (dx.sign() == 0 && dy.sign() == 0) continue;
    const std::int64_t e = dx.sign() == 0   ? dy.exponent()
                           : dy.sign() == 0 ? dx.exponent()
                                            : std::max(dx.exponent(), dy.exponent());
    const long double a = wide(dx, e), b = wide(dy, e), speed = std::sqrt(a * a + b * b);
    const auto found = bezel::frame(c, s);
    ASSERT_EQ(found.status, bezel::SpeedStatus::regular) << run;
    const double error = static_cast<double>(std::max(std::fabs(found.tangent.x() - a / speed),
                                                      std::fabs(found.tangent.y() - b / speed)));
    worst_tangent = std::max(worst_tangent, error / u);
    const auto k = bezel::curvature(c, s);
    ASSERT_EQ(k.status, bezel::SpeedStatus::regular) << run;
    if (turn.sign() == 0) {
      EXPECT_EQ(k.value, 0.0) << run;
      continue;
    }
    const long double exact = wide(turn, 3 * e) / (speed * speed * speed);
    const double relative =
        static_cast<double>(std::fabs((static_cast<long double>(k.value) - exact) / exact));
    worst_curvature = std::max(worst_curvature, relative / u);
  }
  RecordProperty("worst_tangent", std::to_string(worst_tangent));
  RecordProperty("worst_curvature", std::to_string(worst_curvature));
  EXPECT_LE(worst_tangent, 6.0);
  EXPECT_LE(worst_curvature, 16.0);
}

TEST(CurveShapeProperty, ReversalScalingTranslation) {
  RandomStream random("CurveShapeProperty.ReversalScalingTranslation", 1);
  for (int run = 0; run < 3000; ++run) {
    const Points c = random_points(random, 1 + static_cast<int>(random.below(10)), 30);
    const double s = static_cast<double>(random.below(1025)) / 1024;
    const double scale = std::ldexp(1.0, static_cast<int>(random.below(800)) - 400);
    Points mapped;
    for (const Vec2& p : c) mapped.push_back(scale * (p + Vec2{{1 << 10, -(1 << 12)}}));
    const auto f = bezel::frame(c, s), m = bezel::frame(mapped, s),
               r = bezel::frame(reversed(c), 1 - s);
    EXPECT_EQ(f.tangent, m.tangent) << run;
    EXPECT_EQ(f.status, r.status);
    EXPECT_NEAR(f.tangent.x(), -r.tangent.x(), 12 * u);
    EXPECT_NEAR(f.tangent.y(), -r.tangent.y(), 12 * u);
    const double k = bezel::curvature(c, s).value;
    EXPECT_NEAR(bezel::curvature(mapped, s).value * scale, k, 32 * u * std::fabs(k)) << run;
    EXPECT_NEAR(bezel::curvature(reversed(c), 1 - s).value, -k, 32 * u * std::fabs(k)) << run;
    // Differences of 30 bits are exact: the box is the true one rounded outwards, up to ties of
    // the two roundings (translation by 2^12 costs 12 bits).
    const auto box = bezel::tight_box(c), moved = bezel::tight_box(mapped);
    for (int axis = 0; axis < 2; ++axis) {
      const double shift = axis == 0 ? 1 << 10 : -(1 << 12);
      EXPECT_NEAR(moved.hi[axis] / scale - shift, box.hi[axis], 4 * u * 4096) << run;
      EXPECT_GE(moved.hi[axis] / scale - shift, box.hi[axis] - 2 * u) << run;
    }
    EXPECT_EQ(bezel::tight_box(reversed(c)).hi, box.hi) << run;
    EXPECT_EQ(bezel::tight_box(reversed(c)).lo, box.lo) << run;
  }
}

TEST(CurveShapeProperty, TightBoxEnclosesAndTouches) {
  RandomStream random("CurveShapeProperty.TightBox", 1);
  for (int run = 0; run < 3000; ++run) {
    const int degree = run % 100 == 0 ? 60 : 1 + static_cast<int>(random.below(10));
    const Points c = trouble(random, degree);
    const auto box = bezel::tight_box(c);
    for (int axis = 0; axis < 2; ++axis) {
      const ExactPolynomial p = coordinate(c, axis);
      double reach_lo = c[0][axis], reach_hi = c[0][axis], variation = 0, largest = 0;
      for (std::size_t i = 0; i + 1 < c.size(); ++i)
        variation += std::fabs(c[i + 1][axis] - c[i][axis]);
      for (const Vec2& q : c) largest = std::max(largest, std::fabs(q[axis]));
      for (int k = 0; k <= 16; ++k) {
        const Dyadic value = p(Dyadic(k / 16.0));
        ASSERT_FALSE(value < Dyadic(box.lo[axis])) << run << ' ' << k;
        ASSERT_FALSE(Dyadic(box.hi[axis]) < value) << run << ' ' << k;
      }
      // Sampling misses an extremum by at most max |p''| h^2 / 8 <= 2 d (d-1) variation h^2 / 8.
      const int n = 500;
      for (int k = 0; k <= n; ++k) {
        const double x = evaluate(c, k / static_cast<double>(n))[axis];
        reach_lo = std::min(reach_lo, x);
        reach_hi = std::max(reach_hi, x);
      }
      const double missed =
          0.25 * degree * (degree - 1) * variation / (n * static_cast<double>(n)) +
          4.0 * degree * u * largest + u * variation;
      EXPECT_NEAR(box.lo[axis], reach_lo, missed) << run;
      EXPECT_NEAR(box.hi[axis], reach_hi, missed) << run;
    }
  }
}

/// Angle swept by a polyline of n points a curve, in turns; and the smallest distance met.
double turns(const std::vector<Curve>& chain, const Vec2& p, double& nearest) {
  double angle = 0;
  nearest = 1e300;
  for (const Curve& curve : chain) {
    const int n = 400;
    Vec2 a = curve(0.0) - p;
    for (int k = 1; k <= n; ++k) {
      const Vec2 b = curve(k / static_cast<double>(n)) - p;
      angle += std::atan2(cross(a, b), dot(a, b));
      nearest = std::min(nearest, norm(b));
      a = b;
    }
  }
  return angle / (2 * std::acos(-1.0));
}

std::vector<Curve> random_chain(RandomStream& random, int bits) {
  std::vector<Points> parts(1 + random.below(4));
  for (Points& c : parts) c = random_points(random, 1 + static_cast<int>(random.below(10)), bits);
  for (std::size_t i = 0; i < parts.size(); ++i)
    parts[i].back() = parts[(i + 1) % parts.size()].front();
  std::vector<Curve> chain;
  for (const Points& c : parts) chain.emplace_back(c);
  return chain;
}

TEST(CurveShapeProperty, WindingNumbersOfRandomChains) {
  RandomStream random("CurveShapeProperty.Winding", 1);
  int checked = 0;
  for (int run = 0; run < 3000; ++run) {
    const auto chain = random_chain(random, 20);
    Vec2 p{{random.uniform(), random.uniform()}};
    if (run % 3 == 0) p = Vec2{{p.x(), chain[0].control()[0].y()}};  // a joint on the ray's line
    const auto found = bezel::winding_number(chain, p);
    ASSERT_EQ(found.status, WindingStatus::proven) << run;
    double nearest = 0;
    const double swept = turns(chain, p, nearest);
    // The chord of a step of 1/400 stays within d (d-1) / 4 / 400^2 * 2 < 3e-4 of the curve.
    if (nearest < 1e-2) continue;
    ++checked;
    EXPECT_NEAR(swept, found.value, 1e-6) << run;
    std::vector<Curve> back, scaled;
    for (std::size_t i = chain.size(); i-- > 0;)
      back.emplace_back(reversed({chain[i].control().begin(), chain[i].control().end()}));
    EXPECT_EQ(bezel::winding_number(back, p).value, -found.value) << run;
    for (const Curve& c : chain) {
      Points q(c.control().begin(), c.control().end());
      for (Vec2& x : q) x *= 0x1p-300;
      scaled.emplace_back(q);
    }
    EXPECT_EQ(bezel::winding_number(scaled, 0x1p-300 * p).value, found.value) << run;
  }
  EXPECT_GT(checked, 2000);
}

TEST(CurveShapeProperty, PointsOfTheChainAreFoundOnIt) {
  RandomStream random("CurveShapeProperty.OnChain", 1);
  for (int run = 0; run < 1000; ++run) {
    // Integers times 2^(4 d): the points at s = k / 16 are doubles.
    const int degree = 1 + static_cast<int>(random.below(8));
    Points c;
    for (int i = 0; i <= degree; ++i)
      c.push_back(
          Vec2{{static_cast<double>(random.below(64)), static_cast<double>(random.below(64))}});
    const std::vector<Curve> chain{Curve(c), Curve(Points{c.back(), c.front()})};
    const Dyadic s(static_cast<double>(random.below(17)) / 16);
    const Vec2 p{{coordinate(c, 0)(s).to_double(), coordinate(c, 1)(s).to_double()}};
    const auto found = bezel::winding_number(chain, p);
    EXPECT_EQ(found.status, WindingStatus::on_curve) << run;
    // One step of the last place away: only a curve that runs along the axis, or another part of
    // it, could pass there too; at least an answer is proven.
    const Vec2 beside{{p.x() + 0x1p-40, p.y()}};
    EXPECT_NE(bezel::winding_number(chain, beside).status, WindingStatus::undecided) << run;
  }
}

TEST(CurveShapeProperty, AreasWithinTheirBound) {
  RandomStream random("CurveShapeProperty.Area", 1);
  double worst = 0;
  for (int run = 0; run < 2000; ++run) {
    const auto chain = random_chain(random, 20);
    const auto found = bezel::area_and_centroid(chain);
    // Exactly: 2 A = sum over curves and monomials of a_k b_l (l - k) / (k + l), in long double
    // from exact coefficients, relative to the first point (9 bits lost at degree 10 at most leave
    // 55: the rounding below 2^-60 of terms below 2^20 is far below the bound).
    long double twice = 0;
    const Vec2 o = chain[0].control()[0];
    Dyadic common;  // times lcm(1..20)
    for (const Curve& curve : chain) {
      Points q(curve.control().begin(), curve.control().end());
      for (Vec2& p : q) p -= o;  // 21 bits: exact
      const ExactPolynomial x = coordinate(q, 0), y = coordinate(q, 1);
      for (std::size_t k = 0; k < x.monomial().size(); ++k)
        for (std::size_t l = 0; l < y.monomial().size(); ++l) {
          if (k == l) continue;
          const double w = (static_cast<double>(l) - static_cast<double>(k)) *
                           (232792560.0 / static_cast<double>(k + l));
          common += x.monomial()[k] * y.monomial()[l] * Dyadic(w);
        }
    }
    twice = wide(common, 0) / 232792560.0L;
    const double error = std::fabs(static_cast<double>(found.area - 0.5L * twice));
    EXPECT_LE(error, found.error_bound) << run;
    worst = std::max(worst, error / found.error_bound);
  }
  RecordProperty("worst", std::to_string(worst));
}

TEST(CurveShapeProperty, ReductionBoundHolds) {
  RandomStream random("CurveShapeProperty.Reduction", 1);
  for (int run = 0; run < 1000; ++run) {
    const int degree = 1 + static_cast<int>(random.below(20));
    const Points c = random_points(random, degree);
    const int by = 1 + static_cast<int>(random.below(static_cast<std::uint64_t>(degree)));
    const auto low = bezel::reduce(c, by);
    ASSERT_EQ(low.control.size() + static_cast<std::size_t>(by), c.size());
    for (int k = 0; k <= 20; ++k) {
      const double s = k / 20.0;
      EXPECT_LE(norm(evaluate(c, s) - evaluate(low.control, s)), low.error_bound + 8 * degree * u)
          << run;
    }
    if (degree + by > 60) continue;
    const auto same = bezel::reduce(bezel::elevate(c, by), by);
    EXPECT_LE(same.error_bound, 16 * (degree + by + 1) * by * u) << run;
  }
}

}  // namespace
