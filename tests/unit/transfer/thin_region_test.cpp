#include "bezel/transfer/thin_region.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bezel/geometry/area_map.hpp"
#include "bezel/transfer/group.hpp"
#include "support/exact_integrals.hpp"
#include "support/mesh_pairs.hpp"
#include "support/meshes.hpp"

namespace bezel::detail {
namespace {

/// Two triangles of width 1e-6, turned.
OverlayMesh strip(int degree) {
  return {test::grid_mesh(1, degree, 1.0,
                          [](const Vec2& p) {
                            const double v = 1e-6 * (p[1] + 0.3 * (1.0 - p[0] * p[0]));
                            return Vec2{{1.0 + 0.9 * p[0] - 0.4 * v, 0.4 * p[0] + 0.9 * v - 0.5}};
                          }),
          "mesh", 1};
}

/// The boundary of element e, whole, as a donor's.
std::vector<Segment> around(const OverlayMesh& mesh, std::int32_t e) {
  std::vector<Segment> run;
  for (const SideEdge& side : mesh.element_edges[static_cast<std::size_t>(e)]) {
    const double from = side.reversed ? 1.0 : 0.0;
    run.push_back({e, one_curve, Part{}, Part{side.edge.value, from, 1.0 - from}});
  }
  return run;
}

class ThinRegions : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Geometry, ThinRegions, ::testing::Values(1, 2, 3));

TEST_P(ThinRegions, FlatAsGivenWhateverThePlane) {
  OverlayMesh mesh = strip(GetParam());
  EXPECT_TRUE(is_flat(mesh, 0));
  EXPECT_TRUE(is_flat_as_given(mesh, 0));
  EXPECT_EQ(given_diameter(mesh, 0), mesh.element_diameter[0]);
  // Nodes that came from another plane, where the elements were round.
  for (std::size_t n = 0; n < mesh.mesh->node_count(); ++n) {
    const Vec2& p = mesh.mesh->control(NodeId(n));
    const double u = (p[0] - 1.0) / 0.9;
    mesh.given_control.push_back({{1e-3 * u, 1e3 * (p[1] + 0.5 - 0.4 * u)}});
  }
  EXPECT_TRUE(is_flat(mesh, 0));
  EXPECT_FALSE(is_flat_as_given(mesh, 0));
  EXPECT_LT(given_diameter(mesh, 0), 0.01);
  EXPECT_LT(largest_given_coordinate(mesh, 0), 0.01);
}

TEST_P(ThinRegions, PartsMeetAndLieOnTheirEdge) {
  const OverlayMesh mesh = strip(GetParam());
  ThinRegion region(mesh, mesh);
  const std::vector<Segment> run = around(mesh, 0);
  region.begin(0, 0, run, true);
  const auto points = static_cast<std::size_t>(GetParam()) + 1;
  for (const Segment& segment : run) {
    const std::int32_t e = segment.source.edge;
    std::vector<Vec2> whole, parts, back;
    region.append(mesh, {e, 0.0, 1.0}, whole);
    region.append(mesh, {e, 0.0, 0.3}, parts);
    region.append(mesh, {e, 0.3, 1.0}, parts);
    region.append(mesh, {e, 1.0, 0.0}, back);
    EXPECT_EQ(parts.front(), whole.front());
    EXPECT_EQ(parts[points - 1], parts[points]);
    EXPECT_EQ(parts.back(), whole.back());
    for (std::size_t i = 0; i < points; ++i) EXPECT_EQ(back[i], whole[points - 1 - i]);
    // One rounding of coordinates that are at most the element's size there.
    const double size = 1e-3;
    EXPECT_LE(norm(parts[points] - curve_point(whole, 0.3)), 8.0 * 0x1p-53 * size);
  }
}

TEST(ThinRegion, CornersLieInTheCornersOfTheTriangle) {
  const OverlayMesh mesh = strip(1);
  ThinRegion region(mesh, mesh);
  for (std::int32_t e = 0; e < 2; ++e) {
    const std::vector<Segment> run = around(mesh, e);
    region.begin(0, e, run, true);
    const LinearPlace place = region.place_in(mesh, e);
    const LinearPlace in_frame = region.place_in(affine_frame(mesh.corners(e)));
    MappedElement own;
    region.bring(mesh, e, own);
    for (std::size_t k = 0; k < 3; ++k) {
      std::vector<Vec2> side;
      region.append(mesh, run[k].source, side);
      const auto at = place(side[0]);
      EXPECT_NEAR(at[0], k == 1 ? 1.0 : 0.0, 16.0 * 0x1p-53);
      EXPECT_NEAR(at[1], k == 2 ? 1.0 : 0.0, 16.0 * 0x1p-53);
      // A frame's gradients are rounded numbers of size 1e6.
      EXPECT_NEAR(in_frame(side[0])[0], at[0], 1e-9);
      EXPECT_NEAR(in_frame(side[0])[1], at[1], 1e-9);
      EXPECT_EQ(own.control[k], own.moved(side[0]));
    }
  }
}

/// Two triangles of width 1e-6, bent by 0.2.
OverlayMesh bent_strip(int degree) {
  return {test::grid_mesh(1, degree, 1.0,
                          [](const Vec2& p) {
                            const double v = 1e-6 * p[1] + 0.2 * (1.0 - p[0] * p[0]);
                            return Vec2{{1.0 + 0.9 * p[0] - 0.4 * v, 0.4 * p[0] + 0.9 * v - 0.5}};
                          }),
          "mesh", 1};
}

TEST_P(ThinRegions, PartsOfBentEdgesBoundTheWholeArea) {
  if (GetParam() == 1) return;
  const OverlayMesh mesh = bent_strip(GetParam());
  EXPECT_FALSE(is_bent(strip(GetParam()), 0));
  ThinRegion region(mesh, mesh);
  for (std::int32_t e = 0; e < 2; ++e) {
    ASSERT_TRUE(is_bent(mesh, e));
    const std::vector<Segment> run = around(mesh, e);
    region.begin(0, e, run, true);
    DoubleDouble twice;
    for (const Segment& segment : run) {
      const Part& part = segment.source;
      std::vector<ExactVec2> first, rest;
      const double middle = part.from + 0.3 * (part.to - part.from);
      region.append(mesh, {part.edge, part.from, middle}, first);
      region.append(mesh, {part.edge, middle, part.to}, rest);
      EXPECT_EQ(first.back(), rest.front());
      EXPECT_EQ(region.in_plane(region.as_given_exactly({{0.25, 0.5}})), (Vec2{{0.25, 0.5}}));
      twice += twice_swept_area(first) + twice_swept_area(rest);
    }
    const double exact = test::exact_integrals(GetParam(), mesh.element(e), 0)[0].hi;
    EXPECT_NEAR(0.5 * twice.hi, exact, 4e-16 * exact);
    EXPECT_NEAR(mesh.element_area[static_cast<std::size_t>(e)], exact, 4e-16 * exact);
  }
}

// Rounded coordinates of another plane do not tell areas.
TEST_P(ThinRegions, AreasOfMovedBentElementsAreThoseAsGiven) {
  if (GetParam() == 1) return;
  const OverlayMesh given = bent_strip(GetParam());
  const AreaMap map = round_map(given.element(0));
  OverlayMesh mesh(
      test::with_control(given.mesh, [&](const Vec2& p, std::size_t) { return map(p); }), "mesh",
      1);
  std::vector<Vec2> control;
  for (std::size_t n = 0; n < given.mesh->node_count(); ++n)
    control.push_back(given.mesh->control(NodeId(n)));
  mesh.came_from(control, 1e-14);
  EXPECT_EQ(mesh.rounding, 1e-14);
  EXPECT_EQ(mesh.element_area, given.element_area);
  EXPECT_TRUE(is_bent(mesh, 0));
}

TEST_P(ThinRegions, StepsAsGiven) {
  const OverlayMesh mesh = strip(GetParam());
  ThinRegion region(mesh, mesh);
  region.begin(0, 0, around(mesh, 0), true);
  const auto corners = mesh.corners(0);
  std::vector<Vec2> side;
  region.append(mesh, around(mesh, 0)[0].source, side);
  const Vec2 step = region.as_given(side.back() - side.front());
  EXPECT_LE(norm(step - (corners[1] - corners[0])), 1e-14);
  // The height over a side times its length, over the diameter.
  const double width = region.joint_width(mesh, 0, side.back() - side.front());
  const double twice = std::abs(triangle_cross(corners[0], corners[1], corners[2]));
  EXPECT_NEAR(width * mesh.element_diameter[0], twice, 1e-14 * twice);
}

}  // namespace
}  // namespace bezel::detail
