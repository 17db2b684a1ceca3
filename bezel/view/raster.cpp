#include "bezel/view/raster.hpp"

#include <algorithm>
#include <cmath>

namespace bezel::view {

void AreaCoverage::reset(const Box2& box) {
  // Also the pixel after the last one, for edges that run exactly along its border.
  x0_ = static_cast<int>(std::floor(box.lo.x()));
  y0_ = static_cast<int>(std::floor(box.lo.y()));
  width_ = static_cast<int>(std::floor(box.hi.x())) - x0_ + 1;
  height_ = static_cast<int>(std::floor(box.hi.y())) - y0_ + 1;
  sum_.assign(static_cast<std::size_t>(width_ + 2) * static_cast<std::size_t>(height_), 0.0);
}

// An edge within one row of pixels, from xa to xb (relative to x0), rising by dy. Every pixel gets
// the part of dy times the width to its right that the edge cuts; the running sum of finish()
// carries the rest on.
void AreaCoverage::row_edge(double xa, double xb, int row, double dy) {
  if (xa > xb) std::swap(xa, xb);
  const double limit = width_;
  xa = std::clamp(xa, 0.0, limit);
  xb = std::clamp(xb, 0.0, limit);
  const int first = static_cast<int>(xa), last = static_cast<int>(xb);
  if (first == last) {
    const double right = 1.0 - (0.5 * (xa + xb) - first);
    sum_[index(first, row)] += dy * right;
    sum_[index(first + 1, row)] += dy * (1.0 - right);
    return;
  }
  const double slope = dy / (xb - xa);
  double done = 0.0;  // coverage given to pixels so far
  double carried = 0.0;
  for (int column = first; column <= last; ++column) {
    const double from = std::max(xa, static_cast<double>(column)) - column;
    const double to = std::min(xb, column + 1.0) - column;
    const double rise = slope * (to - from);
    const double cover = carried + rise * (1.0 - 0.5 * (from + to));
    sum_[index(column, row)] += cover - done;
    done = cover;
    carried += rise;
  }
  sum_[index(last + 1, row)] += dy - done;
}

void AreaCoverage::edge(const Vec2& a, const Vec2& b) {
  if (a.y() == b.y()) return;
  // Always from top to bottom, so that an edge and its reverse cancel exactly.
  const double sign = a.y() < b.y() ? -1.0 : 1.0;
  const Vec2 top = a.y() < b.y() ? a : b, bottom = a.y() < b.y() ? b : a;
  const double ya = std::clamp(top.y() - y0_, 0.0, static_cast<double>(height_));
  const double yb = std::clamp(bottom.y() - y0_, 0.0, static_cast<double>(height_));
  const double slope = (bottom.x() - top.x()) / (bottom.y() - top.y());
  const auto x_at = [&](double y) { return top.x() - x0_ + slope * (y + y0_ - top.y()); };
  const int first = static_cast<int>(ya), last = std::min(static_cast<int>(yb), height_ - 1);
  for (int row = first; row <= last; ++row) {
    const double from = std::max(ya, static_cast<double>(row)), to = std::min(yb, row + 1.0);
    if (to > from) row_edge(x_at(from), x_at(to), row, sign * (to - from));
  }
}

void AreaCoverage::finish() {
  for (int row = 0; row < height_; ++row) {
    double sum = 0.0;
    for (int column = 0; column < width_ + 2; ++column) {
      double& value = sum_[index(column, row)];
      sum += value;
      value = sum;
    }
  }
}

LineCoverage::LineCoverage(const Box2& box, int image_width, int image_height, double line_width)
    : half_(0.5 * line_width) {
  const double reach = half_ + 1.0;
  const auto bound = [](double value, int limit) {
    return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(limit)));
  };
  x0_ = bound(box.lo.x() - reach, image_width);
  y0_ = bound(box.lo.y() - reach, image_height);
  width_ = bound(box.hi.x() + reach + 1.0, image_width) - x0_;
  height_ = bound(box.hi.y() + reach + 1.0, image_height) - y0_;
  // The ramp of a line narrower than a pixel has the area (half + 1/2)^2 instead of 2 half.
  weight_ = half_ < 0.5 ? 2.0 * half_ / ((half_ + 0.5) * (half_ + 0.5)) : 1.0;
  peak_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0.0f);
}

void LineCoverage::segment(const Vec2& a, const Vec2& b) {
  const double reach = half_ + 0.5;
  const Vec2 d = b - a;
  const double length_squared = dot(d, d);
  const double y_lo = std::min(a.y(), b.y()) - reach, y_hi = std::max(a.y(), b.y()) + reach;
  const int first = std::max(0, static_cast<int>(std::floor(y_lo - y0_ - 0.5)));
  const int last = std::min(height_ - 1, static_cast<int>(std::ceil(y_hi - y0_ - 0.5)));
  for (int row = first; row <= last; ++row) {
    const double y = y0_ + row + 0.5;
    // The part of the segment within reach of this row bounds the columns.
    double t0 = 0.0, t1 = 1.0;
    if (d.y() != 0.0) {
      const double ta = (y - reach - a.y()) / d.y(), tb = (y + reach - a.y()) / d.y();
      t0 = std::clamp(std::min(ta, tb), 0.0, 1.0);
      t1 = std::clamp(std::max(ta, tb), 0.0, 1.0);
    }
    const double xa = a.x() + t0 * d.x(), xb = a.x() + t1 * d.x();
    const int left =
        std::max(0, static_cast<int>(std::floor(std::min(xa, xb) - reach - x0_ - 0.5)));
    const int right =
        std::min(width_ - 1, static_cast<int>(std::ceil(std::max(xa, xb) + reach - x0_ - 0.5)));
    for (int column = left; column <= right; ++column) {
      const Vec2 p = Vec2{{x0_ + column + 0.5, y}} - a;
      const double t =
          length_squared > 0.0 ? std::clamp(dot(p, d) / length_squared, 0.0, 1.0) : 0.0;
      const double cover = std::clamp(reach - norm(p - t * d), 0.0, 1.0);
      float& peak = peak_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                          static_cast<std::size_t>(column)];
      peak = std::max(peak, static_cast<float>(cover));
    }
  }
}

std::vector<std::vector<Vec2>> cut_dashes(std::span<const Vec2> polyline,
                                          std::span<const double> dash) {
  std::vector<std::vector<Vec2>> out;
  if (polyline.empty()) return out;
  std::size_t k = 0;
  double left = dash[0];
  bool on = true;
  out.push_back({polyline[0]});
  for (std::size_t i = 1; i < polyline.size(); ++i) {
    Vec2 from = polyline[i - 1];
    double length = norm(polyline[i] - from);
    while (length > left) {
      from += (left / length) * (polyline[i] - from);
      length -= left;
      if (on) {
        out.back().push_back(from);
      } else {
        out.push_back({from});
      }
      on = !on;
      k = (k + 1) % dash.size();
      left = dash[k];
    }
    left -= length;
    if (on) out.back().push_back(polyline[i]);
  }
  return out;
}

}  // namespace bezel::view
