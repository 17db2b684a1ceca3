#include "bezel/numeric/short_names.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <type_traits>

namespace {

using bezel::short_names::at;
using bezel::short_names::infinity;
using bezel::short_names::u;

TEST(ShortNames, TheUnitRoundoffIsHalfTheDistanceFromOneToTheNextDouble) {
  EXPECT_EQ(2 * u, std::numeric_limits<double>::epsilon());
  volatile double one = 1.0;
  EXPECT_EQ(one + u, 1.0);  // a tie, to even
  EXPECT_EQ(one - u, std::nextafter(1.0, 0.0));
}

TEST(ShortNames, InfinityIsAboveAllNumbers) {
  EXPECT_GT(infinity, std::numeric_limits<double>::max());
}

TEST(ShortNames, AnIndexHasTheSizeOfMemory) {
  static_assert(std::is_same_v<decltype(at(3)), std::size_t>);
  EXPECT_EQ(at(0), 0U);
  EXPECT_EQ(at(std::numeric_limits<int>::max()), 2147483647U);
}

}  // namespace
