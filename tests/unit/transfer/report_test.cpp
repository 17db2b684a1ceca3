#include <gtest/gtest.h>

#include <cmath>

#include "bezel/field/element_range.hpp"
#include "bezel/field/integrals.hpp"
#include "bezel/transfer/operator.hpp"
#include "support/fields.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::bend;
using test::grid_mesh;
using test::turn;

/// Fields that share spaces, and some that do not: one and several components, a constant, one that
/// is 0 or 1 by element, one of another degree.
std::vector<Field> various_fields(const std::shared_ptr<const TriangleMesh>& mesh, Basis basis) {
  const auto space = Space::discontinuous(mesh, 2, basis);
  std::vector<Field> fields;
  RandomStream random("many fields", 1);
  for (int k = 0; k < 9; ++k) {
    const int components = k == 4 ? 3 : 1;
    std::vector<double> c(space->coefficient_count() * static_cast<std::size_t>(components));
    for (double& x : c) x = random.uniform() - 0.1 * k;
    fields.emplace_back("u" + std::to_string(k), space, std::move(c), components);
  }
  fields.emplace_back("constant", space, std::vector<double>(space->coefficient_count(), 0.7));
  const auto cells = Space::discontinuous(mesh, 0, basis);
  std::vector<double> c(cells->coefficient_count());
  for (double& x : c) x = random.uniform() < 0.5 ? 0.0 : 1.0;
  fields.emplace_back("cells", cells, std::move(c));
  return fields;
}

void expect_equal(const FieldReport& a, const FieldReport& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.component, b.component);
  EXPECT_EQ(a.mass_before, b.mass_before);
  EXPECT_EQ(a.mass_after, b.mass_after);
  EXPECT_EQ(a.relative_mass_defect, b.relative_mass_defect);
  EXPECT_EQ(a.min_before, b.min_before);
  EXPECT_EQ(a.max_before, b.max_before);
  EXPECT_EQ(a.min_after, b.min_after);
  EXPECT_EQ(a.max_after, b.max_after);
}

class ManyFields : public testing::TestWithParam<std::tuple<int, Basis>> {};

TEST_P(ManyFields, HaveTheBitsAndReportsThatTheyHaveAlone) {
  const auto [g, basis] = GetParam();
  const auto donor = grid_mesh(5, g, 1.0, bend(0.1, 0.08)),
             target = grid_mesh(4, g, 0.7, turn(0.4, 0.9));
  TransferOptions options;
  options.uncovered = Uncovered::extend;
  const std::vector<Field> fields = various_fields(donor, basis);
  const TransferResult all = transfer(fields, target, options);
  std::size_t line = 0;
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const TransferResult one = transfer({&fields[k], 1}, target, options);
    EXPECT_TRUE(test::same_coefficients(all.fields[k], one.fields[0])) << fields[k].name();
    for (const FieldReport& alone : one.report.fields)
      expect_equal(all.report.fields[line++], alone);
  }
  EXPECT_EQ(line, all.report.fields.size());
}

INSTANTIATE_TEST_SUITE_P(Meshes, ManyFields,
                         testing::Combine(testing::Values(1, 2, 3),
                                          testing::Values(Basis::physical, Basis::reference)));

// The solves' time is an estimate from a sample, which a pause in it makes too long.
TEST(Seconds, AreNotNegative) {
  const auto donor = grid_mesh(5, 1, 1.0, bend(0.1, 0.08)),
             target = grid_mesh(4, 1, 0.7, turn(0.4, 0.9));
  const Field one("one", Space::discontinuous(donor, 0), std::vector<double>(50, 1.0));
  for (int i = 0; i < 200; ++i) {
    const TransferReport::Seconds took = transfer({&one, 1}, target).report.seconds;
    ASSERT_GE(took.integrate, 0.0) << i;
    ASSERT_GE(took.solve, 0.0) << i;
  }
}

