// Fuzzed transfers, their fields against slow projections.

#include <gtest/gtest.h>

#include "property/transfer/fuzz_fields.hpp"

namespace bezel::test {
namespace {

class FuzzedFields : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(FuzzedFields, NoWrongFieldGoesUnreported) {
  const FieldVerdict verdict = FieldJudge(GetParam(), 100).judge();
  EXPECT_EQ(verdict.complaint, "") << verdict.kind;
  EXPECT_FALSE(verdict.refused) << verdict.kind << ": " << verdict.refusal;
  EXPECT_LE(verdict.undecided, 1 + verdict.compared / 10);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FuzzedFields,
                         ::testing::Range(std::uint64_t{0}, std::uint64_t{3 * field_pair_kinds}));

// Some elements far from the boundary leave the shortest way: what one left in the sums for the
// next was seen in these, and in few others.
INSTANTIATE_TEST_SUITE_P(ThinDonorsInTheMiddle, FuzzedFields,
                         ::testing::Values(52U, 105U, 169U, 201U, 339U, 356U));

// A gap of 1e-10 of an element around its corner, with jumps along it.
INSTANTIATE_TEST_SUITE_P(ThinGapAroundACorner, FuzzedFields, ::testing::Values(5728U));

}  // namespace
}  // namespace bezel::test
