#include "bezel/bernstein/band_kernel.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "bezel/numeric/vec.hpp"

namespace {

using bezel::Vec2;
using bezel::bernstein::kernel::BandMatrix;

TEST(BandMatrix, SolvesATridiagonalSystem) {
  BandMatrix<double> a(4, 1);
  for (int i = 0; i < 4; ++i) a(i, i) = 2.0;
  for (int i = 1; i < 4; ++i) a(i, i - 1) = -1.0;
  std::vector<double> x{0.0, 0.0, 0.0, 5.0};  // the solution is 1, 2, 3, 4
  a.solve(x.data());
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(x[static_cast<std::size_t>(i)], i + 1.0, 1e-14);
}

TEST(BandMatrix, SolvesForPoints) {
  BandMatrix<double> a(2, 1);
  a(0, 0) = 4.0, a(1, 0) = 2.0, a(1, 1) = 5.0;
  std::vector<Vec2> x{{{8.0, 4.0}}, {{12.0, 2.0}}};
  a.solve(x.data());
  EXPECT_EQ(x[0], (Vec2{{1.0, 1.0}}));
  EXPECT_EQ(x[1], (Vec2{{2.0, 0.0}}));
}

}  // namespace
