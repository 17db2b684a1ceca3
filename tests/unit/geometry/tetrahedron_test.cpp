#include "bezel/geometry/tetrahedron.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "support/message_of.hpp"

namespace {

using bezel::check_validity;
using bezel::Lambda4;
using bezel::Location;
using bezel::Validity;
using bezel::Vec3;
using bezel::test::message_of;
using Points = std::vector<Vec3>;
namespace bern = bezel::bernstein;

const Points unit{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};

/// The identity as a map of degree g, each control point moved by bump(u, v, w).
template <class Bump>
Points net(int g, const Bump& bump) {
  Points b;
  for (int n = 0; n < bern::tetrahedron_size(g); ++n) {
    const auto x = bern::tetrahedron_multi_index(g, n);
    const Vec3 p{{x[1] / static_cast<double>(g), x[2] / static_cast<double>(g),
                  x[3] / static_cast<double>(g)}};
    b.push_back(p + bump(p));
  }
  return b;
}
/// (u, v, w + a u (1 - u)): one curved direction; the determinant is 1, the volume 1/6.
Points sheared(double a) {
  Points b = net(2, [](const Vec3&) { return Vec3{}; });
  b[1][2] += a / 2;  // the blossom of u - u^2 at (c0, c1); 0 at corners
  b[4][2] += a / 2;
  b[7][2] += a / 2;
  return b;
}

TEST(TetrahedronJacobian, OfAStraightTetrahedronIsSixTimesItsVolume) {
  const Points t{{{0, 0, 0}}, {{2, 0, 0}}, {{0, 3, 0}}, {{0, 0, 5}}};
  EXPECT_EQ(bezel::jacobian_determinant(1, t), std::vector<double>{30.0});
  const auto elevated = bern::tetrahedron::elevate(1, std::span<const Vec3>(t), 1);
  EXPECT_EQ(bezel::jacobian_determinant(2, elevated), std::vector<double>(20, 30.0));
}

TEST(TetrahedronJacobian, OfAKnownQuadraticMap) {
  // (u^2, v, w): determinant 2 u, as cubic coefficients 2 j / 3.
  Points b = net(2, [](const Vec3&) { return Vec3{}; });
  for (int n = 0; n < 10; ++n) {
    const auto x = bern::tetrahedron_multi_index(2, n);
    b[static_cast<std::size_t>(n)][0] = x[1] == 2 ? 1 : 0;
  }
  const auto det = bezel::jacobian_determinant(2, b);
  for (int n = 0; n < 20; ++n)
    EXPECT_DOUBLE_EQ(det[static_cast<std::size_t>(n)],
                     2.0 * bern::tetrahedron_multi_index(3, n)[1] / 3.0);
  EXPECT_EQ(bezel::jacobian_determinant(2, sheared(0.25)), std::vector<double>(20, 1.0));
}

TEST(TetrahedronValidityTest, StraightOnesBySignExactly) {
  const auto good = check_validity(1, unit);
  EXPECT_EQ(good.status, Validity::valid);
  EXPECT_EQ(good.det, 1.0);
  EXPECT_EQ(good.where, (Lambda4{0.25, 0.25, 0.25, 0.25}));
  EXPECT_EQ(check_validity(1, Points{unit[0], unit[2], unit[1], unit[3]}).status,
            Validity::inverted);
  EXPECT_EQ(check_validity(1, Points(4, unit[1])).status, Validity::inverted);
  // In a plane up to one unit in the last place: x + y + z = 1 and a corner off it by 2^-53.
  Points flat{{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{0.5, 0.25, 0.25}}};
  EXPECT_EQ(check_validity(1, flat).status, Validity::inverted);
  EXPECT_EQ(check_validity(1, flat).det, 0.0);
  flat[3][0] = std::nextafter(0.5, 1.0);
  EXPECT_EQ(check_validity(1, flat).status, Validity::valid);
  EXPECT_EQ(check_validity(1, flat).det, 0x1p-53);
  flat[3][0] = std::nextafter(0.5, 0.0);
  EXPECT_EQ(check_validity(1, flat).status, Validity::inverted);
}

TEST(TetrahedronValidityTest, CurvedFoldedAndTouching) {
  const auto good = check_validity(2, sheared(0.5));
  EXPECT_EQ(good.status, Validity::valid);
  EXPECT_NEAR(good.det, 1.0, 1e-15);
  // (u^2 - t u, v, w) has the determinant 2 u - t: zero on u = t / 2.
  const auto folded = [](double t) {
    Points b = net(2, [](const Vec3&) { return Vec3{}; });
    for (int n = 0; n < 10; ++n) {
      const auto x = bern::tetrahedron_multi_index(2, n);
      b[static_cast<std::size_t>(n)][0] = (x[1] == 2 ? 1 : 0) - t * x[1] / 2;
    }
    return b;
  };
  const auto bad = check_validity(2, folded(0.5));
  EXPECT_EQ(bad.status, Validity::inverted);
  EXPECT_LT(bad.det, 0);
  EXPECT_DOUBLE_EQ(2 * bad.where[1] - 0.5, bad.det);
  EXPECT_EQ(check_validity(2, folded(-0x1p-20)).status, Validity::valid);
  EXPECT_EQ(check_validity(2, folded(-0x1p-52)).status, Validity::undecided);
  EXPECT_EQ(check_validity(2, folded(0.0)).status, Validity::inverted);  // zero on a face
  EXPECT_EQ(check_validity(2, folded(0.0)).det, 0.0);
  EXPECT_EQ(check_validity(2, folded(0x1p-52)).status, Validity::inverted);
}

TEST(TetrahedronValidityTest, AnyScale) {
  for (const double scale : {0x1p-1000, 0x1p-400, 0x1p400, 0x1p1022}) {
    Points good = sheared(0.5), bad = sheared(0.5);
    for (Vec3& p : good) p *= scale;
    for (Vec3& p : bad) p = scale * Vec3{{p[1], p[0], p[2]}};
    EXPECT_EQ(check_validity(2, good).status, Validity::valid) << scale;
    EXPECT_EQ(check_validity(2, bad).status, Validity::inverted) << scale;
  }
  Points huge = unit;  // differences overflow
  for (Vec3& p : huge) p = 0x1.8p1023 * (2.0 * p - Vec3{{1, 1, 1}});
  EXPECT_EQ(check_validity(1, huge).status, Validity::valid);
}

TEST(TetrahedronLocateTest, InsideOutsideAndOnTheBoundary) {
  const Points b = sheared(0.5);
  const auto middle = bezel::locate(2, b, Vec3{{0.25, 0.25, 0.25}});
  EXPECT_EQ(middle.status, Location::inside);
  EXPECT_NEAR(middle.lambda[1], 0.25, 1e-15);
  EXPECT_NEAR(middle.lambda[3], 0.25 - 0.5 * 0.25 * 0.75, 1e-15);
  EXPECT_LT(middle.residual, 1e-15);
  EXPECT_EQ(bezel::locate(2, b, Vec3{{2, 2, 2}}).status, Location::outside);
  // Below the face w = 0, which bulges to z = 0.125 at u = 1/2: in the hull only.
  EXPECT_EQ(bezel::locate(2, b, Vec3{{0.5, 0.25, 0.12}}).status, Location::outside);
  EXPECT_EQ(bezel::locate(2, b, Vec3{{0.5, 0.25, 0.125}}).status, Location::inside);
  EXPECT_EQ(bezel::locate(2, b, Vec3{{0.5, 0.25, 0.13}}).status, Location::inside);
  for (int corner = 0; corner < 4; ++corner) {
    const Vec3 p = b[static_cast<std::size_t>(bern::tetrahedron_corner(2, corner))];
    const auto found = bezel::locate(2, b, p);
    EXPECT_EQ(found.status, Location::inside);
    EXPECT_NEAR(found.lambda[static_cast<std::size_t>(corner)], 1.0, 1e-14);
  }
}

TEST(TetrahedronLocateTest, ToleranceIsInBarycentrics) {
  const Vec3 out{{0.25, 0.25, -0.01}};
  for (const int g : {1, 2}) {
    const Points b = net(g, [](const Vec3&) { return Vec3{}; });
    EXPECT_EQ(bezel::locate(g, b, out, 0.0).status, Location::outside);
    EXPECT_EQ(bezel::locate(g, b, out, 0.0099).status, Location::outside);
    const auto within = bezel::locate(g, b, out, 0.0101);
    EXPECT_EQ(within.status, Location::inside);
    EXPECT_NEAR(within.lambda[3], -0.01, 1e-15);
  }
}

TEST(TetrahedronLocateTest, FlatAndCollapsed) {
  const Points flat{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 1, 0}}};
  EXPECT_EQ(bezel::locate(1, flat, Vec3{{0.3, 0.3, 0.1}}).status, Location::outside);
  EXPECT_EQ(bezel::locate(1, flat, Vec3{{3, 3, 0}}).status, Location::outside);
  EXPECT_NE(bezel::locate(1, flat, Vec3{{0.3, 0.3, 0}}).status, Location::outside);
  const Points point(10, Vec3{{1, 2, 3}});
  EXPECT_EQ(bezel::locate(2, point, Vec3{{1, 2, 3}}).status, Location::inside);
  EXPECT_EQ(bezel::locate(2, point, Vec3{{1, 2, 4}}).status, Location::outside);
}

