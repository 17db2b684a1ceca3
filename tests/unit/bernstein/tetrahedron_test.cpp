#include "bezel/bernstein/tetrahedron.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "support/simd_targets.hpp"

namespace {

namespace tet = bezel::bernstein::tetrahedron;
using bezel::InputError;
using bezel::Vec2;
using bezel::Vec3;
using bezel::bernstein::tetrahedron_corner;
using bezel::bernstein::tetrahedron_multi_index;
using bezel::bernstein::tetrahedron_size;
using testing::ThrowsMessage;

using Doubles = std::vector<double>;
std::span<const double> in(const Doubles& b) {
  return b;
}
std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

// u^2 + 2 u v + 3 v - 4 v w + w, from its blossom: coefficients in index order.
const Doubles quadratic{0.0, 0.0, 1.0, 1.5, 2.5, 3.0, 0.5, 0.5, 0.0, 1.0};
double truth(double u, double v, double w) {
  return u * u + 2.0 * u * v + 3.0 * v - 4.0 * v * w + w;
}
tet::Lambda lambda(double u, double v, double w) {
  return {1.0 - u - v - w, u, v, w};
}

TEST(Tetrahedron, EvaluateKnownQuadratic) {
  for (const double u : {0.0, 0.25, 0.5, 1.0, -1.0})
    for (const double v : {0.0, 0.25, 2.0})
      for (const double w : {0.0, 0.125, 0.5, 1.0})
        EXPECT_EQ(tet::evaluate(2, in(quadratic), lambda(u, v, w)), truth(u, v, w))
            << u << " " << v << " " << w;
  EXPECT_EQ(tet::evaluate(0, in({7.0}), lambda(0.2, 0.3, 0.1)), 7.0);
}

TEST(Tetrahedron, EvaluateOfPointsIsPerCoordinate) {
  const std::vector<Vec2> p{{{0, 0}}, {{2, 1}}, {{1, 3}}, {{4, -4}}};
  EXPECT_EQ(tet::evaluate(1, std::span<const Vec2>(p), lambda(0.5, 0.25, 0.125)),
            (Vec2{{1.75, 0.75}}));
  const std::vector<Vec3> q{{{0, 0, 1}}, {{2, 1, 1}}, {{1, 3, 1}}, {{4, -4, 1}}};
  const auto g = tet::evaluate_gradient(1, std::span<const Vec3>(q), lambda(0.5, 0.25, 0.125));
  EXPECT_EQ(g.value, (Vec3{{1.75, 0.75, 1.0}}));
  EXPECT_EQ(g.du, (Vec3{{2, 1, 0}}));
  EXPECT_EQ(g.dv, (Vec3{{1, 3, 0}}));
  EXPECT_EQ(g.dw, (Vec3{{4, -4, 0}}));
}

TEST(Tetrahedron, Gradient) {
  const double u = 0.5, v = 0.25, w = 0.125;
  const auto g = tet::evaluate_gradient(2, in(quadratic), lambda(u, v, w));
  EXPECT_EQ(g.value, truth(u, v, w));
  EXPECT_EQ(g.du, 2 * u + 2 * v);
  EXPECT_EQ(g.dv, 2 * u + 3 - 4 * w);
  EXPECT_EQ(g.dw, 1 - 4 * v);
  const auto constant = tet::evaluate_gradient(0, in({4.0}), lambda(u, v, w));
  EXPECT_EQ(constant.value, 4.0);
  EXPECT_EQ(constant.du, 0.0);
  EXPECT_EQ(constant.dv, 0.0);
  EXPECT_EQ(constant.dw, 0.0);
  const auto [du, dv, dw] = tet::differentiate(2, in(quadratic));
  EXPECT_EQ(du, (Doubles{0, 2, 2, 0}));
  EXPECT_EQ(dv, (Doubles{3, 5, 3, -1}));
  EXPECT_EQ(dw, (Doubles{1, 1, -3, 1}));
  EXPECT_EQ(tet::differentiate(0, in({4.0}))[2], Doubles{0.0});
}

TEST(Tetrahedron, SpecializePermutesAndRestricts) {
  const std::array<tet::Lambda, 4> identity{
      {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  EXPECT_EQ(tet::specialize(2, in(quadratic), identity), quadratic);
  const std::array<tet::Lambda, 4> mirrored{
      {{1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
  EXPECT_EQ(tet::specialize(2, in(quadratic), mirrored),
            (Doubles{0.0, 1.5, 3.0, 0.0, 2.5, 1.0, 0.5, 0.0, 0.5, 1.0}));
  const std::array<tet::Lambda, 4> part{lambda(0.5, 0.25, 0.25), lambda(0.25, 0.25, 0.0),
                                        lambda(0.0, 1.0, 0.0), lambda(0.0, 0.5, 0.5)};
  const Doubles c = tet::specialize(2, in(quadratic), part);
  for (int corner = 0; corner < 4; ++corner) {
    const tet::Lambda& x = part[at(corner)];
    EXPECT_EQ(c[at(tetrahedron_corner(2, corner))], truth(x[1], x[2], x[3]));
  }
}

using Corners = std::array<tet::Lambda, 4>;
/// The corners of the children as the header lists them.
std::array<Corners, 8> child_corners() {
  const tet::Lambda c0 = lambda(0, 0, 0), c1 = lambda(1, 0, 0), c2 = lambda(0, 1, 0),
                    c3 = lambda(0, 0, 1), m01 = lambda(0.5, 0, 0), m02 = lambda(0, 0.5, 0),
                    m03 = lambda(0, 0, 0.5), m12 = lambda(0.5, 0.5, 0), m13 = lambda(0.5, 0, 0.5),
                    m23 = lambda(0, 0.5, 0.5);
  return {{{c0, m01, m02, m03},
           {m01, c1, m12, m13},
           {m02, m12, c2, m23},
           {m03, m13, m23, c3},
           {m02, m13, m01, m12},
           {m02, m13, m12, m23},
           {m02, m13, m23, m03},
           {m02, m13, m03, m01}}};
}

TEST(Tetrahedron, SubdivideGivesEightChildrenInOrder) {
  const auto child = tet::subdivide(2, in(quadratic));
  const auto corners = child_corners();
  for (std::size_t c = 0; c < 8; ++c)
    for (int corner = 0; corner < 4; ++corner) {
      const tet::Lambda& x = corners[c][at(corner)];
      EXPECT_EQ(child[c][at(tetrahedron_corner(2, corner))], truth(x[1], x[2], x[3]));
    }
}

TEST(Tetrahedron, ChildrenArePositivelyOriented) {
  for (const Corners& c : child_corners()) {
    std::array<std::array<double, 3>, 3> e{};
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t i = 0; i < 3; ++i) e[r][i] = c[r + 1][i + 1] - c[0][i + 1];
    const double det = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                       e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                       e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    EXPECT_EQ(det, 0.125);
  }
}

Doubles random_values(std::size_t n, std::mt19937_64& random) {
  Doubles out(n);
  for (double& x : out)
    x = random() % 16 == 0 ? (random() % 2 == 0 ? 0.0 : 0x1p-1070)
                           : std::ldexp(static_cast<double>(random() >> 11) * 0x1p-53 - 0.5,
                                        static_cast<int>(random() % 20) - 10);
  return out;
}

/// A coefficient's places: its blossom arguments, sorted.
using Blossom = std::vector<std::array<double, 4>>;
Blossom blossom(const Corners& corner, int d, int n) {
  Blossom out;
  const auto x = tetrahedron_multi_index(d, n);
  for (std::size_t c = 0; c < 4; ++c)
    for (int i = 0; i < x[c]; ++i) out.push_back(corner[c]);
  std::sort(out.begin(), out.end());
  return out;
}

TEST(Tetrahedron, SharedFacesOfChildrenAgreeBitForBit) {
  std::mt19937_64 random(61);
  const auto corners = child_corners();
  for (const int d : {1, 2, 3, 4, 6}) {
    const Doubles b = random_values(at(tetrahedron_size(d)), random);
    const auto child = tet::subdivide(d, in(b));
    int shared = 0;
    for (std::size_t p = 0; p < 8; ++p)
      for (std::size_t q = 0; q < p; ++q)
        for (int m = 0; m < tetrahedron_size(d); ++m)
          for (int n = 0; n < tetrahedron_size(d); ++n)
            if (blossom(corners[p], d, m) == blossom(corners[q], d, n)) {
              EXPECT_EQ(child[p][at(m)], child[q][at(n)]) << d << " " << p << " " << q;
              ++shared;
            }
    EXPECT_GT(shared, 8 * 3);  // eight interior faces
  }
}

TEST(Tetrahedron, NeighboursAgreeOnACommonFaceWithAscendingCorners) {
  std::mt19937_64 random(62);
  for (const int d : {1, 2, 3, 5, 7}) {
    // a has the face on corners 0, 1, 2; b has it on 1, 2, 3: ascending in both.
    Doubles a = random_values(at(tetrahedron_size(d)), random);
    Doubles b = random_values(at(tetrahedron_size(d)), random);
    for (int k = 0; k <= d; ++k)
      for (int j = 0; j <= d - k; ++j)
        b[at(bezel::bernstein::tetrahedron_index(d, d - j - k, j, k))] =
            a[at(bezel::bernstein::tetrahedron_index(d, j, k, 0))];
    const auto ca = tet::subdivide(d, in(a)), cb = tet::subdivide(d, in(b));
    for (std::size_t child = 0; child < 3; ++child)  // the corner children; face 012 and 123
      for (int k = 0; k <= d; ++k)
        for (int j = 0; j <= d - k; ++j)
          EXPECT_EQ(ca[child][at(bezel::bernstein::tetrahedron_index(d, j, k, 0))],
                    cb[child + 1][at(bezel::bernstein::tetrahedron_index(d, d - j - k, j, k))]);
    // The middle of the face: m02 m01 m12 of child 4, and m13 m12 m23 of child 5.
    for (int k = 0; k <= d; ++k)
      for (int j = 0; j <= d - k; ++j)
        EXPECT_EQ(ca[4][at(bezel::bernstein::tetrahedron_index({d - j - k, 0, j, k}))],
                  cb[5][at(bezel::bernstein::tetrahedron_index({0, d - j - k, j, k}))]);
  }
}

TEST(Tetrahedron, Elevate) {
  EXPECT_EQ(tet::elevate(1, in({1.0, 3.0, 5.0, 9.0})), (Doubles{1, 2, 3, 3, 4, 5, 5, 6, 7, 9}));
  EXPECT_EQ(tet::elevate(2, in(quadratic), 0), quadratic);
  EXPECT_EQ(tet::elevate(0, in({0.1}), 3), Doubles(20, 0.1));
}

TEST(Tetrahedron, MultiplyAndIntegrate) {
  // u * w is half the basis function (0, 1, 0, 1); its integral is 1/120.
  const Doubles product = tet::multiply(1, Doubles{0, 1, 0, 0}, 1, Doubles{0, 0, 0, 1});
  EXPECT_EQ(product, (Doubles{0, 0, 0, 0, 0, 0, 0, 0.5, 0, 0}));
  EXPECT_DOUBLE_EQ(tet::integral(2, product), 1.0 / 120.0);
  EXPECT_EQ(tet::integral(0, Doubles{3.0}), 0.5);
  EXPECT_EQ(tet::multiply(0, Doubles{2.0}, 1, Doubles{1, 2, 3, 4}), (Doubles{2, 4, 6, 8}));
}

TEST(Tetrahedron, FacesAreTrianglesSeenFromOutside) {
  using bezel::bernstein::Lambda;
  const std::array<std::array<int, 3>, 4> corner{{{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};
  const Lambda x{0.5, 0.375, 0.125};
  for (int face = 0; face < 4; ++face) {
    const Doubles f = tet::face(2, in(quadratic), face);
    tet::Lambda y{};
    for (std::size_t c = 0; c < 3; ++c) y[at(corner[at(face)][c])] = x[c];
    EXPECT_EQ(bezel::bernstein::evaluate(2, in(f), x), tet::evaluate(2, in(quadratic), y)) << face;
  }
}

TEST(Tetrahedron, LagrangeForm) {
  Doubles values;
  for (int n = 0; n < 10; ++n) {
    const auto x = tetrahedron_multi_index(2, n);
    values.push_back(truth(x[1] / 2.0, x[2] / 2.0, x[3] / 2.0));
  }
  EXPECT_EQ(tet::to_lagrange(2, in(quadratic)), values);
  EXPECT_EQ(tet::from_lagrange(2, in(values)), quadratic);
  EXPECT_EQ(tet::from_lagrange(0, in({3.0})), Doubles{3.0});
  const std::vector<Vec3> p{{{0, 0, 1}}, {{2, 1, 0}}, {{1, 3, 0}}, {{4, 4, 4}}};
  EXPECT_EQ(tet::from_lagrange(1, std::span<const Vec3>(p)), p);
  EXPECT_EQ(tet::to_lagrange(1, std::span<const Vec3>(p)), p);
}

TEST(Tetrahedron, Basis) {
  Doubles out(10);
  tet::basis(2, lambda(0.25, 0.25, 0.25), out);
  EXPECT_EQ(out,
            (Doubles{0.0625, 0.125, 0.0625, 0.125, 0.125, 0.0625, 0.125, 0.125, 0.125, 0.0625}));
}

// 1 - 4 (u + v + w) + 6 (u + v + w)^2: minimum 1/3 on a plane, maximum 3 on a face.
TEST(Tetrahedron, RangeTightensToTheTolerance) {
  Doubles b;
  for (int n = 0; n < 10; ++n) {
    const int m = 2 - tetrahedron_multi_index(2, n)[0];
    b.push_back(m == 0 ? 1.0 : m == 1 ? -1.0 : 3.0);
  }
  EXPECT_EQ(tet::range(2, b).lo, -1.0);
  EXPECT_EQ(tet::range(2, b).hi, 3.0);
  for (const double tol : {1.0, 0.1, 1e-2}) {
    const auto r = tet::range(2, b, tol);
    EXPECT_LE(r.lo, 1.0 / 3.0);
    EXPECT_GE(r.lo, 1.0 / 3.0 - tol);
    EXPECT_GE(r.hi, 3.0);
    EXPECT_LE(r.hi, 3.0 + tol);
  }
  // Single places: u v w has its maximum 1/27 in the middle of a face.
  const Doubles uv = tet::multiply(1, Doubles{0, 1, 0, 0}, 1, Doubles{0, 0, 1, 0});
  const Doubles uvw = tet::multiply(2, uv, 1, Doubles{0, 0, 0, 1});
  for (double tol = 0.1; tol > 1e-13; tol *= 0.1) {
    const auto r = tet::range(3, uvw, tol);
    EXPECT_EQ(r.lo, 0.0);
    EXPECT_GE(r.hi, 1.0 / 27.0);
    EXPECT_LE(r.hi, 1.0 / 27.0 + tol + 200 * 3 * 0x1p-53);
  }
  // Many places: certified, but wider than asked.
  const auto flat = tet::range(2, b, 1e-9);
  EXPECT_LE(flat.lo, 1.0 / 3.0);
  EXPECT_GE(flat.lo, 1.0 / 3.0 - 0.02);
  EXPECT_EQ(tet::range(0, Doubles{2.0}, 1e-3).hi, 2.0);
}

TEST(TetrahedronBatch, BitsAreTheScalarOnesOnEveryTarget) {
  std::mt19937_64 random(63);
  for (int d = 0; d <= bezel::bernstein::max_tetrahedron_degree; ++d) {
    SCOPED_TRACE("degree " + std::to_string(d));
    const Doubles b = random_values(at(tetrahedron_size(d)), random);
    Doubles u, v, w, expected;
    for (int q = 0; q < 19; ++q) {  // whole vectors of every width and a tail
      for (Doubles* x : {&u, &v, &w}) x->push_back(static_cast<double>(random() >> 11) * 0x1p-54);
      expected.push_back(tet::evaluate(
          d, in(b),
          tet::Lambda{((1.0 - u.back()) - v.back()) - w.back(), u.back(), v.back(), w.back()}));
    }
    support::on_every_target([&] {
      Doubles out(u.size(), -1.0);
      tet::evaluate(d, b, u, v, w, out);
      EXPECT_EQ(std::memcmp(out.data(), expected.data(), out.size() * sizeof(double)), 0);
    });
  }
}

TEST(TetrahedronBatch, AnyNumberOfPointsIncludingNone) {
  const Doubles b{0.0, 1.0, 2.0, 4.0};
  for (std::size_t count = 0; count <= 17; ++count) {
    const Doubles s(count, 0.25);
    Doubles out(count);
    tet::evaluate(1, b, s, s, s, out);
    EXPECT_EQ(out, Doubles(count, 1.75));
  }
}

TEST(TetrahedronErrors, DegreeSizeAndValues) {
  const tet::Lambda x = lambda(0.2, 0.3, 0.1);
  const Doubles none;
  EXPECT_THAT([&] { tet::evaluate(2, in(none), x); },
              ThrowsMessage<InputError>(
                  "found 0 coefficients, expected 10 for degree 2 on the tetrahedron"));
  EXPECT_THAT([&] { tet::evaluate(21, in(quadratic), x); },
              ThrowsMessage<InputError>("degree 21 on the tetrahedron, expected 0 to 20"));
  EXPECT_THAT([&] { tet::evaluate(-1, in(quadratic), x); },
              ThrowsMessage<InputError>("degree -1 on the tetrahedron, expected 0 to 20"));
  const Doubles broken{1.0, 2.0, std::nan(""), 4.0};
  EXPECT_THAT([&] { tet::evaluate(1, in(broken), x); },
              ThrowsMessage<InputError>("coefficient 2 is not finite"));
  const tet::Lambda bad{std::nan(""), 0.0, 0.0, 0.0};
  EXPECT_THAT([&] { tet::evaluate(2, in(quadratic), bad); },
              ThrowsMessage<InputError>("barycentric coordinate is nan, expected a finite value"));
  EXPECT_THAT([&] { tet::face(2, in(quadratic), 4); },
              ThrowsMessage<InputError>("face 4 of a tetrahedron, expected 0 to 3"));
  EXPECT_THAT([&] { tet::face(2, in(quadratic), -1); },
              ThrowsMessage<InputError>("face -1 of a tetrahedron, expected 0 to 3"));
  const Doubles top(at(tetrahedron_size(20)), 1.0);
  EXPECT_THAT([&] { tet::elevate(20, in(top)); },
              ThrowsMessage<InputError>("degree 21 on the tetrahedron, expected 0 to 20"));
  EXPECT_THAT([&] { tet::elevate(2, in(quadratic), -1); },
              ThrowsMessage<InputError>("elevation by -1, expected at least 0"));
  EXPECT_THAT([&] { tet::multiply(20, top, 2, quadratic); },
              ThrowsMessage<InputError>("degree 22 on the tetrahedron, expected 0 to 20"));
  EXPECT_THAT([&] { static_cast<void>(tet::range(2, quadratic, -1.0)); },
              ThrowsMessage<InputError>("range tolerance is -1.000000, expected at least 0"));
  Doubles out(5);
  EXPECT_THAT([&] { tet::basis(2, x, out); },
              ThrowsMessage<InputError>("found 5 places for basis values, expected 10"));
  const Doubles five(5, 0.1), four(4, 0.1), infinite(5, INFINITY);
  EXPECT_THAT([&] { tet::evaluate(2, quadratic, five, four, five, out); },
              ThrowsMessage<InputError>("found 4 coordinates v, expected 5"));
  EXPECT_THAT([&] { tet::evaluate(2, quadratic, five, five, four, out); },
              ThrowsMessage<InputError>("found 4 coordinates w, expected 5"));
  EXPECT_THAT([&] { tet::evaluate(2, quadratic, four, four, four, out); },
              ThrowsMessage<InputError>("found 5 places for values, expected 4"));
  EXPECT_THAT([&] { tet::evaluate(2, quadratic, five, five, infinite, out); },
              ThrowsMessage<InputError>("coordinate w 0 is not finite"));
  // Every function checks at its door.
  EXPECT_THROW(tet::evaluate_gradient(1, in(none), x), InputError);
  EXPECT_THROW(tet::differentiate(1, in(none)), InputError);
  EXPECT_THROW(tet::specialize(1, in(none), {x, x, x, x}), InputError);
  EXPECT_THROW(tet::specialize(2, in(quadratic), {x, x, x, bad}), InputError);
  EXPECT_THROW(tet::subdivide(1, in(none)), InputError);
  EXPECT_THROW(tet::elevate(1, in(none)), InputError);
  EXPECT_THROW(tet::multiply(1, none, 2, quadratic), InputError);
  EXPECT_THROW(tet::integral(1, none), InputError);
  EXPECT_THROW(tet::face(1, in(none), 0), InputError);
  EXPECT_THROW(tet::to_lagrange(1, in(none)), InputError);
  EXPECT_THROW(tet::from_lagrange(21, in(none)), InputError);
  EXPECT_THROW(static_cast<void>(tet::range(1, none)), InputError);
  EXPECT_THROW(tet::basis(21, x, out), InputError);
  EXPECT_THROW(tet::basis(2, bad, out), InputError);
}

}  // namespace
