#include "bezel/transfer/edge_points.hpp"

#include <gtest/gtest.h>

#include "support/meshes.hpp"

namespace bezel::detail {
namespace {

/// Half the integral of cross(x, dx).
double enclosed(const CurvePoints& points) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.count; ++i)
    sum += points.x[i] * points.dy[i] - points.y[i] * points.dx[i];
  return 0.5 * sum;
}

/// The sides of an element, counter-clockwise, as parts of the mesh's edges.
std::vector<Part> sides_of(const OverlayMesh& mesh, std::int32_t e) {
  std::vector<Part> parts;
  for (const SideEdge& side : mesh.element_edges[static_cast<std::size_t>(e)])
    parts.push_back({side.edge.value, side.reversed ? 1.0 : 0.0, side.reversed ? 0.0 : 1.0});
  return parts;
}

TEST(EdgePoints, CurvesEncloseTheElementsArea) {
  for (const int g : {1, 2, 3}) {
    const OverlayMesh mesh(test::grid_mesh(3, g, 1.0, test::bend(0.1, 0.1)), "mesh", 1);
    EdgePoints edges;
    for (std::int32_t e = 0; e < static_cast<std::int32_t>(mesh.element_count()); ++e) {
      const Vec2 origin = mesh.corners(e)[0];
      CurvePoints points;
      for (const Part& part : sides_of(mesh, e))
        edges.append_curve(mesh.edge(part.edge), part, origin, g, points);
      EXPECT_NEAR(enclosed(points), mesh.element_area[static_cast<std::size_t>(e)], 1e-15);
      pad(points);
      EXPECT_NEAR(enclosed(points), mesh.element_area[static_cast<std::size_t>(e)], 1e-15);
    }
  }
}

// Pieces of a side that meet, in the reference triangle: its area is 1/2.
TEST(EdgePoints, SidesEncloseTheReferenceTriangle) {
  const OverlayMesh mesh(test::grid_mesh(3, 2, 1.0, test::bend(0.1, 0.1)), "mesh", 1);
  EdgePoints edges;
  for (std::int32_t e = 0; e < static_cast<std::int32_t>(mesh.element_count()); ++e) {
    CurvePoints points;
    for (const Part& part : sides_of(mesh, e)) {
      edges.append_side(mesh, e, {part.edge, part.from, 0.3}, 2, points);
      edges.append_side(mesh, e, {part.edge, 0.3, part.to}, 2, points);
    }
    EXPECT_NEAR(enclosed(points), 0.5, 1e-15);
    EXPECT_TRUE(in_reference_triangle(points));
    points.x[0] = -1e-3;
    EXPECT_FALSE(in_reference_triangle(points));
  }
}

TEST(EdgePoints, PointsOfASideAreThoseOfItsCurve) {
  const OverlayMesh mesh(test::grid_mesh(2, 3, 1.0, test::bend(0.1, 0.1)), "mesh", 1);
  EdgePoints edges;
  for (std::int32_t e = 0; e < static_cast<std::int32_t>(mesh.element_count()); ++e) {
    for (const Part& part : sides_of(mesh, e)) {
      CurvePoints there, here;
      edges.append_side(mesh, e, part, 5, there);
      edges.append_curve(mesh.edge(part.edge), part, Vec2{}, 5, here);
      pad(there);
      const MapPolynomial map(mesh.degree, mesh.element(e));
      std::vector<double> x(lanes), y(lanes);
      fit_map(map, 1, there.x.data(), there.y.data(), x.data(), y.data(), nullptr);
      for (std::size_t i = 0; i < here.count; ++i) {
        EXPECT_NEAR(x[i], here.x[i], 1e-15);
        EXPECT_NEAR(y[i], here.y[i], 1e-15);
      }
    }
  }
}

}  // namespace
}  // namespace bezel::detail
