// As fuzz_pairs_test.cpp, ten thousand pairs of meshes.

#include <gtest/gtest.h>

#include "property/transfer/fuzz_pairs.hpp"

namespace bezel::test {
namespace {

class ManyFuzzedPairs : public ::testing::TestWithParam<int> {};

TEST_P(ManyFuzzedPairs, NoWrongAreaGoesUnreported) {
  int refused = 0;
  for (int i = 20; i < 715; ++i) {
    const auto seed = static_cast<std::uint64_t>(i * mesh_pair_kinds + GetParam());
    const FuzzVerdict verdict = judge(mesh_pair(seed));
    EXPECT_EQ(verdict.complaint, "") << verdict.kind << ", seed " << seed;
    refused += verdict.refused ? 1 : 0;
  }
  RecordProperty("refused", refused);
  EXPECT_LE(refused, 350);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ManyFuzzedPairs, ::testing::Range(0, mesh_pair_kinds));

}  // namespace
}  // namespace bezel::test
