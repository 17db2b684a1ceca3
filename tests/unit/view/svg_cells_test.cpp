#include "bezel/view/svg_cells.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/meshes.hpp"

namespace bezel::view {
namespace {

TEST(MakeCells, ALinearFieldOnStraightTrianglesNeedsOneCellEach) {
  const auto mesh = test::grid_mesh(3, 1, 1.0, test::same_place);
  const Formula x("x");
  const Field field = project("x", Space::discontinuous(mesh, 1), {&x, 1});
  const ColourMap map("viridis");
  const FieldPaint paint{&field, 0, -1.0, 1.0, &map, {100.0, {{100.0, 100.0}}}};
  const auto cells = make_cells(paint);
  EXPECT_EQ(cells.size(), mesh->element_count());
  for (const Cell& cell : cells) {
    if (cell.flat) continue;
    // t runs from 0 at x = -1 (pixel 0) to 1 at x = 1 (pixel 200), along x only.
    EXPECT_NEAR(cell.from[0], 0.0, 1e-6);
    EXPECT_NEAR(cell.to[0], 200.0, 1e-6);
    EXPECT_NEAR(cell.to[1], cell.from[1], 1e-6);
  }
}

TEST(MakeCells, ABentFieldNeedsMoreAndStaysBounded) {
  const auto mesh = test::grid_mesh(3, 3, 1.0, test::bend(0.15, 0.12));
  const Formula wave("sin(9*x)*cos(8*y)");
  const Field field = project("w", Space::discontinuous(mesh, 6), {&wave, 1});
  const ColourMap map("viridis");
  const FieldPaint paint{&field, 0, -1.0, 1.0, &map, {300.0, {{300.0, 300.0}}}};
  const auto cells = make_cells(paint);
  EXPECT_GT(cells.size(), 20 * mesh->element_count());
  EXPECT_LE(cells.size(), 20000U);
  for (const Cell& cell : cells) EXPECT_FALSE(cell.outline.pieces().empty());
}

}  // namespace
}  // namespace bezel::view
