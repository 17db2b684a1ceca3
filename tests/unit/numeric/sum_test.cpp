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

}  // namespace
