// The double versions on the tetrahedron against exact rationals. Each test states its bound; the
// largest fraction of it that was seen is recorded in the test's XML output under "worst".

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bezel/bernstein/tetrahedron.hpp"
#include "bezel/bernstein/tetrahedron_kernel.hpp"
#include "reference/bernstein/exact.hpp"

namespace {

using namespace bezel::bernstein;
namespace tet = bezel::bernstein::tetrahedron;
namespace tk = bezel::bernstein::tetrahedron::kernel;
using exact::max_abs;
using exact::Rational;
using exact::rationals;
constexpr double u = 0x1p-53;
constexpr double slack = 1.0 + 1e-10;  // second-order terms of bounds that are first order in u

using Doubles = std::vector<double>;
using Span = std::span<const double>;

/// Largest error / bound seen.
class Worst {
 public:
  ~Worst() { testing::Test::RecordProperty("worst", std::to_string(worst_)); }
  void see(double value, const Rational& truth, double bound, int d) {
    const double error = value == truth ? 0.0 : exact::distance(value, truth);
    const double ratio = error == 0.0 ? 0.0 : error / bound;
    EXPECT_LE(ratio, 1.0) << "degree " << d << ": error " << error << ", bound " << bound;
    if (ratio > worst_) worst_ = ratio;
  }
  void see(const Doubles& values, const std::vector<Rational>& truth, double bound, int d) {
    ASSERT_EQ(values.size(), truth.size());
    for (std::size_t i = 0; i < values.size(); ++i) see(values[i], truth[i], bound, d);
  }

