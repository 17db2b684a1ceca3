// The kernels on the tetrahedron in exact arithmetic: identities hold with == at every supported
// degree in a prime field, and at the degrees up to 8 in rationals.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <string>
#include <type_traits>
#include <vector>

#include "bezel/bernstein/tetrahedron_kernel.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "reference/bernstein/exact.hpp"

namespace {

using namespace bezel::bernstein;
namespace tk = bezel::bernstein::tetrahedron::kernel;

template <class Scalar>
class TetrahedronIdentities : public testing::Test {};
using Scalars = testing::Types<exact::Rational, exact::Mod61>;
TYPED_TEST_SUITE(TetrahedronIdentities, Scalars);

template <class Scalar>
using Point = std::array<Scalar, 4>;
template <class Scalar>
using Corners = std::array<Point<Scalar>, 4>;

template <class Scalar>
Point<Scalar> point(int i, int j, int k, int l) {
  const Scalar n(i + j + k + l);
  return {Scalar(Scalar(i) / n), Scalar(Scalar(j) / n), Scalar(Scalar(k) / n),
          Scalar(Scalar(l) / n)};
}

std::size_t size_of(int d) {
  return static_cast<std::size_t>(tetrahedron_size(d));
}

template <class Scalar>
Scalar evaluate(int d, const std::vector<Scalar>& b, const Point<Scalar>& x) {
  return tk::evaluate_unchecked(d, b.data(), x);
}

template <class Scalar, class Check>
void at_every_degree(const Check& check) {
  const int largest = std::is_same_v<Scalar, exact::Rational> ? 8 : max_tetrahedron_degree;
  for (int d = 0; d <= largest; ++d) {
    SCOPED_TRACE("degree " + std::to_string(d));
    std::mt19937_64 random(static_cast<std::uint64_t>(5000 + d));
    check(d, exact::random_values<Scalar>(tetrahedron_size(d), random));
    if (testing::Test::HasFailure()) return;
  }
}

/// The point x of the tetrahedron with the given corners.
template <class Scalar>
Point<Scalar> inside(const Corners<Scalar>& corner, const Point<Scalar>& x) {
  Point<Scalar> y{Scalar(0), Scalar(0), Scalar(0), Scalar(0)};
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t e = 0; e < 4; ++e) y[e] = Scalar(y[e] + Scalar(x[c] * corner[c][e]));
  return y;
}

TYPED_TEST(TetrahedronIdentities, EvaluateIsTheSumOverTheBasis) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    for (const Point<Scalar>& x :
         {point<Scalar>(2, 3, 6, 1), point<Scalar>(1, 0, 0, 0), point<Scalar>(0, 2, 5, 0),
          point<Scalar>(0, 0, 0, 1), point<Scalar>(-2, 3, 4, 1)}) {
      std::vector<Scalar> basis(b.size());
      tk::basis(d, x, basis.data());
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

TYPED_TEST(TetrahedronIdentities, GradientOfOneSweepIsTheDerivativePolynomials) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    const int m = d == 0 ? 0 : d - 1;
    std::vector<Scalar> du(size_of(m)), dv(size_of(m)), dw(size_of(m));
    tk::differentiate<Scalar, Scalar>(d, b.data(), du.data(), dv.data(), dw.data());
    const Point<Scalar> x = point<Scalar>(3, 1, 5, 2);
    const auto all = tk::evaluate_gradient_unchecked(d, b.data(), x);
    EXPECT_EQ(all.value, evaluate(d, b, x));
    EXPECT_EQ(all.du, evaluate(m, du, x));
    EXPECT_EQ(all.dv, evaluate(m, dv, x));
    EXPECT_EQ(all.dw, evaluate(m, dw, x));
  });
}

// l_c^d, whose derivative along u, v, w is d l_c^(d-1) in direction c and, for l_0, minus that in
// all.
TYPED_TEST(TetrahedronIdentities, DerivativesOfPowers) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    if (d == 0) return;
    const Point<Scalar> x = point<Scalar>(3, 1, 5, 2);
    for (int corner = 0; corner < 4; ++corner) {
      std::vector<Scalar> power(b.size(), Scalar(0));
      power[static_cast<std::size_t>(tetrahedron_corner(d, corner))] = Scalar(1);
      const auto all = tk::evaluate_gradient_unchecked(d, power.data(), x);
      Scalar lower(1);
      for (int i = 1; i < d; ++i) lower = Scalar(lower * x[static_cast<std::size_t>(corner)]);
      const Scalar slope = Scalar(Scalar(d) * lower), zero(0);
      const Scalar minus = Scalar(zero - slope);
      EXPECT_EQ(all.value, Scalar(lower * x[static_cast<std::size_t>(corner)]));
      EXPECT_EQ(all.du, corner == 0 ? minus : corner == 1 ? slope : zero);
      EXPECT_EQ(all.dv, corner == 0 ? minus : corner == 2 ? slope : zero);
      EXPECT_EQ(all.dw, corner == 0 ? minus : corner == 3 ? slope : zero);
    }
  });
}

