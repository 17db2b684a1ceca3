#include "bezel/transfer/redistribute.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bezel/base/random.hpp"

namespace bezel::detail {
namespace {

double weighted(const std::vector<double>& value, const std::vector<double>& weight) {
  double total = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i) total += value[i] * weight[i];
  return total;
}

/// Values in a row.
Neighbours row(std::size_t n) {
  return [n](std::int32_t i, std::vector<std::int32_t>& out) {
    if (i > 0) out.push_back(i - 1);
    if (i + 1 < static_cast<std::int32_t>(n)) out.push_back(i + 1);
  };
}

TEST(Redistribute, NeighboursTakeTheExcessByTheirRoom) {
  std::vector<double> value{0.5, 1.2, 0.8, 0.5};
  const std::vector<double> weight{1.0, 2.0, 1.0, 1.0};
  const Redistribution done = redistribute(value, weight, {{0.0}, {1.0}}, row(4));
  // Excess 0.4, room 0.5 and 0.2.
  EXPECT_EQ(value[1], 1.0);
  EXPECT_NEAR(value[0], 0.5 + 0.4 * 5.0 / 7.0, 1e-15);
  EXPECT_NEAR(value[2], 0.8 + 0.4 * 2.0 / 7.0, 1e-15);
  EXPECT_EQ(value[3], 0.5);
  EXPECT_NEAR(done.moved, 0.4, 1e-15);
  EXPECT_EQ(done.left_over, 0.0);
}

TEST(Redistribute, BothSidesAndOpenOnes) {
  std::vector<double> value{-0.25, 0.5, 3.0};
  const std::vector<double> weight{1.0, 1.0, 1.0};
  const double infinity = std::numeric_limits<double>::infinity();
  const Redistribution done = redistribute(value, weight, {{0.0}, {infinity}}, row(3));
  EXPECT_EQ(value[0], 0.0);
  EXPECT_NEAR(value[1], 0.25, 1e-15);
  EXPECT_EQ(value[2], 3.0);
  EXPECT_EQ(done.left_over, 0.0);
}

TEST(Redistribute, WidensWhereTheNeighboursAreFull) {
  std::vector<double> value{0.0, 1.0, 1.0, 1.5, 1.0, 1.0, 0.5};
  const std::vector<double> weight(7, 1.0);
  redistribute(value, weight, {{0.0}, {1.0}}, row(7));
  EXPECT_EQ(value[3], 1.0);
  EXPECT_NEAR(value[0] + value[6], 1.0, 1e-15);
}

TEST(Redistribute, FarAwayWhereTheNeighbourhoodIsFull) {
  std::vector<double> value(1000, 1.0);
  value[0] = 1.5;
  value[999] = 0.25;
  const std::vector<double> weight(1000, 1.0);
  const Redistribution done = redistribute(value, weight, {{0.0}, {1.0}}, row(1000));
  EXPECT_EQ(value[0], 1.0);
  EXPECT_NEAR(value[999], 0.75, 1e-15);
  EXPECT_EQ(done.left_over, 0.0);
}

TEST(Redistribute, SaysWhatDoesNotFit) {
  std::vector<double> value{1.5, 0.9};
  const std::vector<double> weight{2.0, 1.0};
  const Redistribution above = redistribute(value, weight, {{0.0}, {1.0}}, row(2));
  EXPECT_EQ(value, (std::vector<double>{1.0, 1.0}));
  EXPECT_NEAR(above.left_over, 0.9, 1e-15);
  value = {-1.0, 0.25};
  const Redistribution below = redistribute(value, weight, {{0.0}, {1.0}}, row(2));
  EXPECT_EQ(value, (std::vector<double>{0.0, 0.0}));
  EXPECT_NEAR(below.left_over, -1.75, 1e-15);
}

TEST(Redistribute, KeepsTheSumAndTheBoundsOfRandomValues) {
  RandomStream random("redistribute", 3);
  for (int round = 0; round < 50; ++round) {
    const std::size_t n = 1 + random.below(300);
    std::vector<double> value(n), weight(n);
    ValueBounds bounds{std::vector<double>(n), std::vector<double>(n)};
    double least = 0.0;
    double most = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      value[i] = random.uniform(-1.5, 2.5);
      weight[i] = std::exp(random.uniform(-5.0, 5.0));
      bounds.lo[i] = random.uniform(-1.0, 0.2);
      bounds.hi[i] = bounds.lo[i] + random.uniform(0.0, 2.0);
      least += bounds.lo[i] * weight[i];
      most += bounds.hi[i] * weight[i];
    }
    const double before = weighted(value, weight);
    const Redistribution done = redistribute(value, weight, bounds, row(n));
    double size = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      EXPECT_GE(value[i], bounds.lo[i]);
      EXPECT_LE(value[i], bounds.hi[i]);
      size += 2.5 * weight[i];
    }
    EXPECT_NEAR(weighted(value, weight) + done.left_over, before, 1e-15 * size) << round;
    const double outside = before > most ? before - most : before < least ? before - least : 0.0;
    EXPECT_NEAR(done.left_over, outside, 1e-14 * size) << round;
  }
}

}  // namespace
}  // namespace bezel::detail
