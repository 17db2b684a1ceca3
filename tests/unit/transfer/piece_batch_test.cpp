#include "bezel/transfer/piece_batch.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/quadrature.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/group.hpp"
#include "support/simd_targets.hpp"

namespace bezel::detail {
namespace {

std::size_t at(int degree, int a, int b) {
  return static_cast<std::size_t>(bernstein::triangle_index(degree, a, b));
}

/// Two regions of a target element cut by the line between two points of its sides, as a batch.
struct Cut {
  explicit Cut(int degree) : place{} {
    const Frame frame = affine_frame({Vec2{{0.2, 0.1}}, Vec2{{1.3, 0.3}}, Vec2{{0.4, 1.2}}});
    const Vec2 &first = frame.gradient[1], &second = frame.gradient[2];
    const double area = 1.0 / cross(first, second);
    place = {frame.centre,
             first,
             second,
             Vec2{{second[1] * area, -second[0] * area}},
             Vec2{{-first[1] * area, first[0] * area}},
             area};
    const Vec2 a{{0.2, 0.1}}, b{{1.3, 0.3}}, c{{0.4, 1.2}};
    const Vec2 d = a + 0.3 * (b - a), e = c + 0.6 * (a - c);
    // The line between the two regions, which bounds both, comes last.
    const std::vector<std::pair<Vec2, Vec2>> sides = {{a, d}, {e, a}, {d, b},
                                                      {b, c}, {c, e}, {d, e}};
    pieces = {{{}, false, 0, -1}, {{}, false, 0, -1}, {{}, false, 1, -1},
              {{}, false, 1, -1}, {{}, false, 1, -1}, {{}, true, 0, 1}};
    batch.resize(sides.size(), degree);
    for (std::size_t i = 0; i < batch.stride; ++i) {
      const auto& [from, to] = sides[std::min(i, sides.size() - 1)];
      // The piece is the middle of a longer curve, run backwards for odd i.
      const bool backwards = i % 2 == 1;
      batch.from[i] = backwards ? 0.75 : 0.25;
      batch.to[i] = backwards ? 0.25 : 0.75;
      const Vec2 &p = backwards ? to : from, &q = backwards ? from : to;
      for (int k = 0; k <= degree; ++k) {
        const double t = -0.5 + 2.0 * k / degree;
        const Vec2 x = p + (q - p) * t;
        batch.x[static_cast<std::size_t>(k) * batch.stride + i] = x[0];
        batch.y[static_cast<std::size_t>(k) * batch.stride + i] = x[1];
      }
    }
    donors = {affine_frame({Vec2{{0.0, 0.0}}, Vec2{{1.0, -0.1}}, Vec2{{0.3, 0.9}}}),
              affine_frame({Vec2{{0.5, 0.0}}, Vec2{{1.6, 0.4}}, Vec2{{0.2, 1.3}}})};
  }
  void sum(int degree, int moments) {
    const ElementCount all{static_cast<std::uint32_t>(pieces.size()), 2};
    region_sums(PieceTable(degree, moments), moments, {place, Vec2{{0.6, 0.5}}}, pieces, {&all, 1},
                batch);
  }
  TargetPlace place;
  std::vector<BoundaryPiece> pieces;
  PieceBatch batch;
  std::vector<Frame> donors;
};

struct Sums {
  std::vector<double> product, basis, mass;
  friend bool operator==(const Sums&, const Sums&) = default;
};

Sums add(const Cut& cut, int p, int components, const std::vector<double>& donor,
         std::vector<BatchRegion>& regions) {
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(p));
  const auto nc = static_cast<std::size_t>(components);
  Sums sums{std::vector<double>(size * nc + batch_padding), std::vector<double>(size),
            std::vector<double>(2 * nc)};
  // As many numbers behind the coefficients as may be read.
  std::vector<double> padded = donor;
  padded.resize(donor.size() + batch_padding);
  std::vector<double> base(nc, 0.25);
  base.resize(nc + batch_padding);
  regions = {{&cut.donors[0], padded.data(), false},
             {&cut.donors[1], padded.data() + size * nc, false}};
  add_batch(p, cut.place, cut.batch, regions, components, base.data(), sums.product.data(),
            sums.basis.data(), sums.mass.data());
  for (std::size_t n = 0; n < size; ++n)
    for (std::size_t c = 0; c < nc; ++c) sums.product[n * nc + c] += base[c] * sums.basis[n];
  return sums;
}

TEST(MomentBatch, EqualsQuadratureOnTheRegions) {
  for (int g = 1; g <= max_batch_degree; ++g) {
    for (int p = 0; p <= max_moment_degree; ++p) {
      Cut cut(g);
      cut.sum(g, 2 * p);
      const auto size = static_cast<std::size_t>(bernstein::triangle_size(p));
      const int components = 2;
      RandomStream random("moment batch", static_cast<std::uint64_t>(10 * g + p));
      std::vector<double> donor(2 * size * 2);
      for (double& c : donor) c = random.uniform(-1, 1);
      std::vector<BatchRegion> regions;
      const Sums sums = add(cut, p, components, donor, regions);

      // The quadrilateral in two triangles.
      const Vec2 a{{0.2, 0.1}}, b{{1.3, 0.3}}, c{{0.4, 1.2}};
      const Vec2 d = a + 0.3 * (b - a), e = c + 0.6 * (a - c);
      const std::vector<std::array<Vec2, 3>> parts = {{a, d, e}, {d, b, c}, {d, c, e}};
      const TriangleRule rule = triangle_rule(2 * p + 1);
      Sums expected{std::vector<double>(sums.product.size()), std::vector<double>(size),
                    std::vector<double>(4)};
      for (std::size_t part = 0; part < 3; ++part) {
        const std::size_t r = part == 0 ? 0 : 1;
        const auto& t = parts[part];
        const double area = cross(t[1] - t[0], t[2] - t[0]);
        for (std::size_t q = 0; q < rule.weight.size(); ++q) {
          const auto& l = rule.lambda[q];
          const Vec2 x = l[0] * t[0] + l[1] * t[1] + l[2] * t[2];
          const double w = rule.weight[q] * area;
          const auto lambda = cut.donors[r].lambda(x);
          const double u = lambda[1] - 1.0 / 3.0, v = lambda[2] - 1.0 / 3.0;
          const double xi = dot(cut.place.first, x - cut.place.centre);
          const double eta = dot(cut.place.second, x - cut.place.centre);
          for (std::size_t comp = 0; comp < 2; ++comp) {
            double f = 0.0;
            for (int k = 0; k <= p; ++k)
              for (int j = 0; j <= p - k; ++j)
                f += donor[(r * size + at(p, j, k)) * 2 + comp] * std::pow(u, j) * std::pow(v, k);
            expected.mass[r * 2 + comp] += w * f;
            for (int k = 0; k <= p; ++k) {
              for (int j = 0; j <= p - k; ++j) {
                const double m = std::pow(xi, j) * std::pow(eta, k);
                expected.product[at(p, j, k) * 2 + comp] += w * f * m;
                if (comp == 0) expected.basis[at(p, j, k)] += w * m;
              }
            }
          }
        }
      }
      for (std::size_t i = 0; i < size; ++i)
        EXPECT_NEAR(sums.basis[i], expected.basis[i], 1e-15) << g << p;
      for (std::size_t i = 0; i < 2 * size; ++i)
        EXPECT_NEAR(sums.product[i], expected.product[i], 4e-15) << g << p;
      for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(sums.mass[i], expected.mass[i], 4e-15);
    }
  }
}

// Eight components go together, those left over in a part of the lanes: each has its own bits.
TEST(MomentBatch, ComponentsHaveTheBitsTheyHaveAlone) {
  for (int p = 0; p <= max_moment_degree; ++p) {
    Cut cut(2);
    cut.sum(2, 2 * p);
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(p));
    constexpr std::size_t components = 11;
    RandomStream random("components", static_cast<std::uint64_t>(p));
    std::vector<double> donor(2 * size * components);
    for (double& c : donor) c = random.uniform(-1, 1);
    std::vector<BatchRegion> regions;
    const Sums all = add(cut, p, components, donor, regions);
    for (std::size_t c = 0; c < components; ++c) {
      std::vector<double> own(2 * size);
      for (std::size_t n = 0; n < own.size(); ++n) own[n] = donor[n * components + c];
      const Sums one = add(cut, p, 1, own, regions);
      EXPECT_EQ(one.basis, all.basis);
      for (std::size_t n = 0; n < size; ++n)
        EXPECT_EQ(one.product[n], all.product[n * components + c]) << p << n << c;
      for (std::size_t r = 0; r < 2; ++r)
        EXPECT_EQ(one.mass[r], all.mass[r * components + c]) << p << r << c;
    }
    // Solved together and alone.
    std::vector<double> basis(size, 0.1), mass(components + batch_padding), base(mass.size());
    std::vector<double> got(size * components);
    for (double& m : mass) m = random.uniform(-1, 1);
    for (double& b : base) b = random.uniform(-1, 1);
    solve_straight(
        {p, components, 0.4, 0.4, all.product.data(), basis.data(), mass.data(), base.data()},
        got.data());
    for (std::size_t c = 0; c < components; ++c) {
      std::vector<double> product(size), alone(size);
      for (std::size_t n = 0; n < size; ++n) product[n] = all.product[n * components + c];
      solve_straight({p, 1, 0.4, 0.4, product.data(), basis.data(), &mass[c], &base[c]},
                     alone.data());
      for (std::size_t n = 0; n < size; ++n) EXPECT_EQ(alone[n], got[n * components + c]) << p << c;
    }
  }
}

