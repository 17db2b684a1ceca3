// Bounded transfers of rough fields between random meshes: the bounds hold everywhere, the mass
// stays.

#include <gtest/gtest.h>

#include <cmath>

#include "bezel/transfer/transfer.hpp"
#include "support/fields.hpp"
#include "support/meshes.hpp"

namespace bezel {
namespace {

using test::bend;
using test::grid_mesh;
using test::PlaneMap;
using test::sampled_range;

/// Moves every point by up to `size`, a smooth bend first.
PlaneMap jitter(RandomStream& random, double size, const PlaneMap& first) {
  return [&random, size, first](const Vec2& p) {
    const bool inside = std::abs(p[0]) < 1.0 && std::abs(p[1]) < 1.0;
    const double s = inside ? size : 0.0;  // the square stays covered
    return first(p) + Vec2{{random.uniform(-s, s), random.uniform(-s, s)}};
  };
}

/// Coefficients mostly within [0, 1], some at the ends, some polynomials constant.
Field rough(RandomStream& random, const std::shared_ptr<const TriangleMesh>& mesh, int degree,
            Basis basis) {
  auto space = Space::discontinuous(mesh, degree, basis);
  std::vector<double> c(space->coefficient_count());
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    const double level = static_cast<double>(random.below(3)) / 2.0;
    const bool constant = random.below(2) == 0;
    for (int i = 0; i < bernstein::triangle_size(degree); ++i) {
      c[space->offset(ElementId(e)) + static_cast<std::size_t>(i)] =
          constant ? level : random.uniform();
    }
  }
  return Field("rough", space, c);
}

class BoundsHold : public ::testing::TestWithParam<int> {};

TEST_P(BoundsHold, ForRoughFieldsOnRandomMeshes) {
  const int g = GetParam();
  RandomStream random("bounds", static_cast<std::uint64_t>(g));
  for (int round = 0; round < 4; ++round) {
    // Straight grids bear more jitter than curved ones, and tiny ones are their own difficulty.
    const double size = round % 3 == 0 ? 1e-13 : g == 1 ? 0.06 : 0.015;
    const auto donor = grid_mesh(4, g, 1.0, jitter(random, size, bend(0.05, 0.04)));
    const auto target = grid_mesh(3 + round % 3, g, 1.0, jitter(random, size, bend(-0.03, 0.05)));
    const Basis basis = random.below(2) == 0 ? Basis::reference : Basis::physical;
    const Field f = rough(random, donor, static_cast<int>(random.below(4)), basis);
    for (const Continuity continuity : {Continuity::discontinuous, Continuity::continuous}) {
      for (const Bounds& bounds :
           {Bounds::between(0.0, 1.0), Bounds::between(0.2, 0.7), Bounds::local()}) {
        TransferOptions options;
        options.degree = 1 + static_cast<int>(random.below(4));
        options.continuity = continuity;
        options.bounds = bounds;
        const TransferResult result = transfer(std::span(&f, 1), target, options);
        const FieldReport& report = result.report.fields[0];
        EXPECT_LE(report.relative_mass_defect, 1e-14) << round;
        // Ranges of a donor in physical basis are certified with the rounding of its composition.
        const double rounding = bounds.kind == Bounds::Kind::local ? 1e-13 : 1e-14;
        const double lo = bounds.kind == Bounds::Kind::local ? report.min_before : bounds.lo;
        const double hi = bounds.kind == Bounds::Kind::local ? report.max_before : bounds.hi;
        EXPECT_GE(report.min_after - lo, -rounding) << round;
        EXPECT_LE(report.max_after - hi, rounding) << round;
        const auto [least, most] = sampled_range(result.fields[0], 8);
        EXPECT_GE(least - lo, -rounding) << round;
        EXPECT_LE(most - hi, rounding) << round;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(GeometricDegrees, BoundsHold, ::testing::Values(1, 2, 3));

// The values of each target element against those of the donor elements that overlap it.
TEST(LocalBounds, HoldElementByElement) {
  RandomStream random("local bounds", 1);
  for (const int g : {1, 2}) {
    const auto donor = grid_mesh(5, g, 1.0, bend(0.15, 0.12));
    const auto target = grid_mesh(4, g, 1.0, bend(-0.1, 0.1));
    const Field f = rough(random, donor, 2, Basis::reference);
    TransferOptions options;
    options.degree = 3;
    options.bounds = Bounds::local();
    const TransferResult result = transfer(std::span(&f, 1), target, options);
    const auto sample = [](const Field& field, ElementId e, double& lo, double& hi) {
      double v = 0.0;
      constexpr int n = 24;
      for (int k = 0; k <= n; ++k) {
        for (int j = 0; j <= n - k; ++j) {
          field.evaluate(e, {(n - j - k) / 24.0, j / 24.0, k / 24.0}, {&v, 1});
          lo = std::min(lo, v);
          hi = std::max(hi, v);
        }
      }
    };
    std::vector<std::array<double, 2>> allowed(target->element_count(), {1e9, -1e9});
    for (const OverlapArea& pair : overlap_areas(donor, target)) {
      if (pair.area < 1e-12) continue;
      auto& [lo, hi] = allowed[pair.target.index()];
      sample(f, pair.donor, lo, hi);
    }
    for (std::size_t t = 0; t < allowed.size(); ++t) {
      double lo = 1e9;
      double hi = -1e9;
      sample(result.fields[0], ElementId(t), lo, hi);
      // Samples 1/24 apart miss the donor's extremes by less than this (second derivatives < 8).
      EXPECT_GE(lo, allowed[t][0] - 4e-3) << t;
      EXPECT_LE(hi, allowed[t][1] + 4e-3) << t;
    }
  }
}

}  // namespace
}  // namespace bezel