TYPED_TEST(TetrahedronIdentities, SpecializeIsAnAffineMap) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    const Corners<Scalar> corner{point<Scalar>(1, 2, 4, 1), point<Scalar>(5, -1, 2, 1),
                                 point<Scalar>(0, 3, 8, 2), point<Scalar>(1, 0, 1, 3)};
    std::vector<Scalar> part(b.size()), other(b.size());
    tk::specialize<Scalar, Scalar>(d, b.data(), corner, {0, 1, 2, 3}, part.data());
    const Point<Scalar> x = point<Scalar>(2, 1, 1, 4);
    EXPECT_EQ(evaluate(d, part, x), evaluate(d, b, inside(corner, x)));
    tk::specialize<Scalar, Scalar>(d, b.data(), corner, {2, 0, 3, 1}, other.data());
    EXPECT_EQ(part, other);  // a blossom is symmetric
  });
}

TYPED_TEST(TetrahedronIdentities, ChildrenOfTheMidpointSplitAreTheWhole) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    std::array<std::vector<Scalar>, 8> child;
    std::array<Scalar*, 8> place{};
    for (std::size_t c = 0; c < 8; ++c) {
      child[c].resize(b.size());
      place[c] = child[c].data();
    }
    tk::subdivide<Scalar, Scalar>(d, b.data(), place);
    const auto m = [](int i, int j) {
      std::array<int, 4> x{};
      ++x[static_cast<std::size_t>(i)];
      ++x[static_cast<std::size_t>(j)];
      return point<Scalar>(x[0], x[1], x[2], x[3]);
    };
    const std::array<Corners<Scalar>, 8> corners{{{m(0, 0), m(0, 1), m(0, 2), m(0, 3)},
                                                  {m(0, 1), m(1, 1), m(1, 2), m(1, 3)},
                                                  {m(0, 2), m(1, 2), m(2, 2), m(2, 3)},
                                                  {m(0, 3), m(1, 3), m(2, 3), m(3, 3)},
                                                  {m(0, 2), m(1, 3), m(0, 1), m(1, 2)},
                                                  {m(0, 2), m(1, 3), m(1, 2), m(2, 3)},
                                                  {m(0, 2), m(1, 3), m(2, 3), m(0, 3)},
                                                  {m(0, 2), m(1, 3), m(0, 3), m(0, 1)}}};
    const Point<Scalar> x = point<Scalar>(4, 1, 2, 3);
    Scalar sum(0), whole(0);  // integrals: an eighth of each mean
    for (std::size_t c = 0; c < 8; ++c) {
      EXPECT_EQ(evaluate(d, child[c], x), evaluate(d, b, inside(corners[c], x))) << c;
      for (const Scalar& y : child[c]) sum = Scalar(sum + y);
    }
    for (const Scalar& y : b) whole = Scalar(whole + y);
    EXPECT_EQ(sum, Scalar(Scalar(8) * whole));
  });
}

// Three levels of halving; the pieces cover the whole, and the corners are those the coefficients
// belong to.
TYPED_TEST(TetrahedronIdentities, BisectionIsTheWhole) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    struct Piece {
      std::vector<Scalar> b;
      std::array<std::array<double, 4>, 4> corner;
    };
    std::vector<Piece> pieces{{b, {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}}};
    const tk::Bisection bisection(d);
    for (int depth = 0; depth < 5; ++depth) {
      std::vector<Piece> next;
      for (const Piece& p : pieces) {
        Piece first = p, second = p;
        bisection.split<Scalar, Scalar>(depth, p.b.data(), first.b.data(), second.b.data());
        tk::Bisection::split_corners(depth, p.corner, first.corner, second.corner);
        next.push_back(first);
        next.push_back(second);
      }
      pieces = next;
      if (depth % 2 == 0) pieces.resize(pieces.size() / 2 + 1);  // not all need be followed
    }
    const Point<Scalar> x = point<Scalar>(4, 1, 2, 3);
    for (const Piece& p : pieces) {
      Corners<Scalar> corner;
      for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t e = 0; e < 4; ++e) corner[c][e] = Scalar(p.corner[c][e]);
      EXPECT_EQ(evaluate(d, p.b, x), evaluate(d, b, inside(corner, x)));
    }
  });
}

