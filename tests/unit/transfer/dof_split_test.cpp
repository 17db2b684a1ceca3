#include "bezel/transfer/dof_split.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/meshes.hpp"

namespace bezel::detail {
namespace {

using test::bend;
using test::grid_mesh;

TEST(DofSplit, NumbersEveryRowOnceAndSharesThemOut) {
  const auto space = Space::continuous(grid_mesh(16, 2, 1.0, bend(0.1, 0.1)), 3);
  for (const std::size_t count : {1U, 3U, 8U}) {
    const DofSplit split(*space, count);
    std::vector<std::int32_t> rows = split.row;
    std::ranges::sort(rows);
    for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_EQ(rows[i], static_cast<std::int32_t>(i));
    ASSERT_EQ(split.ranges.size(), count);
    std::int32_t next = 0;
    for (std::size_t p = 0; p < count; ++p) {
      const RowRange& range = split.ranges[p];
      EXPECT_EQ(range.first, next);
      EXPECT_EQ(range.all, static_cast<std::int32_t>(space->dof_count()));
      EXPECT_NEAR(range.size(),
                  static_cast<double>(space->dof_count()) / static_cast<double>(count), 1.0);
      EXPECT_EQ(range.outside.size(), range.inside.size());
      next += range.size();
      if (range.size() == 0) continue;
      EXPECT_EQ(split.owner(range.first), static_cast<int>(p));
      EXPECT_EQ(split.owner(next - 1), static_cast<int>(p));
    }
    EXPECT_EQ(next, static_cast<std::int32_t>(space->dof_count()));
  }
}

// The bounds hold for the true pattern, and the parts hang together: few entries lie outside.
TEST(DofSplit, BoundsEntriesPerRow) {
  const auto space = Space::continuous(grid_mesh(16, 1, 1.0, test::same_place), 2);
  const DofSplit split(*space, 4);
  std::vector<std::set<std::int32_t>> entries(space->dof_count());
  for (std::size_t e = 0; e < space->mesh()->element_count(); ++e) {
    for (const std::int32_t i : space->dofs(ElementId(e)))
      for (const std::int32_t j : space->dofs(ElementId(e)))
        entries[static_cast<std::size_t>(split.row[static_cast<std::size_t>(i)])].insert(
            split.row[static_cast<std::size_t>(j)]);
  }
  std::ptrdiff_t all = 0;
  std::ptrdiff_t out = 0;
  for (const RowRange& range : split.ranges) {
    for (std::int32_t k = 0; k < range.size(); ++k) {
      const auto& row = entries[static_cast<std::size_t>(range.first + k)];
      const auto outside = std::ranges::count_if(
          row, [&](std::int32_t j) { return j < range.first || j >= range.first + range.size(); });
      EXPECT_LE(outside, range.outside[static_cast<std::size_t>(k)]);
      EXPECT_LE(static_cast<std::ptrdiff_t>(row.size()) - outside,
                range.inside[static_cast<std::size_t>(k)]);
      all += static_cast<std::ptrdiff_t>(row.size());
      out += outside;
    }
  }
  EXPECT_LT(10 * out, all);
}

TEST(DofSplit, MoreProcessesThanRowsLeaveSomeEmpty) {
  const auto space = Space::continuous(grid_mesh(1, 1, 1.0, test::same_place), 1);
  const DofSplit split(*space, 9);
  std::int32_t rows = 0;
  for (const RowRange& range : split.ranges) rows += range.size();
  EXPECT_EQ(rows, 4);
  for (std::int32_t row = 0; row < rows; ++row) {
    const RowRange& range = split.ranges[static_cast<std::size_t>(split.owner(row))];
    EXPECT_TRUE(range.first <= row && row < range.first + range.size()) << row;
  }
}

}  // namespace
}  // namespace bezel::detail
