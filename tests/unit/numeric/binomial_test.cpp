#include "bezel/numeric/binomial.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/numeric/binomial_kernel.hpp"

namespace {

using bezel::binomial;
using bezel::exact_binomial;
__extension__ using Wide = unsigned __int128;

Wide wide(int n, int k) {
  const auto c = exact_binomial(n, k);
  return (Wide{c.high} << 64) + c.low;
}

TEST(Binomial, KnownValues) {
  EXPECT_EQ(binomial(0, 0), 1.0);
  EXPECT_EQ(binomial(5, 2), 10.0);
  EXPECT_EQ(binomial(30, 15), 155117520.0);
  EXPECT_EQ(binomial(56, 28), 7648690600760440.0);
  EXPECT_EQ(exact_binomial(67, 33).high, 0U);
  EXPECT_EQ(exact_binomial(67, 33).low, 14226520737620288370U);
  EXPECT_EQ(exact_binomial(120, 60).high, 0x129b7b975453a0U);
  EXPECT_EQ(binomial(3, -1), 0.0);
  EXPECT_EQ(binomial(3, 4), 0.0);
}

TEST(Binomial, MultiplicativeRuleHoldsExactlyUpTo120) {
  // C(n, k) (n - k) == C(n, k+1) (k + 1), an identity that Pascal's rule does not use.
  for (int n = 0; n <= bezel::max_binomial; ++n)
    for (int k = 0; k < n; ++k)
      ASSERT_TRUE(wide(n, k) * static_cast<Wide>(n - k) ==
                  wide(n, k + 1) * static_cast<Wide>(k + 1))
          << n << " " << k;
}

TEST(Binomial, RowsAreSymmetricAndRoundedToNearest) {
  for (int n = 0; n <= bezel::max_binomial; ++n)
    for (int k = 0; k <= n; ++k) {
      const double c = binomial(n, k);
      ASSERT_EQ(c, binomial(n, n - k));
      const Wide exact = wide(n, k);
      if (n <= bezel::max_exact_binomial) {
        ASSERT_TRUE(static_cast<Wide>(c) == exact);
      }
      const Wide rounded = static_cast<Wide>(c);
      const Wide error = rounded > exact ? rounded - exact : exact - rounded;
      const double half_ulp = (std::nextafter(c, HUGE_VAL) - c) / 2.0;
      ASSERT_LE(static_cast<double>(error), half_ulp);
      ASSERT_EQ(c, bezel::kernel::Binomial<double>::get(n, k));
      ASSERT_EQ(c, bezel::kernel::Binomial<bezel::DoubleDouble>::get(n, k).hi);
    }
}

TEST(Binomial, TrinomialsAreMultinomials) {
  EXPECT_EQ(bezel::kernel::trinomial<double>(4, 1, 1), 12.0);
  EXPECT_EQ(bezel::kernel::trinomial<double>(6, 2, 2), 90.0);
}

TEST(Binomial, RangeIsChecked) {
  EXPECT_THAT([] { binomial(121, 3); },
              testing::ThrowsMessage<bezel::InputError>(
                  "binomial coefficient C(121, k), expected 0 <= n <= 120"));
  EXPECT_THROW(binomial(-1, 0), bezel::InputError);
  EXPECT_THROW(exact_binomial(121, 0), bezel::InputError);
}

}  // namespace
