#include "bezel/fit/curve_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bezel/base/error.hpp"
#include "bezel/fit/curve_domain.hpp"
#include "bezel/fit/curve_shapes.hpp"
#include "bezel/fit/curve_sources.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/mesh/generate.hpp"
#include "support/message_of.hpp"

namespace bezel {
namespace {

using test::message_of;

constexpr double pi = std::numbers::pi;

TriangleMesh straight_disc(double size) {
  GenerateOptions options;
  options.size = size;
  return generate_disc(1.0, options);
}

double total_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    sum += area(mesh.degree(), mesh.gather(ElementId(e)));
  return sum;
}

TEST(CurveMesh, BendsADiscToHighOrder) {
  const TriangleMesh disc = straight_disc(0.5);
  // The seam of the circle lies at no vertex.
  const std::vector<SmoothCurve<2>> circle = {ellipse_arc(Vec2{}, 1.0, 1.0, 0.1, 2 * pi + 0.1)};
  std::vector<double> error;
  for (int g = 1; g <= 5; ++g) {
    CurveMeshOptions options;
    options.degree = g;
    const CurvedMesh curved = curve_mesh(disc, circle, options);
    EXPECT_TRUE(curved.invalid.empty());
    EXPECT_EQ(curved.relaxation_steps, 0);
    EXPECT_EQ(curved.straight_edges, 0U);
    EXPECT_LE(curved.largest_move, 1e-15);
    EXPECT_EQ(curved.mesh.degree(), g);
    EXPECT_EQ(curved.mesh.vertex_count(), disc.vertex_count());
    EXPECT_EQ(curved.mesh.edge_count(), disc.edge_count());
    ASSERT_EQ(curved.mesh.tags().edges.size(), disc.tags().edges.size());
    for (const TaggedEdge& edge : curved.mesh.tags().edges) {
      ASSERT_EQ(edge.nodes.size(), static_cast<std::size_t>(g + 1));
      EXPECT_NEAR(norm(curved.mesh.control(edge.nodes[0])), 1.0, 4e-16);
    }
    error.push_back(curved.distance_max);
    // The distance has one sign, so the area is off by its integral.
    EXPECT_NEAR(total_area(curved.mesh), pi, 2 * pi * curved.distance_max + 1e-14);
  }
  // Order 2 g, where usual nodes give g + 1.
  EXPECT_LT(error[1], 1e-3);
  EXPECT_LT(error[2], 1e-5);
  EXPECT_LT(error[3], 1e-8);
  EXPECT_LT(error[4], 1e-10);
}

TEST(CurveMesh, BestBeatsEqualParameter) {
  const TriangleMesh disc = straight_disc(0.5);
  // A parameter of uneven speed, as nature has it.
  const std::vector<Formula> xy = {Formula("cos(t + 0.3*sin(t))", {"t"}),
                                   Formula("sin(t + 0.3*sin(t))", {"t"})};
  const std::vector<SmoothCurve<2>> circle = {formula_curve<2>(xy, 0.0, 2 * pi)};
  for (int g = 2; g <= 4; ++g) {
    CurveMeshOptions options;
    options.degree = g;
    const CurvedMesh best = curve_mesh(disc, circle, options);
    options.equal_parameter = true;
    const CurvedMesh equal = curve_mesh(disc, circle, options);
    EXPECT_TRUE(best.invalid.empty() && equal.invalid.empty());
    EXPECT_LE(best.distance_l2, equal.distance_l2);
    if (g > 2) {
      EXPECT_LT(10 * best.distance_l2, equal.distance_l2);
    }
  }
}

/// The square [0, 3]^2 with one vertex inside, whose bottom a curve will push up.
TriangleMesh fan(double height) {
  const std::vector<Vec2> p = {Vec2{{0, 0}}, Vec2{{3, 0}}, Vec2{{3, 3}}, Vec2{{0, 3}},
                               Vec2{{1.5, height}}};
  const auto node = [](int i) { return NodeId(i); };
  return {1,
          p,
          {node(0), node(1), node(4), node(1), node(2), node(4), node(2), node(3), node(4), node(3),
           node(0), node(4)}};
}

TEST(CurveMesh, RelaxesWhereBendingIsNotEnough) {
  // The bump of the bottom passes the vertex inside: it must move.
  const std::vector<Formula> xy = {Formula("t", {"t"}), Formula("0.4*t*(3 - t)", {"t"})};
  const std::vector<SmoothCurve<2>> bump = {formula_curve<2>(xy, 0.0, 3.0)};
  for (int g = 2; g <= 4; ++g) {
    CurveMeshOptions options;
    options.degree = g;
    const CurvedMesh curved = curve_mesh(fan(0.6), bump, options);
    EXPECT_TRUE(curved.invalid.empty());
    EXPECT_GT(curved.relaxation_steps, 0);
    EXPECT_EQ(curved.straight_edges, 3U);
    EXPECT_LE(curved.distance_max, 1e-15);
    EXPECT_NEAR(total_area(curved.mesh), 9 - 1.8, 1e-13);
    for (std::size_t e = 0; e < curved.mesh.element_count(); ++e)
      EXPECT_EQ(check_validity(g, curved.mesh.gather(ElementId(e))).status, Validity::valid);
  }
}

TEST(CurveMesh, KeepsCornersAndStraightSides) {
  // Half a disc: the diameter is a curve of its own.
  GenerateOptions options;
  options.size = 0.4;
  options.pattern = Pattern::structured;
  const TriangleMesh square = generate_rectangle(2.0, 2.0, options);
  const auto side = [](double x0, double y0, double x1, double y1) {
    const std::vector<Formula> xy = {
        Formula(std::to_string(x0) + "+(" + std::to_string(x1 - x0) + ")*t", {"t"}),
        Formula(std::to_string(y0) + "+(" + std::to_string(y1 - y0) + ")*t", {"t"})};
    return formula_curve<2>(xy, 0.0, 1.0);
  };
  const std::vector<SmoothCurve<2>> curves = {side(-1, -1, 1, -1), side(1, 1, 1, -1),
                                              side(1, 1, -1, 1), side(-1, -1, -1, 1)};
  CurveMeshOptions how;
  how.degree = 3;
  const CurvedMesh curved = curve_mesh(square, curves, how);
  EXPECT_EQ(curved.edges.size(), square.tags().edges.size());
  EXPECT_LE(curved.distance_max, 1e-15);
  EXPECT_NEAR(total_area(curved.mesh), 4.0, 1e-13);
}

TEST(CurveDomain, MeshesTheOutsideOfAnAerofoil) {
  const std::vector<SmoothCurve<2>> curves = {ellipse_arc(Vec2{{0.5, 0}}, 1.5, 1.5, 0.0, 2 * pi),
                                              naca4("0012", AerofoilPart::upper),
                                              naca4("0012", AerofoilPart::lower)};
  // Twice the integral of the thickness.
  const double foil = 1.2 * (0.2969 / 1.5 - 0.1260 / 2 - 0.3516 / 3 + 0.2843 / 4 - 0.1036 / 5);
  for (const double turn : {0.3, 1.0}) {
    const TriangleMesh straight = mesh_curve_domain(curves, {0.25, turn, 1});
    ASSERT_EQ(straight.tags().groups.size(), 4U);
    CurveMeshOptions options;
    options.degree = 4;
    const CurvedMesh best = curve_mesh(straight, curves, options);
    EXPECT_TRUE(best.invalid.empty());
    EXPECT_EQ(best.straight_edges, 0U);
    EXPECT_EQ(best.edges.size(), best.mesh.tags().edges.size());
    EXPECT_NEAR(total_area(best.mesh), pi * 2.25 - foil, 10 * best.distance_max + 1e-13);
    options.equal_parameter = true;
    EXPECT_GT(curve_mesh(straight, curves, options).distance_l2, 1000 * best.distance_l2);
  }
}

TEST(CurveDomain, TakesCurvesInAnyOrderAndDirection) {
  const std::vector<Vec2> p = {Vec2{{0, 0}}, Vec2{{2, 0}}, Vec2{{2, 1}}, Vec2{{0, 1}}};
  const auto line = [&](std::size_t a, std::size_t b) {
    return bezier_curve<2>(std::vector<Vec2>{p[a], p[b]});
  };
  const std::vector<SmoothCurve<2>> curves = {line(2, 1), line(0, 1), line(0, 3), line(2, 3),
                                              ellipse_arc(Vec2{{1, 0.5}}, 0.2, 0.2, 0, 2 * pi)};
  const std::vector<std::string> names = {"right", "bottom", "left", "top", "hole"};
  const TriangleMesh mesh = mesh_curve_domain(curves, {0.2, 0.5, 1}, names);
  EXPECT_NEAR(total_area(mesh), 2 - 0.04 * pi, 0.01);
  EXPECT_EQ(mesh.tags().groups[5].name, "hole");
  // Tagged edges have the domain on their left: the bottom runs to the right, the left downwards.
  for (const TaggedEdge& edge : mesh.tags().edges) {
    const Vec2 d = mesh.control(edge.nodes[1]) - mesh.control(edge.nodes[0]);
    if (edge.entity == 2) {
      EXPECT_GT(d.x(), 0.0);
    } else if (edge.entity == 3) {
      EXPECT_LT(d.y(), 0.0);
    }
  }
}

TEST(CurveDomain, RefusesBadInput) {
  const auto line = [](double x0, double y0, double x1, double y1) {
    return bezier_curve<2>(std::vector<Vec2>{Vec2{{x0, y0}}, Vec2{{x1, y1}}});
  };
  const std::vector<SmoothCurve<2>> open = {line(0, 0, 1, 0), line(1, 0, 0, 1),
                                            line(0, 1, 0, 0.125)};
  EXPECT_EQ(message_of([&] { return mesh_curve_domain(open); }),
            "the end of curve 2 meets no other end; the nearest is 0.125000 away, expected closed "
            "chains of curves");
  EXPECT_NE(message_of([&] { return mesh_curve_domain({}); }), "no InputError");
  const std::vector<SmoothCurve<2>> good = {line(0, 0, 1, 0), line(1, 0, 0, 1), line(0, 1, 0, 0)};
  EXPECT_EQ(message_of([&] { return mesh_curve_domain(good, {0.25, 0.5, 1}); }), "no InputError");
  EXPECT_NE(message_of([&] { return mesh_curve_domain(good, {-1.0, 0.5, 1}); }), "no InputError");
  EXPECT_NE(message_of([&] { return mesh_curve_domain(good, {0.25, 3.0, 1}); }), "no InputError");
  EXPECT_NE(message_of([&] { return mesh_curve_domain(good, {1e-4, 0.5, 1}); }), "no InputError");
  const std::vector<std::string> names = {"a"};
  EXPECT_NE(message_of([&] { return mesh_curve_domain(good, {}, names); }), "no InputError");
  // Circles that cross.
  const std::vector<SmoothCurve<2>> crossing = {ellipse_arc(Vec2{}, 1, 1, 0, 2 * pi),
                                                ellipse_arc(Vec2{{1, 0}}, 1, 1, 0, 2 * pi)};
  EXPECT_NE(message_of([&] { return mesh_curve_domain(crossing); }), "no InputError");
}

TEST(CurveMesh, RefusesBadInput) {
  const TriangleMesh disc = straight_disc(0.8);
  const std::vector<SmoothCurve<2>> far = {ellipse_arc(Vec2{{5, 5}}, 1.0, 1.0, 0.0, pi)};
  const std::string none = message_of([&] { return curve_mesh(disc, far); });
  EXPECT_NE(none.find("boundary edges lies on a curve"), std::string::npos) << none;
  const std::vector<SmoothCurve<2>> circle = {ellipse_arc(Vec2{}, 1.0, 1.0, 0.0, 2 * pi)};
  CurveMeshOptions options;
  options.degree = 11;
  EXPECT_EQ(message_of([&] { return curve_mesh(disc, circle, options); }),
            "found geometric degree 11, expected 1 to 10");
  options.degree = 2;
  options.tolerance = 0.5;
  EXPECT_NE(message_of([&] { return curve_mesh(disc, circle, options); }), "no InputError");
  EXPECT_NE(message_of([&] { return curve_mesh(disc, {}); }), "no InputError");
  GenerateOptions curved;
  curved.degree = 2;
  EXPECT_NE(message_of([&] { return curve_mesh(generate_disc(1.0, curved), circle); }),
            "no InputError");
  // Two sides that leave a gap at the corner where they should meet.
  const std::vector<Formula> bottom = {Formula("3*t", {"t"}), Formula("0.2*t*(1-t)", {"t"})};
  const std::vector<Formula> right = {Formula("3.0001", {"t"}), Formula("3*t", {"t"})};
  const std::vector<SmoothCurve<2>> apart = {formula_curve<2>(bottom, 0.0, 1.0),
                                             formula_curve<2>(right, 0.0, 1.0)};
  options.tolerance = 1e-3;
  const std::string gap = message_of([&] { return curve_mesh(fan(1.5), apart, options); });
  EXPECT_NE(gap.find("curves 0 and 1 pass it 0.000100 apart"), std::string::npos) << gap;
}

}  // namespace
}  // namespace bezel