TEST(Ranges, HoldAllValuesAndAreAttainedUpToTheTolerance) {
  for (const Basis basis : {Basis::physical, Basis::reference}) {
    for (const int g : {1, 3}) {
      const auto mesh = grid_mesh(6, g, 1.0, bend(0.1, 0.08));
      for (const Field& f : various_fields(mesh, basis)) {
        const ValueRanges ranges(f.space_ptr());
        for (int c = 0; c < f.components(); ++c) {
          const bernstein::Range range = ranges(f, c);
          double lo = range.hi, hi = range.lo;
          std::vector<double> value(static_cast<std::size_t>(f.components()));
          for (std::size_t e = 0; e < mesh->element_count(); ++e) {
            for (int n = 0; n < bernstein::triangle_size(24); ++n) {
              const auto at = bernstein::triangle_multi_index(24, n);
              f.evaluate(ElementId(e), {at[0] / 24.0, at[1] / 24.0, at[2] / 24.0}, value);
              lo = std::min(lo, value[static_cast<std::size_t>(c)]);
              hi = std::max(hi, value[static_cast<std::size_t>(c)]);
            }
          }
          const double width = range.hi - range.lo;
          EXPECT_LE(range.lo, lo + 1e-14) << f.name();
          EXPECT_GE(range.hi, hi - 1e-14) << f.name();
          // 1e-3 of the coefficients' width, and what 24 steps along an element may miss.
          EXPECT_GE(range.lo, lo - 0.02 * width - 1e-14) << f.name();
          EXPECT_LE(range.hi, hi + 0.02 * width + 1e-14) << f.name();
        }
      }
    }
  }
}

// Frames that do not hold their elements: coefficients say nothing about the values there.
TEST(Ranges, HoldAllValuesWhereFramesAreTooSmall) {
  const auto mesh = grid_mesh(3, 2, 1.0, bend(0.1, 0.08));
  std::vector<Frame> frames;
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    frames.push_back(element_frame(mesh->gather(ElementId(e))));
    for (Vec2& g : frames.back().gradient) g = g * 3.0;
  }
  const auto space =
      Space::discontinuous(mesh, std::vector<int>(mesh->element_count(), 2), std::move(frames));
  RandomStream random("small frames", 1);
  std::vector<double> c(space->coefficient_count());
  for (double& x : c) x = random.uniform();
  const Field f("f", space, std::move(c));
  const bernstein::Range range = value_range(f, 0);
  double value = 0.0, hi = range.lo;
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    for (int n = 0; n < bernstein::triangle_size(24); ++n) {
      const auto at = bernstein::triangle_multi_index(24, n);
      f.evaluate(ElementId(e), {at[0] / 24.0, at[1] / 24.0, at[2] / 24.0}, {&value, 1});
      EXPECT_GE(value, range.lo);
      EXPECT_LE(value, range.hi);
      hi = std::max(hi, value);
    }
  }
  EXPECT_GT(hi, 1.5);  // beyond all coefficients
  EXPECT_LE(range.hi, hi + 0.02 * (range.hi - range.lo));
}

TEST(BasisIntegrals, OfTheReferenceBasisAddUpToTheElementsAreas) {
  const auto mesh = grid_mesh(3, 3, 1.0, bend(0.1, 0.08));
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    for (const int p : {0, 1, 4, Space::max_degree}) {
      const auto space = Space::discontinuous(mesh, p, basis);
      const std::vector<double> integrals = field_detail::basis_integrals(*space);
      const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
      for (std::size_t e = 0; e < mesh->element_count(); ++e) {
        double area_found = 0.0;
        for (std::size_t i = 0; i < n; ++i) area_found += integrals[e * n + i];
        const double expected = area(3, mesh->gather(ElementId(e)));
        EXPECT_NEAR(area_found, expected, 1e-14 * expected);
      }
    }
  }
}

}  // namespace
}  // namespace bezel
