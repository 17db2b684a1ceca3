// The double versions against exact rationals at every supported degree. Each test states its
// bound; the largest fraction of it that was seen is recorded in the test's XML output under
// "worst".

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bezel/bernstein/interval.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "reference/bernstein/exact.hpp"

namespace {

using namespace bezel::bernstein;
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
  explicit Worst(const char* key = "worst") : key_(key) {}
  Worst(const Worst&) = delete;
  Worst& operator=(const Worst&) = delete;
  ~Worst() { testing::Test::RecordProperty(key_, std::to_string(worst_)); }
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
  const char* key_;
  double worst_ = 0.0;
};

Doubles absolute(Doubles b) {
  for (double& x : b) x = std::fabs(x);
  return b;
}

template <class Check>
void at_interval_degrees(const Check& check) {
  for (int d = 0; d <= max_interval_degree; ++d) {
    std::mt19937_64 random(static_cast<std::uint64_t>(3000 + d));
    check(d, exact::random_doubles(d + 1, random), random);
    if (testing::Test::HasFailure()) return;
  }
}
template <class Check>
void at_triangle_degrees(int largest, const Check& check) {
  for (int d = 0; d <= largest; ++d) {
    std::mt19937_64 random(static_cast<std::uint64_t>(4000 + d));
    check(d, exact::random_doubles(triangle_size(d), random), random);
    if (testing::Test::HasFailure()) return;
  }
}
double parameter(std::mt19937_64& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

// Per level: one rounding of 1-s, one product, one sum.
TEST(IntervalAccuracy, EvaluateWithin3dURelativeToAbsolutePolynomial) {
  Worst worst;
  at_interval_degrees([&](int d, const Doubles& b, std::mt19937_64& random) {
    for (const double s : {parameter(random), parameter(random) * 0x1p-20, 0.0, 1.0}) {
      const auto exact_b = rationals(b), exact_abs = rationals(absolute(b));
      const Rational truth = kernel::evaluate_unchecked(d, exact_b.data(), Rational(s));
      const Rational size = kernel::evaluate_unchecked(d, exact_abs.data(), Rational(s));
      worst.see(evaluate(Span(b), s), truth, 3.0 * d * u * size.get_d() * slack, d);
    }
  });
}

TEST(IntervalAccuracy, ManyPointsWithin3dURelativeToAbsolutePolynomial) {
  Worst worst;
  at_interval_degrees([&](int d, const Doubles& b, std::mt19937_64& random) {
    Doubles s{0.0, 1.0, parameter(random) * 0x1p-20, 1.0 - parameter(random) * 0x1p-20};
    while (s.size() < 8) s.push_back(parameter(random));
    Doubles value(s.size());
    evaluate(b, s, value);
    const auto exact_b = rationals(b), exact_abs = rationals(absolute(b));
    for (std::size_t q = 0; q < s.size(); ++q) {
      const Rational truth = kernel::evaluate_unchecked(d, exact_b.data(), Rational(s[q]));
      const Rational size = kernel::evaluate_unchecked(d, exact_abs.data(), Rational(s[q]));
      worst.see(value[q], truth, 3.0 * d * u * size.get_d() * slack, d);
    }
  });
}

TEST(IntervalAccuracy, DerivativeWithin6dSquaredU) {
  Worst worst;
  at_interval_degrees([&](int d, const Doubles& b, std::mt19937_64& random) {
    const double s = parameter(random);
    const auto exact_b = rationals(b);
    const Rational truth =
        kernel::evaluate_derivative_unchecked(d, exact_b.data(), Rational(s)).derivative;
    worst.see(evaluate_derivative(Span(b), s), truth, 6.0 * d * d * u * max_abs(b) * slack, d);
  });
}

TEST(IntervalAccuracy, SubdivideAndSpecializeWithin3dU) {
  Worst worst;
  at_interval_degrees([&](int d, const Doubles& b, std::mt19937_64& random) {
    const double s = parameter(random), t = parameter(random);
    const auto exact_b = rationals(b);
    std::vector<Rational> left(b.size()), right(b.size()), part(b.size());
    kernel::subdivide(d, exact_b.data(), Rational(s), left.data(), right.data());
    const auto halves = subdivide(Span(b), s);
    const double bound = 3.0 * d * u * max_abs(b) * slack;
    worst.see(halves.first, left, bound, d);
    worst.see(halves.second, right, bound, d);
    if (d > 30 && d % 6 != 0) return;
    kernel::specialize(d, exact_b.data(), Rational(s), Rational(t), part.data());
    worst.see(specialize(Span(b), s, t), part, bound, d);
  });
}

// Elevation: per step product, sum, the rounded 1/n and its product: 4 u. Reduction: the
// tridiagonal system has condition (d+1)/2 and is solved backward stably: 4 (d+1) u per step.
TEST(IntervalAccuracy, ElevateAndReduce) {
  Worst elevation, reduction;
  at_interval_degrees([&](int d, const Doubles& b, std::mt19937_64&) {
    const int by = std::min(3, max_interval_degree - d);
    std::vector<Rational> truth = rationals(b), next;
    for (int m = d; m < d + by; ++m, truth.swap(next)) {
      next.resize(truth.size() + 1);
      kernel::elevate<Rational, Rational>(m, truth.data(), next.data());
    }
    elevation.see(elevate(Span(b), by), truth, 4.0 * by * u * max_abs(b) * slack, d);
    const int down = std::min(2, d);
    truth = rationals(b);
    for (int m = d; m > d - down; --m, truth.swap(next)) {
      next.resize(truth.size() - 1);
      kernel::reduce<Rational, Rational>(m, truth.data(), next.data());
    }
    reduction.see(reduce(Span(b), down), truth, down * 4.0 * (d + 1.0) * u * max_abs(b), d);
  });
}

// Per coefficient: scaling of both factors, product, at most min(da, db) sums, division, and the
// rounding of three tabulated binomials, relative to the product of the absolute polynomials.
TEST(IntervalAccuracy, MultiplyIsSmallRelativeToAbsoluteProduct) {
  Worst worst;
  at_interval_degrees([&](int d, const Doubles& b, std::mt19937_64& random) {
    const int e = max_interval_degree - d;
    const Doubles c = exact::random_doubles(e + 1, random);
    const auto product = [&](const Doubles& x, const Doubles& y) {
      const auto exact_x = rationals(x), exact_y = rationals(y);
      std::vector<Rational> out(x.size() + y.size() - 1);
      kernel::multiply(d, exact_x.data(), e, exact_y.data(), out.data());
      return out;
    };
    const auto truth = product(b, c), size = product(absolute(b), absolute(c));
    const Doubles computed = multiply(b, c);
    for (std::size_t k = 0; k < truth.size(); ++k)
      worst.see(computed[k], truth[k], (std::min(d, e) + 7.0) * u * size[k].get_d() * slack, d);
  });
}

TEST(IntervalAccuracy, IntegralsAreRoundedAFewTimes) {
  Worst worst;
  at_interval_degrees([&](int d, const Doubles& b, std::mt19937_64&) {
    const auto exact_b = rationals(b);
    std::vector<Rational> truth(b.size() + 1);
    kernel::antiderivative<Rational, Rational>(d, exact_b.data(), truth.data());
    const double total = std::fabs(truth.back().get_d());
    worst.see(integral(b), truth.back(), 2.0 * u * total * slack + d * d * u * u * max_abs(b), d);
    if (d == max_interval_degree) return;
    const Doubles computed = antiderivative(b);
    for (std::size_t i = 0; i < truth.size(); ++i)
      worst.see(computed[i], truth[i],
                u * std::fabs(truth[i].get_d()) * slack + d * d * 4.0 * u * u * max_abs(b), d);
  });
}

// One rounding of the result, plus double-double's roundings relative to the size of the terms.
TEST(IntervalAccuracy, MonomialConversionsAreRoundedOnce) {
  Worst worst;
  at_interval_degrees([&](int d, const Doubles& b, std::mt19937_64&) {
    const auto exact_b = rationals(b);
    std::vector<Rational> a(b.size()), back(b.size());
    kernel::to_monomial(d, exact_b.data(), a.data());
    kernel::from_monomial(d, exact_b.data(), back.data());
    const Doubles computed = to_monomial(b), computed_back = from_monomial(b);
    for (int k = 0; k <= d; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double terms = std::ldexp(bezel::kernel::Binomial<double>::get(d, k), k) * max_abs(b);
      worst.see(computed[i], a[i],
                u * std::fabs(a[i].get_d()) * slack + 8.0 * (d + 1) * u * u * terms, d);
      worst.see(
          computed_back[i], back[i],
          u * std::fabs(back[i].get_d()) * slack + 16.0 * (d + 1) * u * u * (k + 1.0) * max_abs(b),
          d);
    }
  });
}

// The a-priori bound grows with the inverse's condition, 8^d; the error seen stays below u
// max|result|.
TEST(IntervalAccuracy, LagrangeConversions) {
  Worst worst;
  at_interval_degrees([&](int d, const Doubles& b, std::mt19937_64&) {
    const auto exact_b = rationals(b);
    std::vector<Rational> values(b.size()), back(b.size());
    kernel::to_lagrange(d, exact_b.data(), values.data());
    kernel::from_lagrange(d, exact_b.data(), back.data());
    const Doubles computed = to_lagrange(Span(b)), computed_back = from_lagrange(Span(b));
    double largest = 0.0;
    for (const Rational& x : back) largest = std::max(largest, std::fabs(x.get_d()));
    for (std::size_t i = 0; i < b.size(); ++i) {
      worst.see(computed[i], values[i],
                u * std::fabs(values[i].get_d()) * slack + 32.0 * (d + 1) * u * u * max_abs(b), d);
      const double bound =
          u * std::fabs(back[i].get_d()) * slack + 64.0 * u * u * std::pow(8.0, d) * max_abs(b);
      worst.see(computed_back[i], back[i], bound, d);
      worst.see(computed_back[i], back[i], u * largest * slack, d);
    }
  });
}

TEST(IntervalAccuracy, BasisIsRelativelyAccurate) {
  Worst worst;
  at_interval_degrees([&](int d, const Doubles&, std::mt19937_64& random) {
    const double s = parameter(random);
    Doubles computed(static_cast<std::size_t>(d + 1));
    std::vector<Rational> truth(computed.size());
    basis(d, s, computed);
    kernel::basis(d, Rational(s), truth.data());
    for (std::size_t i = 0; i < truth.size(); ++i)
      worst.see(computed[i], truth[i], (2.0 * d + 3.0) * u * truth[i].get_d() * slack, d);
  });
}

Lambda point(std::mt19937_64& random) {
  double a = parameter(random), b = parameter(random);
  if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
  return {(1.0 - a) - b, a, b};
}
std::array<Rational, 3> exactly(const Lambda& x) {
  return {Rational(x[0]), Rational(x[1]), Rational(x[2])};
}

// Per level one product and at most two sums.
TEST(TriangleAccuracy, EvaluateWithin3dURelativeToAbsolutePolynomial) {
  Worst worst, many("worst of many");
  at_triangle_degrees(max_triangle_degree, [&](int d, const Doubles& b, std::mt19937_64& random) {
    if (d > 20 && d % 5 != 0) return;
    const Lambda x = point(random);
    const auto exact_b = rationals(b), exact_abs = rationals(absolute(b));
    // Sums over the basis: independent of de Casteljau, and cheaper in rationals.
    std::vector<Rational> weights(b.size());
    kernel::basis_triangle(d, exactly(x), weights.data());
    Rational truth(0), size(0);
    for (std::size_t n = 0; n < b.size(); ++n) {
      truth += exact_b[n] * weights[n];
      size += exact_abs[n] * weights[n];
    }
    const double bound = 3.0 * d * u * size.get_d() * slack;
    worst.see(evaluate(d, Span(b), x), truth, bound, d);
    double value;  // the evaluation of many points has the same bound
    evaluate(d, Span(b), {&x[1], 1}, {&x[2], 1}, {&value, 1});
    many.see(value, truth, bound, d);
  });
}

TEST(TriangleAccuracy, GradientWithin6dSquaredU) {
  Worst worst;
  at_triangle_degrees(16, [&](int d, const Doubles& b, std::mt19937_64& random) {
    const Lambda x = point(random);
    const auto exact_b = rationals(b);
    const auto truth = kernel::evaluate_gradient_unchecked(d, exact_b.data(), exactly(x));
    const auto computed = evaluate_gradient(d, Span(b), x);
    const double bound = 6.0 * d * d * u * max_abs(b) * slack;
    worst.see(computed.value, truth.value, 3.0 * d * u * max_abs(b) * slack, d);
    worst.see(computed.du, truth.du, bound, d);
    worst.see(computed.dv, truth.dv, bound, d);
  });
}

TEST(TriangleAccuracy, ChildrenWithinDU) {
  Worst worst;
  at_triangle_degrees(10, [&](int d, const Doubles& b, std::mt19937_64&) {
    const auto exact_b = rationals(b);
    std::array<std::vector<Rational>, 4> truth;
    std::array<Rational*, 4> place{};
    for (std::size_t c = 0; c < 4; ++c) {
      truth[c].resize(b.size());
      place[c] = truth[c].data();
    }
    kernel::subdivide_triangle<Rational, Rational>(d, exact_b.data(), place);
    const auto computed = subdivide(d, Span(b));
    for (std::size_t c = 0; c < 4; ++c)
      worst.see(computed[c], truth[c], d * u * max_abs(b) * slack, d);
  });
}

TEST(TriangleAccuracy, SpecializeWithin3dU) {
  Worst worst;
  at_triangle_degrees(10, [&](int d, const Doubles& b, std::mt19937_64& random) {
    const std::array<Lambda, 3> corner{point(random), point(random), point(random)};
    const auto exact_b = rationals(b);
    std::vector<Rational> truth(b.size());
    kernel::specialize_triangle<Rational, Rational>(
        d, exact_b.data(), {exactly(corner[0]), exactly(corner[1]), exactly(corner[2])}, {0, 1, 2},
        truth.data());
    worst.see(specialize(d, Span(b), corner), truth, 3.0 * d * u * max_abs(b) * slack, d);
  });
}

TEST(TriangleAccuracy, ElevateWithin5U) {
  Worst worst;
  at_triangle_degrees(max_triangle_degree - 1, [&](int d, const Doubles& b, std::mt19937_64&) {
    const auto exact_b = rationals(b);
    std::vector<Rational> truth(static_cast<std::size_t>(triangle_size(d + 1)));
    kernel::elevate_triangle<Rational, Rational>(d, exact_b.data(), truth.data());
    worst.see(elevate(d, Span(b)), truth, 5.0 * u * max_abs(b) * slack, d);
  });
}

// The error of a least-squares solution from its exact normal residual: |E^T (E c - b)| / smallest
// eigenvalue of E^T E, which is 2 (d+1/2) / d^2 > 2 / d; in the Euclidean norm.
TEST(TriangleAccuracy, ReduceFromItsExactResidual) {
  Worst worst;
  at_triangle_degrees(max_triangle_degree, [&](int d, const Doubles& b, std::mt19937_64&) {
    if (d == 0) return;
    const Doubles c = reduce(d, Span(b));
    const auto exact_c = rationals(c);
    std::vector<Rational> rest(b.size());
    kernel::elevate_triangle<Rational, Rational>(d - 1, exact_c.data(), rest.data());
    std::vector<Rational> normal(c.size(), Rational(0));
    for (int n = 0; n < triangle_size(d); ++n) {
      const auto i = static_cast<std::size_t>(n);
      rest[i] -= Rational(b[i]);
      const auto index = triangle_multi_index(d, n);
      const int j = index[1], k = index[2];
      const auto add = [&](int weight, int column) {
        if (weight > 0) normal[static_cast<std::size_t>(column)] += rest[i] * weight / d;
      };
      add(index[0], triangle_index(d - 1, j, k));
      add(j, triangle_index(d - 1, j - 1, k));
      add(k, triangle_index(d - 1, j, k - 1));
    }
    Rational squared(0);
    for (const Rational& x : normal) squared += x * x;
    const double error = std::sqrt(squared.get_d()) * 0.5 * d;
    const double norm = std::sqrt(static_cast<double>(b.size())) * max_abs(b);
    worst.see(error, Rational(0), 4.0 * d * u * norm, d);
  });
}

TEST(TriangleAccuracy, MultiplyIsSmallRelativeToAbsoluteProduct) {
  Worst worst;
  at_triangle_degrees(max_triangle_degree, [&](int d, const Doubles& b, std::mt19937_64& random) {
    const int e = std::min(4, max_triangle_degree - d);
    const Doubles c = exact::random_doubles(triangle_size(e), random);
    const auto product = [&](const Doubles& x, const Doubles& y) {
      const auto exact_x = rationals(x), exact_y = rationals(y);
      std::vector<Rational> out(static_cast<std::size_t>(triangle_size(d + e)));
      kernel::multiply_triangle(d, exact_x.data(), e, exact_y.data(), out.data());
      return out;
    };
    const auto truth = product(b, c), size = product(absolute(b), absolute(c));
    const Doubles computed = multiply(d, b, e, c);
    const double roundings = triangle_size(std::min(d, e)) + 10.0;
    for (std::size_t k = 0; k < truth.size(); ++k)
      worst.see(computed[k], truth[k], roundings * u * size[k].get_d() * slack, d);
  });
}

TEST(TriangleAccuracy, IntegralIsRoundedAFewTimes) {
  Worst worst;
  at_triangle_degrees(max_triangle_degree, [&](int d, const Doubles& b, std::mt19937_64&) {
    Rational truth(0);
    for (const double x : b) truth += Rational(x);
    truth /= (d + 1) * (d + 2);
    const double n = static_cast<double>(b.size());
    worst.see(integral(d, b), truth,
              2.0 * u * std::fabs(truth.get_d()) * slack + n * n * u * u * max_abs(b), d);
  });
}

TEST(TriangleAccuracy, LagrangeConversions) {
  Worst worst;
  at_triangle_degrees(12, [&](int d, const Doubles& b, std::mt19937_64&) {
    const auto exact_b = rationals(b);
    std::vector<Rational> values(b.size()), back(b.size());
    kernel::to_lagrange_triangle(d, exact_b.data(), values.data());
    kernel::from_lagrange_triangle(d, exact_b.data(), back.data());
    const Doubles computed = to_lagrange(d, Span(b)), computed_back = from_lagrange(d, Span(b));
    double largest = 0.0;
    for (const Rational& x : back) largest = std::max(largest, std::fabs(x.get_d()));
    for (std::size_t i = 0; i < b.size(); ++i) {
      worst.see(computed[i], values[i],
                u * std::fabs(values[i].get_d()) * slack + 32.0 * (d + 1) * u * u * max_abs(b), d);
      worst.see(
          computed_back[i], back[i],
          u * std::fabs(back[i].get_d()) * slack + 64.0 * u * u * std::pow(8.0, d) * max_abs(b), d);
      worst.see(computed_back[i], back[i], u * largest * slack, d);
    }
  });
}

// Three tabulated binomials, three products, the scale's product and the division.
TEST(TriangleAccuracy, MassMatrixWithin8URelatively) {
  Worst worst;
  for (const int d : {0, 1, 2, 3, 5, 8, 13, 20, 29, 40}) {
    const Doubles computed = mass_matrix(d);
    const auto size = static_cast<std::size_t>(triangle_size(d));
    ASSERT_EQ(computed.size(), size * size);
    const Rational scale =
        bezel::kernel::Binomial<Rational>::get(2 * d, d) * ((2 * d + 1) * (2 * d + 2));
    const std::size_t stride = d <= 8 ? 1 : 37;
    for (std::size_t entry = 0; entry < computed.size(); entry += stride) {
      const auto a = triangle_multi_index(d, static_cast<int>(entry / size));
      const auto b = triangle_multi_index(d, static_cast<int>(entry % size));
      Rational truth = 1 / scale;
      for (std::size_t e = 0; e < 3; ++e)
        truth *= bezel::kernel::Binomial<Rational>::get(a[e] + b[e], a[e]);
      worst.see(computed[entry], truth, 8.0 * u * truth.get_d() * slack, d);
    }
  }
}

TEST(TriangleAccuracy, BasisIsRelativelyAccurate) {
  Worst worst;
  at_triangle_degrees(max_triangle_degree, [&](int d, const Doubles& b, std::mt19937_64& random) {
    if (d > 20 && d % 4 != 0) return;
    const Lambda x = point(random);
    Doubles computed(b.size());
    std::vector<Rational> truth(b.size());
    basis(d, x, computed);
    kernel::basis_triangle(d, exactly(x), truth.data());
    for (std::size_t n = 0; n < b.size(); ++n)
      worst.see(computed[n], truth[n], (d + 6.0) * u * truth[n].get_d() * slack, d);
  });
}

}  // namespace
