// As robust_test.cpp, at every field degree, and on larger meshes.

#include "property/transfer/robust_checks.hpp"

namespace bezel::test {
namespace {

class EveryDegrees : public ::testing::TestWithParam<std::tuple<int, int>> {};
INSTANTIATE_TEST_SUITE_P(Geometry, EveryDegrees,
                         ::testing::Combine(::testing::Range(1, 6), ::testing::Range(0, 9)));

TEST_P(EveryDegrees, SharedBoundary) {
  const auto [g, p] = GetParam();
  expect_kept(grid_mesh(3, g, 1.0, bend(0.15, -0.1)),
              grid_mesh(2, 1 + g % 5, 1.0, bend(-0.1, 0.12)), p, p == 8 ? 8 : (p * 5) % 8,
              "shared boundary");
}

TEST_P(EveryDegrees, ToItself) {
  const auto [g, p] = GetParam();
  const auto mesh = grid_mesh(2, g, 1.0, bend(0.15, -0.1));
  expect_kept(mesh, mesh, p, p, "itself");
}

TEST_P(EveryDegrees, SizeRatioAThousand) {
  const auto [g, p] = GetParam();
  const auto large = grid_mesh(2, g, 1.0, bend(0.15, -0.1));
  for (const Vec2& at : {Vec2{{0.31, 0.17}}, large->control(large->nodes(ElementId(0))[0])}) {
    const auto small = stretched(grid_mesh(2, g, 1.0, bend(0.1, 0.1)), 1e-3, 1e-3, at);
    expect_kept(large, small, p, p, "down", 10.0);
  }
}

TEST_P(EveryDegrees, AspectRatioAMillion) {
  const auto [g, p] = GetParam();
  const auto flat = stretched(grid_mesh(3, g, 1.0, bend(0.1, 0.1)), 1.0, 1e-6);
  const auto other = stretched(grid_mesh(2, g, 1.0, bend(-0.1, 0.1)), 1.0, 1e-6);
  expect_kept(flat, other, p, p, "both flat");
}

TEST(RobustLong, OneElementOverTenThousand) {
  for (const int g : {1, 2}) {
    const auto one = grid_mesh(1, g, 1.0, bend(0.1, 0.1));
    const auto many = grid_mesh(71, g, 1.0, bend(0.1, 0.1));
    ASSERT_GT(many->element_count(), 10000U);
    expect_kept(one, many, 3, 2, "down", 10.0);
    expect_kept(many, one, 2, 3, "up", 10.0);
  }
}

}  // namespace
}  // namespace bezel::test
