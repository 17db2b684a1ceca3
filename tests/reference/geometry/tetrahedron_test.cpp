// The Jacobian determinant of curved tetrahedra in exact arithmetic, and check_validity against
// exact values of it.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/geometry/tetrahedron.hpp"
#include "bezel/geometry/tetrahedron_kernel.hpp"
#include "reference/bernstein/exact.hpp"

namespace exact {  // what Vec asks of its scalar
inline Mod61& operator+=(Mod61& a, Mod61 b) {
  return a = a + b;
}
inline Mod61& operator-=(Mod61& a, Mod61 b) {
  return a = a - b;
}
inline Mod61& operator*=(Mod61& a, Mod61 b) {
  return a = a * b;
}
}  // namespace exact

namespace {

using namespace bezel::bernstein;
namespace tk = bezel::bernstein::tetrahedron::kernel;
using bezel::Lambda4;
using bezel::Validity;
using bezel::Vec;
using bezel::Vec3;
using exact::Rational;

template <class Scalar>
using Point = std::array<Scalar, 4>;

/// The determinant at x from the map's derivatives there: not the routine's way.
template <class Scalar>
Scalar determinant(int g, const std::vector<Vec<3, Scalar>>& b, const Point<Scalar>& x) {
  std::array<std::array<Scalar, 3>, 3> a;
  for (int c = 0; c < 3; ++c) {
    std::vector<Scalar> coordinate;
    for (const auto& p : b) coordinate.push_back(p[c]);
    const auto f = tk::evaluate_gradient_unchecked(g, coordinate.data(), x);
    a[static_cast<std::size_t>(c)] = {f.du, f.dv, f.dw};
  }
  const auto minor = [&](std::size_t i, std::size_t j) {
    return Scalar(Scalar(a[1][i] * a[2][j]) - Scalar(a[1][j] * a[2][i]));
  };
  return Scalar(Scalar(Scalar(a[0][0] * minor(1, 2)) - Scalar(a[0][1] * minor(0, 2))) +
                Scalar(a[0][2] * minor(0, 1)));
}

template <class Scalar>
class TetrahedronDeterminant : public testing::Test {};
using Scalars = testing::Types<exact::Rational, exact::Mod61>;
TYPED_TEST_SUITE(TetrahedronDeterminant, Scalars);

template <class Scalar>
std::vector<Vec<3, Scalar>> random_points(int g, std::mt19937_64& random) {
  const auto v = exact::random_values<Scalar>(3 * tetrahedron_size(g), random);
  std::vector<Vec<3, Scalar>> b;
  for (std::size_t n = 0; n < v.size(); n += 3) b.push_back({{v[n], v[n + 1], v[n + 2]}});
  return b;
}

TYPED_TEST(TetrahedronDeterminant, IsThatOfTheMapsDerivatives) {
  using Scalar = TypeParam;
  const int largest = std::is_same_v<Scalar, Rational> ? 4 : bezel::max_tetrahedron_map_degree;
  for (int g = 1; g <= largest; ++g) {
    SCOPED_TRACE("degree " + std::to_string(g));
    std::mt19937_64 random(static_cast<std::uint64_t>(7000 + g));
    const auto b = random_points<Scalar>(g, random);
    const int d = 3 * (g - 1);
    std::vector<Scalar> det(static_cast<std::size_t>(tetrahedron_size(d)));
    bezel::geometry_kernel::hodograph_determinant(
        g, bezel::geometry_kernel::hodographs(g, b.data()), det.data());
    for (int sample = 0; sample < 4; ++sample) {
      const auto v = exact::random_values<Scalar>(3, random);
      const Point<Scalar> x{Scalar(Scalar(Scalar(Scalar(1) - v[0]) - v[1]) - v[2]), v[0], v[1],
                            v[2]};
      EXPECT_EQ(tk::evaluate_unchecked(d, det.data(), x), determinant<Scalar>(g, b, x));
    }
  }
}

std::vector<Vec<3, Rational>> rationals(const std::vector<Vec3>& b) {
  std::vector<Vec<3, Rational>> out;
  for (const Vec3& p : b) out.push_back({{Rational(p[0]), Rational(p[1]), Rational(p[2])}});
  return out;
}

/// The identity as a map of degree g, each control point moved by up to `amount` / g.
std::vector<Vec3> perturbed(bezel::RandomStream& random, int g, double amount) {
  std::vector<Vec3> b;
  for (int n = 0; n < tetrahedron_size(g); ++n) {
    const auto x = tetrahedron_multi_index(g, n);
    Vec3 p;
    for (int c = 0; c < 3; ++c)
      p[c] = (x[static_cast<std::size_t>(c) + 1] + random.uniform(-amount, amount)) / g;
    b.push_back(p);
  }
  return b;
}

TEST(TetrahedronReference, DeterminantWithinItsBound) {
  bezel::RandomStream random("DeterminantWithinItsBound", 1);
  double worst = 0;
  for (int g = 1; g <= 5; ++g)
    for (int trial = 0; trial < 5; ++trial) {
      const auto b = perturbed(random, g, 1.0);
      const auto computed = bezel::jacobian_determinant(g, b);
      auto hodographs = bezel::geometry_kernel::hodographs(g, b.data());
      double h = 0;
      for (const auto& along : hodographs)
        for (const Vec3& e : along)
          for (int c = 0; c < 3; ++c) h = std::max(h, std::fabs(e[c]));
      std::vector<Rational> truth(computed.size());
      bezel::geometry_kernel::hodograph_determinant(
          g, bezel::geometry_kernel::hodographs(g, rationals(b).data()), truth.data());
      const double bound =
          6 * (2 * tetrahedron_size(g - 1) + 13) * 0x1p-53 * g * g * g * h * h * h * (1 + 1e-10);
      Rational sum(0);
      for (std::size_t n = 0; n < truth.size(); ++n) {
        const double error = exact::distance(computed[n], truth[n]);
        EXPECT_LE(error, bound) << g;
        worst = std::max(worst, error / bound);
        sum += truth[n];
      }
      sum /= 6 * static_cast<int>(truth.size());
      EXPECT_LE(exact::distance(bezel::volume(g, b), sum),
                bound / 6 + 2 * 0x1p-53 * std::fabs(sum.get_d()) * (1 + 1e-10));
    }
  RecordProperty("worst", std::to_string(worst));
}

// A verdict is proven: `valid` maps have positive exact values everywhere they are tried,
// `inverted` ones an exact value that is not positive at the place given, whose entries are exact.
TEST(TetrahedronReference, VerdictsAgreeWithExactValues) {
  bezel::RandomStream random("VerdictsAgreeWithExactValues", 1);
  std::array<int, 3> counts{};
  for (int g = 1; g <= 4; ++g)
    for (const double amount : {0.1, 0.2, 0.6, 1.0})
      for (int trial = 0; trial < 25; ++trial) {
        const auto b = perturbed(random, g, amount);
        const auto exact_b = rationals(b);
        const auto found = bezel::check_validity(g, b);
        ++counts[static_cast<std::size_t>(found.status)];
        const auto at = [&](const Lambda4& x) {
          return determinant<Rational>(
              g, exact_b, {Rational(x[0]), Rational(x[1]), Rational(x[2]), Rational(x[3])});
        };
        if (found.status == Validity::valid) {
          for (int n = 0; n < tetrahedron_size(4); ++n) {  // a lattice with corners, edges, faces
            const auto x = tetrahedron_multi_index(4, n);
            EXPECT_GT(at({x[0] / 4.0, x[1] / 4.0, x[2] / 4.0, x[3] / 4.0}), 0);
          }
        } else if (found.status == Validity::inverted) {
          EXPECT_LE(at(found.where), 0);
        }
      }
  RecordProperty("valid", counts[0]);
  RecordProperty("inverted", counts[1]);
  RecordProperty("undecided", counts[2]);
  EXPECT_GT(counts[0], 100);
  EXPECT_GT(counts[1], 100);
  EXPECT_EQ(counts[2], 0);
}

// Nets on a coarse lattice: collapsed edges and faces, corners in a plane, determinants that vanish
// in places or everywhere. Whatever is decided is right, and no image of a place is outside.
TEST(TetrahedronReference, DegenerateNets) {
  bezel::RandomStream random("DegenerateNets", 1);
  std::array<int, 3> counts{};
  for (int g = 1; g <= 3; ++g)
    for (int trial = 0; trial < 60; ++trial) {
      std::vector<Vec3> b;
      for (int n = 0; n < tetrahedron_size(g); ++n) {
        const auto x = tetrahedron_multi_index(g, n);
        Vec3 p;
        for (int c = 0; c < 3; ++c)
          p[c] = trial % 3 == 0
                     ? static_cast<double>(random.below(3))
                     : 2 * x[static_cast<std::size_t>(c) + 1] + (random.below(3) == 0 ? 1.0 : 0.0);
        if (trial % 3 == 2 && x[0] + x[1] == 0) p = Vec3{};  // an edge collapses to a point
        b.push_back(p);
      }
      const auto exact_b = rationals(b);
      const auto found = bezel::check_validity(g, b);
      ++counts[static_cast<std::size_t>(found.status)];
      const auto at = [&](const Lambda4& x) {
        return determinant<Rational>(
            g, exact_b, {Rational(x[0]), Rational(x[1]), Rational(x[2]), Rational(x[3])});
      };
      if (found.status == Validity::inverted) {
        EXPECT_LE(at(found.where), 0);
      }
      for (int n = 0; n < tetrahedron_size(4); ++n) {
        const auto m = tetrahedron_multi_index(4, n);
        const Lambda4 x{m[0] / 4.0, m[1] / 4.0, m[2] / 4.0, m[3] / 4.0};
        if (found.status == Validity::valid) {
          EXPECT_GT(at(x), 0);
        }
        const Vec3 p = tetrahedron::evaluate(g, std::span<const Vec3>(b), x);
        EXPECT_NE(bezel::locate(g, b, p).status, bezel::Location::outside);
      }
    }
  RecordProperty("valid", counts[0]);
  RecordProperty("inverted", counts[1]);
  RecordProperty("undecided", counts[2]);
  EXPECT_GT(counts[0], 10);
  EXPECT_GT(counts[1], 60);
}

// det = 3 (u - s)^2 + 3 e exactly, from x = 3 times the antiderivative of (u - s)^2 + e.
TEST(TetrahedronReference, TouchingAndNearlyTouching) {
  const double s = 0.375;
  const auto map = [&](double e) {
    // x = u^3 - 3 s u^2 + 3 (s^2 + e) u.
    std::vector<Vec3> b;
    for (int n = 0; n < tetrahedron_size(3); ++n) {
      const auto m = tetrahedron_multi_index(3, n);
      const double j = m[1];  // blossoms of u, u^2, u^3: j/3, j(j-1)/6, j(j-1)(j-2)/6
      b.push_back({{j * (j - 1) * (j - 2) / 6 - s * (j * (j - 1) / 2) + (s * s + e) * j,
                    static_cast<double>(m[2]), static_cast<double>(m[3])}});
    }
    return b;
  };
  const auto exact_value = [&](double e) {
    return determinant<Rational>(3, rationals(map(e)), {Rational(0.625), Rational(s), 0, 0});
  };
  ASSERT_EQ(exact_value(0.0), 0);
  ASSERT_EQ(exact_value(0x1p-10), Rational(27) / 1024);
  // Touching zero inside, on an edge of the 1/8 lattice that halving reaches: zero, exactly.
  const auto touching = bezel::check_validity(3, map(0.0));
  EXPECT_EQ(touching.status, Validity::inverted);
  EXPECT_EQ(touching.det, 0.0);
  EXPECT_EQ(touching.where[1], s);
  EXPECT_EQ(bezel::check_validity(3, map(0x1p-10)).status, Validity::valid);
  EXPECT_EQ(bezel::check_validity(3, map(-0x1p-10)).status, Validity::inverted);
  EXPECT_EQ(bezel::check_validity(3, map(-0x1p-46)).status, Validity::inverted);
  EXPECT_NE(bezel::check_validity(3, map(0x1p-46)).status, Validity::inverted);
}

}  // namespace
