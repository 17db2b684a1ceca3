// As elements_alone_test.cpp, all elements of more transfers: BEZEL_FUZZ_PAIRS of each kind, by
// default 60.

#include <gtest/gtest.h>

#include <cstdlib>

#include "property/transfer/elements_alone.hpp"

namespace bezel::test {
namespace {

class ManyElementsAlone : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(ManyElementsAlone, HaveTheBitsTheyHaveAmongOthers) {
  const char* asked = std::getenv("BEZEL_FUZZ_PAIRS");
  const auto pairs = static_cast<std::uint64_t>(asked != nullptr ? std::atoi(asked) : 60);
  std::size_t elements = 0;
  for (std::uint64_t i = 10; i < pairs; ++i) {
    const std::uint64_t seed = i * field_pair_kinds + GetParam();
    const AloneVerdict verdict = AloneJudge(seed).judge();
    EXPECT_EQ(verdict.complaint, "") << verdict.kind << ", seed " << seed;
    EXPECT_FALSE(verdict.refused) << verdict.kind << ", seed " << seed;
    elements += verdict.elements;
  }
  EXPECT_GT(elements, 0U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ManyElementsAlone,
                         ::testing::Range(std::uint64_t{0}, std::uint64_t{field_pair_kinds}));

}  // namespace
}  // namespace bezel::test
