#include "bezel/numeric/triangle_rule_table.hpp"

#include <gtest/gtest.h>

namespace {

TEST(TriangleRuleTable, DegreesAscendAndOrbitsFillTheRow) {
  int previous = 5;
  for (const auto& rule : bezel::symmetric_rules) {
    EXPECT_GT(rule.degree, previous);
    previous = rule.degree;
    const int used = rule.ones + 2 * rule.threes + 3 * rule.sixes;
    ASSERT_LE(used, static_cast<int>(rule.number.size()));
    for (int i = 0; i < static_cast<int>(rule.number.size()); ++i)
      EXPECT_EQ(rule.number[static_cast<std::size_t>(i)] > 0.0, i < used);
  }
}

}  // namespace