 private:
  double worst_ = 0.0;
};

template <class Check>
void at_degrees(const std::vector<int>& degrees, const Check& check) {
  for (const int d : degrees) {
    std::mt19937_64 random(static_cast<std::uint64_t>(6000 + d));
    check(d, exact::random_doubles(tetrahedron_size(d), random), random);
    if (testing::Test::HasFailure()) return;
  }
}
const std::vector<int> few{0, 1, 2, 3, 4, 5, 6, 8, 10, 13, 16, 20};
const std::vector<int> low{0, 1, 2, 3, 4, 5, 6, 8};

/// Barycentrics that sum to 1 exactly, inside.
tet::Lambda point(std::mt19937_64& random) {
  const auto part = [&] { return static_cast<double>(random() >> 44) * 0x1p-20; };
  std::array<double, 3> x{part(), part(), part()};
  std::sort(x.begin(), x.end());
  return {x[0], x[1] - x[0], x[2] - x[1], 1.0 - x[2]};
}
std::array<Rational, 4> exactly(const tet::Lambda& x) {
  return {Rational(x[0]), Rational(x[1]), Rational(x[2]), Rational(x[3])};
}
Doubles absolute(Doubles b) {
  for (double& x : b) x = std::fabs(x);
  return b;
}

TEST(TetrahedronAccuracy, EvaluateWithin3dURelativeToAbsolutePolynomial) {
  Worst worst;
  at_degrees(few, [&](int d, const Doubles& b, std::mt19937_64& random) {
    const auto exact_b = rationals(b), exact_abs = rationals(absolute(b));
    for (int sample = 0; sample < 3; ++sample) {
      const tet::Lambda x = point(random);
      const Rational truth = tk::evaluate_unchecked(d, exact_b.data(), exactly(x));
      const Rational size = tk::evaluate_unchecked(d, exact_abs.data(), exactly(x));
      worst.see(tet::evaluate(d, Span(b), x), truth, 3.0 * d * u * size.get_d() * slack, d);
    }
  });
}

TEST(TetrahedronAccuracy, DerivativesWithin6dSquaredU) {
  Worst worst;
  at_degrees(few, [&](int d, const Doubles& b, std::mt19937_64& random) {
    const auto exact_b = rationals(b);
    const tet::Lambda x = point(random);
    const auto truth = tk::evaluate_gradient_unchecked(d, exact_b.data(), exactly(x));
    const auto computed = tet::evaluate_gradient(d, Span(b), x);
    const double bound = 6.0 * d * d * u * max_abs(b) * slack;
    worst.see(computed.du, truth.du, bound, d);
    worst.see(computed.dv, truth.dv, bound, d);
    worst.see(computed.dw, truth.dw, bound, d);
  });
}

TEST(TetrahedronAccuracy, SpecializeWithin3dU) {
  Worst worst;
  at_degrees(low, [&](int d, const Doubles& b, std::mt19937_64& random) {
    const auto exact_b = rationals(b);
    const std::array<tet::Lambda, 4> corner{point(random), point(random), point(random),
                                            point(random)};
    std::vector<Rational> truth(b.size());
    tk::specialize<Rational, Rational>(
        d, exact_b.data(),
        {exactly(corner[0]), exactly(corner[1]), exactly(corner[2]), exactly(corner[3])},
        {0, 1, 2, 3}, truth.data());
    worst.see(tet::specialize(d, Span(b), corner), truth, 3.0 * d * u * max_abs(b) * slack, d);
  });
}

TEST(TetrahedronAccuracy, SubdivideWithinDU) {
  Worst worst;
  at_degrees({0, 1, 2, 3, 4, 5, 6}, [&](int d, const Doubles& b, std::mt19937_64&) {
    const auto exact_b = rationals(b);
    std::array<std::vector<Rational>, 8> truth;
    std::array<Rational*, 8> place{};
    for (std::size_t c = 0; c < 8; ++c) {
      truth[c].resize(b.size());
      place[c] = truth[c].data();
    }
    tk::subdivide<Rational, Rational>(d, exact_b.data(), place);
    const auto child = tet::subdivide(d, Span(b));
    for (std::size_t c = 0; c < 8; ++c)
      worst.see(child[c], truth[c], d * u * max_abs(b) * slack, d);
  });
}

// Halving along edges, on which range and the searches of geometry rely: d u max|b| per level.
TEST(TetrahedronAccuracy, BisectionWithinDUPerLevel) {
  Worst worst;
  at_degrees(few, [&](int d, const Doubles& b, std::mt19937_64& random) {
    Doubles piece = b;
    std::vector<Rational> truth = rationals(b);
    const tk::Bisection bisection(d);
    for (int depth = 0; depth < 7; ++depth) {
      Doubles first(b.size()), second(b.size());
      std::vector<Rational> exact_first(b.size()), exact_second(b.size());
      bisection.split(depth, piece.data(), first.data(), second.data());
      bisection.split<Rational, Rational>(depth, truth.data(), exact_first.data(),
                                          exact_second.data());
      const double bound = (depth + 1) * d * u * max_abs(b) * slack;
      worst.see(first, exact_first, bound, d);
      worst.see(second, exact_second, bound, d);
      const bool left = random() % 2 == 0;
      piece = left ? first : second;
      truth = left ? exact_first : exact_second;
    }
  });
}

// Per level: a product, up to three sums, the rounded 1/n and its product.
TEST(TetrahedronAccuracy, ElevateWithin6UPerDegree) {
  Worst worst;
  at_degrees({0, 1, 2, 3, 5, 8, 12, 16}, [&](int d, const Doubles& b, std::mt19937_64&) {
    std::vector<Rational> truth = rationals(b), next;
    for (int by = 1; by <= 4; ++by) {
      next.resize(static_cast<std::size_t>(tetrahedron_size(d + by)));
      tk::elevate<Rational, Rational>(d + by - 1, truth.data(), next.data());
      truth = next;
      worst.see(tet::elevate(d, Span(b), by), truth, 6.0 * by * u * max_abs(b) * slack, d);
    }
  });
}

TEST(TetrahedronAccuracy, MultiplyRelativeToAbsolutePolynomials) {
  Worst worst;
  at_degrees({0, 1, 2, 3, 5, 8, 12, 16}, [&](int d, const Doubles& b, std::mt19937_64& random) {
    const int e = std::min(4, max_tetrahedron_degree - d);
    const Doubles c = exact::random_doubles(tetrahedron_size(e), random);
    std::vector<Rational> truth(static_cast<std::size_t>(tetrahedron_size(d + e))),
        size(truth.size());
    const auto rb = rationals(b), rc = rationals(c), ab = rationals(absolute(b)),
               ac = rationals(absolute(c));
    tk::multiply(d, rb.data(), e, rc.data(), truth.data());
    tk::multiply(d, ab.data(), e, ac.data(), size.data());
    const Doubles computed = tet::multiply(d, b, e, c);
    const double roundings = tetrahedron_size(std::min(d, e)) + 4.0;
    for (std::size_t k = 0; k < truth.size(); ++k)
      worst.see(computed[k], truth[k], roundings * u * size[k].get_d() * slack, d);
  });
}

TEST(TetrahedronAccuracy, IntegralIsRoundedAFewTimes) {
  Worst worst;
  at_degrees(few, [&](int d, const Doubles& b, std::mt19937_64&) {
    Rational truth(0);
    for (const double x : b) truth += Rational(x);
    truth /= (d + 1) * (d + 2) * (d + 3);
    const double n = static_cast<double>(b.size());
    worst.see(tet::integral(d, b), truth,
              2.0 * u * std::fabs(truth.get_d()) * slack + n * n * u * u * max_abs(b), d);
  });
}

TEST(TetrahedronAccuracy, LagrangeConversions) {
  Worst worst;
  at_degrees({0, 1, 2, 3, 4, 5, 6, 8, 10, 14, 20}, [&](int d, const Doubles& b, std::mt19937_64&) {
    const auto exact_b = rationals(b);
    std::vector<Rational> values(b.size()), back(b.size());
    tk::to_lagrange(d, exact_b.data(), values.data());
    tk::from_lagrange(d, exact_b.data(), back.data());
    const Doubles computed = tet::to_lagrange(d, Span(b)),
                  computed_back = tet::from_lagrange(d, Span(b));
    double largest = 0.0;
    for (const Rational& x : back) largest = std::max(largest, std::fabs(x.get_d()));
    for (std::size_t i = 0; i < b.size(); ++i) {
      worst.see(computed[i], values[i],
                u * std::fabs(values[i].get_d()) * slack + 64.0 * (d + 1) * u * u * max_abs(b), d);
      worst.see(
          computed_back[i], back[i],
          u * std::fabs(back[i].get_d()) * slack + 64.0 * u * u * std::pow(8.0, d) * max_abs(b), d);
      worst.see(computed_back[i], back[i], u * largest * slack, d);
    }
  });
}

// Powers: at most d - 1 roundings together, then three products; the multinomials are exact.
TEST(TetrahedronAccuracy, BasisIsRelativelyAccurate) {
  Worst worst;
  at_degrees(few, [&](int d, const Doubles& b, std::mt19937_64& random) {
    const tet::Lambda x = point(random);
    Doubles computed(b.size());
    std::vector<Rational> truth(b.size());
    tet::basis(d, x, computed);
    tk::basis(d, exactly(x), truth.data());
    for (std::size_t n = 0; n < b.size(); ++n)
      worst.see(computed[n], truth[n], (d + 3.0) * u * truth[n].get_d() * slack, d);
  });
}

// The enclosure holds the exact values and is no wider than the coefficients.
TEST(TetrahedronAccuracy, RangeEnclosesExactValues) {
  at_degrees({1, 2, 3, 4, 6, 9}, [&](int d, const Doubles& b, std::mt19937_64& random) {
    const double tol = 0.05;
    const auto r = tet::range(d, b, tol);
    const auto exact_b = rationals(b);
    for (int sample = 0; sample < 60; ++sample) {
      const Rational value = tk::evaluate_unchecked(d, exact_b.data(), exactly(point(random)));
      EXPECT_LE(Rational(r.lo), value);
      EXPECT_GE(Rational(r.hi), value);
    }
    EXPECT_GE(r.lo, *std::min_element(b.begin(), b.end()));
    EXPECT_LE(r.hi, *std::max_element(b.begin(), b.end()));
  });
}

}  // namespace