TEST(TetrahedronLocateTest, AnyScale) {
  for (const double scale : {0x1p-1000, 0x1p-300, 0x1p300, 0x1p1022}) {
    Points b = sheared(0.5);
    for (Vec3& p : b) p *= scale;
    EXPECT_EQ(bezel::locate(2, b, scale * Vec3{{0.25, 0.25, 0.25}}).status, Location::inside);
    EXPECT_EQ(bezel::locate(2, b, scale * Vec3{{0.5, 0.25, 0.12}}).status, Location::outside);
  }
  Points huge = unit;  // differences overflow
  for (Vec3& p : huge) p = 0x1.8p1023 * (2.0 * p - Vec3{{1, 1, 1}});
  const auto found = bezel::locate(1, huge, Vec3{{-0x1p1023, -0x1p1023, -0x1p1023}});
  EXPECT_EQ(found.status, Location::inside);
  EXPECT_NEAR(found.lambda[1], 1.0 / 6, 1e-15);
}

TEST(TetrahedronInvertTest, AlsoOutside) {
  const auto found = bezel::invert(1, unit, Vec3{{2, -0.5, 0.25}}, Lambda4{0.25, 0.25, 0.25, 0.25});
  EXPECT_TRUE(found.converged);
  EXPECT_EQ(found.lambda, (Lambda4{-0.75, 2.0, -0.5, 0.25}));
  const Points flat(4, Vec3{});
  EXPECT_FALSE(bezel::invert(1, flat, Vec3{{1, 0, 0}}, Lambda4{1, 0, 0, 0}).converged);
}

