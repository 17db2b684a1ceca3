#include "bezel/bernstein/index.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>

namespace {

using namespace bezel::bernstein;
using Index = std::array<int, 3>;

TEST(Index, DegreeTwoIsInTheDocumentedOrder) {
  const std::array<Index, 6> order{
      {{2, 0, 0}, {1, 1, 0}, {0, 2, 0}, {1, 0, 1}, {0, 1, 1}, {0, 0, 2}}};
  for (int n = 0; n < 6; ++n) {
    const Index& index = order[static_cast<std::size_t>(n)];
    EXPECT_EQ(triangle_multi_index(2, n), index);
    EXPECT_EQ(triangle_index(2, index[1], index[2]), n);
  }
}

TEST(Index, FlatAndMultiIndexAreInverseAtEveryDegree) {
  for (int d = 0; d <= max_triangle_degree; ++d)
    for (int n = 0; n < triangle_size(d); ++n) {
      const Index index = triangle_multi_index(d, n);
      EXPECT_EQ(index[0] + index[1] + index[2], d);
      EXPECT_GE(index[0], 0);
      EXPECT_EQ(triangle_index(d, index[1], index[2]), n);
    }
}

TEST(Index, CornersAndSides) {
  for (int d = 1; d <= 9; ++d)
    for (int side = 0; side < 3; ++side) {
      EXPECT_EQ(triangle_side_index(d, side, 0), triangle_corner(d, side));
      EXPECT_EQ(triangle_side_index(d, side, d), triangle_corner(d, (side + 1) % 3));
      const std::size_t opposite = static_cast<std::size_t>((side + 2) % 3);
      for (int m = 0; m <= d; ++m) {
        const Index index = triangle_multi_index(d, triangle_side_index(d, side, m));
        EXPECT_EQ(index[opposite], 0);
        EXPECT_EQ(index[static_cast<std::size_t>((side + 1) % 3)], m);
      }
    }
}

TEST(Index, TetrahedronIsABijection) {
  for (int d = 0; d <= 7; ++d) {
    std::set<int> seen;
    for (int l = 0; l <= d; ++l)
      for (int k = 0; k + l <= d; ++k)
        for (int j = 0; j + k + l <= d; ++j) seen.insert(tetrahedron_index(d, j, k, l));
    EXPECT_EQ(static_cast<int>(seen.size()), tetrahedron_size(d));
    EXPECT_EQ(*seen.begin(), 0);
    EXPECT_EQ(*seen.rbegin(), tetrahedron_size(d) - 1);
  }
}

TEST(Index, SimplexSizes) {
  EXPECT_EQ(simplex_size(1, 4), 5);
  EXPECT_EQ(simplex_size(2, 4), 15);
  EXPECT_EQ(simplex_size(3, 4), 35);
}

}  // namespace
