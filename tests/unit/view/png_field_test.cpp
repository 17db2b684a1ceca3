#include "bezel/view/png_field.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.hpp"

namespace bezel::view {
namespace {

// A curved mesh of [-1, 1]^2 on 200 x 200 pixels; the field x is the same through any element map.
TEST(PaintField, EveryPixelHasTheColourOfTheFieldThere) {
  for (int g = 1; g <= 4; ++g) {
    const auto mesh = test::grid_mesh(4, g, 1.0, test::bend(0.15, 0.12));
    const Formula x("x");
    const Field field = project("x", Space::discontinuous(mesh, 2, Basis::physical), {&x, 1});
    const ColourMap map("grey");
    const FieldPaint paint{&field, 0, -1.0, 1.0, &map, {100.0, {{100.0, 100.0}}}};
    const FieldPixels pixels = paint_field(paint, 200, 200);
    ASSERT_EQ(pixels.rgb.size(), 3U * 200 * 200);
    double worst = 0.0;
    for (int row = 0; row < 200; ++row) {
      for (int column = 0; column < 200; ++column) {
        const auto i = static_cast<std::size_t>(row * 200 + column);
        EXPECT_NEAR(pixels.cover[i], 1.0, 1e-6) << row << " " << column;  // no pinholes
        const double expected = map((column + 0.5) / 200.0).r;
        worst = std::max(worst, std::abs(pixels.rgb[3 * i] - expected));
      }
    }
    EXPECT_LE(worst, 2.0 / 255.0) << g;
  }
}

}  // namespace
}  // namespace bezel::view
