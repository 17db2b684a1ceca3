// The kernels on [0, 1] in exact arithmetic: identities hold with == at every supported degree.

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "bezel/bernstein/interval_kernel.hpp"
#include "reference/bernstein/exact.hpp"

namespace {

using bezel::bernstein::max_interval_degree;
namespace kernel = bezel::bernstein::kernel;

template <class Scalar>
class IntervalIdentities : public testing::Test {};
using Scalars = testing::Types<exact::Rational, exact::Mod61>;
TYPED_TEST_SUITE(IntervalIdentities, Scalars);

template <class Scalar>
Scalar evaluate(const std::vector<Scalar>& b, const Scalar& s) {
  return kernel::evaluate_unchecked(static_cast<int>(b.size()) - 1, b.data(), s);
}

template <class Scalar>
Scalar fraction(int p, int q) {
  return Scalar(Scalar(p) / Scalar(q));
}

template <class Scalar, class Check>
void at_every_degree(const Check& check) {
  for (int d = 0; d <= max_interval_degree; ++d) {
    SCOPED_TRACE("degree " + std::to_string(d));
    std::mt19937_64 random(static_cast<std::uint64_t>(1000 + d));
    check(d, exact::random_values<Scalar>(d + 1, random));
    if (testing::Test::HasFailure()) return;
  }
}

TYPED_TEST(IntervalIdentities, EvaluateIsTheSumOverTheBasis) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    for (const Scalar& s : {fraction<Scalar>(0, 1), fraction<Scalar>(3, 7), fraction<Scalar>(1, 1),
                            fraction<Scalar>(-5, 3)}) {
      std::vector<Scalar> basis(b.size());
      kernel::basis(d, s, basis.data());
      Scalar sum(0), ones(0);
      for (std::size_t i = 0; i < b.size(); ++i) {
        sum = Scalar(sum + Scalar(b[i] * basis[i]));
        ones = Scalar(ones + basis[i]);
      }
      EXPECT_EQ(evaluate(b, s), sum);
      EXPECT_EQ(ones, Scalar(1));
    }
  });
}

TYPED_TEST(IntervalIdentities, DerivativeOfOneSweepIsTheDerivativePolynomial) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    std::vector<Scalar> slope(static_cast<std::size_t>(d == 0 ? 1 : d));
    kernel::differentiate<Scalar, Scalar>(d, b.data(), slope.data());
    const Scalar s = fraction<Scalar>(2, 5);
    const auto both = kernel::evaluate_derivative_unchecked(d, b.data(), s);
    EXPECT_EQ(both.value, evaluate(b, s));
    EXPECT_EQ(both.derivative, evaluate(slope, s));
  });
}

TYPED_TEST(IntervalIdentities, ChildrenOfASplitAreTheWhole) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    std::vector<Scalar> left(b.size()), right(b.size());
    for (const Scalar& t :
         {fraction<Scalar>(1, 2), fraction<Scalar>(1, 3), fraction<Scalar>(4, 3)}) {
      kernel::subdivide(d, b.data(), t, left.data(), right.data());
      const Scalar x = fraction<Scalar>(3, 4);
      EXPECT_EQ(evaluate(left, x), evaluate(b, Scalar(t * x)));
      EXPECT_EQ(evaluate(right, x), evaluate(b, Scalar(t + Scalar((Scalar(1) - t) * x))));
      EXPECT_EQ(left.back(), right.front());
      EXPECT_EQ(left.back(), evaluate(b, t));
    }
  });
}

TYPED_TEST(IntervalIdentities, SpecializeIsAChangeOfParameter) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    std::vector<Scalar> part(b.size()), back(b.size());
    const Scalar t0 = fraction<Scalar>(5, 6), t1 = fraction<Scalar>(1, 4),
                 x = fraction<Scalar>(2, 3);
    kernel::specialize(d, b.data(), t0, t1, part.data());
    EXPECT_EQ(evaluate(part, x), evaluate(b, Scalar(t0 + Scalar(Scalar(t1 - t0) * x))));
    // And back: 0 and 1 lie at (0 - t0) / (t1 - t0) and (1 - t0) / (t1 - t0) of the part.
    const Scalar width = Scalar(t1 - t0);
    kernel::specialize(d, part.data(), Scalar(Scalar(Scalar(0) - t0) / width),
                       Scalar(Scalar(Scalar(1) - t0) / width), back.data());
    EXPECT_EQ(back, b);
  });
}

