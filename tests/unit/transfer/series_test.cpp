#include "bezel/transfer/series.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::bend;
using test::grid_mesh;

/// A step as a reader would make it: with a mesh object of its own.
std::vector<Field> fields_at(double time, double bending) {
  const auto mesh = grid_mesh(4, 2, 1.0, bend(bending, 0.1));
  const auto number = std::to_string(time);
  const Formula u("x*y + " + number);
  const std::vector<Formula> v = {Formula("x"), Formula("sin(y + " + number + ")")};
  return {project("u", Space::discontinuous(mesh, 1), {&u, 1}),
          project("v", Space::discontinuous(mesh, 2, Basis::physical), v)};
}

double largest_difference(const Field& a, const Field& b) {
  double m = 0.0;
  for (std::size_t i = 0; i < a.coefficients().size(); ++i)
    m = std::max(m, std::abs(a.coefficients()[i] - b.coefficients()[i]));
  return m;
}

TEST(TransferSeries, GeometryIsDoneOncePerMeshAndSpace) {
  const auto target = grid_mesh(5, 2, 1.0, bend(-0.1, 0.12));
  TransferSeries series(target);
  const std::vector<double> bending = {0.1, 0.1, 0.1, 0.15, 0.2, 0.2};
  const std::vector<std::size_t> geometries = {2, 2, 2, 3, 5, 5};
  for (std::size_t i = 0; i < bending.size(); ++i) {
    const std::vector<Field> fields = fields_at(0.1 * static_cast<double>(i), bending[i]);
    const bool again = i + 1 < bending.size() && bending[i + 1] == bending[i];
    const TransferResult result = series.step(fields, again);
    const TransferResult expected = transfer(fields, target);
    EXPECT_EQ(series.geometries(), geometries[i]) << "step " << i;
    ASSERT_EQ(result.fields.size(), 2U);
    ASSERT_EQ(result.report.fields.size(), 3U);
    for (std::size_t k = 0; k < 2; ++k) {
      EXPECT_EQ(result.fields[k].name(), fields[k].name());
      EXPECT_LE(largest_difference(result.fields[k], expected.fields[k]), 2e-14);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(result.report.fields[k].component, expected.report.fields[k].component);
      EXPECT_LE(result.report.fields[k].relative_mass_defect, 1e-14);
      EXPECT_NEAR(result.report.fields[k].mass_before, expected.report.fields[k].mass_before,
                  1e-15);
    }
  }
}

TEST(TransferSeries, StaysWithinItsMemory) {
  const auto target = grid_mesh(5, 2, 1.0, bend(-0.1, 0.12));
  TransferSeries series(target, {}, 1000);
  for (int i = 0; i < 3; ++i) (void)series.step(fields_at(0.0, 0.1), i < 2);
  EXPECT_EQ(series.geometries(), 3U);
}

TEST(TransferSeries, WeightsAreTransferredAnew) {
  const auto target = grid_mesh(3, 1, 1.0, test::same_place);
  TransferOptions options;
  options.weight = Formula("2+x");
  TransferSeries series(target, options);
  const auto mesh = grid_mesh(2, 1, 1.0, test::same_place);
  const Formula u("y");
  const Field f = project("u", Space::discontinuous(mesh, 1), {&u, 1});
  for (int i = 0; i < 2; ++i) {
    const TransferResult result = series.step({&f, 1}, true);
    EXPECT_LE(error_norms(result.fields[0], {&u, 1}).max, 1e-13);
  }
  EXPECT_EQ(series.geometries(), 2U);
}

TEST(TransferSeriesErrors, AreThoseOfTransfer) {
  TransferSeries series(grid_mesh(2, 1, 1.0, test::same_place));
  EXPECT_THROW((void)series.step({}, true), InputError);
  std::vector<Field> mixed = fields_at(0.0, 0.1);
  mixed.push_back(fields_at(0.0, 0.1)[0]);
  EXPECT_THROW((void)series.step(mixed, true), InputError);
  EXPECT_THROW((void)TransferSeries(nullptr).step(fields_at(0.0, 0.1), true), InputError);
}

}  // namespace
}  // namespace bezel
