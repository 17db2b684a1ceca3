// locate and invert at many points: the bits of the functions for one point, on every SIMD target.

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/base/random.hpp"
#include "bezel/geometry/triangle.hpp"
#include "support/simd_targets.hpp"

namespace {

using bezel::InverseResult;
using bezel::Lambda;
using bezel::LocateResult;
using bezel::Location;
using bezel::RandomStream;
using bezel::Vec2;
using Points = std::vector<Vec2>;

/// The unit triangle's nodes, each moved by up to amount / g.
Points net_of(RandomStream& random, int g, double amount) {
  Points net;
  for (int k = 0; k <= g; ++k)
    for (int j = 0; j + k <= g; ++j) {
      const double dx = random.uniform(-amount, amount), dy = random.uniform(-amount, amount);
      net.push_back(Vec2{{(j + dx) / g, (k + dy) / g}});
    }
  return net;
}
Lambda lambda_of(RandomStream& random) {
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return {1 - u - v, u, v};
}
Vec2 evaluate(int g, const Points& net, const Lambda& lambda) {
  Vec2 p;
  for (int axis = 0; axis < 2; ++axis) {
    std::vector<double> x;
    for (const Vec2& c : net) x.push_back(c[axis]);
    p[axis] = bezel::bernstein::evaluate(g, std::span<const double>(x), lambda);
  }
  return p;
}
/// Inside, on the sides, at the corners, somewhat and far outside.
Points points_for(RandomStream& random, int g, const Points& net, int count) {
  Points points;
  for (int i = 0; i < count; ++i) {
    Lambda l = lambda_of(random);
    if (i % 8 == 1) l = {0.0, l[1], 1.0 - l[1]};
    if (i % 8 == 2) l = {1.0 - l[2], 0.0, l[2]};
    if (i % 8 == 3) l = {1.0, 0.0, 0.0};
    if (i % 8 == 4) l = {1.0 - l[1] + 1e-3, l[1], -1e-3};
    points.push_back(evaluate(g, net, l));
    if (i % 8 == 5) {
      const double x = random.uniform(-0.5, 1.5), y = random.uniform(-0.5, 1.5);
      points.back() = Vec2{{x, y}};
    }
    if (i % 32 == 6) points.back() = Vec2{{0x1p60, -3.0}};
  }
  return points;
}

using Bits = std::array<std::uint64_t, 5>;
Bits bits(const LocateResult& r) {
  return {std::bit_cast<std::uint64_t>(r.lambda[0]), std::bit_cast<std::uint64_t>(r.lambda[1]),
          std::bit_cast<std::uint64_t>(r.lambda[2]), std::bit_cast<std::uint64_t>(r.residual),
          static_cast<std::uint64_t>(r.status)};
}
Bits bits(const InverseResult& r) {
  // Which NaN it is depends on the order of operands.
  const auto of = [](double x) { return std::isnan(x) ? 1 : std::bit_cast<std::uint64_t>(x); };
  return {of(r.lambda[0]), of(r.lambda[1]), of(r.lambda[2]), r.converged ? 1ull : 0ull, 0};
}

void expect_the_bits_of_single_points(int g, const Points& net, const Points& points,
                                      const std::vector<Lambda>& start, double tolerance) {
  std::vector<LocateResult> located;
  std::vector<InverseResult> inverted;
  for (std::size_t i = 0; i < points.size(); ++i) {
    located.push_back(bezel::locate(g, net, points[i], tolerance));
    inverted.push_back(bezel::invert(g, net, points[i], start[i]));
  }
  support::on_every_target([&] {
    for (const std::size_t count : {points.size(), std::size_t{3}, std::size_t{0}}) {
      const std::span<const Vec2> some(points.data(), count);
      std::vector<LocateResult> out(count);
      bezel::locate(g, net, some, out, tolerance);
      std::vector<InverseResult> inverse(count);
      bezel::invert(g, net, some, std::span(start).first(count), inverse);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(bits(out[i]), bits(located[i])) << g << " " << i;
        EXPECT_EQ(bits(inverse[i]), bits(inverted[i])) << g << " " << i;
      }
    }
  });
}