TYPED_TEST(IntervalIdentities, ElevateKeepsThePolynomialAndReduceUndoesIt) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    if (d == max_interval_degree) return;
    std::vector<Scalar> raised(b.size() + 1), back(b.size());
    kernel::elevate<Scalar, Scalar>(d, b.data(), raised.data());
    EXPECT_EQ(evaluate(raised, fraction<Scalar>(3, 8)), evaluate(b, fraction<Scalar>(3, 8)));
    kernel::reduce<Scalar, Scalar>(d + 1, raised.data(), back.data());
    EXPECT_EQ(back, b);
  });
}

// p - reduce(p) is orthogonal to every polynomial of degree d-1:
// integral B_i^d B_j^(d-1) = C(d,i) C(d-1,j) / (C(2d-1,i+j) 2d).
TYPED_TEST(IntervalIdentities, ReduceLeavesAnOrthogonalRest) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    if (d == 0) return;
    using Table = bezel::kernel::Binomial<Scalar>;
    std::vector<Scalar> low(b.size() - 1), rest(b.size());
    kernel::reduce<Scalar, Scalar>(d, b.data(), low.data());
    kernel::elevate<Scalar, Scalar>(d - 1, low.data(), rest.data());
    for (std::size_t i = 0; i < b.size(); ++i) rest[i] = Scalar(b[i] - rest[i]);
    for (int j = 0; j < d; ++j) {
      Scalar sum(0);
      for (int i = 0; i <= d; ++i)
        sum = Scalar(sum + Scalar(Scalar(rest[static_cast<std::size_t>(i)] * Table::get(d, i)) /
                                  Table::get(2 * d - 1, i + j)));
      EXPECT_EQ(sum, Scalar(0)) << j;
    }
  });
}

TYPED_TEST(IntervalIdentities, DifferentiateUndoesAntiderivative) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    std::vector<Scalar> integral(b.size() + 1), back(b.size());
    kernel::antiderivative<Scalar, Scalar>(d, b.data(), integral.data());
    kernel::differentiate<Scalar, Scalar>(d + 1, integral.data(), back.data());
    EXPECT_EQ(back, b);
    EXPECT_EQ(integral[0], Scalar(0));
  });
}

TYPED_TEST(IntervalIdentities, ProductsAndTheProductRule) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    const int db = max_interval_degree - d;
    std::mt19937_64 random(7);
    const std::vector<Scalar> c = exact::random_values<Scalar>(db + 1, random);
    const auto times = [](const std::vector<Scalar>& x, const std::vector<Scalar>& y) {
      std::vector<Scalar> product(x.size() + y.size() - 1);
      kernel::multiply(static_cast<int>(x.size()) - 1, x.data(), static_cast<int>(y.size()) - 1,
                       y.data(), product.data());
      return product;
    };
    const auto slope = [](const std::vector<Scalar>& x) {
      std::vector<Scalar> out(x.size() > 1 ? x.size() - 1 : 1);
      kernel::differentiate<Scalar, Scalar>(static_cast<int>(x.size()) - 1, x.data(), out.data());
      return out;
    };
    const Scalar s = fraction<Scalar>(2, 7);
    EXPECT_EQ(evaluate(times(b, c), s), Scalar(evaluate(b, s) * evaluate(c, s)));
    EXPECT_EQ(times(b, c), times(c, b));
    EXPECT_EQ(evaluate(slope(times(b, c)), s),
              Scalar(Scalar(evaluate(slope(b), s) * evaluate(c, s)) +
                     Scalar(evaluate(b, s) * evaluate(slope(c), s))));
  });
}

TYPED_TEST(IntervalIdentities, MonomialFormIsTheSamePolynomialAndConvertsBack) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    std::vector<Scalar> a(b.size()), back(b.size());
    kernel::to_monomial(d, b.data(), a.data());
    const Scalar s = fraction<Scalar>(3, 5);
    Scalar horner(0);
    for (std::size_t k = a.size(); k-- > 0;) horner = Scalar(Scalar(horner * s) + a[k]);
    EXPECT_EQ(horner, evaluate(b, s));
    kernel::from_monomial(d, a.data(), back.data());
    EXPECT_EQ(back, b);
  });
}

TYPED_TEST(IntervalIdentities, LagrangeFormIsTheValuesAndConvertsBack) {
  using Scalar = TypeParam;
  at_every_degree<Scalar>([](int d, const std::vector<Scalar>& b) {
    std::vector<Scalar> values(b.size()), back(b.size());
    kernel::to_lagrange(d, b.data(), values.data());
    for (int i = 0; i <= d; i += 1 + d / 8)
      EXPECT_EQ(values[static_cast<std::size_t>(i)],
                evaluate(b, fraction<Scalar>(i, d == 0 ? 1 : d)));
    kernel::from_lagrange(d, values.data(), back.data());
    EXPECT_EQ(back, b);
  });
}

}  // namespace
