// The kernels on the triangle in exact arithmetic: identities hold with == at every supported
// degree in a prime field, and at the degrees up to 10 in rationals.

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <type_traits>
#include <vector>

#include "bezel/bernstein/triangle_kernel.hpp"
#include "reference/bernstein/exact.hpp"

namespace {

using namespace bezel::bernstein;

template <class Scalar>
class TriangleIdentities : public testing::Test {};
using Scalars = testing::Types<exact::Rational, exact::Mod61>;
TYPED_TEST_SUITE(TriangleIdentities, Scalars);

template <class Scalar>
using Point = std::array<Scalar, 3>;

template <class Scalar>
Point<Scalar> point(int i, int j, int k) {
  const Scalar n(i + j + k);
  return {Scalar(Scalar(i) / n), Scalar(Scalar(j) / n), Scalar(Scalar(k) / n)};
}

std::size_t size_of(int d) {
  return static_cast<std::size_t>(triangle_size(d));
}

template <class Scalar>
Scalar evaluate(int d, const std::vector<Scalar>& b, const Point<Scalar>& x) {
  return kernel::evaluate_unchecked(d, b.data(), x);
}

template <class Scalar, class Check>
void at_every_degree(const Check& check) {
  const int largest = std::is_same_v<Scalar, exact::Rational> ? 10 : max_triangle_degree;
  for (int d = 0; d <= largest; ++d) {
    SCOPED_TRACE("degree " + std::to_string(d));
    std::mt19937_64 random(static_cast<std::uint64_t>(2000 + d));
    check(d, exact::random_values<Scalar>(triangle_size(d), random));
    if (testing::Test::HasFailure()) return;
  }
}

// Barycentric combination of corners: the point x of the triangle with the given corners.
template <class Scalar>
Point<Scalar> inside(const std::array<Point<Scalar>, 3>& corner, const Point<Scalar>& x) {
  Point<Scalar> y{Scalar(0), Scalar(0), Scalar(0)};
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t e = 0; e < 3; ++e) y[e] = Scalar(y[e] + Scalar(x[c] * corner[c][e]));
  return y;
}

TYPED_TEST(TriangleIdentities, EvaluateIsTheSumOverTheBasis) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    for (const Point<Scalar>& x : {point<Scalar>(2, 3, 6), point<Scalar>(1, 0, 0),
                                   point<Scalar>(0, 2, 5), point<Scalar>(-2, 3, 4)}) {
      std::vector<Scalar> basis(b.size());
      kernel::basis_triangle(d, x, basis.data());
      Scalar sum(0), ones(0);
      for (std::size_t n = 0; n < b.size(); ++n) {
        sum = Scalar(sum + Scalar(b[n] * basis[n]));
        ones = Scalar(ones + basis[n]);
      }
      EXPECT_EQ(evaluate(d, b, x), sum);
      EXPECT_EQ(ones, Scalar(1));
    }
  });
}

TYPED_TEST(TriangleIdentities, GradientOfOneSweepIsTheDerivativePolynomials) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    const int m = d == 0 ? 0 : d - 1;
    std::vector<Scalar> du(size_of(m)), dv(size_of(m));
    kernel::differentiate_triangle<Scalar, Scalar>(d, b.data(), du.data(), dv.data());
    const Point<Scalar> x = point<Scalar>(3, 1, 5);
    const auto all = kernel::evaluate_gradient_unchecked(d, b.data(), x);
    EXPECT_EQ(all.value, evaluate(d, b, x));
    EXPECT_EQ(all.du, evaluate(m, du, x));
    EXPECT_EQ(all.dv, evaluate(m, dv, x));
  });
}