TEST(TriangleBatchTest, BitsOfSinglePointsOnEveryTarget) {
  RandomStream random("TriangleBatchTest.BitsOfSinglePointsOnEveryTarget", 1);
  for (const int g : {1, 2, 3, 4, 5, 7, 10, 11, 40})
    for (int trial = 0; trial < (g > 7 ? 1 : 6); ++trial) {
      const Points net = net_of(random, g, 0.15);
      const Points points = points_for(random, g, net, g > 7 ? 37 : 299);
      std::vector<Lambda> start;
      for (std::size_t i = 0; i < points.size(); ++i)
        start.push_back(i % 2 == 0 ? Lambda{1.0 / 3, 1.0 / 3, 1.0 / 3} : lambda_of(random));
      expect_the_bits_of_single_points(g, net, points, start, trial % 2 == 0 ? 1e-12 : 0.0);
    }
}

/// Folded, flat and point-like triangles, where Newton's method meets zero determinants, growing
/// residuals and steps without end.
TEST(TriangleBatchTest, BitsOfSinglePointsOnBadTriangles) {
  RandomStream random("TriangleBatchTest.BitsOfSinglePointsOnBadTriangles", 1);
  for (int g = 1; g <= 5; ++g)
    for (int kind = 0; kind < 5; ++kind) {
      Points net = net_of(random, g, kind == 0 ? 2.0 : 0.15);
      for (Vec2& c : net) {
        if (kind == 1) c[1] = 0.0;
        if (kind == 2) c = Vec2{{0.25, 0.5}};
        if (kind == 3) c *= 0x1p600;
        if (kind == 4) c *= 0x1p-600;
      }
      Points points = points_for(random, g, net, 24);
      points.push_back(Vec2{{0.25, 0.5}});
      std::vector<Lambda> start;
      for (std::size_t i = 0; i < points.size(); ++i) start.push_back(lambda_of(random));
      expect_the_bits_of_single_points(g, net, points, start, 1e-12);
    }
}

TEST(TriangleBatchTest, NotFiniteAndWildStarts) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), inf = HUGE_VAL;
  const Points unit{{{0, 0}}, {{1, 0}}, {{0, 1}}};
  const Points points{{{0.25, 0.5}}, {{0.25, 0.5}}, {{0.25, 0.5}}, {{nan, 0}}, {{0, inf}}};
  const std::vector<Lambda> start{
      {nan, nan, nan}, {0, 1e300, -1e300}, {0, inf, 0}, {1, 0, 0}, {1, 0, 0}};
  std::vector<InverseResult> expected;
  for (std::size_t i = 0; i < points.size(); ++i)
    expected.push_back(bezel::invert(1, unit, points[i], start[i]));
  support::on_every_target([&] {
    std::vector<InverseResult> out(points.size());
    bezel::invert(1, unit, points, start, out);
    for (std::size_t i = 0; i < points.size(); ++i) EXPECT_EQ(bits(out[i]), bits(expected[i])) << i;
    for (const std::size_t i : {0u, 2u, 3u, 4u}) EXPECT_FALSE(out[i].converged) << i;
  });
}

TEST(TriangleBatchTest, BadInput) {
  const Points unit{{{0, 0}}, {{1, 0}}, {{0, 1}}};
  const auto message_of = [](auto&& f) -> std::string {
    try {
      f();
    } catch (const bezel::InputError& error) {
      return error.what();
    }
    return "no InputError";
  };
  const Points two(2);
  std::vector<LocateResult> located(2);
  std::vector<InverseResult> inverted(2);
  std::vector<Lambda> starts(2);
  EXPECT_EQ(message_of([&] { bezel::locate(2, unit, two, located); }),
            "a triangle of degree 2 has 6 control points, found 3");
  EXPECT_EQ(message_of([&] { bezel::locate(1, unit, two, std::span(located).first(1)); }),
            "found 1 places for results, expected 2");
  EXPECT_EQ(message_of([&] {
              bezel::locate(1, unit, Points{{{0, 0}}, {{0, NAN}}}, located);
            }),
            "point 1 to locate is not finite");
  EXPECT_EQ(message_of([&] { bezel::locate(1, unit, two, located, -1.0); }),
            "the barycentric tolerance must be in [0, 1)");
  EXPECT_EQ(message_of([&] { bezel::invert(41, unit, two, starts, inverted); }),
            "the triangle's degree is 41, expected 1 to 40");
  EXPECT_EQ(message_of([&] { bezel::invert(1, unit, two, std::span(starts).first(1), inverted); }),
            "found 1 starts, expected 2");
  EXPECT_EQ(message_of([&] { bezel::invert(1, unit, two, starts, std::span(inverted).first(1)); }),
            "found 1 places for results, expected 2");
}

}  // namespace
