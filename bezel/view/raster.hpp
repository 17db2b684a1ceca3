#pragma once
// Coverage of pixels by areas and lines.

#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel::view {

/// Exact area of every pixel covered by polygons, inside a box of pixels that holds them all.
class AreaCoverage {
 public:
  /// Starts anew for polygons inside `box` (pixels).
  void reset(const Box2& box);
  /// One directed edge; a closed polygon is the sum of its edges. Clockwise on the screen (y down)
  /// counts positive.
  void edge(const Vec2& a, const Vec2& b);
  /// Sums up. Afterwards value() holds signed winding number times covered area.
  void finish();
  int x0() const { return x0_; }
  int y0() const { return y0_; }
  int width() const { return width_; }
  int height() const { return height_; }
  double value(int column, int row) const { return sum_[index(column, row)]; }

 private:
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width_ + 2) +
           static_cast<std::size_t>(column);
  }
  void row_edge(double xa, double xb, int row, double dy);

  int x0_ = 0, y0_ = 0, width_ = 0, height_ = 0;
  std::vector<double> sum_;
};

/// Coverage of pixels by line segments of one width with round ends; where segments overlap the
/// larger counts.
class LineCoverage {
 public:
  LineCoverage(const Box2& box, int image_width, int image_height, double line_width);
  void segment(const Vec2& a, const Vec2& b);
  int x0() const { return x0_; }
  int y0() const { return y0_; }
  int width() const { return width_; }
  int height() const { return height_; }
  double value(int column, int row) const {
    return static_cast<double>(
               peak_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                     static_cast<std::size_t>(column)]) *
           weight_;
  }

 private:
  int x0_ = 0, y0_ = 0, width_ = 0, height_ = 0;
  double half_, weight_;
  std::vector<float> peak_;
};

/// The dashes of a polyline: pieces of the given lengths, every second one left out.
std::vector<std::vector<Vec2>> cut_dashes(std::span<const Vec2> polyline,
                                          std::span<const double> dash);

}  // namespace bezel::view
