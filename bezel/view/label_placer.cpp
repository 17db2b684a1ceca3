#include "bezel/view/label_placer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace bezel::view {
namespace {

// What it costs to cover things: a label is worse than a marker, a marker worse than a line.
constexpr double label_cost = 400.0, disc_cost = 120.0, ink_cost = 4.0, outside_cost = 5000.0;

double overlap(const Box2& a, const Box2& b) {
  const double w = std::min(a.hi.x(), b.hi.x()) - std::max(a.lo.x(), b.lo.x());
  const double h = std::min(a.hi.y(), b.hi.y()) - std::max(a.lo.y(), b.lo.y());
  return w > 0.0 && h > 0.0 ? w * h : 0.0;
}

double area(const Box2& box) {
  return (box.hi.x() - box.lo.x()) * (box.hi.y() - box.lo.y());
}

}  // namespace

LabelPlacer::LabelPlacer(const Box2& frame)
    : frame_(frame),
      columns_(1 + static_cast<int>((frame.hi.x() - frame.lo.x()) / cell_)),
      rows_(1 + static_cast<int>((frame.hi.y() - frame.lo.y()) / cell_)),
      ink_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

void LabelPlacer::avoid(std::span<const Vec2> polyline) {
  const auto mark = [&](const Vec2& p) {
    if (!frame_.contains(p)) return;
    const auto column = static_cast<std::size_t>((p.x() - frame_.lo.x()) / cell_);
    const auto row = static_cast<std::size_t>((p.y() - frame_.lo.y()) / cell_);
    ink_[row * static_cast<std::size_t>(columns_) + column] = 1;
  };
  sums_.clear();
  for (std::size_t i = 0; i < polyline.size(); ++i) {
    if (i == 0) {
      mark(polyline[0]);
      continue;
    }
    const Vec2 a = polyline[i - 1], d = polyline[i] - a;
    const int steps = static_cast<int>(std::clamp(norm(d) / (0.5 * cell_), 1.0, 20000.0));
    for (int k = 1; k <= steps; ++k) mark(a + (static_cast<double>(k) / steps) * d);
  }
}

void LabelPlacer::avoid(const Vec2& centre, double radius) {
  discs_.push_back({centre, radius});
}

double LabelPlacer::ink_in(const Box2& box) {
  const std::size_t width = static_cast<std::size_t>(columns_) + 1;
  if (sums_.empty()) {
    sums_.assign(width * (static_cast<std::size_t>(rows_) + 1), 0);
    for (std::size_t r = 0; r < static_cast<std::size_t>(rows_); ++r)
      for (std::size_t c = 0; c + 1 < width; ++c)
        sums_[(r + 1) * width + c + 1] = ink_[r * (width - 1) + c] + sums_[r * width + c + 1] +
                                         sums_[(r + 1) * width + c] - sums_[r * width + c];
  }
  const auto cell = [](double x, int most) {
    return static_cast<std::size_t>(std::clamp(x / cell_, 0.0, static_cast<double>(most)));
  };
  const std::size_t c0 = cell(box.lo.x() - frame_.lo.x(), columns_),
                    c1 = cell(box.hi.x() - frame_.lo.x() + cell_, columns_),
                    r0 = cell(box.lo.y() - frame_.lo.y(), rows_),
                    r1 = cell(box.hi.y() - frame_.lo.y() + cell_, rows_);
  return static_cast<double>(sums_[r1 * width + c1] - sums_[r0 * width + c1] -
                             sums_[r1 * width + c0] + sums_[r0 * width + c0]);
}

double LabelPlacer::cost(const Box2& box, const Vec2& point) {
  double sum = ink_cost * ink_in(box);
  const double missing = 1.0 - overlap(box, frame_) / area(box);
  if (missing > 1e-9) sum += outside_cost * (0.1 + missing);
  for (const Box2& other : labels_)
    if (const double common = overlap(box, other); common > 0.0)
      sum += label_cost * (0.2 + common / area(box));
  for (const Disc& disc : discs_) {
    const Vec2 nearest{{std::clamp(disc.centre.x(), box.lo.x(), box.hi.x()),
                        std::clamp(disc.centre.y(), box.lo.y(), box.hi.y())}};
    if (norm(nearest - disc.centre) < disc.radius) {
      sum += disc_cost;
    } else if (disc.centre != point &&
               norm(box.centre() - disc.centre) < norm(box.centre() - point)) {
      sum += 0.3 * disc_cost;  // it would seem to belong to the other one
    }
  }
  return sum;
}

LabelPlacer::Place LabelPlacer::place(const Vec2& point, const Vec2& size, double clearance) {
  constexpr int directions = 16;
  constexpr std::array<double, 4> steps{0.0, 6.0, 14.0, 28.0};
  double least = INFINITY;
  Place best{point, false};
  Box2 best_box;
  for (const double step : steps)
    for (int k = 0; k < directions; ++k) {
      // Up to the right first.
      const double angle = 2.0 * std::numbers::pi * (k + 2) / directions;
      const Vec2 direction{{std::cos(angle), -std::sin(angle)}};
      // From the point along the direction until the box is clear of it.
      const double reach =
          clearance + step +
          0.5 * (std::fabs(direction.x()) * size.x() + std::fabs(direction.y()) * size.y());
      const Vec2 centre = point + reach * direction;
      Box2 box;
      box.include(centre - 0.5 * size);
      box.include(centre + 0.5 * size);
      const double c = cost(box, point) + 1.2 * step + 0.1 * k;
      if (c < least) {
        least = c;
        best = {centre, step > 10.0};
        best_box = box;
      }
    }
  labels_.push_back(best_box);
  return best;
}

LabelPlacer::Room LabelPlacer::room_at_side(const Vec2& size, double inset, double margin) {
  std::vector<Vec2> places{Vec2{{1.0, 0.0}}, Vec2{{0.0, 0.0}}, Vec2{{0.0, 1.0}}, Vec2{{1.0, 1.0}},
                           Vec2{{1.0, 0.5}}, Vec2{{0.0, 0.5}}, Vec2{{0.5, 0.0}}, Vec2{{0.5, 1.0}}};
  constexpr int steps = 8;
  for (int k = 1; k < steps; ++k) {
    const double f = static_cast<double>(k) / steps;
    for (const Vec2& p : {Vec2{{1.0, f}}, Vec2{{0.0, f}}, Vec2{{f, 0.0}}, Vec2{{f, 1.0}}})
      places.push_back(p);
  }
  const Vec2 around{{inset, inset}}, lo = frame_.lo + around, room = frame_.hi - size - around - lo;
  Room best{lo, true};
  double least = INFINITY;
  for (const Vec2& p : places) {
    const Vec2 corner{{lo.x() + p.x() * room.x(), lo.y() + p.y() * room.y()}};
    Box2 box;
    box.include(corner - Vec2{{margin, margin}});
    box.include(corner + size + Vec2{{margin, margin}});
    const double c = cost(box, box.centre());
    if (c >= least) continue;
    least = c;
    best = {corner, c > 0.0};
  }
  return best;
}

}  // namespace bezel::view
