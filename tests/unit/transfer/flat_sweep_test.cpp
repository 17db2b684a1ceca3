// Meshes of thin elements in any direction: as many digits as round ones have.

#include "bezel/transfer/flat_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bezel/transfer/operator.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/conservation.hpp"
#include "support/mesh_pairs.hpp"
#include "support/slow_projection.hpp"
#include "support/swept.hpp"

namespace bezel {
namespace {

using test::constant_and_noise;
using test::mass_defect;
using test::MeshPtr;
using test::off_constant;

MeshPtr affine(const MeshPtr& mesh, const Vec2& first, const Vec2& second, const Vec2& to) {
  return test::with_control(
      mesh, [&](const Vec2& p, std::size_t) { return first * p[0] + second * p[1] + to; });
}

/// Flattened along y, then turned and moved.
MeshPtr strip(const MeshPtr& mesh, double flat, double angle, const Vec2& to) {
  const double c = std::cos(angle), s = std::sin(angle);
  return affine(mesh, {{c, s}}, Vec2{{-s, c}} * flat, to);
}

/// Calls check(donor field, result, what it is) for fields of several degrees in both bases.
template <class Check>
void transfer_each(const MeshPtr& donor, const MeshPtr& target, Uncovered policy,
                   const std::string& where, const Check& check) {
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    for (const auto& [from, to] :
         test::swept({std::pair(0, 1), std::pair(2, 2), std::pair(3, 1)})) {
      const Field field = constant_and_noise(Space::discontinuous(donor, from, basis));
      TransferOptions options;
      options.degree = to;
      options.uncovered = policy;
      options.threads = 1;
      const TransferResult result = transfer({&field, 1}, target, options);
      check(field, result,
            where + " p" + std::to_string(from) + "->" + std::to_string(to) +
                (basis == Basis::reference ? "" : " physical"));
    }
  }
}

void expect_exact(const MeshPtr& donor, const MeshPtr& target, Uncovered policy,
                  const std::string& where) {
  transfer_each(donor, target, policy, where,
                [](const Field& field, const TransferResult& result, const std::string& at) {
                  // Largest seen: 9e-16, 3e-15, 1e-15.
                  EXPECT_LE(mass_defect(field, result), 1e-14) << at;
                  EXPECT_LE(off_constant(result.fields[0]), 1e-14) << at;
                  EXPECT_LE(result.report.max_partition_residual, 1e-14) << at;
                });
}

class FlatMeshes : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Geometry, FlatMeshes, ::testing::Values(1, 2, 3));

TEST_P(FlatMeshes, BothFlatInOneDirection) {
  const auto donor = test::grid_mesh(3, GetParam(), 1.0, test::bend(0.1, 0.1));
  const auto target = test::grid_mesh(2, GetParam(), 1.0, test::bend(-0.1, 0.1));
  for (const double flat : {1e-4, 1e-6}) {
    for (const double angle : {0.3, 2.0, -1.3}) {
      const Vec2 to{{1.0, -0.5}};
      expect_exact(strip(donor, flat, angle, to), strip(target, flat, angle, to), Uncovered::error,
                   "flat " + std::to_string(flat) + " angle " + std::to_string(angle));
    }
  }
}

TEST_P(FlatMeshes, FarFromTheOrigin) {
  const auto donor = test::grid_mesh(3, GetParam(), 1.0, test::bend(0.1, 0.1));
  const auto target = test::grid_mesh(2, GetParam(), 1.0, test::bend(-0.1, 0.1));
  const Vec2 to{{1e3, 7e2}};
  expect_exact(strip(donor, 1e-4, 0.3, to), strip(target, 1e-4, 0.3, to), Uncovered::error, "far");
}

TEST_P(FlatMeshes, ThinTargetInARoundDonor) {
  const Vec2 to{{1.0, -0.5}};
  const auto donor = affine(test::grid_mesh(3, GetParam(), 1.0, test::bend(0.1, 0.1)), {{2, -0.3}},
                            {{0.3, 2}}, to);
  const auto target = test::grid_mesh(2, GetParam(), 1.0, test::bend(-0.1, 0.1));
  for (const double angle : {0.3, 2.0})
    expect_exact(donor, strip(target, 1e-6, angle, to), Uncovered::error, "thin in round");
}

TEST_P(FlatMeshes, NearlyParallelStrips) {
  const Vec2 to{{1.0, -0.5}};
  const auto donor = test::grid_mesh(3, GetParam(), 1.0, test::bend(0.1, 0.1));
  const auto target = test::grid_mesh(2, GetParam(), 1.0, test::bend(-0.1, 0.1));
  expect_exact(strip(donor, 1e-6, 0.3, to), strip(target, 1e-6, 0.3 + 3e-7, to), Uncovered::extend,
               "nearly parallel");
}