TYPED_TEST(TetrahedronIdentities, ElevateKeepsThePolynomial) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    if (d == max_tetrahedron_degree) return;
    std::vector<Scalar> raised(size_of(d + 1));
    tk::elevate<Scalar, Scalar>(d, b.data(), raised.data());
    const Point<Scalar> x = point<Scalar>(4, 1, 2, 3);
    EXPECT_EQ(evaluate(d + 1, raised, x), evaluate(d, b, x));
    // The same as the product with 1 = l0 + l1 + l2 + l3.
    const std::vector<Scalar> one(4, Scalar(1));
    std::vector<Scalar> product(size_of(d + 1));
    tk::multiply(d, b.data(), 1, one.data(), product.data());
    EXPECT_EQ(raised, product);
  });
}

TYPED_TEST(TetrahedronIdentities, ProductsOfValues) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    const int dc = std::min(max_tetrahedron_degree - d, 6);
    std::mt19937_64 random(17);
    const auto c = exact::random_values<Scalar>(tetrahedron_size(dc), random);
    std::vector<Scalar> product(size_of(d + dc)), swapped(product.size());
    tk::multiply(d, b.data(), dc, c.data(), product.data());
    tk::multiply(dc, c.data(), d, b.data(), swapped.data());
    const Point<Scalar> x = point<Scalar>(2, 5, 3, 1);
    EXPECT_EQ(evaluate(d + dc, product, x), Scalar(evaluate(d, b, x) * evaluate(dc, c, x)));
    EXPECT_EQ(product, swapped);
  });
}

// The integral is the mean of the coefficients over 6, on a face over 2.
TYPED_TEST(TetrahedronIdentities, DivergenceTheoremTiesIntegralsToFaces) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    if (d == 0) return;
    // The integral of dp/du over the tetrahedron is that of p over face 0 less that over face 1,
    // both parametrised by (v, w).
    std::vector<Scalar> du(size_of(d - 1)), dv(size_of(d - 1)), dw(size_of(d - 1));
    tk::differentiate<Scalar, Scalar>(d, b.data(), du.data(), dv.data(), dw.data());
    const std::array<std::vector<Scalar>*, 3> derivative{&du, &dv, &dw};
    const auto face_sum = [&](int face) {
      Scalar sum(0);
      for (int k = 0; k <= d; ++k)
        for (int j = 0; j <= d - k; ++j)
          sum = Scalar(sum + b[static_cast<std::size_t>(tetrahedron_face_index(d, face, j, k))]);
      return Scalar(sum / Scalar((d + 1) * (d + 2)));
    };
    for (int axis = 1; axis <= 3; ++axis) {
      Scalar volume(0);
      for (const Scalar& x : *derivative[static_cast<std::size_t>(axis - 1)])
        volume = Scalar(volume + x);
      volume = Scalar(volume / Scalar(d * (d + 1) * (d + 2)));
      EXPECT_EQ(volume, Scalar(face_sum(0) - face_sum(axis)));
    }
  });
}

TYPED_TEST(TetrahedronIdentities, LagrangeFormIsTheValuesAndConvertsBack) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    std::vector<Scalar> values(b.size()), back(b.size());
    tk::to_lagrange(d, b.data(), values.data());
    for (int n = 0; n < tetrahedron_size(d); n += 1 + tetrahedron_size(d) / 13) {
      const auto index = tetrahedron_multi_index(d, n);
      const Point<Scalar> x = d == 0 ? point<Scalar>(1, 1, 1, 1)
                                     : point<Scalar>(index[0], index[1], index[2], index[3]);
      EXPECT_EQ(values[static_cast<std::size_t>(n)], evaluate(d, b, x));
    }
    tk::from_lagrange(d, values.data(), back.data());
    EXPECT_EQ(back, b);
  });
}

// A face of the tetrahedron is the polynomial on it.
TYPED_TEST(TetrahedronIdentities, FacesAreTrianglePolynomials) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    const std::array<Scalar, 3> x{Scalar(Scalar(2) / Scalar(7)), Scalar(Scalar(4) / Scalar(7)),
                                  Scalar(Scalar(1) / Scalar(7))};
    for (int face = 0; face < 4; ++face) {
      std::vector<Scalar> c;
      for (int k = 0; k <= d; ++k)
        for (int j = 0; j <= d - k; ++j)
          c.push_back(b[static_cast<std::size_t>(tetrahedron_face_index(d, face, j, k))]);
      Point<Scalar> y{Scalar(0), Scalar(0), Scalar(0), Scalar(0)};
      for (std::size_t i = 0; i < 3; ++i)
        y[static_cast<std::size_t>(tetrahedron_face_corners[static_cast<std::size_t>(face)][i])] =
            x[i];
      EXPECT_EQ(kernel::evaluate_unchecked(d, c.data(), x), evaluate(d, b, y));
    }
  });
}

}  // namespace