// d/du of the monomial-like polynomial from its basis: l1^d has the derivative d l1^(d-1) in u, 0
// in v.
TYPED_TEST(TriangleIdentities, DerivativesOfPowers) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    if (d == 0) return;
    std::vector<Scalar> power(b.size(), Scalar(0));
    power[static_cast<std::size_t>(triangle_corner(d, 1))] = Scalar(1);
    const Point<Scalar> x = point<Scalar>(3, 1, 5);
    const auto all = kernel::evaluate_gradient_unchecked(d, power.data(), x);
    Scalar lower(1);
    for (int i = 1; i < d; ++i) lower = Scalar(lower * x[1]);
    EXPECT_EQ(all.value, Scalar(lower * x[1]));
    EXPECT_EQ(all.du, Scalar(Scalar(d) * lower));
    EXPECT_EQ(all.dv, Scalar(0));
  });
}

TYPED_TEST(TriangleIdentities, SpecializeIsAnAffineMap) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    const std::array<Point<Scalar>, 3> corner{point<Scalar>(1, 2, 4), point<Scalar>(5, -1, 2),
                                              point<Scalar>(0, 3, 8)};
    std::vector<Scalar> part(b.size()), other(b.size());
    kernel::specialize_triangle<Scalar, Scalar>(d, b.data(), corner, {0, 1, 2}, part.data());
    const Point<Scalar> x = point<Scalar>(2, 1, 1);
    EXPECT_EQ(evaluate(d, part, x), evaluate(d, b, inside(corner, x)));
    kernel::specialize_triangle<Scalar, Scalar>(d, b.data(), corner, {2, 0, 1}, other.data());
    EXPECT_EQ(part, other);  // a blossom is symmetric
  });
}

TYPED_TEST(TriangleIdentities, ChildrenOfTheMidpointSplitAreTheWhole) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    std::array<std::vector<Scalar>, 4> child;
    std::array<Scalar*, 4> place{};
    for (std::size_t c = 0; c < 4; ++c) {
      child[c].resize(b.size());
      place[c] = child[c].data();
    }
    kernel::subdivide_triangle<Scalar, Scalar>(d, b.data(), place);
    const Point<Scalar> c0 = point<Scalar>(1, 0, 0), c1 = point<Scalar>(0, 1, 0),
                        c2 = point<Scalar>(0, 0, 1), m0 = point<Scalar>(1, 1, 0),
                        m1 = point<Scalar>(0, 1, 1), m2 = point<Scalar>(1, 0, 1);
    const std::array<std::array<Point<Scalar>, 3>, 4> corners{
        {{c0, m0, m2}, {m0, c1, m1}, {m2, m1, c2}, {m1, m2, m0}}};
    const Point<Scalar> x = point<Scalar>(4, 1, 2);
    for (std::size_t c = 0; c < 4; ++c)
      EXPECT_EQ(evaluate(d, child[c], x), evaluate(d, b, inside(corners[c], x))) << c;
  });
}

TYPED_TEST(TriangleIdentities, ElevateKeepsThePolynomialAndReduceUndoesIt) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    if (d == max_triangle_degree) return;
    std::vector<Scalar> raised(size_of(d + 1)), back(b.size());
    kernel::elevate_triangle<Scalar, Scalar>(d, b.data(), raised.data());
    const Point<Scalar> x = point<Scalar>(4, 1, 2);
    EXPECT_EQ(evaluate(d + 1, raised, x), evaluate(d, b, x));
    kernel::reduce_triangle<Scalar, Scalar>(d + 1, raised.data(), back.data());
    EXPECT_EQ(back, b);
  });
}

// With the exact mass matrix of degree d: the rest is orthogonal to every elevated polynomial.
TYPED_TEST(TriangleIdentities, ReduceLeavesAnOrthogonalRest) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    if (d == 0 || d > 20) return;  // the mass matrix is what costs; elevation covers the rest
    std::vector<Scalar> low(size_of(d - 1)), rest(b.size()), mass(b.size() * b.size());
    kernel::reduce_triangle<Scalar, Scalar>(d, b.data(), low.data());
    kernel::elevate_triangle<Scalar, Scalar>(d - 1, low.data(), rest.data());
    for (std::size_t n = 0; n < b.size(); ++n) rest[n] = Scalar(b[n] - rest[n]);
    kernel::mass_matrix(d, mass.data());
    std::mt19937_64 random(11);
    for (int sample = 0; sample < 3; ++sample) {
      const auto test = exact::random_values<Scalar>(triangle_size(d - 1), random);
      std::vector<Scalar> raised(b.size());
      kernel::elevate_triangle<Scalar, Scalar>(d - 1, test.data(), raised.data());
      Scalar sum(0);
      for (std::size_t m = 0; m < b.size(); ++m)
        for (std::size_t n = 0; n < b.size(); ++n)
          sum = Scalar(sum + Scalar(Scalar(raised[m] * mass[m * b.size() + n]) * rest[n]));
      EXPECT_EQ(sum, Scalar(0));
    }
  });
}

