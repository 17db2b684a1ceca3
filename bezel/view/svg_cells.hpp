#pragma once
// Curved cells on each of which a field is linear enough to be one SVG gradient.

#include <vector>

#include "bezel/view/canvas.hpp"

namespace bezel::view {

/// A part of an element with its paint: the map's colours from t = 0 at `from` to t = 1 at `to`, or
/// one colour.
struct Cell {
  Path outline;  ///< pixels; sides on element sides are exact Bezier curves
  bool flat = false;
  double t = 0.0;  ///< of a flat cell
  Vec2 from, to;   ///< pixels
};

/// Cuts every element into cells until a linear function of x and y is within 0.006 of t on each,
/// or they are smaller than 2 pixels. More than 20000 cells (and more than elements) relax the
/// 0.006, doubling it.
std::vector<Cell> make_cells(const FieldPaint& paint);

}  // namespace bezel::view
