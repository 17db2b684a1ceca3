#include "bezel/transfer/bent_element.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/index.hpp"
#include "support/exact_integrals.hpp"

namespace bezel::detail {
namespace {

/// About 1 long, along a parabola bent by 0.3.
std::vector<Vec2> bent_control(int g, double width) {
  std::vector<Vec2> control;
  for (int k = 0; k <= g; ++k)
    for (int j = 0; j + k <= g; ++j) {
      const double sum = j + 0.4 * k, squares = j + 0.16 * k, x = sum / g;
      const double y = width * k / g + 0.3 * (x - (sum * sum - squares) / (g * (g - 1.0)));
      control.push_back({{2.0 + 0.8 * x - 0.6 * y, 0.6 * x + 0.8 * y}});
    }
  return control;
}

class BentElements : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degree, BentElements, ::testing::Values(2, 3, 5));

// at(invert(x)) == x, and invert(at(q)) == q, to far more than the rounding of a double.
TEST_P(BentElements, InvertsItsMap) {
  RandomStream random("bent elements", static_cast<std::uint64_t>(GetParam()));
  for (const double width : {1e-4, 1e-6, 1e-8}) {
    BentElement element;
    const std::vector<Vec2> control = bent_control(GetParam(), width);
    element.set(GetParam(), control, control[1]);
    for (int i = 0; i < 50; ++i) {
      const double u = random.uniform(-0.1, 1.0), v = random.uniform(-0.1, 1.0 - u);
      const BentElement::Place q{u, v};
      const ExactVec2 x = element.at(q).value;
      BentElement::Place found{};
      ASSERT_TRUE(element.invert(x, found, false)) << width << " " << u << " " << v;
      EXPECT_LE(std::abs((found[0] - q[0]).hi), 1e-18) << width;
      EXPECT_LE(std::abs((found[1] - q[1]).hi), 1e-18) << width;
      BentElement::Place near{u + 1e-3, v};
      ASSERT_TRUE(element.invert(x, near, true));
      EXPECT_LE(std::abs((near[0] - q[0]).hi), 1e-18) << width;
    }
  }
}

TEST_P(BentElements, DeterminantIsTheCrossProductOfTheDerivatives) {
  RandomStream random("determinants", static_cast<std::uint64_t>(GetParam()));
  BentElement element;
  const std::vector<Vec2> control = bent_control(GetParam(), 1e-6);
  element.set(GetParam(), control, {});
  for (int i = 0; i < 20; ++i) {
    const double u = random.uniform(0.0, 1.0), v = random.uniform(0.0, 1.0 - u);
    const BentElement::Point at = element.at({u, v});
    const double det = static_cast<double>(cross(at.du, at.dv));
    EXPECT_NEAR(element.det({u, v}), det, 4e-15 * det);
  }
}

TEST(BentElement, EdgePointsAreExact) {
  const std::vector<ExactVec2> line = {{{1.0, 0.0}}, {{1.0, DoubleDouble(1.0, 1e-20)}}};
  const auto at = exact_edge_point(line, 0.5);
  EXPECT_EQ(at.value.y(), DoubleDouble(0.5, 0.5e-20));
  EXPECT_EQ(at.derivative.y(), DoubleDouble(1.0, 1e-20));
  EXPECT_EQ(rounded(BentElement::Place{DoubleDouble(0.25, 1e-20), 0.5}),
            (std::array<double, 2>{0.25, 0.5}));
}

}  // namespace
}  // namespace bezel::detail
