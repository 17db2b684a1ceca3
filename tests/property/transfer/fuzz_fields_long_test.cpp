// As fuzz_fields_test.cpp, more transfers: BEZEL_FUZZ_PAIRS of each kind (a thousand take half an
// hour), by default 40.

#include <gtest/gtest.h>

#include <cstdlib>

#include "property/transfer/fuzz_fields.hpp"

namespace bezel::test {
namespace {

class ManyFuzzedFields : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(ManyFuzzedFields, NoWrongFieldGoesUnreported) {
  const char* asked = std::getenv("BEZEL_FUZZ_PAIRS");
  const auto pairs = static_cast<std::uint64_t>(asked != nullptr ? std::atoi(asked) : 40);
  int compared = 0, undecided = 0;
  for (std::uint64_t i = 3; i < pairs; ++i) {
    const std::uint64_t seed = i * field_pair_kinds + GetParam();
    const FieldVerdict verdict = FieldJudge(seed).judge();
    EXPECT_EQ(verdict.complaint, "") << verdict.kind << ", seed " << seed;
    EXPECT_FALSE(verdict.refused) << verdict.kind << ", seed " << seed << verdict.refusal;
    compared += verdict.compared;
    undecided += verdict.undecided;
  }
  EXPECT_GT(compared, 0);
  EXPECT_LE(undecided, compared / 20);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ManyFuzzedFields,
                         ::testing::Range(std::uint64_t{0}, std::uint64_t{field_pair_kinds}));

}  // namespace
}  // namespace bezel::test