TEST_P(FlatMeshes, OntoItself) {
  const auto mesh =
      strip(test::grid_mesh(3, GetParam(), 1.0, test::bend(0.1, 0.1)), 1e-6, 0.3, {{1.0, -0.5}});
  for (const Basis basis : {Basis::reference, Basis::physical}) {
    const std::vector<Field> fields = {constant_and_noise(Space::discontinuous(mesh, 2, basis))};
    const TransferResult result = transfer(fields, mesh);
    for (std::size_t i = 0; i < fields[0].coefficients().size(); ++i)
      EXPECT_NEAR(result.fields[0].coefficients()[i], fields[0].coefficients()[i], 1e-13);
  }
}

// A layer along a bent wall: each element has a plane of its own.
TEST(FlatSweep, LayerOfStraightElementsAlongAnArc) {
  const auto layer = [](double grading) {
    return test::grid_mesh(5, 1, 1.0, [&](const Vec2& p) {
      const double s = 0.5 * (p[1] + 1.0), r = 1.0 + 1e-6 * (s + grading * s * (1.0 - s));
      return Vec2{{5.0 - r * std::cos(0.9 * p[0]), r * std::sin(0.9 * p[0])}};
    });
  };
  expect_exact(layer(0.3), layer(-0.3), Uncovered::error, "layer");
}

// In the plane where the strip is round a linear function across it has all its digits.
TEST(FlatSweep, LinearFunctionsComeBack) {
  const Vec2 to{{1.0, -0.5}};
  const auto donor = strip(test::grid_mesh(3, 1, 1.0, test::bend(0.1, 0.1)), 1e-6, 0.3, to);
  const auto target = strip(test::grid_mesh(2, 1, 1.0, test::bend(-0.1, 0.1)), 1e-6, 0.3, to);
  const AreaMap map = round_map(donor->gather(ElementId(0)));
  ASSERT_FALSE(map.identity);
  const auto linear = [&](const MeshPtr& mesh) {
    std::vector<double> c;
    for (const NodeId n : mesh->connectivity()) {
      const Vec2 p = map(mesh->control(n)) * 1e3;
      c.push_back(1.0 + 2.0 * p.x() - 3.0 * p.y());
    }
    return Field("linear", Space::discontinuous(mesh, 1), c);
  };
  const std::vector<Field> fields = {linear(donor)};
  const TransferResult result = transfer(fields, target);
  const Field exact = linear(target);
  double size = 0.0;
  for (const double c : exact.coefficients()) size = std::max(size, std::abs(c));
  for (std::size_t i = 0; i < exact.coefficients().size(); ++i)
    EXPECT_NEAR(result.fields[0].coefficients()[i], exact.coefficients()[i], 1e-13 * size);
}

TEST(FlatSweep, OperatorsAndContinuousTargets) {
  const Vec2 to{{1.0, -0.5}};
  for (const int g : {1, 3}) {
    const auto donor = strip(test::grid_mesh(3, g, 1.0, test::bend(0.1, 0.1)), 1e-6, 0.3, to);
    const auto target = strip(test::grid_mesh(2, g, 1.0, test::bend(-0.1, 0.1)), 1e-6, 0.3, to);
    const std::vector<Field> fields = {constant_and_noise(Space::discontinuous(donor, 2))};
    const TransferOperator move(fields[0].space_ptr(), target);
    EXPECT_LE(move.report().max_partition_residual, 1e-14);
    const TransferResult moved = move.transfer(fields);
    EXPECT_LE(mass_defect(fields[0], moved), 1e-14);
    EXPECT_LE(off_constant(moved.fields[0]), 1e-14);
    TransferOptions options;
    options.continuity = Continuity::continuous;
    const TransferResult continuous = transfer(fields, target, options);
    EXPECT_LE(mass_defect(fields[0], continuous), 1e-14);
    EXPECT_LE(off_constant(continuous.fields[0]), 1e-13);
  }
}

// The weight's polynomials live on frames that are known to 1e-16 over the width.
TEST(FlatSweep, WeightsArePolynomialsUpToTheRoundingOfFrames) {
  const Vec2 to{{1.0, -0.5}};
  const auto donor = strip(test::grid_mesh(3, 2, 1.0, test::bend(0.1, 0.1)), 1e-6, 0.3, to);
  const auto target = strip(test::grid_mesh(2, 2, 1.0, test::bend(-0.1, 0.1)), 1e-6, 0.3, to);
  const std::vector<Field> fields = {constant_and_noise(Space::discontinuous(donor, 1))};
  TransferOptions options;
  options.weight = Formula("x^2+1");
  const TransferResult result = transfer(fields, target, options);
  for (const FieldReport& line : result.report.fields) EXPECT_LE(line.relative_mass_defect, 1e-14);
  EXPECT_LE(off_constant(result.fields[0]), 1e-10);
}

