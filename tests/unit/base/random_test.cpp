#include "bezel/base/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace bezel {
namespace {

TEST(Random, NumbersAreFixedForever) {
  // Computed by a separate Python program from the published algorithms.
  RandomStream stream("bezel", 1);
  EXPECT_EQ(stream.next(), 0xcfffc4fd1809671du);
  EXPECT_EQ(stream.next(), 0x9c14c4380f245521u);
  EXPECT_EQ(stream.next(), 0xe12ac5d1a9f97644u);
}

TEST(Random, NameAndSeedBothMatter) {
  EXPECT_NE(RandomStream("a", 1).next(), RandomStream("a", 2).next());
  EXPECT_NE(RandomStream("a", 1).next(), RandomStream("b", 1).next());
  EXPECT_EQ(RandomStream("a", 1).next(), RandomStream("a", 1).next());
}

TEST(Random, UniformStaysInsideAndIsUniform) {
  RandomStream stream("uniform", 7);
  double sum = 0, square = 0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double x = stream.uniform();
    ASSERT_GE(x, 0.0);
    ASSERT_LT(x, 1.0);
    sum += x;
    square += x * x;
  }
  // Five standard deviations of the mean of n values: of x, sqrt(1/12); of x^2, sqrt(4/45).
  EXPECT_NEAR(sum / n, 1.0 / 2, 5 * std::sqrt(1.0 / 12 / n));
  EXPECT_NEAR(square / n, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / n));
}

TEST(Random, UniformOfAnInterval) {
  RandomStream stream("interval", 7);
  const double hi = std::nextafter(1.0, 2.0);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(stream.uniform(1.0, hi), 1.0);  // the only double in [1, 1 + 2^-52)
    const double x = stream.uniform(-3.0, 2.0);
    EXPECT_GE(x, -3.0);
    EXPECT_LT(x, 2.0);
  }
  EXPECT_EQ(stream.uniform(4.0, 4.0), 4.0);
}

TEST(Random, BelowIsUnbiased) {
  RandomStream stream("below", 7);
  std::array<int, 6> count{};
  constexpr int n = 60000;
  for (int i = 0; i < n; ++i) ++count[stream.below(6)];
  // Five standard deviations of a binomial count: 5 sqrt(n 1/6 5/6).
  for (const int c : count) EXPECT_NEAR(c, n / 6, 5 * std::sqrt(n * 5.0 / 36));
  EXPECT_EQ(stream.below(1), 0u);
  // Rejection is about every second draw here.
  const std::uint64_t large = (std::uint64_t{1} << 63) + 1;
  for (int i = 0; i < 1000; ++i) EXPECT_LT(stream.below(large), large);
}

}  // namespace
}  // namespace bezel
