#include "bezel/geometry/bent.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/geometry/area_map.hpp"
#include "bezel/geometry/triangle.hpp"
#include "support/exact_integrals.hpp"

namespace bezel {
namespace {

/// A triangle about 1 long and `width` wide along a parabola bent by `bend`, turned.
std::vector<Vec2> bent_triangle(int g, double width, double bend, RandomStream& random) {
  const double angle = random.uniform(-3.2, 3.2), c = std::cos(angle), s = std::sin(angle);
  std::vector<Vec2> control;
  for (int k = 0; k <= g; ++k)
    for (int j = 0; j + k <= g; ++j) {
      // Of corners at x = 0, 1 and 0.3; the coefficients of x^2 are the means of their products.
      const double sum = j + 0.3 * k, squares = j + 0.09 * k, x = sum / g;
      const double x_squared = (sum * sum - squares) / (g * (g - 1.0));
      const double v = static_cast<double>(k) / g + 0.05 * random.uniform(-1.0, 1.0);
      const double y = width * v + bend * (x - x_squared);
      control.push_back({{c * x - s * y + 2.0, s * x + c * y - 1.0}});
    }
  return control;
}

class BentTriangles : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Degree, BentTriangles, ::testing::Values(2, 3, 4, 7));

// Against integrals in double-double arithmetic over the reference triangle, not along the sides.
TEST_P(BentTriangles, AreaAndJacobianHaveAllTheirDigits) {
  const int g = GetParam();
  RandomStream random("bent triangles", static_cast<std::uint64_t>(g));
  for (const double width : {1e-5, 1e-7, 1e-9}) {
    for (const double bend : {0.02, 0.1, 0.6}) {
      for (int i = 0; i < 10; ++i) {
        const std::vector<Vec2> control = bent_triangle(g, width, bend, random);
        const double exact = test::exact_integrals(g, control, 0)[0].hi;
        EXPECT_NEAR(area(g, control), exact, 4e-16 * exact) << width << " " << bend;
        const std::vector<double> det = jacobian_determinant(g, control);
        double mean = 0.0, size = 0.0;
        for (const double d : det) {
          mean += d / static_cast<double>(det.size());
          size = std::max(size, std::abs(d));
        }
        EXPECT_NEAR(0.5 * mean, exact, 2e-15 * size) << width << " " << bend;
      }
    }
  }
}

TEST(Bent, OnlyWhatNoAreaMapMakesRound) {
  RandomStream random("round or bent", 1);
  const auto bent = [](const std::vector<Vec2>& control) {
    return is_bent(RoundControl(control).points(), area(2, control));
  };
  for (int i = 0; i < 20; ++i) {
    EXPECT_FALSE(bent(bent_triangle(2, 1.0, 0.5, random)));
    EXPECT_FALSE(bent(bent_triangle(2, 1e-6, 0.0, random)));
    EXPECT_FALSE(bent(bent_triangle(2, 1e-6, 1e-6, random)));
    EXPECT_FALSE(bent(bent_triangle(2, 1e-6, 1e-5, random)));
    EXPECT_TRUE(bent(bent_triangle(2, 1e-6, 1e-2, random)));
    EXPECT_TRUE(bent(bent_triangle(2, 1e-6, 1.0, random)));
  }
}

TEST_P(BentTriangles, JacobianOnlyIfBent) {
  const int g = GetParam();
  RandomStream random("if bent", static_cast<std::uint64_t>(g));
  const std::vector<Vec2> bent = bent_triangle(g, 1e-6, 0.3, random),
                          round = bent_triangle(g, 1.0, 0.3, random);
  EXPECT_EQ(jacobian_if_bent(g, bent, RoundControl(bent).points()), bent_jacobian(g, bent));
  EXPECT_TRUE(jacobian_if_bent(g, round, RoundControl(round).points()).empty());
}

// The corners' coefficients are cross products of the sides' first steps.
TEST_P(BentTriangles, JacobianAtTheCorners) {
  const int g = GetParam();
  RandomStream random("corners", static_cast<std::uint64_t>(g));
  const std::vector<Vec2> control = bent_triangle(g, 1e-6, 0.3, random);
  const ExactVec2 a = exact_step(control[0], control[1]);
  const ExactVec2 b = exact_step(control[0], control[static_cast<std::size_t>(g) + 1]);
  const double corner = static_cast<double>(cross(a, b)) * g * g;
  EXPECT_NEAR(bent_jacobian(g, control)[0], corner, 4e-16 * std::abs(corner));
}

TEST(Bent, SweptAreaOfACurveIsThatOfItsParts) {
  // y = x^2 from (0, 0) to (1, 1): twice the area to the chord is 1/3.
  const std::vector<ExactVec2> parabola = {{{0.0, 0.0}}, {{0.5, 0.0}}, {{1.0, 1.0}}};
  const DoubleDouble third = DoubleDouble(1.0) / DoubleDouble(3.0);
  EXPECT_LE(std::abs((twice_swept_area(parabola) - third).hi), 1e-31);
  const std::vector<ExactVec2> line = {{{1.0, 0.0}}, {{1.0, 2.0}}};
  EXPECT_EQ(twice_swept_area(line).hi, 2.0);
}

}  // namespace
}  // namespace bezel
