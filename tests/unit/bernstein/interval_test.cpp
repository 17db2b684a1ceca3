#include "bezel/bernstein/interval.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "bezel/base/error.hpp"

namespace {

using namespace bezel::bernstein;
using bezel::InputError;
using bezel::Vec2;
using bezel::Vec3;
using testing::ThrowsMessage;

using Doubles = std::vector<double>;
std::span<const double> in(const Doubles& b) {
  return b;
}

// 1 - 4s + 6s^2 has the coefficients 1, -1, 3.
const Doubles quadratic{1.0, -1.0, 3.0};

TEST(Interval, EvaluateKnownQuadratic) {
  EXPECT_EQ(evaluate(in(quadratic), 0.0), 1.0);
  EXPECT_EQ(evaluate(in(quadratic), 1.0), 3.0);
  EXPECT_EQ(evaluate(in(quadratic), 0.5), 0.5);
  EXPECT_EQ(evaluate(in(quadratic), 2.0), 17.0);
  EXPECT_EQ(evaluate(in(quadratic), -1.0), 11.0);
  EXPECT_EQ(evaluate(in({7.0}), 0.3), 7.0);
}

TEST(Interval, EvaluateOfPointsIsPerCoordinate) {
  const std::vector<Vec3> p{{{1.0, 0.0, 5.0}}, {{-1.0, 2.0, 5.0}}, {{3.0, 0.0, 5.0}}};
  EXPECT_EQ(evaluate(std::span<const Vec3>(p), 0.5), (Vec3{{0.5, 1.0, 5.0}}));
  const std::vector<Vec2> q{{{0.0, 0.0}}, {{1.0, 2.0}}};
  EXPECT_EQ(evaluate_derivative(std::span<const Vec2>(q), 0.7), (Vec2{{1.0, 2.0}}));
}

TEST(Interval, Derivatives) {
  EXPECT_EQ(evaluate_derivative(in(quadratic), 0.0), -4.0);
  EXPECT_EQ(evaluate_derivative(in(quadratic), 0.5), 2.0);
  EXPECT_EQ(differentiate(in(quadratic)), (Doubles{-4.0, 8.0}));
  EXPECT_EQ(differentiate(in({5.0})), Doubles{0.0});
  EXPECT_EQ(evaluate_derivative(in({5.0}), 0.2), 0.0);
}

TEST(Interval, SubdivideSharesTheValue) {
  const auto [left, right] = subdivide(in(quadratic), 0.5);
  EXPECT_EQ(left, (Doubles{1.0, 0.0, 0.5}));
  EXPECT_EQ(right, (Doubles{0.5, 1.0, 3.0}));
}

TEST(Interval, SpecializeReversesRestrictsAndExtrapolates) {
  EXPECT_EQ(specialize(in(quadratic), 0.0, 1.0), quadratic);
  EXPECT_EQ(specialize(in(quadratic), 1.0, 0.0), (Doubles{3.0, -1.0, 1.0}));
  EXPECT_EQ(specialize(in(quadratic), 0.0, 0.5), (Doubles{1.0, 0.0, 0.5}));
  const Doubles wide = specialize(in(quadratic), -1.0, 2.0);
  EXPECT_EQ(wide.front(), 11.0);
  EXPECT_EQ(wide.back(), 17.0);
  EXPECT_EQ(evaluate(in(wide), 0.5), 0.5);
}

TEST(Interval, ElevateAndReduceAreInverse) {
  EXPECT_EQ(elevate(in({1.0, 3.0})), (Doubles{1.0, 2.0, 3.0}));
  const Doubles raised = elevate(in({1.0, 5.0}), 3);
  ASSERT_EQ(raised.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i)  // 4 u max|b| per step
    EXPECT_NEAR(raised[i], 1.0 + static_cast<double>(i), 12.0 * 0x1p-53 * 5.0);
  EXPECT_EQ(elevate(in(quadratic), 0), quadratic);
  const Doubles back = reduce(in(elevate(in(quadratic), 3)), 3);
  ASSERT_EQ(back.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(back[i], quadratic[i], 1e-15 * 3.0);
}

TEST(Interval, ReduceIsTheL2Projection) {
  // s^2 = s - 1/6 + (Legendre polynomial): nearest line has the values -1/6 and 5/6.
  const Doubles line = reduce(in({0.0, 0.0, 1.0}));
  EXPECT_NEAR(line[0], -1.0 / 6.0, 0x1p-52);
  EXPECT_NEAR(line[1], 5.0 / 6.0, 0x1p-52);
  // and nearest constant: the mean.
  EXPECT_NEAR(reduce(in({0.0, 0.0, 1.0}), 2)[0], 1.0 / 3.0, 0x1p-52);
}

TEST(Interval, Integrals) {
  EXPECT_EQ(integral(quadratic), 1.0);
  EXPECT_EQ(antiderivative(quadratic), (Doubles{0.0, 1.0 / 3.0, 0.0, 1.0}));
}

TEST(Interval, Multiply) {
  // (1 - s) s
  EXPECT_EQ(multiply(Doubles{1.0, 0.0}, Doubles{0.0, 1.0}), (Doubles{0.0, 0.5, 0.0}));
  EXPECT_EQ(multiply(Doubles{2.0}, quadratic), (Doubles{2.0, -2.0, 6.0}));
}

TEST(Interval, MonomialForm) {
  EXPECT_EQ(to_monomial(quadratic), (Doubles{1.0, -4.0, 6.0}));
  EXPECT_EQ(from_monomial(Doubles{1.0, -4.0, 6.0}), quadratic);
}

TEST(Interval, LagrangeForm) {
  EXPECT_EQ(to_lagrange(in(quadratic)), (Doubles{1.0, 0.5, 3.0}));
  EXPECT_EQ(from_lagrange(in({1.0, 0.5, 3.0})), quadratic);
  EXPECT_EQ(to_lagrange(in({4.0})), Doubles{4.0});
  EXPECT_EQ(from_lagrange(in({4.0})), Doubles{4.0});
}

TEST(Interval, LagrangeRoundTripUpToDegreeTen) {
  for (int d = 1; d <= 10; ++d) {
    Doubles b;
    for (int i = 0; i <= d; ++i) b.push_back(std::sin(1.0 + 3.0 * i));
    const Doubles back = from_lagrange(in(to_lagrange(in(b))));
    // The rounding of the values is amplified by the inverse's norm, below 2.6^d up to degree 10.
    for (std::size_t i = 0; i < b.size(); ++i)
      EXPECT_NEAR(back[i], b[i], std::pow(2.6, d) * 0x1p-53) << d;
  }
}

TEST(Interval, BasisKnownValues) {
  Doubles out(3);
  basis(2, 0.25, out);
  EXPECT_EQ(out, (Doubles{0.5625, 0.375, 0.0625}));
  basis(2, 0.0, out);
  EXPECT_EQ(out, (Doubles{1.0, 0.0, 0.0}));
}

TEST(Interval, EndValuesAreExactAtTheLargestDegree) {
  Doubles b;
  for (int i = 0; i <= max_interval_degree; ++i) b.push_back(std::cos(i) * 1e3);
  EXPECT_EQ(evaluate(in(b), 0.0), b.front());
  EXPECT_EQ(evaluate(in(b), 1.0), b.back());
  const Doubles same = specialize(in(b), 0.0, 1.0);
  EXPECT_EQ(same.front(), b.front());
  EXPECT_EQ(same.back(), b.back());
}

TEST(IntervalErrors, EmptyTooHighAndNotFinite) {
  const Doubles empty, high(62, 1.0);
  const Doubles with_nan{1.0, std::nan(""), 2.0};
  EXPECT_THAT([&] { evaluate(in(empty), 0.5); },
              ThrowsMessage<InputError>("found no coefficients, expected at least one"));
  EXPECT_THAT([&] { evaluate(in(high), 0.5); },
              ThrowsMessage<InputError>("degree 61 on the interval, expected 0 to 60"));
  EXPECT_THAT([&] { evaluate(in(with_nan), 0.5); },
              ThrowsMessage<InputError>("coefficient 1 is not finite"));
  EXPECT_THAT([&] { evaluate(in(quadratic), std::nan("")); },
              ThrowsMessage<InputError>("parameter is nan, expected a finite value"));
  EXPECT_THAT([&] { subdivide(in(quadratic), std::numeric_limits<double>::infinity()); },
              ThrowsMessage<InputError>("parameter is inf, expected a finite value"));
  const std::vector<Vec2> bad{{{0.0, 0.0}}, {{0.0, std::nan("")}}};
  EXPECT_THAT([&] { evaluate(std::span<const Vec2>(bad), 0.5); },
              ThrowsMessage<InputError>("coefficient 1 is not finite"));
  // Every function checks at its door.
  EXPECT_THROW(evaluate_derivative(in(empty), 0.5), InputError);
  EXPECT_THROW(differentiate(in(with_nan)), InputError);
  EXPECT_THROW(specialize(in(high), 0.0, 1.0), InputError);
  EXPECT_THROW(specialize(in(quadratic), 0.0, std::nan("")), InputError);
  EXPECT_THROW(elevate(in(empty)), InputError);
  EXPECT_THROW(reduce(in(empty)), InputError);
  EXPECT_THROW(antiderivative(empty), InputError);
  EXPECT_THROW(integral(empty), InputError);
  EXPECT_THROW(multiply(empty, quadratic), InputError);
  EXPECT_THROW(to_monomial(empty), InputError);
  EXPECT_THROW(from_monomial(with_nan), InputError);
  EXPECT_THROW(to_lagrange(in(high)), InputError);
  EXPECT_THROW(from_lagrange(in(high)), InputError);
  EXPECT_THROW(range(empty), InputError);
}

TEST(IntervalErrors, DegreesOfResultsAreLimited) {
  const Doubles top(61, 1.0);
  EXPECT_THAT([&] { elevate(in(top)); },
              ThrowsMessage<InputError>("degree 61 on the interval, expected 0 to 60"));
  EXPECT_THAT(
      [&] {
        multiply(top, Doubles{1.0, 2.0});
      },
      ThrowsMessage<InputError>("degree 61 on the interval, expected 0 to 60"));
  EXPECT_THAT([&] { antiderivative(top); },
              ThrowsMessage<InputError>("degree 61 on the interval, expected 0 to 60"));
  EXPECT_THAT([&] { elevate(in(quadratic), -1); },
              ThrowsMessage<InputError>("elevation by -1, expected at least 0"));
  EXPECT_THROW(elevate(in(quadratic), std::numeric_limits<int>::max()), InputError);
  EXPECT_THAT([&] { reduce(in(quadratic), 3); },
              ThrowsMessage<InputError>("reduction by 3 of degree 2, expected 0 to 2"));
  EXPECT_THROW(reduce(in(quadratic), -1), InputError);
}

TEST(IntervalErrors, BasisChecksItsArguments) {
  Doubles out(3);
  EXPECT_THAT([&] { basis(3, 0.5, out); },
              ThrowsMessage<InputError>("found 3 places for basis values, expected 4"));
  EXPECT_THROW(basis(-1, 0.5, out), InputError);
  EXPECT_THROW(basis(61, 0.5, out), InputError);
  EXPECT_THROW(basis(2, std::nan(""), out), InputError);
}

}  // namespace
