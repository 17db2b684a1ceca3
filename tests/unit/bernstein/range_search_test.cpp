#include "bezel/bernstein/range_search.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "bezel/bernstein/interval.hpp"

namespace {

using Doubles = std::vector<double>;

// 4 s (1 - s): maximum 1 in the middle, coefficients 0, 2, 0.
const Doubles hump{0.0, 2.0, 0.0};
constexpr std::array<std::size_t, 2> ends{0, 2};

double bound(double tol, int max_depth, int max_splits, int* splits = nullptr) {
  return bezel::bernstein::upper_bound_by_splitting(
      2, hump, bezel::bernstein::WithinTolerance{tol}, ends, max_depth, max_splits,
      [&](int, const Doubles& b) {
        if (splits != nullptr) ++*splits;
        auto [left, right] = bezel::bernstein::subdivide(std::span<const double>(b), 0.5);
        return std::array<Doubles, 2>{std::move(left), std::move(right)};
      });
}

TEST(RangeSearch, StopsWithinTheTolerance) {
  EXPECT_EQ(bound(2.0, 30, 1000), 2.0);
  int splits = 0;
  const double b = bound(1e-3, 30, 1000, &splits);
  EXPECT_GE(b, 1.0);
  EXPECT_LE(b, 1.0 + 1e-3);
  EXPECT_GT(splits, 0);
  EXPECT_LT(splits, 10);
}

TEST(RangeSearch, StopsAtTheLimitsWithACertifiedBound) {
  int splits = 0;
  EXPECT_EQ(bound(0.0, 30, 0, &splits), 2.0);
  EXPECT_EQ(splits, 0);
  EXPECT_EQ(bound(0.0, 0, 1000), 2.0);
  // One split: both halves have the largest coefficient 1, a value, up to outward rounding.
  const double one = bound(0.0, 30, 1);
  EXPECT_GE(one, 1.0);
  EXPECT_LE(one, 1.0 + 0x1p-49);
}

}  // namespace