TEST(FlatSweep, ThreadsGiveTheSameBits) {
  const Vec2 to{{1.0, -0.5}};
  const auto donor = strip(test::grid_mesh(20, 1, 1.0, test::bend(0.1, 0.1)), 1e-5, 0.3, to);
  const auto target = strip(test::grid_mesh(17, 1, 1.0, test::bend(-0.1, 0.1)), 1e-5, 0.3, to);
  const std::vector<Field> fields = {constant_and_noise(Space::discontinuous(donor, 1))};
  TransferOptions options;
  options.threads = 1;
  const TransferResult one = transfer(fields, target, options);
  options.threads = 3;
  const TransferResult three = transfer(fields, target, options);
  EXPECT_TRUE(std::ranges::equal(one.fields[0].coefficients(), three.fields[0].coefficients()));
  EXPECT_LE(mass_defect(fields[0], one), 1e-14);
  EXPECT_EQ(one.report.pairs, three.report.pairs);
}

// Donors that are nothing but a strip: what lies around them in the target counts as 0.
void expect_conserved(const MeshPtr& donor, const MeshPtr& target, const std::string& where) {
  transfer_each(donor, target, Uncovered::zero, where,
                [](const Field& field, const TransferResult& result, const std::string& at) {
                  // Largest seen: 8e-16 (1e-10 from points rounded in the plane of the files),
                  // 1e-15.
                  EXPECT_LE(mass_defect(field, result), 1e-14) << at;
                  EXPECT_LE(result.report.max_partition_residual, 1e-14) << at;
                  EXPECT_EQ(result.report.outside_area, 0.0) << at;
                });
}

MeshPtr round_mesh(int cells, int degree) {
  return affine(test::grid_mesh(cells, degree, 1.0, test::bend(-0.1, 0.1)), {{2, -0.3}}, {{0.3, 2}},
                {{1.0, -0.5}});
}

MeshPtr short_strip(int degree, double flat, double angle) {
  const auto mesh = affine(test::grid_mesh(3, degree, 1.0, test::bend(0.1, 0.1)), {{0.4, 0.0}},
                           {{0.0, 1.0}}, {{0.0, 0.0}});
  return strip(mesh, flat, angle, {{1.0, -0.5}});
}

TEST_P(FlatMeshes, ThinDonorInRoundTargets) {
  for (const double flat : {1e-4, 1e-6})
    for (const double angle : {0.3, 2.0})
      expect_conserved(short_strip(GetParam(), flat, angle), round_mesh(2, GetParam()),
                       "flat " + std::to_string(flat) + " angle " + std::to_string(angle));
}

TEST_P(FlatMeshes, ThinDonorInsideOneTarget) {
  const auto donor =
      affine(short_strip(GetParam(), 1e-6, 0.3), {{0.5, 0.0}}, {{0.0, 0.5}}, {{1.0, -0.65}});
  expect_conserved(donor, round_mesh(1, GetParam()), "inside");
}

TEST_P(FlatMeshes, StripsAcrossStrips) {
  const auto donor = test::grid_mesh(3, GetParam(), 1.0, test::bend(0.1, 0.1));
  const auto target = test::grid_mesh(2, GetParam(), 1.0, test::bend(-0.1, 0.1));
  const Vec2 to{{1.0, -0.5}};
  for (const double flat : test::swept({1e-4, 1e-6}))
    expect_exact(strip(donor, flat, 0.3, to), strip(target, 1e-6, 1.4, to), Uncovered::extend,
                 "across");
}

/// Between ordinary rows and columns one of width 1e-6, turned; the edges in the middle of both
/// meshes lie on each other up to rounding.
MeshPtr thin_rows(int degree, int axis) {
  const auto squeeze = [](double x) {
    const double off = std::abs(x);
    return off <= 0.5 ? 2e-6 * x : std::copysign(1e-6 + (2.0 * off - 1.0) * (1.0 - 1e-6), x);
  };
  const auto mesh = test::grid_mesh(4, degree, 1.0, [&](const Vec2& p) {
    return axis == 0 ? Vec2{{squeeze(p[0]), p[1]}} : Vec2{{p[0], squeeze(p[1])}};
  });
  return affine(mesh, {{0.9, 0.3}}, {{-0.3, 0.9}}, {{1.0, -0.5}});
}