// The mass matrix against the integral of the product: sum of coefficients over their number, times
// 1/2.
TYPED_TEST(TriangleIdentities, MassMatrixIntegratesProducts) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    if (2 * d > max_triangle_degree && d % 5 != 0) return;
    std::mt19937_64 random(13);
    const auto c = exact::random_values<Scalar>(triangle_size(d), random);
    std::vector<Scalar> product(size_of(2 * d)), mass(b.size() * b.size());
    kernel::multiply_triangle(d, b.data(), d, c.data(), product.data());
    kernel::mass_matrix(d, mass.data());
    Scalar integral(0), form(0);
    for (const Scalar& x : product) integral = Scalar(integral + x);
    integral = Scalar(integral / Scalar((2 * d + 1) * (2 * d + 2)));
    for (std::size_t m = 0; m < b.size(); ++m)
      for (std::size_t n = 0; n < b.size(); ++n)
        form = Scalar(form + Scalar(Scalar(b[m] * mass[m * b.size() + n]) * c[n]));
    EXPECT_EQ(form, integral);
  });
}

TYPED_TEST(TriangleIdentities, ProductsOfValues) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    const int dc = max_triangle_degree - d > 10 ? 10 : max_triangle_degree - d;
    std::mt19937_64 random(17);
    const auto c = exact::random_values<Scalar>(triangle_size(dc), random);
    std::vector<Scalar> product(size_of(d + dc));
    kernel::multiply_triangle(d, b.data(), dc, c.data(), product.data());
    const Point<Scalar> x = point<Scalar>(2, 5, 3);
    EXPECT_EQ(evaluate(d + dc, product, x), Scalar(evaluate(d, b, x) * evaluate(dc, c, x)));
  });
}

TYPED_TEST(TriangleIdentities, LagrangeFormIsTheValuesAndConvertsBack) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    std::vector<Scalar> values(b.size()), back(b.size());
    kernel::to_lagrange_triangle(d, b.data(), values.data());
    for (int n = 0; n < triangle_size(d); n += 1 + triangle_size(d) / 9) {
      const auto index = triangle_multi_index(d, n);
      const Point<Scalar> x =
          d == 0 ? point<Scalar>(1, 1, 1) : point<Scalar>(index[0], index[1], index[2]);
      EXPECT_EQ(values[static_cast<std::size_t>(n)], evaluate(d, b, x));
    }
    kernel::from_lagrange_triangle(d, values.data(), back.data());
    EXPECT_EQ(back, b);
  });
}

// A side of the triangle is the polynomial on it.
TYPED_TEST(TriangleIdentities, SidesAreIntervalPolynomials) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    const Scalar s = Scalar(Scalar(2) / Scalar(7)), r = Scalar(Scalar(1) - s), zero(0);
    const std::array<Point<Scalar>, 3> x{{{r, s, zero}, {zero, r, s}, {s, zero, r}}};
    for (int side = 0; side < 3; ++side) {
      std::vector<Scalar> c;
      for (int m = 0; m <= d; ++m)
        c.push_back(b[static_cast<std::size_t>(triangle_side_index(d, side, m))]);
      EXPECT_EQ(kernel::evaluate_unchecked(d, c.data(), s),
                evaluate(d, b, x[static_cast<std::size_t>(side)]));
    }
  });
}

}  // namespace