TEST(MomentBatch, RegionsCloseAndAddUp) {
  for (int g = 1; g <= max_batch_degree; ++g) {
    std::array<double, 2> first{};
    for (const int moments : {0, 2, 4, 6}) {
      Cut cut(g);
      cut.sum(g, moments);
      const double whole = 0.5 * cross(Vec2{{1.1, 0.2}}, Vec2{{0.2, 1.1}});
      const double* corner = cut.batch.region(0);
      const double* rest = cut.batch.region(1);
      const double unit = cut.batch.area_in_units ? cut.place.area : 1.0;
      const double corner_area = corner[cut.batch.area] * unit;
      const double rest_area = rest[cut.batch.area] * unit;
      EXPECT_NEAR(corner_area, whole * 0.3 * 0.4, 1e-15);
      EXPECT_NEAR(rest_area, whole * (1.0 - 0.3 * 0.4), 1e-15);
      EXPECT_NEAR(corner[0] * cut.place.area, corner_area, 1e-15);
      EXPECT_NEAR(rest[0] * cut.place.area, rest_area, 1e-15);
      for (const double* region : {corner, rest}) {
        EXPECT_NEAR(std::hypot(region[cut.batch.open], region[cut.batch.open + 1]), 0.0, 1e-15);
      }
      // The same bits whatever the degree of the moments.
      if (moments == 0) first = {corner_area, rest_area};
      EXPECT_EQ(corner_area, first[0]);
      EXPECT_EQ(rest_area, first[1]);
    }
  }
}

