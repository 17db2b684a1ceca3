#include "bezel/bernstein/triangle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
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

// u^2 + 2 u v + 3 v, from its values' blossom: coefficients in index order.
const Doubles quadratic{0.0, 0.0, 1.0, 1.5, 2.5, 3.0};
double truth(double u, double v) {
  return u * u + 2.0 * u * v + 3.0 * v;
}
Lambda at(double u, double v) {
  return {1.0 - u - v, u, v};
}

TEST(Triangle, EvaluateKnownQuadratic) {
  for (const double u : {0.0, 0.25, 0.5, 1.0, -1.0})
    for (const double v : {0.0, 0.25, 0.5, 2.0})
      EXPECT_EQ(evaluate(2, in(quadratic), at(u, v)), truth(u, v)) << u << " " << v;
  EXPECT_EQ(evaluate(0, in({7.0}), at(0.2, 0.3)), 7.0);
}

TEST(Triangle, EvaluateOfPointsIsPerCoordinate) {
  const std::vector<Vec2> p{{{0.0, 0.0}}, {{2.0, 1.0}}, {{1.0, 3.0}}};
  EXPECT_EQ(evaluate(1, std::span<const Vec2>(p), at(0.5, 0.25)), (Vec2{{1.25, 1.25}}));
  const std::vector<Vec3> q{{{0.0, 0.0, 1.0}}, {{2.0, 1.0, 1.0}}, {{1.0, 3.0, 1.0}}};
  const auto g = evaluate_gradient(1, std::span<const Vec3>(q), at(0.5, 0.25));
  EXPECT_EQ(g.value, (Vec3{{1.25, 1.25, 1.0}}));
  EXPECT_EQ(g.du, (Vec3{{2.0, 1.0, 0.0}}));
  EXPECT_EQ(g.dv, (Vec3{{1.0, 3.0, 0.0}}));
}

TEST(Triangle, Gradient) {
  const auto g = evaluate_gradient(2, in(quadratic), at(0.5, 0.25));
  EXPECT_EQ(g.value, truth(0.5, 0.25));
  EXPECT_EQ(g.du, 2.0 * 0.5 + 2.0 * 0.25);
  EXPECT_EQ(g.dv, 2.0 * 0.5 + 3.0);
  const auto constant = evaluate_gradient(0, in({4.0}), at(0.5, 0.25));
  EXPECT_EQ(constant.value, 4.0);
  EXPECT_EQ(constant.du, 0.0);
  EXPECT_EQ(constant.dv, 0.0);
  const auto [du, dv] = differentiate(2, in(quadratic));
  EXPECT_EQ(du, (Doubles{0.0, 2.0, 2.0}));
  EXPECT_EQ(dv, (Doubles{3.0, 5.0, 3.0}));
  EXPECT_EQ(differentiate(0, in({4.0}))[1], Doubles{0.0});
}

TEST(Triangle, SpecializePermutesAndRestricts) {
  const std::array<Lambda, 3> identity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  EXPECT_EQ(specialize(2, in(quadratic), identity), quadratic);
  const std::array<Lambda, 3> mirrored{{{1, 0, 0}, {0, 0, 1}, {0, 1, 0}}};
  EXPECT_EQ(specialize(2, in(quadratic), mirrored), (Doubles{0.0, 1.5, 3.0, 0.0, 2.5, 1.0}));
  const std::array<Lambda, 3> part{at(0.5, 0.25), at(0.25, 0.25), at(0.0, 1.0)};
  const Doubles c = specialize(2, in(quadratic), part);
  EXPECT_EQ(c[0], truth(0.5, 0.25));
  EXPECT_EQ(c[2], truth(0.25, 0.25));
  EXPECT_EQ(c[5], truth(0.0, 1.0));
}

