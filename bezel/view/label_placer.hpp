#pragma once
// Internal to view: finds room for labels beside points.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel::view {

/// Puts boxes of text near points inside a frame, off lines, points and other labels as far as
/// there is room. All lengths in pixels.
class LabelPlacer {
 public:
  explicit LabelPlacer(const Box2& frame);
  /// A line that labels should not cover; outside the frame it does not matter.
  void avoid(std::span<const Vec2> polyline);
  /// A disc that labels should not cover.
  void avoid(const Vec2& centre, double radius);

  struct Place {
    Vec2 centre;  ///< of the label's box
    bool far;     ///< so far away that a line to its point helps
  };
  /// The best of 16 directions and 4 distances; later labels keep off it.
  /// @param clearance  from the point to the nearest label, at least
  Place place(const Vec2& point, const Vec2& size, double clearance);

  struct Room {
    Vec2 corner;   ///< the smaller coordinates of the box
    bool covered;  ///< whether the box covers lines, discs or labels
  };
  /// Where along the frame a box of this size covers least: in a corner, at the middle of a side,
  /// then elsewhere on the sides.
  /// @param inset   from the frame, at least
  /// @param margin  around the box that lines should not cross either
  Room room_at_side(const Vec2& size, double inset, double margin);

 private:
  struct Disc {
    Vec2 centre;
    double radius;
  };
  double ink_in(const Box2& box);
  double cost(const Box2& box, const Vec2& point);

  static constexpr double cell_ = 3.0;  // pixels of one cell of the grid of ink
  Box2 frame_;
  int columns_, rows_;
  std::vector<std::int32_t> ink_;   // points of lines in each cell
  std::vector<std::int64_t> sums_;  // over all cells before; empty: to be made
  std::vector<Disc> discs_;
  std::vector<Box2> labels_;
};

}  // namespace bezel::view
