#include "bezel/transfer/moments.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "bezel/bernstein/index.hpp"

namespace bezel::detail {
namespace {

std::size_t at(int degree, int a, int b) {
  return static_cast<std::size_t>(bernstein::triangle_index(degree, a, b));
}

/// Integral of x^a y^b over the triangle (0,0), (1,0), (0,1): a! b! / (a+b+2)!.
double triangle_moment(int a, int b) {
  return std::tgamma(a + 1.0) * std::tgamma(b + 1.0) / std::tgamma(a + b + 3.0);
}

TEST(RegionMoments, ExactOnTheTriangleInPiecesOfAnyDegree) {
  for (int degree = 0; degree <= 2 * max_moment_degree; ++degree) {
    for (int g = 1; g <= 10; ++g) {
      const PieceTable table(g, degree);
      const std::vector<Vec2> corners = {{{0, 0}}, {{1, 0}}, {{0, 1}}};
      std::vector<Vec2> control;
      for (std::size_t k = 0; k < 3; ++k) {
        // Sides of degree g that run unevenly: quadratic in the parameter when there is room.
        for (int i = 0; i <= g; ++i) {
          const double t = g < 2 ? i : double(i) * (i + g - 1.0) / (2.0 * g * (g - 0.5));
          control.push_back(corners[k] + (corners[(k + 1) % 3] - corners[k]) * t);
        }
      }
      std::vector<MomentPiece> pieces;
      for (std::size_t k = 0; k < 3; ++k)
        pieces.push_back({control.data() + k * static_cast<std::size_t>(g + 1), &table});
      std::vector<double> moments(static_cast<std::size_t>(bernstein::triangle_size(degree)));
      region_moments(degree, pieces, moments.data());
      for (int b = 0; b <= degree; ++b) {
        for (int a = 0; a <= degree - b; ++a)
          EXPECT_NEAR(moments[at(degree, a, b)], triangle_moment(a, b), 4e-16)
              << "g " << g << " a " << a << " b " << b;
      }
    }
  }
}

}  // namespace
}  // namespace bezel::detail
