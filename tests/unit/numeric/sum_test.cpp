#include "bezel/numeric/sum.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "bezel/base/error.hpp"

namespace {

using bezel::dot;
using bezel::sum;

TEST(Sum, EmptyIsZero) {
  EXPECT_EQ(sum({}), 0.0);
}

TEST(Sum, CancellationLosesNothing) {
  const std::vector<double> values{1e16, 1.0, -1e16, 1.0, 0x1p-40};
  EXPECT_EQ(sum(values), 2.0 + 0x1p-40);
}

TEST(Sum, TenTenthsAreOneRounded) {
  const std::vector<double> values(10, 0.1);
  EXPECT_EQ(sum(values), 1.0);
}

TEST(Sum, HarmonicSumForwardsAndBackwardsAgree) {
  std::vector<double> up, down;
  for (int i = 1; i <= 100000; ++i) {
    up.push_back(1.0 / i);
    down.push_back(1.0 / (100001 - i));
  }
  EXPECT_EQ(sum(up), sum(down));
}

TEST(Sum, DotIsAsIfInTwiceThePrecision) {
  const std::vector<double> a{1.0 + 0x1p-52, 1.0, 0x1p53}, b{1.0 - 0x1p-52, -1.0, 0x1p-200};
  EXPECT_EQ(dot(a, b), -0x1p-104 + 0x1p-147);
}

TEST(Sum, DotOfDifferentLengthsIsAnInputError) {
  const std::vector<double> a{1.0, 2.0}, b{1.0};
  EXPECT_THAT([&] { dot(a, b); }, testing::ThrowsMessage<bezel::InputError>(
                                      "found vectors of lengths 2 and 1, expected equal lengths"));
}

TEST(Sum, VecSumKeepsTheSumAndEndsInTheRoundedOne) {
  std::vector<double> p{1.0, 0x1p-60, -1.0, 0x1p-70};
  bezel::vec_sum(p);
  EXPECT_EQ(p, (std::vector<double>{0x1p-60, 0.0, 0.0, 0x1p-70}));
  std::vector<double> none;
  bezel::vec_sum(none);
  EXPECT_TRUE(none.empty());
}

TEST(Sum, KFoldSumSeesKTimesAsFar) {
  // Each step of 2^60 down needs one more fold.
  const std::vector<double> p{1.0, 0x1p-60, 0x1p-120, 0x1p-180, -0x1p-120, -0x1p-60, -1.0};
  EXPECT_EQ(bezel::sum_k(p, 1), 0.0);
  EXPECT_EQ(bezel::sum_k(p, 4), 0x1p-180);
  EXPECT_EQ(bezel::sum_k(std::vector<double>{}, 3), 0.0);
  EXPECT_EQ(bezel::sum_k(std::vector<double>{0.1}, 3), 0.1);
  EXPECT_EQ(bezel::sum_k(std::vector<double>(100, 0.1), 2), 0.1 * 100);
}

TEST(Sum, KBelowOneIsAnInputError) {
  EXPECT_THAT([] { bezel::sum_k(std::vector<double>{1.0}, 0); },
              testing::ThrowsMessage<bezel::InputError>("found K = 0, expected at least 1"));
}

}  // namespace
