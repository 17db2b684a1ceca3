#include "bezel/numeric/finite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "support/simd_targets.hpp"

namespace {

TEST(AllFinite, FindsOneBadValueAnywhere) {
  const double infinity = std::numeric_limits<double>::infinity();
  support::on_every_target([&] {
    for (std::size_t n = 0; n < 40; ++n) {
      std::vector<double> x(n, 1.7976931348623157e308);
      EXPECT_TRUE(bezel::all_finite(x));
      for (std::size_t i = 0; i < n; ++i)
        for (const double bad : {infinity, -infinity, std::nan("")}) {
          x[i] = bad;
          EXPECT_FALSE(bezel::all_finite(x)) << i << " of " << n;
          x[i] = -0x1p-1074;
          EXPECT_TRUE(bezel::all_finite(x));
        }
    }
  });
}

}  // namespace
