// The predicates against exact rationals: every sign must agree.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bezel/base/random.hpp"
#include "bezel/mesh/predicates.hpp"

namespace bezel {
namespace {

struct ExactVec {
  mpq_class x, y;
  ExactVec(const Vec2& a, const Vec2& b) : x(mpq_class(a[0]) - b[0]), y(mpq_class(a[1]) - b[1]) {}
};
mpq_class cross(const ExactVec& a, const ExactVec& b) {
  return a.x * b.y - a.y * b.x;
}
mpq_class squared(const ExactVec& a) {
  return a.x * a.x + a.y * a.y;
}

int exact_orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  return sgn(cross(ExactVec(a, c), ExactVec(b, c)));
}
int exact_in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const ExactVec x(a, d), y(b, d), z(c, d);
  return sgn(
      mpq_class(squared(x) * cross(y, z) + squared(y) * cross(z, x) + squared(z) * cross(x, y)));
}

/// A number that makes differences inexact: of any size from 2^-60 to 1, or on a coarse grid.
double awkward(RandomStream& random) {
  switch (random.below(4)) {
    case 0:
      return random.uniform(-1, 1);
    case 1:
      return 0.1 * static_cast<double>(random.below(21)) - 1;
    case 2:
      return static_cast<double>(random.below(9)) / 4 - 1;
    default:
      return std::ldexp(random.uniform(-1, 1), -static_cast<int>(random.below(60)));
  }
}

double nudged(double x, RandomStream& random) {
  const std::uint64_t kind = random.below(4);
  if (kind == 0 || x == 0) return x;  // next to zero lies an underflow
  if (kind == 1) return std::nextafter(x, random.below(2) == 0 ? -2 : 2);
  return x + std::ldexp(random.uniform(-1, 1), -10 - static_cast<int>(random.below(50)));
}

TEST(PredicatesReference, OrientationHasTheExactSign) {
  RandomStream random("OrientationHasTheExactSign", 1);
  std::array<int, 3> seen{};
  for (int round = 0; round < 20000; ++round) {
    const double ax = awkward(random), ay = awkward(random), bx = awkward(random),
                 by = awkward(random);
    const Vec2 a{{ax, ay}}, b{{bx, by}};
    const double s = awkward(random);  // c near the line through a and b
    const double cx = nudged(ax + s * (bx - ax), random);
    const Vec2 c{{cx, nudged(ay + s * (by - ay), random)}};
    const int expected = exact_orientation(a, b, c);
    ++seen[static_cast<std::size_t>(expected + 1)];
    ASSERT_EQ(orientation(a, b, c), expected) << round;
    ASSERT_EQ(orientation(b, c, a), expected) << round;
    ASSERT_EQ(orientation(b, a, c), -expected) << round;
  }
  for (const int count : seen) EXPECT_GT(count, 300);
}

TEST(PredicatesReference, InCircleHasTheExactSign) {
  RandomStream random("InCircleHasTheExactSign", 1);
  std::array<int, 3> seen{};
  for (int round = 0; round < 20000; ++round) {
    std::array<Vec2, 4> p;
    if (round % 2 == 0) {  // near a circle
      const double cx = awkward(random), cy = awkward(random), r = awkward(random);
      for (Vec2& q : p) {
        const double angle = random.uniform(0, 6.3), x = nudged(cx + r * std::cos(angle), random);
        q = Vec2{{x, nudged(cy + r * std::sin(angle), random)}};
      }
    } else {  // near the corners of a rectangle
      const double x0 = awkward(random), x1 = awkward(random), y0 = awkward(random),
                   y1 = awkward(random);
      p = {Vec2{{x0, y0}}, Vec2{{x1, y0}}, Vec2{{x1, y1}}, Vec2{{x0, nudged(y1, random)}}};
    }
    const int expected = exact_in_circle(p[0], p[1], p[2], p[3]);
    ++seen[static_cast<std::size_t>(expected + 1)];
    ASSERT_EQ(in_circle(p[0], p[1], p[2], p[3]), expected) << round;
    ASSERT_EQ(in_circle(p[1], p[2], p[0], p[3]), expected) << round;
    ASSERT_EQ(in_circle(p[1], p[0], p[2], p[3]), -expected) << round;
    ASSERT_EQ(in_circle(p[3], p[1], p[2], p[0]), -expected) << round;
  }
  for (const int count : seen) EXPECT_GT(count, 300);
}

}  // namespace
}  // namespace bezel
