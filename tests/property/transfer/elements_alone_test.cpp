// What an element gets does not depend on the elements worked on before it.

#include "property/transfer/elements_alone.hpp"

#include <gtest/gtest.h>

namespace bezel::test {
namespace {

class ElementsAlone : public ::testing::TestWithParam<std::uint64_t> {};

TEST_P(ElementsAlone, HaveTheBitsTheyHaveAmongOthers) {
  const AloneVerdict verdict = AloneJudge(GetParam(), 25, 1).judge();
  EXPECT_EQ(verdict.complaint, "") << verdict.kind;
  EXPECT_FALSE(verdict.refused) << verdict.kind;
  EXPECT_GT(verdict.elements, 1U) << verdict.kind;
}

INSTANTIATE_TEST_SUITE_P(Seeds, ElementsAlone,
                         ::testing::Range(std::uint64_t{0}, std::uint64_t{5 * field_pair_kinds}));

// Where planes are shared by thin elements: donors that were there for another element continued a
// field. In the second one they are in another share.
INSTANTIATE_TEST_SUITE_P(GapsOfThinElements, ElementsAlone, ::testing::Values(75U, 433U));

// Open joints of an element before were seen in the first two, sums of a thin donor in the others,
// and in few besides.
INSTANTIATE_TEST_SUITE_P(FewOfAKind, ElementsAlone,
                         ::testing::Values(122U, 156U, 126U, 133U, 153U));

}  // namespace
}  // namespace bezel::test
