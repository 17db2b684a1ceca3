#include "bezel/transfer/group.hpp"

#include <gtest/gtest.h>

#include "support/meshes.hpp"

namespace bezel::detail {
namespace {

TEST(Group, HoldsTheComponentsOfItsFields) {
  const auto mesh = test::grid_mesh(2, 2, 1.0, test::bend(0.1, 0.1));
  const OverlayMesh overlay(mesh, "donor", 1);
  const auto space = Space::discontinuous(mesh, 1);
  const std::vector<Formula> velocity = {Formula("2"), Formula("3")};
  const Formula one("1");
  const Field a = project("velocity", space, velocity);
  const Field b = project("one", space, {&one, 1});
  const std::vector<const Field*> fields = {&a, &b};
  const Group group(overlay, overlay, fields, space, 1);
  EXPECT_EQ(group.components, 3);
  EXPECT_TRUE(group.donor_mapped);
  EXPECT_EQ(group.donor_scaled(0).size(), 9U);
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = c == 0 ? 2.0 : c == 1 ? 3.0 : 1.0;
      EXPECT_NEAR(group.donor_mass[3 * e + c], value * overlay.element_area[e], 1e-15);
    }
  }
}

TEST(SmallestConstants, KeepsTheSmallestByComponent) {
  std::vector<double> constants = {7.0, 7.0};
  SmallestConstants smallest(constants);
  EXPECT_EQ(constants, (std::vector<double>{7.0, 7.0}));
  const std::vector<std::vector<double>> donors = {{8.0, -3.0}, {-2.0, 4.0}, {2.0, -1.0}};
  for (const std::vector<double>& of_donor : donors) smallest.take(of_donor.data());
  EXPECT_EQ(constants, (std::vector<double>{-2.0, -1.0}));
}

TEST(AffineFrame, LambdaAreTheBarycentrics) {
  const std::array<Vec2, 3> corners = {{{{0, 0}}, {{2, 0}}, {{0, 4}}}};
  const Frame frame = affine_frame(corners);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto lambda = frame.lambda(corners[k]);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(lambda[i], i == k ? 1.0 : 0.0, 1e-15);
  }
}

}  // namespace
}  // namespace bezel::detail