TEST_P(FlatMeshes, ThinRowsAcrossThinRows) {
  const auto rows = thin_rows(GetParam(), 0), columns = thin_rows(GetParam(), 1);
  expect_exact(rows, columns, Uncovered::extend, "rows to columns");
  expect_exact(columns, rows, Uncovered::extend, "columns to rows");
}

double largest_of(const Field& f) {
  double largest = 0.0;
  for (const double c : f.coefficients()) largest = std::max(largest, std::abs(c));
  return largest;
}

TransferResult from_thin(const MeshPtr& donor, const MeshPtr& target, Basis basis) {
  const std::vector<Field> fields = {constant_and_noise(Space::discontinuous(donor, 2, basis))};
  TransferOptions options;
  options.degree = 2;
  options.uncovered = Uncovered::zero;
  return transfer(fields, target, options);
}

// Regions by clipping, sums and systems in long double.
TEST(FlatSweep, ThinDonorsGiveTheProjection) {
  const auto donor = short_strip(1, 1e-6, 0.3);
  for (const auto& target : {round_mesh(2, 1), strip(round_mesh(2, 1), 1e-5, 1.0, {{1.0, -0.5}})}) {
    for (const Basis basis : {Basis::reference, Basis::physical}) {
      const Field from = constant_and_noise(Space::discontinuous(donor, 2, basis));
      const TransferResult result = from_thin(donor, target, basis);
      const Field& to = result.fields[0];
      const double allowed = 1e-10 * largest_of(to);
      for (std::size_t t = 0; t < target->element_count(); ++t) {
        const ElementId e(t);
        const test::SlowSystem system(to.space(), e);
        std::vector<test::Real> sums(system.size * 2, 0);
        for (std::size_t d = 0; d < donor->element_count(); ++d) {
          const test::SlowRegion region =
              test::clipped(target->gather(e), donor->gather(ElementId(d)));
          test::SlowPair pair;
          ASSERT_TRUE(test::slow_pair({region}, to.space(), e, from, ElementId(d), 6, pair));
          for (std::size_t n = 0; n < sums.size(); ++n) sums[n] += pair.integrals[n];
        }
        for (std::size_t c = 0; c < 2; ++c) {
          std::vector<test::Real> own(system.size);
          for (std::size_t n = 0; n < system.size; ++n) own[n] = sums[n * 2 + c];
          system.solve(own);
          for (std::size_t n = 0; n < system.size; ++n)
            EXPECT_NEAR(to.coefficients(e)[n * 2 + c], static_cast<double>(own[n]), allowed);
        }
      }
    }
  }
}

// Straight elements of any degree are the same elements, up to the rounding of their control
// points.
TEST_P(FlatMeshes, StraightElementsOfAnyDegreeGiveTheSame) {
  const Vec2 to{{1.0, -0.5}};
  const auto donor = [&](int g) {
    return strip(test::grid_mesh(3, g, 1.0, test::same_place), 1e-6, 0.3, to);
  };
  const auto round = [&](int g) {
    return affine(test::grid_mesh(2, g, 1.0, test::same_place), {{2, -0.3}}, {{0.3, 2}}, to);
  };
  const auto across = [&](int g) {
    return strip(test::grid_mesh(2, g, 1.0, test::same_place), 1e-5, 1.4, to);
  };
  const int g = GetParam();
  for (const bool thin : {false, true}) {
    const auto exact = from_thin(donor(1), thin ? across(1) : round(1), Basis::reference);
    const auto mapped = from_thin(donor(g), thin ? across(g) : round(g), Basis::reference);
    const double allowed = 1e-8 * largest_of(exact.fields[0]);
    for (std::size_t i = 0; i < exact.fields[0].coefficients().size(); ++i)
      EXPECT_NEAR(mapped.fields[0].coefficients()[i], exact.fields[0].coefficients()[i], allowed);
  }
}

TEST_P(FlatMeshes, ThinDonorsGiveTheSameBitsAnywhere) {
  const auto donor = short_strip(GetParam(), 1e-5, 0.3);
  const auto target = round_mesh(9, GetParam());
  const std::vector<Field> fields = {constant_and_noise(Space::discontinuous(donor, 1))};
  TransferOptions options;
  options.uncovered = Uncovered::zero;
  options.threads = 1;
  const TransferResult one = transfer(fields, target, options);
  options.threads = 3;
  const TransferResult three = transfer(fields, target, options);
  EXPECT_TRUE(std::ranges::equal(one.fields[0].coefficients(), three.fields[0].coefficients()));
  const TransferOperator move(fields[0].space_ptr(), target, options);
  const TransferResult moved = move.transfer(fields);
  EXPECT_LE(mass_defect(fields[0], moved), 1e-14);
}

}  // namespace
}  // namespace bezel