TEST(Triangle, SubdivideGivesFourChildrenInOrder) {
  const auto child = subdivide(2, in(quadratic));
  const std::array<std::array<Lambda, 3>, 4> corners{{{at(0, 0), at(0.5, 0), at(0, 0.5)},
                                                      {at(0.5, 0), at(1, 0), at(0.5, 0.5)},
                                                      {at(0, 0.5), at(0.5, 0.5), at(0, 1)},
                                                      {at(0.5, 0.5), at(0, 0.5), at(0.5, 0)}}};
  for (std::size_t c = 0; c < 4; ++c)
    for (int corner = 0; corner < 3; ++corner) {
      const Lambda& x = corners[c][static_cast<std::size_t>(corner)];
      EXPECT_EQ(child[c][static_cast<std::size_t>(triangle_corner(2, corner))], truth(x[1], x[2]));
    }
}

TEST(Triangle, ElevateAndReduceAreInverse) {
  EXPECT_EQ(elevate(1, in({1.0, 3.0, 5.0})), (Doubles{1.0, 2.0, 3.0, 3.0, 4.0, 5.0}));
  const Doubles back = reduce(6, in(elevate(2, in(quadratic), 4)), 4);
  ASSERT_EQ(back.size(), 6U);
  for (std::size_t n = 0; n < 6; ++n) EXPECT_NEAR(back[n], quadratic[n], 4e-15);
  EXPECT_EQ(elevate(2, in(quadratic), 0), quadratic);
}

TEST(Triangle, ReduceIsTheL2Projection) {
  // The mean of u over the triangle is 1/3; the best line of u^2 keeps its three moments.
  EXPECT_NEAR(reduce(1, in({0.0, 1.0, 0.0}))[0], 1.0 / 3.0, 0x1p-52);
  const Doubles line = reduce(2, in({0.0, 0.0, 1.0, 0.0, 0.0, 0.0}));
  const Doubles rest{-line[0],
                     -(line[0] + line[1]) / 2,
                     1 - line[1],
                     -(line[0] + line[2]) / 2,
                     -(line[1] + line[2]) / 2,
                     -line[2]};
  for (const Doubles& test : {Doubles{1, 0, 0}, Doubles{0, 1, 0}, Doubles{0, 0, 1}})
    EXPECT_NEAR(integral(3, multiply(2, rest, 1, test)), 0.0, 0x1p-54);
}

TEST(Triangle, MultiplyAndIntegrate) {
  // u * v = the basis function (0,1,1) / 2; its integral is 1/24.
  const Doubles product = multiply(1, Doubles{0, 1, 0}, 1, Doubles{0, 0, 1});
  EXPECT_EQ(product, (Doubles{0, 0, 0, 0, 0.5, 0}));
  EXPECT_DOUBLE_EQ(integral(2, product), 1.0 / 24.0);
  EXPECT_EQ(integral(0, Doubles{1.0}), 0.5);
  EXPECT_EQ(multiply(0, Doubles{2.0}, 1, Doubles{1, 2, 3}), (Doubles{2, 4, 6}));
}

TEST(Triangle, SidesRunCounterClockwise) {
  EXPECT_EQ(side(2, in(quadratic), 0), (Doubles{0.0, 0.0, 1.0}));
  EXPECT_EQ(side(2, in(quadratic), 1), (Doubles{1.0, 2.5, 3.0}));
  EXPECT_EQ(side(2, in(quadratic), 2), (Doubles{3.0, 1.5, 0.0}));
}

TEST(Triangle, LagrangeForm) {
  Doubles values;
  for (int n = 0; n < 6; ++n) {
    const auto index = triangle_multi_index(2, n);
    values.push_back(truth(index[1] / 2.0, index[2] / 2.0));
  }
  EXPECT_EQ(to_lagrange(2, in(quadratic)), values);
  EXPECT_EQ(from_lagrange(2, in(values)), quadratic);
  EXPECT_EQ(from_lagrange(0, in({3.0})), Doubles{3.0});
  const std::vector<Vec2> p{{{0.0, 0.0}}, {{2.0, 1.0}}, {{1.0, 3.0}}};
  EXPECT_EQ(from_lagrange(1, std::span<const Vec2>(p)), p);
  EXPECT_EQ(to_lagrange(1, std::span<const Vec2>(p)), p);
}