TEST(TetrahedronVolumeTest, StraightCurvedAndFarAway) {
  EXPECT_DOUBLE_EQ(bezel::volume(1, unit), 1.0 / 6);
  EXPECT_DOUBLE_EQ(bezel::volume(2, sheared(0.5)), 1.0 / 6);
  Points far = unit;
  for (Vec3& p : far) p += Vec3{{0x1p30, -0x1p30, 0x1p40}};
  EXPECT_EQ(bezel::volume(1, far), bezel::volume(1, unit));
  // (u^2, v, w): the integral of 2 u is 2 / 24.
  Points square = net(2, [](const Vec3&) { return Vec3{}; });
  for (int n = 0; n < 10; ++n)
    square[static_cast<std::size_t>(n)][0] = bern::tetrahedron_multi_index(2, n)[1] == 2 ? 1 : 0;
  EXPECT_DOUBLE_EQ(bezel::volume(2, square), 1.0 / 12);
}

TEST(TetrahedronTest, TheLargestDegreeWorks) {
  const Points b = net(7, [](const Vec3& p) { return 0.05 * Vec3{{p[1] * p[1], p[2], p[0]}}; });
  EXPECT_EQ(check_validity(7, b).status, Validity::valid);
  EXPECT_EQ(bezel::jacobian_determinant(7, b).size(), 1330U);
  EXPECT_EQ(bezel::locate(7, b, Vec3{{0.3, 0.2, 0.2}}).status, Location::inside);
  EXPECT_EQ(bezel::locate(7, b, Vec3{{0.3, 0.2, -0.2}}).status, Location::outside);
}

TEST(TetrahedronTest, BadInput) {
  EXPECT_EQ(message_of([] { bezel::volume(0, unit); }),
            "the tetrahedron's degree is 0, expected 1 to 7");
  EXPECT_EQ(message_of([] { bezel::jacobian_determinant(8, unit); }),
            "the tetrahedron's degree is 8, expected 1 to 7");
  EXPECT_EQ(message_of([] { bezel::volume(2, unit); }),
            "a tetrahedron of degree 2 has 10 control points, found 4");
  Points broken = unit;
  broken[2] = Vec3{{0, 0, INFINITY}};
  EXPECT_EQ(message_of([&] { static_cast<void>(check_validity(1, broken)); }),
            "control point 2 of the tetrahedron is not finite");
  EXPECT_EQ(message_of([&] { static_cast<void>(bezel::locate(1, broken, Vec3{})); }),
            "control point 2 of the tetrahedron is not finite");
  EXPECT_EQ(message_of([&] {
              static_cast<void>(bezel::locate(1, unit, Vec3{{0, NAN, 0}}));
            }),
            "the point to locate is not finite");
  for (const double tolerance : {-0.1, 1.0, static_cast<double>(NAN)})
    EXPECT_EQ(message_of([&] { static_cast<void>(bezel::locate(1, unit, Vec3{}, tolerance)); }),
              "the barycentric tolerance must be in [0, 1)");
}

}  // namespace