TEST(SolveStraight, GivesBackPolynomialsWithTheirMasses) {
  const double area = 0.37;
  for (int p = 0; p <= max_moment_degree; ++p) {
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(p));
    RandomStream random("solve straight", static_cast<std::uint64_t>(p));
    std::vector<double> expected(2 * size), product(2 * size + batch_padding), basis(size);
    std::vector<double> mass(2 + batch_padding), got(2 * size);
    for (double& c : expected) c = random.uniform(-1, 1);
    const TriangleRule rule = triangle_rule(2 * p + 1);
    std::vector<double> phi(size);
    std::vector<double> base = {-0.5, 2.0};
    base.resize(2 + batch_padding);
    for (std::size_t q = 0; q < rule.weight.size(); ++q) {
      const double u = rule.lambda[q][1], v = rule.lambda[q][2], w = 2.0 * area * rule.weight[q];
      basis_at(p, u, v, phi.data());
      for (std::size_t c = 0; c < 2; ++c) {
        double f = 0.0;
        for (std::size_t n = 0; n < size; ++n) f += expected[n * 2 + c] * phi[n];
        mass[c] += w * f;
        for (int k = 0; k <= p; ++k)
          for (int j = 0; j <= p - k; ++j)
            product[at(p, j, k) * 2 + c] +=
                w * (f - base[c]) * std::pow(u - 1.0 / 3.0, j) * std::pow(v - 1.0 / 3.0, k);
      }
      for (int k = 0; k <= p; ++k)
        for (int j = 0; j <= p - k; ++j)
          basis[at(p, j, k)] += w * std::pow(u - 1.0 / 3.0, j) * std::pow(v - 1.0 / 3.0, k);
    }
    std::vector<std::vector<double>> seen;
    support::on_every_target(
        [&] {
          const double defect = solve_straight(
              {p, 2, area, area, product.data(), basis.data(), mass.data(), base.data()},
              got.data());
          EXPECT_LE(defect, 1e-15);
          for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], expected[i], 3e-14) << p;
          seen.push_back(got);
          EXPECT_EQ(seen.back(), seen.front());
        },
        true);
  }
}

TEST(MomentBatch, SameBitsOnEveryFusedTarget) {
  for (int g = 1; g <= max_batch_degree; ++g) {
    for (int p = 0; p <= max_moment_degree; ++p) {
      const auto size = static_cast<std::size_t>(bernstein::triangle_size(p));
      RandomStream random("moment targets", static_cast<std::uint64_t>(10 * g + p));
      std::vector<double> donor(2 * size * 3);
      for (double& c : donor) c = random.uniform(-1, 1);
      std::vector<Sums> seen;
      support::on_every_target(
          [&] {
            Cut cut(g);
            cut.sum(g, 2 * p);
            std::vector<BatchRegion> regions;
            seen.push_back(add(cut, p, 3, donor, regions));
            EXPECT_TRUE(seen.back() == seen.front()) << g << p;
          },
          true);
    }
  }
}

TEST(MomentBatch, ADonorMuchSmallerThanTheTargetIsLeftToItsOwnCentre) {
  Cut cut(1);
  cut.sum(1, 6);
  cut.donors[0] = affine_frame({Vec2{{0.2, 0.1}}, Vec2{{0.21, 0.1}}, Vec2{{0.2, 0.11}}});
  std::vector<BatchRegion> regions;
  const Sums sums = add(cut, 3, 1, std::vector<double>(20, 1.0), regions);
  EXPECT_TRUE(regions[0].far);
  EXPECT_FALSE(regions[1].far);
  EXPECT_EQ(sums.mass[0], 0.0);
  EXPECT_NE(sums.mass[1], 0.0);
}

}  // namespace
}  // namespace bezel::detail
