// Two meshes that do not cover each other: what is measured, and what Conserve::total does.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/mesh/generate.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::bend;
using test::grid_mesh;
using test::same_place;

std::shared_ptr<const TriangleMesh> disc(int g, double size, std::uint64_t seed) {
  GenerateOptions options;
  options.degree = g;
  options.size = size;
  options.seed = seed;
  return std::make_shared<const TriangleMesh>(generate_disc(1.0, options));
}

Field with(const std::shared_ptr<const TriangleMesh>& mesh, int degree, const char* text,
           Basis basis = Basis::reference) {
  const Formula formula(text);
  return project("u", Space::discontinuous(mesh, degree, basis), {&formula, 1});
}

TransferOptions total(Uncovered uncovered) {
  TransferOptions options;
  options.uncovered = uncovered;
  options.conserve = Conserve::total;
  return options;
}

// Area of a disc of degree g is off by O(h^(2g)), its boundary by O(h^(g+1)): so are the slivers.
TEST(Coverage, SliversOfTwoDiscsShrinkWithTheBoundarysOrder) {
  for (int g = 1; g <= 4; ++g) {
    std::array<double, 2> uncovered{};
    std::array<double, 2> outside{};
    for (const std::size_t level : {0U, 1U}) {
      const double size = level == 0 ? 0.5 : 0.25;
      const auto donor = disc(g, size, 1);
      const auto target = disc(g, 0.8 * size, 2);
      const Field f = with(donor, g, "2+x");
      TransferOptions options;
      options.uncovered = Uncovered::extend;
      const TransferResult result = transfer({&f, 1}, target, options);
      uncovered[level] = result.report.uncovered_area;
      outside[level] = result.report.outside_area;
      const FieldReport& line = result.report.fields[0];
      EXPECT_LE(line.relative_mass_defect, 1e-14);
      EXPECT_GT(line.mass_outside, 0.0);
      EXPECT_LE(line.mass_outside, 3.0 * result.report.outside_area);
      EXPECT_LE(line.mass_made, 3.0 * result.report.uncovered_area);
    }
    EXPECT_GT(uncovered[1], 0.0);
    EXPECT_GT(std::log2((uncovered[0] + outside[0]) / (uncovered[1] + outside[1])), g + 1 - 0.5)
        << "degree " << g;
  }
}

TEST(ConserveTotal, KeepsTheMassOfTwoDiscs) {
  for (const int g : {1, 2, 3}) {
    for (const Basis basis : {Basis::reference, Basis::physical}) {
      for (const Uncovered uncovered : {Uncovered::extend, Uncovered::zero}) {
        const auto donor = disc(g, 0.4, 1);
        const auto target = disc(g, 0.3, 2);
        const Field f = with(donor, g, "exp(x)*cos(y)", basis);
        const TransferResult result = transfer({&f, 1}, target, total(uncovered));
        const FieldReport& line = result.report.fields[0];
        EXPECT_NEAR(line.mass_after, line.mass_before, 1e-14 * line.mass_before);
        EXPECT_LE(line.relative_mass_defect, 1e-14);
        EXPECT_NEAR(line.mass_spread, line.mass_outside - line.mass_made, 1e-15);
        EXPECT_GT(line.max_spread_change, 0.0);
      }
    }
  }
}

