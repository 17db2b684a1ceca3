#include "bezel/transfer/sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "support/field_pairs.hpp"

namespace bezel::detail {
namespace {

using test::MeshPtr;

/// What part of a donor element lies in the target mesh is known from the areas of all its pairs.
void expect_rim_holds_all_partly_outside(const MeshPtr& a, const MeshPtr& b,
                                         const std::string& what) {
  const OverlayMesh donor(a, "donor", 1), target(b, "target", 1);
  const FrontSearch search(donor);
  const std::vector<std::uint8_t> rim = rim_donors(donor, target, search);
  ASSERT_EQ(rim.size(), donor.element_count());
  std::map<std::int32_t, double> given;
  for (const OverlapArea& o : overlap_areas(a, b, 1)) given[o.donor.value] += o.area;
  for (std::size_t d = 0; d < rim.size(); ++d) {
    const auto at = given.find(static_cast<std::int32_t>(d));
    const double inside = at == given.end() ? 0.0 : at->second / donor.element_area[d];
    // Those that lie in part outside must keep their masses; those that meet nothing have none.
    const bool partly = inside > 1e-9 && inside < 1.0 - 1e-9;
    EXPECT_TRUE(!partly || rim[d] != 0) << what << " " << d << ": " << inside;
  }
}

TEST(RimDonors, HoldAllThatLiePartlyOutsideTheTarget) {
  for (std::uint64_t seed = 1; seed < 32; ++seed) {
    const test::MeshPair pair = test::field_pair(seed);
    if (seed % test::field_pair_kinds == 0) continue;  // few elements, all at the boundary
    expect_rim_holds_all_partly_outside(pair.donor, pair.target,
                                        pair.kind + " " + std::to_string(seed));
  }
}

TEST(RimDonors, AreFewFarFromTheBoundary) {
  const auto a = test::grid_mesh(20, 1, 1.0, test::same_place);
  const auto b = test::grid_mesh(10, 1, 0.75, test::bend(0.1, 0.1));
  const OverlayMesh donor(a, "donor", 1), target(b, "target", 1);
  const auto rim = rim_donors(donor, target, FrontSearch(donor));
  const auto many = std::count(rim.begin(), rim.end(), 0);
  EXPECT_GT(many, static_cast<std::ptrdiff_t>(rim.size()) / 2);
}

// The same elements in another order, and some of them alone: what a chunk leaves of an element
// depends on nothing else.
TEST(SweepElements, LeavesTheSameOfAnElementInAnyCompany) {
  for (const int g : {1, 2}) {
    RandomStream random("sweep", static_cast<std::uint64_t>(g));
    const auto a = test::field_pairs::graded_grid(12, g, true, 1.0, random);
    const auto b = test::field_pairs::turned(
        test::field_pairs::graded_grid(7, g, false, 1.0, random), 0.6, 0.55, {});
    const OverlayMesh donor(a, "donor", 1), target(b, "target", 1);
    const FrontSearch search(donor);
    std::vector<Field> fields;
    for (const int p : {1, 3}) {
      const auto space = Space::discontinuous(a, p, Basis::physical);
      std::vector<double> c(space->coefficient_count() * 2);
      for (double& x : c) x = random.uniform(-1, 1);
      fields.emplace_back("jumps " + std::to_string(p), space, c, 2);
    }
    const auto sweep = [&](std::span<const std::int32_t> elements) {
      std::vector<Group> groups;
      for (const Field& f : fields) {
        const Field* one = &f;
        groups.emplace_back(donor, target, std::span(&one, 1),
                            Space::discontinuous(b, f.space().highest_degree(), Basis::physical),
                            1);
      }
      TransferOptions options;
      options.threads = 1;
      sweep_elements(donor, target, search, groups, elements, options, {});
      std::vector<std::vector<double>> out;
      for (const std::int32_t t : elements) {
        out.emplace_back();
        for (Group& g2 : groups) {
          const auto own = g2.target_out(t);
          out.back().insert(out.back().end(), own.begin(), own.end());
        }
      }
      return out;
    };
    const std::vector<std::int32_t> order = target.spatial_order();
    const auto all = sweep(order);
    std::vector<std::int32_t> backwards(order.rbegin(), order.rend());
    auto reversed = sweep(backwards);
    std::reverse(reversed.begin(), reversed.end());
    EXPECT_TRUE(reversed == all) << g;
    for (std::size_t i = 0; i < order.size(); i += 5)
      EXPECT_TRUE(sweep(std::span(order).subspan(i, 1))[0] == all[i]) << g << " " << order[i];
    // Chunks that end elsewhere, and blocks of elements that are not full.
    const auto some = sweep(std::span(order).subspan(3, 13));
    for (std::size_t i = 0; i < some.size(); ++i)
      EXPECT_TRUE(some[i] == all[3 + i]) << g << " " << i;
  }
}

}  // namespace
}  // namespace bezel::detail
