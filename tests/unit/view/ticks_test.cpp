#include "bezel/view/ticks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace bezel::view {
namespace {

using ::testing::ElementsAre;

TEST(LinearTicks, AreNiceNumbersWithLabels) {
  const Ticks t = linear_ticks(0.0, 1.0, 6);
  EXPECT_THAT(t.labels, ElementsAre("0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  ASSERT_EQ(t.major.size(), 6U);
  EXPECT_DOUBLE_EQ(t.major[3], 0.6);
}

TEST(LinearTicks, StayInsideAndAreEvenlySpaced) {
  for (const auto& [lo, hi] : {std::pair{-0.75, 1.7}, {1e-9, 3e-9}, {-1e6, 2e7}, {99.9, 100.1}}) {
    const Ticks t = linear_ticks(lo, hi, 7);
    ASSERT_GE(t.major.size(), 2U);
    EXPECT_LE(t.major.size(), 10U);
    const double step = t.major[1] - t.major[0];
    const double mantissa = step / std::pow(10.0, std::floor(std::log10(step * (1 + 1e-9))));
    EXPECT_TRUE(std::abs(mantissa - 1) < 1e-6 || std::abs(mantissa - 2) < 1e-6 ||
                std::abs(mantissa - 2.5) < 1e-6 || std::abs(mantissa - 5) < 1e-6)
        << mantissa;
    for (std::size_t i = 0; i < t.major.size(); ++i) {
      EXPECT_GE(t.major[i], lo - 1e-9 * (hi - lo));
      EXPECT_LE(t.major[i], hi + 1e-9 * (hi - lo));
      if (i > 0) {
        EXPECT_NEAR(t.major[i] - t.major[i - 1], step, 1e-6 * step);
      }
    }
    EXPECT_EQ(t.labels.size(), t.major.size());
    EXPECT_EQ(t.superscripts.size(), t.major.size());
  }
}

TEST(LogTicks, ArePowersOfTenWithMinorTicksBetween) {
  const Ticks t = log_ticks(1e-8, 1e-2, 10);
  ASSERT_EQ(t.major.size(), 7U);
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_NEAR(std::log10(t.major[i]), -8.0 + static_cast<double>(i), 1e-12);
  EXPECT_EQ(t.labels[0], "10");
  EXPECT_GE(t.minor.size(), 6U * 8U);
}

}  // namespace
}  // namespace bezel::view
