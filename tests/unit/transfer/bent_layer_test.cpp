// Layers of thin curved elements along a wall, bent by many times their width: no plane makes them
// round.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "bezel/transfer/operator.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/conservation.hpp"
#include "support/mesh_pairs.hpp"
#include "support/swept.hpp"

namespace bezel {
namespace {

using test::constant_and_noise;
using test::mass_defect;
using test::MeshPtr;
using test::off_constant;

/// A layer of width w along a wall bent by `bend`, turned; of parabolas, or cubics.
MeshPtr layer(int cells, int degree, double w, double bend, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return test::grid_mesh(cells, degree, 1.0, [=](const Vec2& p) {
    const double x = p[0], cubic = degree == 3 ? 1.0 + 0.5 * x : 1.0;
    const double y = 0.5 * w * p[1] + bend * (1.0 - x * x) * cubic;
    return Vec2{{c * x - s * y, s * x + c * y}};
  });
}

/// Between two walls that follow circles of radius 1 and 1 + w: one polynomial on each half,
/// through the points of the arc. Meshes of any even number of cells have the same walls.
MeshPtr arc(int cells, int degree, double w) {
  return test::grid_mesh(cells, degree, 1.0, [=](const Vec2& p) {
    const double start = p[0] < 0.0 ? -1.0 : 0.0, s = (p[0] - start) * degree;
    Vec2 wall;
    for (int i = 0; i <= degree; ++i) {
      double value = 1.0;
      for (int k = 0; k <= degree; ++k)
        if (k != i) value *= (s - k) / (i - k);
      const double angle = 0.7 * (start + static_cast<double>(i) / degree);
      wall += value * Vec2{{std::sin(angle), std::cos(angle)}};
    }
    return (1.0 + 0.5 * w * (p[1] + 1.0)) * wall;
  });
}

TransferResult moved(const Field& field, const MeshPtr& target, int degree, Uncovered policy) {
  TransferOptions options;
  options.degree = degree;
  options.uncovered = policy;
  options.threads = 1;
  return transfer({&field, 1}, target, options);
}

class BentLayers : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Geometry, BentLayers, ::testing::Values(2, 3));

// Largest seen: 9e-15, 2e-14 and 3e-14 where elements are bent by less than 256 of their widths (at
// 1e-3 and 1e-4), 3e-16, 5e-16 and 4e-16 else. Affine planes gave 6e-12, 2e-10 and 2e-10 at 1e-6.
TEST_P(BentLayers, OntoAnotherLayer) {
  for (const double angle : {0.0, 0.3}) {
    for (const double w : test::swept({1e-3, 1e-4, 1e-5, 1e-6})) {
      for (const auto& [from, to, bend] : {std::tuple(1, 1, 0.5), std::tuple(3, 2, 0.1)}) {
        const MeshPtr donor = layer(5, GetParam(), w, bend, angle),
                      target = layer(7, GetParam(), w, bend, angle);
        const Field field = constant_and_noise(Space::discontinuous(donor, from));
        const TransferResult result = moved(field, target, to, Uncovered::extend);
        const std::string where = "angle " + std::to_string(angle) + " w " + std::to_string(w) +
                                  " bend " + std::to_string(bend);
        EXPECT_LE(mass_defect(field, result), 1e-14) << where;
        EXPECT_LE(off_constant(result.fields[0]), 1e-13) << where;
        EXPECT_LE(result.report.max_partition_residual, 1e-13) << where;
      }
    }
  }
}

// A physical basis has frames that are no rounder than the elements: masses are not sharp in it.
TEST_P(BentLayers, ConstantsInAPhysicalBasis) {
  for (const double w : {1e-5, 1e-6}) {
    const MeshPtr donor = layer(5, GetParam(), w, 0.1, 0.3),
                  target = layer(7, GetParam(), w, 0.1, 0.3);
    const Field field = constant_and_noise(Space::discontinuous(donor, 1, Basis::physical));
    const TransferResult result = moved(field, target, 1, Uncovered::extend);
    EXPECT_LE(off_constant(result.fields[0]), 1e-13) << w;
    EXPECT_LE(result.report.max_partition_residual, 1e-13) << w;
    for (const FieldReport& line : result.report.fields)
      EXPECT_LE(line.relative_mass_defect, 1e-11) << w;
  }
}

// The layer is the whole donor, across triangles of ordinary shape.
TEST_P(BentLayers, OntoRoundTargets) {
  const MeshPtr target = test::grid_mesh(4, GetParam(), 1.3, test::bend(0.05, 0.05));
  for (const double w : {1e-4, 1e-6}) {
    const Field field =
        constant_and_noise(Space::discontinuous(layer(5, GetParam(), w, 0.4, 0.3), 2));
    const TransferResult result = moved(field, target, 2, Uncovered::zero);
    EXPECT_LE(mass_defect(field, result), 1e-14) << w;
    EXPECT_LE(result.report.max_partition_residual, 1e-13) << w;
  }
}

// Round donors, straight and curved, give a layer what lies in it.
TEST_P(BentLayers, FromRoundDonors) {
  for (const int donor_degree : {1, GetParam()}) {
    const MeshPtr donor = test::grid_mesh(4, donor_degree, 1.3, test::bend(0.05, 0.05));
    for (const double w : {1e-4, 1e-6}) {
      const Field field = constant_and_noise(Space::discontinuous(donor, 2));
      const TransferResult result =
          moved(field, layer(5, GetParam(), w, 0.4, 0.3), 2, Uncovered::error);
      EXPECT_LE(off_constant(result.fields[0]), 1e-13) << w << " " << donor_degree;
      EXPECT_LE(result.report.max_partition_residual, 1e-13) << w << " " << donor_degree;
      // The layer's own mass is small beside the donor's.
      const FieldReport& line = result.report.fields[1];
      EXPECT_LE(line.relative_mass_defect, 1e-14) << w << " " << donor_degree;
    }
  }
}

// Along rows that both meshes have, edges 1e-16 apart count as one curve or as two, and elements on
// either side may see that differently in their planes: then the strip between goes to neither.
// Largest seen: 4e-14 of the mass.
TEST_P(BentLayers, AlongAnArc) {
  for (const double w : test::swept({1e-3, 1e-5, 1e-6})) {
    for (const auto& [from, to] : {std::pair(4, 4), std::pair(6, 4), std::pair(4, 6)}) {
      const Field field = constant_and_noise(Space::discontinuous(arc(from, GetParam(), w), 1));
      const TransferResult result = moved(field, arc(to, GetParam(), w), 1, Uncovered::extend);
      const std::string where =
          std::to_string(w) + " " + std::to_string(from) + " to " + std::to_string(to);
      EXPECT_LE(mass_defect(field, result), w < 1e-5 ? 1.2e-13 : 1e-14) << where;
      EXPECT_LE(off_constant(result.fields[0]), 1e-13) << where;
      EXPECT_LE(result.report.max_partition_residual, 1e-13) << where;
    }
  }
}

/// Half of the rows in a layer of width w along a bent wall, half beside it.
MeshPtr layer_and_more(int cells, int degree, double w) {
  return test::grid_mesh(cells, degree, 1.0, [=](const Vec2& p) {
    const double away = p[1] < 0.0 ? w * (p[1] + 1.0) : w + p[1];
    const double bent = 0.3 * (1.0 - p[0] * p[0]) * (1.0 - 0.8 * away);
    return Vec2{{p[0] + 0.3 * away, away + bent}};
  });
}

// Largest seen: 4e-16, 9e-16, 8e-16; affine planes gave constants to 2e-11.
TEST_P(BentLayers, BesideOrdinaryElements) {
  for (const double w : {1e-5, 1e-6}) {
    for (const double wider : {1.0, 2.7}) {
      const Field field =
          constant_and_noise(Space::discontinuous(layer_and_more(6, GetParam(), w), 2));
      const TransferResult result =
          moved(field, layer_and_more(8, GetParam(), wider * w), 2, Uncovered::extend);
      EXPECT_LE(mass_defect(field, result), 1e-14) << w << " " << wider;
      EXPECT_LE(off_constant(result.fields[0]), 1e-14) << w << " " << wider;
      EXPECT_LE(result.report.max_partition_residual, 1e-14) << w << " " << wider;
    }
  }
}

TEST_P(BentLayers, PolynomialsComeBackFromTheSameMesh) {
  const MeshPtr mesh = layer(4, GetParam(), 1e-6, 0.3, 0.3);
  const Field field = constant_and_noise(Space::discontinuous(mesh, 2));
  const TransferResult result = moved(field, mesh, 2, Uncovered::error);
  for (std::size_t i = 0; i < field.coefficients().size(); ++i)
    EXPECT_NEAR(result.fields[0].coefficients()[i], field.coefficients()[i], 1e-13);
}

TEST_P(BentLayers, OperatorsAndContinuousTargets) {
  const MeshPtr donor = layer(5, GetParam(), 1e-6, 0.3, 0.3),
                target = layer(7, GetParam(), 1e-6, 0.3, 0.3);
  const std::vector<Field> fields = {constant_and_noise(Space::discontinuous(donor, 2))};
  TransferOptions options;
  options.uncovered = Uncovered::extend;
  const TransferOperator move(fields[0].space_ptr(), target, options);
  EXPECT_LE(move.report().max_partition_residual, 1e-13);
  const TransferResult by_operator = move.transfer(fields);
  EXPECT_LE(mass_defect(fields[0], by_operator), 1e-14);
  EXPECT_LE(off_constant(by_operator.fields[0]), 1e-13);
  options.continuity = Continuity::continuous;
  const TransferResult continuous = transfer(fields, target, options);
  EXPECT_LE(mass_defect(fields[0], continuous), 1e-14);
  EXPECT_LE(off_constant(continuous.fields[0]), 1e-13);
}

}  // namespace
}  // namespace bezel
