#include "bezel/view/raster.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bezel/base/random.hpp"

namespace bezel::view {
namespace {

TEST(AreaCoverage, SumsToTheAreaOfThePolygon) {
  RandomStream random("area coverage", 1);
  for (int i = 0; i < 50; ++i) {
    std::array<Vec2, 3> p;
    Box2 box;
    for (Vec2& q : p) {
      q = Vec2{{random.uniform(0, 40), random.uniform(0, 30)}};
      box.include(q);
    }
    AreaCoverage area;
    area.reset(box);
    for (std::size_t k = 0; k < 3; ++k) area.edge(p[k], p[(k + 1) % 3]);
    area.finish();
    double sum = 0.0;
    for (int y = 0; y < area.height(); ++y) {
      for (int x = 0; x < area.width(); ++x) sum += area.value(x, y);
    }
    EXPECT_NEAR(std::abs(sum), 0.5 * std::abs(cross(p[1] - p[0], p[2] - p[0])), 1e-9);
  }
}

TEST(AreaCoverage, APixelInsideIsFullAndOutsideEmpty) {
  AreaCoverage area;
  const std::array<Vec2, 4> p = {{{{1.5, 1.0}}, {{4.0, 1.0}}, {{4.0, 3.0}}, {{1.5, 3.0}}}};
  Box2 box;
  for (const Vec2& q : p) box.include(q);
  area.reset(box);
  for (std::size_t k = 0; k < 4; ++k) area.edge(p[k], p[(k + 1) % 4]);
  area.finish();
  const auto at = [&](int x, int y) { return std::abs(area.value(x - area.x0(), y - area.y0())); };
  EXPECT_NEAR(at(1, 1), 0.5, 1e-12);
  EXPECT_NEAR(at(2, 2), 1.0, 1e-12);
  EXPECT_NEAR(at(3, 1), 1.0, 1e-12);
}

TEST(LineCoverage, CoversTheLineAndNothingElse) {
  Box2 box;
  box.include({{2, 10}});
  box.include({{30, 10}});
  LineCoverage line(box, 40, 20, 2.0);
  line.segment({{2, 10}}, {{30, 10}});
  const auto at = [&](int x, int y) { return line.value(x - line.x0(), y - line.y0()); };
  EXPECT_NEAR(at(15, 9), 1.0, 0.01);
  EXPECT_NEAR(at(15, 10), 1.0, 0.01);
  for (int y = line.y0(); y < line.y0() + line.height(); ++y) {
    if (y < 8 || y > 11) {
      EXPECT_EQ(at(15, y), 0.0);
    }
  }
}

TEST(CutDashes, LeavesEverySecondPieceOut) {
  const std::array<Vec2, 2> line = {{{{0, 0}}, {{10, 0}}}};
  const std::array<double, 2> dash = {3.0, 2.0};
  const auto pieces = cut_dashes(line, dash);
  ASSERT_EQ(pieces.size(), 2U);
  EXPECT_NEAR(pieces[0].back()[0], 3.0, 1e-12);
  EXPECT_NEAR(pieces[1].front()[0], 5.0, 1e-12);
  EXPECT_NEAR(pieces[1].back()[0], 8.0, 1e-12);
}

}  // namespace
}  // namespace bezel::view
