#include "bezel/bernstein/tetrahedron_index.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

using namespace bezel::bernstein;
using Index = std::array<int, 4>;

TEST(TetrahedronIndex, DegreeTwoIsInTheDocumentedOrder) {
  const std::array<Index, 10> order{{{2, 0, 0, 0},
                                     {1, 1, 0, 0},
                                     {0, 2, 0, 0},
                                     {1, 0, 1, 0},
                                     {0, 1, 1, 0},
                                     {0, 0, 2, 0},
                                     {1, 0, 0, 1},
                                     {0, 1, 0, 1},
                                     {0, 0, 1, 1},
                                     {0, 0, 0, 2}}};
  for (int n = 0; n < 10; ++n) {
    const Index& x = order[static_cast<std::size_t>(n)];
    EXPECT_EQ(tetrahedron_multi_index(2, n), x);
    EXPECT_EQ(tetrahedron_index(2, x[1], x[2], x[3]), n);
  }
}

TEST(TetrahedronIndex, FlatAndMultiIndexAreInverseAtEveryDegree) {
  for (int d = 0; d <= max_tetrahedron_degree; ++d)
    for (int n = 0; n < tetrahedron_size(d); ++n) {
      const Index x = tetrahedron_multi_index(d, n);
      EXPECT_EQ(x[0] + x[1] + x[2] + x[3], d);
      for (const int i : x) EXPECT_GE(i, 0);
      EXPECT_EQ(tetrahedron_index(x), n);
    }
}

TEST(TetrahedronIndex, CornersAndFaces) {
  for (int d = 1; d <= 6; ++d)
    for (int face = 0; face < 4; ++face) {
      const auto& corner = tetrahedron_face_corners[static_cast<std::size_t>(face)];
      for (int c = 0; c < 3; ++c) {
        const auto triangle = triangle_multi_index(d, triangle_corner(d, c));
        EXPECT_EQ(tetrahedron_face_index(d, face, triangle[1], triangle[2]),
                  tetrahedron_corner(d, corner[static_cast<std::size_t>(c)]));
      }
      for (int k = 0; k <= d; ++k)
        for (int j = 0; j <= d - k; ++j) {
          const Index x = tetrahedron_multi_index(d, tetrahedron_face_index(d, face, j, k));
          EXPECT_EQ(x[static_cast<std::size_t>(face)], 0);  // on the face opposite to the corner
          EXPECT_EQ(x[static_cast<std::size_t>(corner[1])], j);
          EXPECT_EQ(x[static_cast<std::size_t>(corner[2])], k);
        }
    }
}

// The faces' normals point outwards on the reference tetrahedron.
TEST(TetrahedronIndex, FacesAreCounterClockwiseFromOutside) {
  constexpr std::array<std::array<int, 3>, 4> point{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (std::size_t face = 0; face < 4; ++face) {
    std::array<std::array<int, 3>, 3> p{};
    for (std::size_t c = 0; c < 3; ++c)
      p[c] = point[static_cast<std::size_t>(tetrahedron_face_corners[face][c])];
    const auto minus = [](const std::array<int, 3>& a, const std::array<int, 3>& b) {
      return std::array<int, 3>{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    };
    const auto a = minus(p[1], p[0]), b = minus(p[2], p[0]), inward = minus(point[face], p[0]);
    const int volume = (a[1] * b[2] - a[2] * b[1]) * inward[0] +
                       (a[2] * b[0] - a[0] * b[2]) * inward[1] +
                       (a[0] * b[1] - a[1] * b[0]) * inward[2];
    EXPECT_EQ(volume, -1) << face;
  }
}

}  // namespace
