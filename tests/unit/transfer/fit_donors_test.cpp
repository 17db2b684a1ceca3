#include "bezel/transfer/fit_donors.hpp"

#include <gtest/gtest.h>

#include "bezel/base/random.hpp"
#include "support/meshes.hpp"

namespace bezel::detail {
namespace {

/// Two components at random, on curved elements.
Field noise(const std::shared_ptr<const TriangleMesh>& mesh, int degree) {
  const auto space = Space::discontinuous(mesh, degree);
  RandomStream random("fit donors", 1);
  std::vector<double> c(2 * space->coefficient_count());
  for (double& value : c) value = random.uniform(-1.0, 2.0);
  return {"noise", space, c, 2};
}

TEST(FitDonors, MassesOfWholeElementsAreTheFields) {
  const auto mesh = test::grid_mesh(3, 2, 1.0, test::bend(0.1, 0.1));
  const OverlayMesh overlay(mesh, "donor", 1);
  for (const int p : {0, 1, 3}) {
    const Field field = noise(mesh, p);
    const Field* const fields[] = {&field};
    const Group group(overlay, overlay, fields, Space::discontinuous(mesh, p), 1);
    FitDonors donors(overlay, overlay, 1);
    for (std::int32_t e = 0; e < static_cast<std::int32_t>(mesh->element_count()); ++e) {
      const auto at = static_cast<std::size_t>(e);
      const FitDonor& donor = donors.of(0, group, e);
      EXPECT_EQ(donor.element, e);
      std::vector<Segment> run;
      for (const SideEdge& side : overlay.element_edges[at]) {
        Segment segment;
        segment.donor = e;
        segment.source = {side.edge.value, side.reversed ? 1.0 : 0.0, side.reversed ? 0.0 : 1.0};
        run.push_back(segment);
      }
      std::vector<double> own(2), pulled(2);
      EXPECT_EQ(donor.degree, FitDonors::mass_degree(overlay, p));
      donors.integrate(donor, run, overlay.element_area[at], {}, own);
      // The same by the curves of a target, here the element itself.
      for (Segment& segment : run) std::swap(segment.source, segment.target);
      donors.integrate(donor, run, overlay.element_area[at], {}, pulled);
      for (std::size_t c = 0; c < 2; ++c) {
        EXPECT_NEAR(own[c], group.donor_mass[2 * at + c], 1e-15);
        EXPECT_NEAR(pulled[c], group.donor_mass[2 * at + c], 1e-15);
      }
    }
  }
}

// A slit: out along a side's piece and back by a bridge has nearly no mass; without the bridge the
// rays to the piece have.
TEST(FitDonors, BridgesCloseARegion) {
  const auto mesh = test::grid_mesh(2, 2, 1.0, test::bend(0.1, 0.1));
  const OverlayMesh overlay(mesh, "donor", 1);
  const Field field = noise(mesh, 1);
  const Field* const fields[] = {&field};
  const Group group(overlay, overlay, fields, Space::discontinuous(mesh, 1), 1);
  FitDonors donors(overlay, overlay, 1);
  const FitDonor& donor = donors.of(0, group, 3);
  const SideEdge side = overlay.element_edges[3][0];
  Segment segment;
  segment.donor = 3;
  segment.source = {side.edge.value, 0.5, 0.5 + 1e-4};
  const auto curve = overlay.edge(side.edge.value);
  const Vec2 from = curve_point(curve, 0.5 + 1e-4), to = curve_point(curve, 0.5);
  const std::array<std::array<Vec2, 2>, 1> bridge = {{{from, to - from}}};
  std::vector<double> open(2), closed(2);
  donors.integrate(donor, {&segment, 1}, 0.0, {}, open);
  donors.integrate(donor, {&segment, 1}, 0.0, bridge, closed);
  EXPECT_GT(std::abs(open[0]) + std::abs(open[1]), 1e-6);
  for (const double mass : closed) EXPECT_NEAR(mass, 0.0, 1e-10);
}

}  // namespace
}  // namespace bezel::detail
