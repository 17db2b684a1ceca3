#include "bezel/fit/gordon_hall.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "bezel/base/error.hpp"
#include "support/message_of.hpp"
#include "support/quad_maps.hpp"

namespace bezel {
namespace {

using std::numbers::pi;
using test::message_of;
using test::ring_map;
using test::segment;
using test::side;
using test::straight_map;

TEST(GordonHall, StraightSidesGiveTheBilinearMap) {
  const Vec2 a{0.1, 0.2}, b{2.1, 0.3}, c{1.9, 2.2}, d{0.4, 1.7};
  for (const int degree : {1, 2, 9, 24}) {
    const GordonHall map = straight_map(degree, a, b, c, d);
    for (const double xi : {-1.0, -0.3, 0.8, 1.0})
      for (const double eta : {-1.0, 0.1, 1.0}) {
        const double x = 0.5 * (1 + xi), y = 0.5 * (1 + eta);
        const Vec2 expected = (1 - x) * (1 - y) * a + x * (1 - y) * b + x * y * c + (1 - x) * y * d;
        EXPECT_LT(norm(map(xi, eta) - expected), 1e-14);
        EXPECT_NEAR(map.jacobian(xi, eta),
                    0.25 * cross((1 - y) * (b - a) + y * (c - d), (1 - x) * (d - a) + x * (c - b)),
                    8 * (1 + degree * degree) * 0x1p-53 * 4);
      }
    EXPECT_NEAR(map.area(), 0.5 * cross(c - a, d - b), 1e-14);
  }
}

TEST(GordonHall, SidesAreKeptBitForBitAndTheInsideFollowsTheFormula) {
  const auto bottom = [](double t) { return Vec2{t, 0.2 * std::cos(2 * t) - 0.2 * std::cos(2.0)}; };
  const auto top = [](double t) { return Vec2{t, 1.0 + 0.3 * std::sin(pi * t)}; };
  const int n = 20;
  const QuadSides sides{side(n, bottom), segment(n, {1.0, 0.0}, {1.0, 1.0}), side(n, top),
                        segment(n, {-1.0, 0.0}, {-1.0, 1.0})};
  QuadSides exact = sides;  // the corners as the straight sides have them
  exact.bottom.front() = exact.left.front();
  exact.bottom.back() = exact.right.front();
  exact.top.front() = exact.left.back();
  exact.top.back() = exact.right.back();
  const GordonHall map(exact);
  const auto nodes = map.nodes();
  for (std::size_t i = 0; i <= n; ++i) {
    EXPECT_EQ(nodes[i], exact.bottom[i]);
    EXPECT_EQ(nodes[21 * 20 + i], exact.top[i]);
    EXPECT_EQ(nodes[21 * i], exact.left[i]);
    EXPECT_EQ(nodes[21 * i + 20], exact.right[i]);
  }
  for (const double xi : {-0.7, 0.0, 0.45})
    for (const double eta : {-0.2, 0.6}) {
      const double y = 0.5 * (1 + eta);
      EXPECT_LT(norm(map(xi, eta) - ((1 - y) * bottom(xi) + y * top(xi))), 1e-13);
    }
  // Integral of top - bottom over [-1, 1]; sin(pi t) has none.
  const double area = 2.0 - 0.2 * std::sin(2.0) + 0.4 * std::cos(2.0);
  EXPECT_NEAR(map.area(), area, 1e-14);
  EXPECT_NEAR(quad_area(n, map.control()), area, 1e-13);
  EXPECT_EQ(check_quad_validity(n, map.control()).status, Validity::valid);
}

TEST(GordonHall, SidesOfDifferentDegreesAreRaised) {
  const auto arc = [](double t) { return Vec2{t, 1.0 + 0.25 * (1.0 - t * t)}; };
  const GordonHall mixed({segment(1, {-1, 0}, {1, 0}), segment(3, {1, 0}, {1, 1}), side(2, arc),
                          segment(7, {-1, 0}, {-1, 1})});
  EXPECT_EQ(mixed.degree(), 7);
  EXPECT_NEAR(mixed.area(), 2.0 + 1.0 / 3.0, 1e-14);
  EXPECT_LT(norm(mixed(0.5, 1.0) - arc(0.5)), 1e-14);
}

TEST(GordonHall, FoldedMapsSayWhere) {
  // The bottom side bulges through the top one.
  const auto bulge = [](double t) { return Vec2{t, 1.5 * (1.0 - t * t)}; };
  const GordonHall map({side(6, bulge), segment(6, {1, 0}, {1, 1}), segment(6, {-1, 1}, {1, 1}),
                        segment(6, {-1, 0}, {-1, 1})});
  const JacobianRange range = map.jacobian_range();
  EXPECT_NEAR(range.min, -0.25, 1e-14);  // half of 1 - 1.5 in the middle
  EXPECT_NEAR(range.max, 0.5, 1e-14);
  EXPECT_NEAR(range.xi, 0.0, 1e-15);
  EXPECT_NEAR(map.jacobian(range.xi, range.eta), range.min, 1e-14);
  EXPECT_LT(norm(map(range.xi, range.eta) - range.point), 1e-14);
  const std::string message = message_of([&] { map.require_valid(); });
  EXPECT_EQ(message.substr(0, 45), "the jacobian determinant is -0.25 at xi = 0, ");
  EXPECT_NE(message.find("expected above 0 (its largest value is 0.5)"), std::string::npos);
}

TEST(GordonHall, CornersThatDoNotMeetSayHowFarApart) {
  QuadSides sides{segment(2, {0, 0}, {1, 0}), segment(2, {1, 0}, {1, 1}),
                  segment(2, {0, 1}, {1, 1}), segment(2, {0, 0}, {0, 1})};
  sides.right.back() = Vec2{1.0, 1.25};
  EXPECT_EQ(message_of([&] { GordonHall map(sides); }),
            "the sides at the top right corner end 0.25 apart, at (1, 1) and (1, 1.25), expected "
            "at most 1.6e-12");
  sides.right.back() = Vec2{1.0, 1.0 + 1e-13};
  EXPECT_EQ(GordonHall(sides).nodes()[8], (Vec2{1.0, 1.0}));  // as the top side has it
}

TEST(GordonHall, BadInput) {
  const QuadSides good{segment(2, {0, 0}, {1, 0}), segment(2, {1, 0}, {1, 1}),
                       segment(2, {0, 1}, {1, 1}), segment(2, {0, 0}, {0, 1})};
  QuadSides bad = good;
  bad.left = {Vec2{0.0, 0.0}};
  EXPECT_EQ(message_of([&] { GordonHall map(bad); }),
            "the left side has 1 points, expected 2 to 61");
  bad = good;
  bad.top[1] = Vec2{std::nan(""), 1.0};
  EXPECT_EQ(message_of([&] { GordonHall map(bad); }), "point 1 of the top side is not finite");
  EXPECT_EQ(message_of([] {
              straight_map(31, {0, 0}, {1, 0}, {1, 1}, {0, 1}).control();
            }),
            "found a map of degree 31, expected at most 30 for control points");
  EXPECT_EQ(message_of([] { join({}); }), "found no maps to join, expected at least one");
  const std::vector<GordonHall> clockwise{straight_map(1, {0, 0}, {1, 0}, {1, 1}, {0, 1}),
                                          straight_map(1, {0, 0}, {0, 1}, {1, 1}, {1, 0})};
  EXPECT_EQ(message_of([&] { join(clockwise); }).substr(0, 57),
            "quadrilateral 1: the jacobian determinant is -0.25 at xi ");
}

PlaneCurve line(const Vec2& a, const Vec2& b) {
  return PlaneCurve([=](double t) {
    return CurveJet<2>{0.5 * (1 - t) * a + 0.5 * (1 + t) * b, 0.5 * (b - a), Vec2{0.0, 0.0}};
  });
}
PlaneCurve half_circle() {  // from (-1, 1) over the top to (1, 1)
  return PlaneCurve([](double t) {
    const double phi = 0.5 * pi * (1 - t), h = -0.5 * pi;
    const Vec2 e{std::cos(phi), std::sin(phi)}, turned{-e.y(), e.x()};
    return CurveJet<2>{Vec2{0.0, 1.0} + e, h * turned, -(h * h) * e};
  });
}

TEST(GordonHallOfCurves, EveryMethodInterpolatesTheSides) {
  const PlaneCurve top([](double t) {
    return CurveJet<2>{Vec2{t, 1.0 + 0.3 * std::cos(pi * t)},
                       Vec2{1.0, -0.3 * pi * std::sin(pi * t)},
                       Vec2{0.0, -0.3 * pi * pi * std::cos(pi * t)}};
  });
  const QuadCurves curves{line({-1, 0}, {1, 0}), line({1, 0}, top(1.0).x), top,
                          line({-1, 0}, top(-1.0).x)};
  const CurveInterpolator interpolator(12);
  for (const CurveMethod method :
       {CurveMethod::standard, CurveMethod::chord, CurveMethod::arc_length, CurveMethod::l2,
        CurveMethod::equal_tangent, CurveMethod::orthogonal_distance, CurveMethod::best}) {
    const GordonHall map = gordon_hall(curves, 12, method, interpolator);
    map.require_valid();
    for (std::size_t i = 0; i <= 12; ++i) {
      const Vec2 p = map.nodes()[13 * 12 + i];
      EXPECT_NEAR(p.y(), 1.0 + 0.3 * std::cos(pi * p.x()), 1e-15) << name(method);
    }
    EXPECT_NEAR(map.area(), 2.0, method == CurveMethod::arc_length ? 1e-3 : 1e-8) << name(method);
  }
}

TEST(GordonHallOfCurves, SidesWithoutInterpolantSayWhy) {
  const PlaneCurve hook([](double t) {  // turns back on itself in x and y
    const double phi = 1.5 * pi * t;
    const Vec2 e{std::sin(phi), 3.0 - std::cos(phi)};
    return CurveJet<2>{e, 1.5 * pi * Vec2{std::cos(phi), std::sin(phi)},
                       2.25 * pi * pi * Vec2{-std::sin(phi), std::cos(phi)}};
  });
  const QuadCurves curves{line({-1, 0}, {1, 0}), line({1, 0}, hook(1.0).x), hook,
                          line({-1, 0}, hook(-1.0).x)};
  EXPECT_EQ(message_of([&] { gordon_hall(curves, 8, CurveMethod::chord); }),
            "the top side has no interpolant by the method chord: " +
                std::string(name(CurveStatus::not_a_chord_map)));
  EXPECT_EQ(message_of([&] { gordon_hall(curves, 8, CurveMethod::standard); }),
            "the top side has no interpolant by the method standard: " +
                std::string(name(CurveStatus::not_a_graph)));
  const QuadCurves apart{line({-1, 0}, {1, 0}), line({1, 0}, {1, 1.5}), half_circle(),
                         line({-1, 0}, {-1, 1})};
  EXPECT_EQ(message_of([&] { gordon_hall(apart, 8); }).substr(0, 46),
            "the sides at the top right corner end 0.5 apar");
}

TEST(Join, ARingOfTwoMapsHasDifferentCurvesBetweenTheSameCorners) {
  const std::vector<GordonHall> maps{ring_map(16, 0.0, pi), ring_map(16, pi, 2 * pi)};
  const QuadMesh mesh = join(maps);
  EXPECT_EQ(mesh.vertex_count(), 4u);
  EXPECT_EQ(mesh.edge_count(), 6u);
  std::size_t inner = 0;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) inner += mesh.is_boundary(EdgeId(e)) ? 0 : 1;
  EXPECT_EQ(inner, 2u);
  EXPECT_NEAR(mesh.area(), 3 * pi, 1e-12);
  for (std::size_t e = 0; e < 2; ++e)
    EXPECT_EQ(mesh.validity(ElementId(e)).status, Validity::valid);
}

TEST(Join, TurnedNeighboursShareTheirSide) {
  // The right square starts at its upper right corner.
  const std::vector<GordonHall> maps{straight_map(3, {0, 0}, {1, 0}, {1, 1}, {0, 1}),
                                     straight_map(2, {2, 1}, {1, 1}, {1, 0}, {2, 0})};
  const QuadMesh mesh = join(maps);
  EXPECT_EQ(mesh.degree(), 3);
  EXPECT_EQ(mesh.vertex_count(), 6u);
  EXPECT_EQ(mesh.edge_count(), 7u);
  EXPECT_EQ(mesh.node_count(), 2u * 16u - 4u);
  EXPECT_NEAR(mesh.area(), 2.0, 1e-14);
}

TEST(Join, NodesComeBack) {
  const GordonHall map = ring_map(20, 0.3, 1.9);
  const QuadMesh mesh = join(std::span(&map, 1));
  const std::vector<Vec2> nodes = lobatto_nodes(mesh, ElementId(0), map.basis());
  for (std::size_t k = 0; k < nodes.size(); ++k) EXPECT_LT(norm(nodes[k] - map.nodes()[k]), 2e-14);
}

}  // namespace
}  // namespace bezel
