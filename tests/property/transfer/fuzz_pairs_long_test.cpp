// As fuzz_pairs_test.cpp, more pairs of meshes: BEZEL_FUZZ_PAIRS of each kind (ten thousand in all
// are 715, which takes an hour), by default 40.

#include <gtest/gtest.h>

#include <cstdlib>

#include "property/transfer/fuzz_pairs.hpp"

namespace bezel::test {
namespace {

class ManyFuzzedPairs : public ::testing::TestWithParam<int> {};

TEST_P(ManyFuzzedPairs, NoWrongAreaGoesUnreported) {
  const char* asked = std::getenv("BEZEL_FUZZ_PAIRS");
  const int pairs = asked != nullptr ? std::atoi(asked) : 40;
  int refused = 0;
  for (int i = 20; i < pairs; ++i) {
    const auto seed = static_cast<std::uint64_t>(i * mesh_pair_kinds + GetParam());
    const FuzzVerdict verdict = judge(mesh_pair(seed));
    EXPECT_EQ(verdict.complaint, "") << verdict.kind << ", seed " << seed;
    refused += verdict.refused ? 1 : 0;
  }
  EXPECT_EQ(refused, 0);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ManyFuzzedPairs, ::testing::Range(0, mesh_pair_kinds));

}  // namespace
}  // namespace bezel::test
