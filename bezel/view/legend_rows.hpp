#pragma once
// Internal to view: a legend outside the frame of a picture.

#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel::view {

/// Where the entries of a legend stand, in rows from left to right, and how many rows that makes.
struct LegendRows {
  std::vector<Vec2> places;
  int count = 0;
};

/// @param widths  of the entries, with the room between them
/// @param first   place of the first entry
/// @param right   x that no entry crosses, unless it is wider than a row
/// @param height  from row to row
inline LegendRows legend_rows(std::span<const double> widths, const Vec2& first, double right,
                              double height) {
  LegendRows out;
  Vec2 at = first;
  for (const double width : widths) {
    if (at.x() > first.x() && at.x() + width > right) at = Vec2{{first.x(), at.y() + height}};
    if (at.x() == first.x()) ++out.count;
    out.places.push_back(at);
    at = at + Vec2{{width, 0.0}};
  }
  return out;
}

}  // namespace bezel::view