TEST(Triangle, BasisAndMassMatrix) {
  Doubles out(6);
  basis(2, at(0.25, 0.25), out);
  EXPECT_EQ(out, (Doubles{0.25, 0.25, 0.0625, 0.25, 0.125, 0.0625}));
  const Doubles mass = mass_matrix(1);
  for (std::size_t m = 0; m < 3; ++m)
    for (std::size_t n = 0; n < 3; ++n)
      EXPECT_DOUBLE_EQ(mass[3 * m + n], m == n ? 1.0 / 12.0 : 1.0 / 24.0);
  EXPECT_EQ(mass_matrix(0), Doubles{0.5});
}

TEST(TriangleErrors, DegreeSizeAndValues) {
  const Lambda x = at(0.2, 0.3);
  EXPECT_THAT(
      [&] {
        evaluate(2, in({1.0, 2.0}), x);
      },
      ThrowsMessage<InputError>("found 2 coefficients, expected 6 for degree 2 on the triangle"));
  EXPECT_THAT([&] { evaluate(41, in(quadratic), x); },
              ThrowsMessage<InputError>("degree 41 on the triangle, expected 0 to 40"));
  EXPECT_THAT([&] { evaluate(-1, in(quadratic), x); },
              ThrowsMessage<InputError>("degree -1 on the triangle, expected 0 to 40"));
  EXPECT_THAT(
      [&] {
        evaluate(1, in({1.0, 2.0, std::nan("")}), x);
      },
      ThrowsMessage<InputError>("coefficient 2 is not finite"));
  EXPECT_THAT(
      [&] {
        evaluate(2, in(quadratic), Lambda{std::nan(""), 0.0, 0.0});
      },
      ThrowsMessage<InputError>("barycentric coordinate is nan, expected a finite value"));
  EXPECT_THAT([&] { side(2, in(quadratic), 3); },
              ThrowsMessage<InputError>("side 3 of a triangle, expected 0, 1 or 2"));
  EXPECT_THAT([&] { reduce(2, in(quadratic), 3); },
              ThrowsMessage<InputError>("reduction by 3 of degree 2, expected 0 to 2"));
  const Doubles top(static_cast<std::size_t>(triangle_size(40)), 1.0), none;
  EXPECT_THAT([&] { elevate(40, in(top)); },
              ThrowsMessage<InputError>("degree 41 on the triangle, expected 0 to 40"));
  EXPECT_THAT([&] { multiply(40, top, 2, quadratic); },
              ThrowsMessage<InputError>("degree 42 on the triangle, expected 0 to 40"));
  Doubles out(5);
  EXPECT_THAT([&] { basis(2, x, out); },
              ThrowsMessage<InputError>("found 5 places for basis values, expected 6"));
  // Every function checks at its door.
  EXPECT_THROW(evaluate_gradient(1, in(none), x), InputError);
  EXPECT_THROW(differentiate(1, in(none)), InputError);
  EXPECT_THROW(specialize(1, in(none), {x, x, x}), InputError);
  EXPECT_THROW(specialize(2, in(quadratic), {x, x, Lambda{0, 0, std::nan("")}}), InputError);
  EXPECT_THROW(subdivide(1, in(none)), InputError);
  EXPECT_THROW(elevate(1, in(none)), InputError);
  EXPECT_THROW(elevate(2, in(quadratic), -1), InputError);
  EXPECT_THROW(reduce(1, in(none)), InputError);
  EXPECT_THROW(multiply(1, none, 2, quadratic), InputError);
  EXPECT_THROW(integral(1, none), InputError);
  EXPECT_THROW(to_lagrange(1, in(none)), InputError);
  EXPECT_THROW(from_lagrange(41, in(none)), InputError);
  EXPECT_THROW(range(1, none), InputError);
  EXPECT_THROW(mass_matrix(41), InputError);
  EXPECT_THROW(basis(41, x, out), InputError);
}

}  // namespace
