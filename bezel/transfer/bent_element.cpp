#include "bezel/transfer/bent_element.hpp"

#include <cmath>
#include <limits>

#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/geometry/curve.hpp"
#include "bezel/transfer/overlay_mesh.hpp"

namespace bezel::detail {
namespace {

/// From a place that is near along the element.
constexpr int most_steps = 20;

}  // namespace

void BentElement::set(int degree, std::span<const Vec2> control, const Vec2& centre) {
  degree_ = degree;
  map_ = round_map(control);
  control_.clear();
  in_plane_.clear();
  for (const Vec2& p : control) {
    control_.push_back(exact_step(centre, p));
    in_plane_.push_back(rounded(map_.step(control_.back())));
  }
  det_ = bent_jacobian(degree, control);
}

BentElement::Point BentElement::at(const Place& q) const {
  const auto point = bernstein::kernel::evaluate_gradient_unchecked<ExactVec2, DoubleDouble>(
      degree_, control_.data(), {DoubleDouble(1.0) - q[0] - q[1], q[0], q[1]});
  return {point.value, point.du, point.dv};
}

double BentElement::det(const std::array<double, 2>& q) const {
  return bernstein::kernel::evaluate_unchecked<double, double>(2 * (degree_ - 1), det_.data(),
                                                               {1.0 - q[0] - q[1], q[0], q[1]});
}

// A plane's roundings leave an error of about u times the diameter, most of it along the element.
// What Newton's method leaves of an error of length r is the bend over r, at most r^2 over the
// diameter, and has to be small beside the width.
bool BentElement::improve(const ExactVec2& x, Place& q) const {
  constexpr double small = 0x1p-60, far = 1e6;
  for (int step = 0; step < most_steps; ++step) {
    const Point point = at(q);
    const ExactVec2 left = x - point.value;
    const DoubleDouble det = cross(point.du, point.dv);
    if (det.hi == 0.0) return false;
    q[0] += cross(left, point.dv) / det;
    q[1] += cross(point.du, left) / det;
    if (!(std::abs(q[0].hi) + std::abs(q[1].hi) < far)) return false;
    const Vec2 off = rounded(left);
    if (dot(off, off) <= small * std::abs(det.hi)) return true;
  }
  return false;
}

BentElement::Place BentElement::nearest_on_sides(const Vec2& x) const {
  std::vector<Vec2> side(static_cast<std::size_t>(degree_) + 1);
  double least = std::numeric_limits<double>::infinity();
  Place best{};
  for (int k = 0; k < 3; ++k) {
    for (int m = 0; m <= degree_; ++m)
      side[static_cast<std::size_t>(m)] =
          in_plane_[static_cast<std::size_t>(bernstein::triangle_side_index(degree_, k, m))];
    const FootPoint foot = foot_point(side, x);
    if (!(foot.distance < least)) continue;
    least = foot.distance;
    const double s = foot.s, r = 1.0 - s;
    best = k == 0 ? Place{s, 0.0} : k == 1 ? Place{r, s} : Place{0.0, r};
  }
  return best;
}

// Beyond an element its bend, continued, has roots that are not wanted, and a start from the
// triangle of the corners is the bend over the width away. A place along the element is known from
// the nearest side.
bool BentElement::invert(const ExactVec2& x, Place& q, bool warm) const {
  constexpr double beyond = 4.0;
  const Vec2 there = rounded(map_.step(x));
  std::array<double, 3> lambda{1.0 - q[0].hi - q[1].hi, q[0].hi, q[1].hi};
  if (invert_map(degree_, in_plane_, there, lambda, warm) &&
      std::abs(lambda[1]) + std::abs(lambda[2]) < beyond) {
    q = {lambda[1], lambda[2]};
    if (improve(x, q)) return true;
  }
  q = nearest_on_sides(there);
  return improve(x, q);
}

}  // namespace bezel::detail
