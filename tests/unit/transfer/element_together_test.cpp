// Ordinary target elements that are worked on together, against the same elements one by one.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "bezel/base/random.hpp"
#include "bezel/mesh/generate.hpp"
#include "bezel/transfer/element_transfer.hpp"
#include "support/simd_targets.hpp"

namespace bezel::detail {
namespace {

struct Meshes {
  explicit Meshes(int degree)
      : donor(make(degree, 1, 0.35), "donor", 1), target(make(degree, 2, 0.4), "target", 1) {}
  static std::shared_ptr<const TriangleMesh> make(int degree, std::uint64_t seed, double size) {
    GenerateOptions options;
    options.degree = degree;
    options.curve_jitter = degree > 1 ? 0.05 : 0.0;
    options.seed = seed;
    options.size = size;
    const double width = seed == 1 ? 2.4 : 2.0;
    return std::make_shared<const TriangleMesh>(generate_rectangle(width, width, options));
  }
  OverlayMesh donor, target;
  FrontSearch search{donor};
};

struct Result {
  std::vector<std::vector<double>> out;
  std::vector<std::int32_t> donors, targets;
  std::vector<double> areas;
  std::vector<double> covered, defects;
  std::size_t ordinary = 0;
  friend bool operator==(const Result&, const Result&) = default;
};

/// @param at_once  elements looked at together; 0: each on its own, as any element
/// @param after_loose  an element whose joints may be open is worked on before
Result transfer_all(const Meshes& m, const std::vector<std::vector<Field>>& fields,
                    std::size_t at_once, bool after_loose = false) {
  std::vector<Group> groups;
  for (const std::vector<Field>& some : fields) {
    std::vector<const Field*> pointers;
    for (const Field& f : some) pointers.push_back(&f);
    groups.emplace_back(m.donor, m.target, pointers,
                        Space::discontinuous(m.target.mesh, some[0].space().highest_degree(),
                                             some[0].space().basis()),
                        1);
  }
  std::size_t components = 0;
  for (const Group& g : groups) components += static_cast<std::size_t>(g.components);
  std::vector<std::int32_t> elements = m.target.spatial_order();
  ElementOverlay overlay(m.donor, m.target, m.search);
  overlay.begin_chunk(elements);
  OverlayList list;
  OverlayCounts counts;
  for (const std::int32_t t : elements) overlay.add(t, list, counts);
  ElementTransfer element(m.donor, m.target, m.search, groups, Uncovered::error);
  const std::vector<std::uint8_t> rim(m.donor.element_count(), 0);
  element.keep_masses_of(rim);
  GivenList given;
  std::vector<double> made(components);
  if (after_loose) {
    GivenList dropped;
    std::vector<Segment> segments;
    collect_segments(list[0], segments);
    element.process(elements[0], {list[0].donors, list[0].pieces, segments}, dropped, made);
  }
  Result result;
  for (std::size_t i = 0; i < elements.size();) {
    const auto some = std::span(elements).first(std::min(i + at_once, elements.size()));
    const std::size_t count = at_once == 0 ? 0 : element.begin_together(some, list, i);
    for (std::size_t k = 0; k < std::max<std::size_t>(count, 1); ++k, ++i) {
      const bool ready = k < count && element.together(k);
      const ElementOutcome outcome = ready ? element.take(k, elements[i], list[i], given)
                                           : element.process(elements[i], list[i], given, made);
      result.ordinary += ready ? 1 : 0;
      EXPECT_FALSE(outcome.inconsistent);
      result.covered.push_back(outcome.covered_area);
      result.defects.push_back(outcome.max_mass_defect);
    }
  }
  for (Group& g : groups) result.out.emplace_back(g.out.begin(), g.out.end());
  result.donors = given.donor;
  result.targets = given.target;
  result.areas = given.area;
  return result;
}

/// Fields of random coefficients of the given degrees and numbers of components, a group each.
std::vector<std::vector<Field>> random_fields(const Meshes& m,
                                              const std::vector<std::array<int, 2>>& kinds) {
  RandomStream random("elements together", 1);
  std::vector<std::vector<Field>> fields;
  for (const auto& [degree, components] : kinds) {
    const auto space = Space::discontinuous(m.donor.mesh, degree, Basis::physical);
    fields.emplace_back();
    for (int c = 0; c < components; ++c) {
      std::vector<double> coefficients(space->coefficient_count());
      for (double& x : coefficients) x = random.uniform(-1.0, 1.0);
      fields.back().emplace_back("f" + std::to_string(c), space, std::move(coefficients), 1);
    }
  }
  return fields;
}

void expect_near(const std::vector<double>& a, const std::vector<double>& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

class Together : public testing::TestWithParam<int> {};

TEST_P(Together, GivesWhatElementsGetOnTheirOwn) {
  const Meshes m(GetParam());
  for (const auto& kinds : std::vector<std::vector<std::array<int, 2>>>{
           {{0, 1}}, {{1, 1}}, {{2, 1}}, {{3, 1}}, {{1, 3}}, {{2, 17}}, {{1, 1}, {3, 2}}}) {
    const auto fields = random_fields(m, kinds);
    const Result alone = transfer_all(m, fields, 0), together = transfer_all(m, fields, 8);
    EXPECT_EQ(alone.ordinary, 0U);
    EXPECT_GT(together.ordinary, m.target.element_count() / 2);
    EXPECT_EQ(together.donors, alone.donors);
    EXPECT_EQ(together.targets, alone.targets);
    expect_near(together.areas, alone.areas, 1e-15);
    expect_near(together.covered, alone.covered, 1e-15);
    for (std::size_t g = 0; g < kinds.size(); ++g)
      expect_near(together.out[g], alone.out[g], 1e-12);
    EXPECT_LE(*std::max_element(together.defects.begin(), together.defects.end()), 1e-15);
  }
}

TEST_P(Together, HasTheSameBitsHoweverManyAreTogether) {
  const Meshes m(GetParam());
  const auto fields = random_fields(m, {{1, 1}, {2, 9}});
  const Result all = transfer_all(m, fields, 8);
  for (const std::size_t at_once : {1U, 2U, 3U, 7U})
    EXPECT_TRUE(transfer_all(m, fields, at_once) == all) << at_once;
}

TEST_P(Together, HasTheSameBitsAfterAnElementOfOpenJoints) {
  Meshes m(GetParam());
  m.target.rounding = 1e-17;  // as in a plane where thin elements are round
  const auto fields = random_fields(m, {{2, 1}, {1, 3}});
  EXPECT_TRUE(transfer_all(m, fields, 8, true) == transfer_all(m, fields, 8));
}

TEST_P(Together, EachFieldHasTheBitsItHasAlone) {
  const Meshes m(GetParam());
  for (int p = 0; p <= 3; ++p) {
    auto fields = random_fields(m, {{p, 3}});
    const Result all = transfer_all(m, fields, 8);
    for (std::size_t c = 0; c < 3; ++c) {
      const Result one = transfer_all(m, {{fields[0][c]}}, 8);
      for (std::size_t n = 0; n < one.out[0].size(); ++n)
        ASSERT_EQ(one.out[0][n], all.out[0][3 * n + c]) << p << " " << c << " " << n;
    }
  }
}

TEST_P(Together, SameBitsOnEveryFusedTarget) {
  const Meshes m(GetParam());
  const auto fields = random_fields(m, {{3, 1}, {1, 5}});
  std::vector<Result> seen;
  support::on_every_target(
      [&] {
        seen.push_back(transfer_all(m, fields, 8));
        EXPECT_TRUE(seen.back() == seen.front());
      },
      true);
}

INSTANTIATE_TEST_SUITE_P(Degrees, Together, testing::Values(1, 2, 3));

}  // namespace
}  // namespace bezel::detail
