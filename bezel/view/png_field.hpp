#pragma once
// The pixels of a field: exact coverage of every element, colours by inverting the element map.

#include <vector>

#include "bezel/view/canvas.hpp"

namespace bezel::view {

/// Red, green, blue of each pixel, already blended with each other but not with what lies below,
/// and how much of the pixel the mesh covers.
struct FieldPixels {
  std::vector<double> rgb;    ///< 3 per pixel: the average colour where covered
  std::vector<double> cover;  ///< in [0, 1]
};

/// Where several elements share a pixel it gets their colours weighted by their exact areas in it.
/// Deterministic for any number of threads.
FieldPixels paint_field(const FieldPaint& paint, int width, int height);

}  // namespace bezel::view
