// Curved tetrahedra on random and degenerate input: locate and invert against the map, volume
// against splitting, sides and affine change, validity under change of numbering.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/geometry/tetrahedron.hpp"

namespace {

namespace tet = bezel::bernstein::tetrahedron;
using bezel::Lambda4;
using bezel::Location;
using bezel::RandomStream;
using bezel::Validity;
using bezel::Vec3;
using bezel::bernstein::tetrahedron_multi_index;
using bezel::bernstein::tetrahedron_size;
using Points = std::vector<Vec3>;
constexpr double u = 0x1p-53;

std::span<const Vec3> in(const Points& b) {
  return b;
}

/// The equally spaced net of an affine tetrahedron, each point moved by up to `amount` / g.
Points perturbed(RandomStream& random, int g, double amount) {
  const std::array<Vec3, 4> corner{
      {{{0.2, -0.1, 0.3}}, {{1.3, 0.2, 0.2}}, {{0.1, 1.1, 0.4}}, {{0.3, 0.1, 1.5}}}};
  Points b;
  for (int n = 0; n < tetrahedron_size(g); ++n) {
    const auto x = tetrahedron_multi_index(g, n);
    Vec3 p;
    for (std::size_t c = 0; c < 4; ++c) p += (static_cast<double>(x[c]) / g) * corner[c];
    for (int c = 0; c < 3; ++c) p[c] += random.uniform(-amount, amount) / g;
    b.push_back(p);
  }
  return b;
}

/// Inside, on a face, an edge or a corner in turn.
Lambda4 random_lambda(RandomStream& random) {
  Lambda4 x{};
  double sum = 0;
  const std::uint64_t zeros = random.below(8);
  for (std::size_t c = 0; c < 4; ++c) {
    x[c] = (zeros < 4 && c == zeros) || (zeros < 2 && c == zeros + 2) ? 0.0 : random.uniform();
    sum += x[c];
  }
  for (double& l : x) l /= sum;
  return x;
}

double extent(const Points& b) {
  double e = 0;
  for (const Vec3& p : b)
    for (int c = 0; c < 3; ++c) e = std::max(e, std::fabs(p[c]));
  return e;
}

TEST(TetrahedronProperty, LocateFindsTheImageOfEveryPlace) {
  RandomStream random("LocateFindsTheImageOfEveryPlace", 1);
  for (int g = 1; g <= bezel::max_tetrahedron_map_degree; ++g) {
    int found = 0;
    while (found < 120) {
      const Points b = perturbed(random, g, 0.25);
      const auto valid = bezel::check_validity(g, b);
      if (valid.status != Validity::valid || valid.det < 0.05) continue;
      for (int i = 0; i < 12; ++i, ++found) {
        const Lambda4 x = random_lambda(random);
        const auto r = bezel::locate(g, b, tet::evaluate(g, in(b), x));
        ASSERT_EQ(r.status, Location::inside) << g;
        // p is off by 3 g u max|b|, the residual's evaluation by as much again.
        EXPECT_LE(r.residual, 8 * 3 * g * u * extent(b));
        // The inverse's Lipschitz constant: |J^-1| <= |J|^2 / det, with |J| below 3 g on these maps
        // (differences of neighbours below (1.5 + 2 * 0.25) / g in each coordinate).
        for (std::size_t c = 0; c < 4; ++c)
          EXPECT_NEAR(r.lambda[c], x[c], 36.0 / valid.det * 8 * 3 * g * u * extent(b));
      }
    }
  }
}

/// A little beyond each face: outside is proven, or the place is found with a negative barycentric.
TEST(TetrahedronProperty, LocateTellsThePlaceSideBySide) {
  RandomStream random("LocateTellsThePlaceSideBySide", 1);
  int outside = 0;
  for (int g = 1; g <= 5; ++g)
    for (int trial = 0; trial < 12; ++trial) {
      const Points b = perturbed(random, g, 0.2);
      const auto valid = bezel::check_validity(g, b);
      if (valid.status != Validity::valid || valid.det < 0.1) continue;
      for (const double step : {1e-1, 1e-3, 1e-6, 1e-9}) {
        Lambda4 x = random_lambda(random);
        const std::size_t face = random.below(4);
        const double moved = x[face] + step;
        x[face] = -step;
        x[(face + 1) % 4] += moved;
        const Vec3 p = tet::evaluate(g, in(b), x);
        // Beyond the tolerance: no place may be reported inside that does not map to p.
        const auto r = bezel::locate(g, b, p, 1e-12);
        EXPECT_NE(r.status, Location::not_converged) << g << " " << step;
        if (r.status == Location::outside) ++outside;
        if (r.status == Location::inside) {  // another preimage, possible for large steps
          EXPECT_LE(r.residual, 8 * 3 * g * u * extent(b));
          EXPECT_GE(step, 1e-3);
        }
        // Within the tolerance it is inside.
        EXPECT_EQ(bezel::locate(g, b, p, 2 * step).status, Location::inside) << g << " " << step;
      }
    }
  EXPECT_GT(outside, 100);
}

/// Points in a box around it: whoever is reported outside has no preimage on a fine lattice of
/// values nearby, whoever is inside is an image.
TEST(TetrahedronProperty, OutsideIsProvenForAnyMap) {
  RandomStream random("OutsideIsProvenForAnyMap", 1);
  std::array<int, 3> counts{};
  for (int g = 1; g <= 4; ++g)
    for (int trial = 0; trial < 70; ++trial) {
      const Points b = perturbed(random, g, 1.5);  // folded ones among them
      for (int i = 0; i < 20; ++i) {
        const Vec3 p{
            {random.uniform(-0.3, 1.6), random.uniform(-0.3, 1.4), random.uniform(-0.2, 1.8)}};
        const auto r = bezel::locate(g, b, p);
        ++counts[static_cast<std::size_t>(r.status)];
        if (r.status == Location::inside) {
          EXPECT_LE(bezel::norm(tet::evaluate(g, in(b), r.lambda) - p),
                    8 * 3 * g * u * (extent(b) + 1.8));
          continue;
        }
        if (r.status != Location::outside) continue;
        for (int m = 0; m < 20; ++m) {  // no Newton iteration from anywhere may end inside
          const auto inverse = bezel::invert(g, b, p, random_lambda(random));
          if (inverse.converged) {
            EXPECT_LT(*std::min_element(inverse.lambda.begin(), inverse.lambda.end()), -1e-13);
          }
        }
      }
      for (int i = 0; i < 20; ++i) {  // images are never outside, whatever the map
        const Vec3 p = tet::evaluate(g, in(b), random_lambda(random));
        EXPECT_NE(bezel::locate(g, b, p).status, Location::outside) << g;
      }
    }
  EXPECT_GT(counts[0], 200);
  EXPECT_GT(counts[1], 200);
  RecordProperty("not_converged", counts[2]);
  EXPECT_EQ(counts[2], 0);
}

/// The determinant's coefficients carry 6 (2 size + 13) u g^3 h^3, the volume a sixth of it.
double volume_bound(int g, const Points& b) {
  double h = 0;
  for (const Vec3& p : b)
    for (const Vec3& q : b)
      for (int c = 0; c < 3; ++c) h = std::max(h, std::fabs(p[c] - q[c]));
  return (2 * tetrahedron_size(g - 1) + 13) * u * g * g * g * h * h * h;
}

TEST(TetrahedronProperty, VolumesOfTheChildrenSumToTheWhole) {
  RandomStream random("VolumesOfTheChildrenSumToTheWhole", 1);
  for (int g = 1; g <= bezel::max_tetrahedron_map_degree; ++g)
    for (int trial = 0; trial < 4; ++trial) {
      const Points b = perturbed(random, g, 1.0);
      double sum = 0, bound = 0;
      for (const Points& child : tet::subdivide(g, in(b))) {
        sum += bezel::volume(g, child);
        bound += volume_bound(g, child);
      }
      // Children's control points are off by g u extent: a surface shell of that thickness.
      const double shell = 8 * 6.0 * g * g * g * g * u * std::pow(2 * extent(b), 3);
      EXPECT_NEAR(sum, bezel::volume(g, b), volume_bound(g, b) + bound + shell) << g;
    }
}

/// By the divergence theorem: a third of the integral of p . n over the faces, outside by their
/// orientation; exact by a product of Bernstein polynomials.
double volume_by_faces(int g, const Points& b) {
  double sum = 0;
  for (int face = 0; face < 4; ++face) {
    const Points f = tet::face(g, in(b), face);
    // f . (f_u x f_v) by summing over all products of coefficients: degree 3g - 2.
    std::array<std::vector<double>, 3> x, du, dv;
    for (int c = 0; c < 3; ++c) {
      const auto i = static_cast<std::size_t>(c);
      for (const Vec3& p : f) x[i].push_back(p[c]);
      auto d = bezel::bernstein::differentiate(g, std::span<const double>(x[i]));
      du[i] = d[0];
      dv[i] = d[1];
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t i = (c + 1) % 3, j = (c + 2) % 3;
      const auto plus = bezel::bernstein::multiply(g - 1, du[i], g - 1, dv[j]);
      const auto minus = bezel::bernstein::multiply(g - 1, du[j], g - 1, dv[i]);
      std::vector<double> normal;
      for (std::size_t n = 0; n < plus.size(); ++n) normal.push_back(plus[n] - minus[n]);
      sum += bezel::bernstein::integral(3 * g - 2,
                                        bezel::bernstein::multiply(g, x[c], 2 * (g - 1), normal));
    }
  }
  return sum / 3;
}

TEST(TetrahedronProperty, VolumeByTheDivergenceTheorem) {
  RandomStream random("VolumeByTheDivergenceTheorem", 1);
  for (int g = 1; g <= bezel::max_tetrahedron_map_degree; ++g)
    for (int trial = 0; trial < 10; ++trial) {
      const Points b = perturbed(random, g, 0.5);
      // Four faces with three products each of the size of the determinant, whose sums have
      // size(g)-ish terms: eight times the volume's own bound.
      EXPECT_NEAR(bezel::volume(g, b), volume_by_faces(g, b), 8 * volume_bound(g, b)) << g;
    }
}

TEST(TetrahedronProperty, VolumeUnderAffineMapsAndReflection) {
  RandomStream random("VolumeUnderAffineMapsAndReflection", 1);
  for (int g = 1; g <= 5; ++g)
    for (int trial = 0; trial < 10; ++trial) {
      const Points b = perturbed(random, g, 0.5);
      Points scaled = b, mirrored = b, sheared = b;
      for (Vec3& p : scaled) p = Vec3{{2 * p[0], 0.5 * p[1], 4 * p[2]}};
      for (Vec3& p : mirrored) p = Vec3{{p[1], p[0], p[2]}};
      EXPECT_EQ(bezel::volume(g, scaled), 4 * bezel::volume(g, b));
      for (Vec3& p : sheared) p[0] += 0.5 * p[2];
      EXPECT_NEAR(bezel::volume(g, mirrored), -bezel::volume(g, b), 2 * volume_bound(g, b));
      EXPECT_NEAR(bezel::volume(g, sheared), bezel::volume(g, b),
                  2 * volume_bound(g, sheared) + 3.0 * g * g * g * u * std::pow(2 * extent(b), 3));
    }
}

/// The verdict does not depend on the numbering of the corners (even ones keep the orientation,
/// odd ones change the sign), nor on scaling by powers of two.
TEST(TetrahedronProperty, ValidityUnderRenumberingAndScaling) {
  RandomStream random("ValidityUnderRenumberingAndScaling", 1);
  std::array<int, 3> counts{};
  for (int g = 1; g <= 4; ++g)
    for (int trial = 0; trial < 40; ++trial) {
      const Points b = perturbed(random, g, 0.15 + 0.85 * (trial % 5) / 4);
      const auto expected = bezel::check_validity(g, b).status;
      ++counts[static_cast<std::size_t>(expected)];
      Points scaled = b, turned(b.size()), mirrored(b.size());
      for (Vec3& p : scaled) p *= 0x1p-300;
      EXPECT_EQ(bezel::check_validity(g, scaled).status, expected);
      for (int n = 0; n < tetrahedron_size(g); ++n) {
        const auto x = tetrahedron_multi_index(g, n);
        const auto i = static_cast<std::size_t>(n);
        turned[i] = b[static_cast<std::size_t>(
            bezel::bernstein::tetrahedron_index({x[1], x[2], x[0], x[3]}))];
        mirrored[i] = b[static_cast<std::size_t>(
            bezel::bernstein::tetrahedron_index({x[1], x[0], x[2], x[3]}))];
      }
      EXPECT_EQ(bezel::check_validity(g, turned).status, expected);
      if (expected == Validity::valid) {
        EXPECT_EQ(bezel::check_validity(g, mirrored).status, Validity::inverted);
      }
    }
  EXPECT_GT(counts[0], 30);
  EXPECT_GT(counts[1], 30);
}

}  // namespace