TEST(ConserveTotal, ChangesOnlyElementsThatTouchTheBoundary) {
  const auto donor = disc(2, 0.4, 1);
  const auto target = disc(2, 0.3, 2);
  const Field f = with(donor, 2, "3");
  TransferOptions options;
  options.uncovered = Uncovered::extend;
  const TransferResult plain = transfer({&f, 1}, target, options);
  const TransferResult kept = transfer({&f, 1}, target, total(Uncovered::extend));
  std::int64_t changed = 0;
  double largest = 0.0;
  std::vector<char> at_boundary(target->node_count(), 0);
  for (std::size_t e = 0; e < target->edge_count(); ++e) {
    const EdgeId edge(static_cast<std::int32_t>(e));
    if (!target->is_boundary(edge)) continue;
    for (const NodeId n : target->edge_nodes(edge)) at_boundary[n.index()] = 1;
  }
  for (std::size_t e = 0; e < target->element_count(); ++e) {
    const auto a = plain.fields[0].coefficients(ElementId(e));
    const auto b = kept.fields[0].coefficients(ElementId(e));
    bool boundary = false;
    for (const NodeId n : target->nodes(ElementId(e)))
      boundary = boundary || at_boundary[n.index()] != 0;
    const double step = b[0] - a[0];
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(b[i] - a[i], step, 1e-14);
    if (std::abs(step) <= 1e-14) continue;
    ++changed;
    largest = std::max(largest, std::abs(step));
    EXPECT_TRUE(boundary) << e << " " << step;
  }
  EXPECT_GT(changed, 0);
  EXPECT_LE(changed, kept.report.spread_elements);
  EXPECT_NEAR(largest, kept.report.fields[0].max_spread_change, 1e-14);
  EXPECT_LT(largest, 0.1);
  EXPECT_EQ(plain.report.spread_elements, 0);
  EXPECT_EQ(plain.report.fields[0].mass_spread, 0.0);
}

// What lies far outside goes to all elements at the boundary; vectors component by component.
TEST(ConserveTotal, TargetInsideTheDonorAndVectors) {
  const auto donor = grid_mesh(6, 1, 1.0, bend(0.1, 0.1));
  const auto target = grid_mesh(5, 2, 0.45, same_place);
  const std::array<Formula, 2> formulas = {Formula("1+x"), Formula("y-2")};
  const Field f = project("v", Space::discontinuous(donor, 1), formulas);
  const TransferResult result = transfer({&f, 1}, target, total(Uncovered::error));
  ASSERT_EQ(result.report.fields.size(), 2U);
  EXPECT_NEAR(result.report.fields[0].mass_after, 4.0, 1e-13);
  EXPECT_NEAR(result.report.fields[1].mass_after, -8.0, 1e-13);
  for (const FieldReport& line : result.report.fields) {
    EXPECT_NEAR(line.mass_after, line.mass_before, 2e-14 * std::abs(line.mass_before));
    EXPECT_EQ(line.mass_made, 0.0);
  }
  EXPECT_EQ(result.report.spread_elements, 18);  // of 50, those with a side on the boundary
}

TEST(ConserveTotal, TargetThatSticksOut) {
  const auto donor = grid_mesh(3, 2, 1.0, same_place);
  const auto target = grid_mesh(4, 1, 1.2, bend(0.05, 0.05));
  const Field f = with(donor, 2, "2+x*y");
  const TransferResult result = transfer({&f, 1}, target, total(Uncovered::extend));
  const FieldReport& line = result.report.fields[0];
  EXPECT_GT(line.mass_made, 1.0);
  EXPECT_NEAR(line.mass_after, line.mass_before, 1e-14 * line.mass_before);
}

TEST(ConserveTotal, RefusesContinuousTargets) {
  const auto mesh = grid_mesh(2, 1, 1.0, same_place);
  const Field f = with(mesh, 1, "1");
  TransferOptions options = total(Uncovered::error);
  options.continuity = Continuity::continuous;
  try {
    (void)transfer({&f, 1}, mesh, options);
    FAIL() << "expected an InputError";
  } catch (const InputError& e) {
    EXPECT_STREQ(e.what(),
                 "transfer: the total mass is kept by constants on single triangles, which "
                 "continuous fields do not have: expected a discontinuous target, or the covered "
                 "mass kept");
  }
}

TEST(ConserveTotal, IsNothingWhereTheMeshesCoverEachOther) {
  const auto donor = grid_mesh(3, 2, 1.0, bend(0.1, 0.1));
  const auto target = grid_mesh(4, 3, 1.0, bend(-0.1, 0.1));
  const Field f = with(donor, 2, "2+x*y");
  const TransferResult result = transfer({&f, 1}, target, total(Uncovered::error));
  EXPECT_NEAR(result.report.fields[0].mass_spread, 0.0, 1e-15);
  EXPECT_LE(result.report.fields[0].max_spread_change, 1e-14);
}

}  // namespace
}  // namespace bezel
