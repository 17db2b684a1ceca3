// Curved triangles on random input: locate against the map, area and moments against splitting and
// affine change, validity against sampling.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/geometry/triangle.hpp"

namespace {

using bezel::Lambda;
using bezel::Location;
using bezel::RandomStream;
using bezel::Validity;
using bezel::Vec2;
using Points = std::vector<Vec2>;
using bezel::bernstein::triangle_size;

/// The equally spaced net of an affine triangle, each point moved by up to `amount` / g.
Points perturbed(RandomStream& random, int g, double amount) {
  const Vec2 c0{{0.2, -0.1}}, c1{{1.3, 0.2}}, c2{{0.1, 1.1}};
  Points net;
  for (int k = 0; k <= g; ++k)
    for (int j = 0; j + k <= g; ++j) {
      const double u = static_cast<double>(j) / g, v = static_cast<double>(k) / g;
      const Vec2 noise{{random.uniform(-1, 1), random.uniform(-1, 1)}};
      net.push_back((1 - u - v) * c0 + u * c1 + v * c2 + (amount / g) * noise);
    }
  return net;
}

/// By the recurrence on full copies.
Vec2 evaluate(int g, Points b, const Lambda& l) {
  for (int d = g; d > 0; --d) {
    Points next;
    for (int k = 0; k < d; ++k)
      for (int j = 0; j + k < d; ++j) {
        const auto at = [&](int jj, int kk) {
          return b[static_cast<std::size_t>(bezel::bernstein::triangle_index(d, jj, kk))];
        };
        next.push_back(l[0] * at(j, k) + l[1] * at(j + 1, k) + l[2] * at(j, k + 1));
      }
    b = next;
  }
  return b[0];
}

Lambda random_lambda(RandomStream& random) {
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return {1 - u - v, u, v};
}

double distance(const Lambda& p, const Lambda& q) {
  return std::max({std::fabs(p[0] - q[0]), std::fabs(p[1] - q[1]), std::fabs(p[2] - q[2])});
}

TEST(TriangleProperty, LocateAndInvertFindThePoint) {
  RandomStream random("LocateAndInvertFindThePoint", 1);
  for (int g = 1; g <= 6; ++g)
    for (int trial = 0; trial < 200; ++trial) {
      const Points net = perturbed(random, g, 0.15);
      ASSERT_EQ(check_validity(g, net).status, Validity::valid) << g << " " << trial;
      Lambda lambda = random_lambda(random);
      if (trial % 4 == 1) lambda = {0.0, lambda[1], 1.0 - lambda[1]};  // on side 1
      if (trial % 4 == 2) lambda = {1.0 - lambda[2], 0.0, lambda[2]};  // on side 2
      if (trial % 16 == 3) lambda = {1.0, 0.0, 0.0};                   // a corner
      if (trial % 16 == 7) lambda = {0.0, 0.0, 1.0};
      const Vec2 p = evaluate(g, net, lambda);
      const auto found = locate(g, net, p);
      ASSERT_EQ(found.status, Location::inside) << g << " " << trial;
      EXPECT_LT(distance(found.lambda, lambda), 1e-14) << g << " " << trial;
      EXPECT_LT(found.residual, 1e-15);
      const auto inverse = invert(g, net, p, {1.0 / 3, 1.0 / 3, 1.0 / 3});
      EXPECT_TRUE(inverse.converged);
      EXPECT_LT(distance(inverse.lambda, lambda), 1e-14) << g << " " << trial;
    }
}

/// Many points of one triangle, inside and on its boundary, from starts anywhere in it.
TEST(TriangleProperty, LocateAndInvertFindManyPoints) {
  RandomStream random("LocateAndInvertFindManyPoints", 1);
  for (int g = 1; g <= 12; ++g)
    for (int trial = 0; trial < 10; ++trial) {
      const Points net = perturbed(random, g, 0.15);
      std::vector<Lambda> lambda, start;
      Points points;
      for (int i = 0; i < 100; ++i) {
        Lambda l = random_lambda(random);
        if (i % 4 == 1) l = {0.0, l[1], 1.0 - l[1]};
        if (i % 4 == 2) l = {1.0 - l[2], 0.0, l[2]};
        if (i % 4 == 3) l = {1.0 - l[1], l[1], 0.0};
        if (i % 25 == 0) l = {0.0, 1.0, 0.0};
        lambda.push_back(l);
        points.push_back(evaluate(g, net, l));
        start.push_back(random_lambda(random));
      }
      std::vector<bezel::LocateResult> located(points.size());
      std::vector<bezel::InverseResult> inverted(points.size());
      locate(g, net, points, located);
      invert(g, net, points, start, inverted);
      // The points are rounded values of de Casteljau, to 3 g u of about 1; so are the residuals.
      const double bound = 8 * (g + 1) * 0x1p-53;
      for (std::size_t i = 0; i < points.size(); ++i) {
        ASSERT_EQ(located[i].status, Location::inside) << g << " " << i;
        EXPECT_LT(distance(located[i].lambda, lambda[i]), 4 * bound) << g << " " << i;
        EXPECT_LT(norm(evaluate(g, net, located[i].lambda) - points[i]), bound);
        ASSERT_TRUE(inverted[i].converged) << g << " " << i;
        EXPECT_LT(distance(inverted[i].lambda, lambda[i]), 4 * bound) << g << " " << i;
      }
    }
}

/// Just outside a side, at distances from 1e-10 up: proven outside; just inside: inside.
TEST(TriangleProperty, LocateNearTheBoundary) {
  RandomStream random("LocateNearTheBoundary", 1);
  for (int g = 1; g <= 4; ++g)
    for (int trial = 0; trial < 100; ++trial) {
      const Points net = perturbed(random, g, 0.15);
      const double s = random.uniform(0.02, 0.98);
      Lambda on{0, 0, 0};
      const auto side = static_cast<std::size_t>(random.below(3));
      on[side] = 1 - s;
      on[(side + 1) % 3] = s;
      for (const double off : {1e-10, 1e-8, 1e-6, 1e-4, 1e-2}) {
        Lambda out = on, in = on;
        out[(side + 2) % 3] -= off;
        out[side] += off;
        in[(side + 2) % 3] += off;
        in[side] -= off;
        EXPECT_EQ(locate(g, net, evaluate(g, net, out)).status, Location::outside)
            << g << " " << trial << " " << off;
        EXPECT_EQ(locate(g, net, evaluate(g, net, in)).status, Location::inside)
            << g << " " << trial << " " << off;
        std::vector<bezel::LocateResult> both(2);
        locate(g, net, Points{evaluate(g, net, out), evaluate(g, net, in)}, both);
        EXPECT_EQ(both[0].status, Location::outside) << g << " " << trial << " " << off;
        EXPECT_EQ(both[1].status, Location::inside) << g << " " << trial << " " << off;
      }
    }
}

TEST(TriangleProperty, FarPointsAreOutside) {
  RandomStream random("FarPointsAreOutside", 1);
  for (int g = 1; g <= 5; ++g)
    for (int trial = 0; trial < 100; ++trial) {
      const Points net = perturbed(random, g, 0.15);
      const double angle = random.uniform(0, 6.28), r = random.uniform(1.5, 100);
      EXPECT_EQ(locate(g, net, Vec2{{r * std::cos(angle), r * std::sin(angle)}}).status,
                Location::outside);
    }
}

/// The verdict agrees with the determinant at many points, and the determinant with differences of
/// the map.
TEST(TriangleProperty, ValidityAgreesWithSampling) {
  RandomStream random("ValidityAgreesWithSampling", 1);
  int counts[3] = {0, 0, 0};
  for (int g = 2; g <= 5; ++g)
    for (int trial = 0; trial < 200; ++trial) {
      const Points net = perturbed(random, g, random.uniform(0.1, 1.0));
      const auto result = check_validity(g, net);
      ++counts[static_cast<int>(result.status)];
      const auto det = jacobian_determinant(g, net);
      double least = 1e300;
      for (int i = 0; i < 200; ++i) {
        const Lambda l = random_lambda(random);
        Points as_points;
        for (const double c : det) as_points.push_back(Vec2{{c, 0}});
        least = std::min(least, evaluate(2 * (g - 1), as_points, l).x());
      }
      if (least < -1e-12) {
        EXPECT_EQ(result.status, Validity::inverted) << g << " " << trial;
      }
      if (result.status == Validity::inverted) {
        Points as_points;
        for (const double c : det) as_points.push_back(Vec2{{c, 0}});
        EXPECT_NEAR(evaluate(2 * (g - 1), as_points, result.where).x(), result.det, 1e-12);
        EXPECT_LT(result.det, 0);
      }
    }
  EXPECT_GT(counts[0], 100);
  EXPECT_GT(counts[1], 100);
  EXPECT_LT(counts[2], 8);
}

TEST(TriangleProperty, DeterminantIsTheMapsOwn) {
  RandomStream random("DeterminantIsTheMapsOwn", 1);
  for (int g = 1; g <= 6; ++g) {
    const Points net = perturbed(random, g, 0.5);
    Points det;
    for (const double c : jacobian_determinant(g, net)) det.push_back(Vec2{{c, 0}});
    for (int i = 0; i < 20; ++i) {
      const Lambda l = random_lambda(random);
      const double h = 1e-6;  // central differences: error about h^2
      const Vec2 du = (0.5 / h) * (evaluate(g, net, {l[0] - h, l[1] + h, l[2]}) -
                                   evaluate(g, net, {l[0] + h, l[1] - h, l[2]}));
      const Vec2 dv = (0.5 / h) * (evaluate(g, net, {l[0] - h, l[1], l[2] + h}) -
                                   evaluate(g, net, {l[0] + h, l[1], l[2] - h}));
      EXPECT_NEAR(g == 1 ? det[0].x() : evaluate(2 * (g - 1), det, l).x(), cross(du, dv), 1e-8)
          << g;
    }
  }
}

/// Area and moments against the integral of the determinant: the mean of its Bernstein
/// coefficients.
TEST(TriangleProperty, AreaIsTheIntegralOfTheDeterminant) {
  RandomStream random("AreaIsTheIntegralOfTheDeterminant", 1);
  for (int g = 1; g <= 10; ++g)
    for (int trial = 0; trial < 20; ++trial) {
      const Points net = perturbed(random, g, 0.4);
      const auto det = jacobian_determinant(g, net);
      double sum = 0;
      for (const double c : det) sum += c;
      const double area = bezel::area(g, net);
      EXPECT_NEAR(area, 0.5 * sum / static_cast<double>(det.size()), 4e-15) << g;
      if (g <= 6) {
        EXPECT_NEAR(moment(g, net, 0, 0), area, 4e-15) << g;
      }
    }
}

/// Moving the triangle by d: the integral of (x + d)^2 = m2 + 2 d m1 + d^2 m0.
TEST(TriangleProperty, MomentsUnderTranslation) {
  RandomStream random("MomentsUnderTranslation", 1);
  for (int g = 1; g <= 5; ++g) {
    const Points net = perturbed(random, g, 0.4);
    Points moved = net;
    const double d = 0.75;
    for (Vec2& p : moved) p += Vec2{{d, 0}};
    for (int b = 0; b <= 4; ++b)
      EXPECT_NEAR(
          moment(g, moved, 2, b),
          moment(g, net, 2, b) + 2 * d * moment(g, net, 1, b) + d * d * moment(g, net, 0, b),
          4e-15);
  }
}

}  // namespace
