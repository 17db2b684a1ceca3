// The nearest point of a curve: the smallest value of f(s) = |c(s) - p|^2, by best-first search.
//
// A part of the curve is done with when a bound of its distance to p says so, when f is monotonic
// on it (its ends are known then), or when f is convex on it (Newton's method finds the one
// minimum). Otherwise it is halved. All bounds come from the control points of the part.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/curve_check.hpp"
#include "bezel/geometry/curve_kernel.hpp"

namespace bezel {

using geometry_kernel::max_curve_points;

namespace {

constexpr int max_parts = 512;
constexpr double narrowest = 0x1p-30;  // parts in which f is neither monotonic nor convex
constexpr double same_foot = 0x1p-20;  // parameters closer than this are not two feet

struct Interval {
  double lo, hi;
};
Interval operator+(const Interval& a, const Interval& b) {
  return {a.lo + b.lo, a.hi + b.hi};
}
Interval operator*(const Interval& a, const Interval& b) {
  const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
  return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}
double smallest_square(const Interval& a) {
  const double distance = std::max(std::max(a.lo, -a.hi), 0.0);
  return distance * distance;
}
Interval x_of(const Box2& box) {
  return {box.lo.x(), box.hi.x()};
}
Interval y_of(const Box2& box) {
  return {box.lo.y(), box.hi.y()};
}

struct Jet {
  Vec2 value, first, second;
};
/// c(s), c'(s), c''(s) by de Casteljau, degree at least 1.
Jet curve_jet(int degree, const Vec2* c, double s) {
  const double r = 1.0 - s, d = degree;
  if (degree == 1) return {r * c[0] + s * c[1], c[1] - c[0], {}};
  const auto finish = [&](const Vec2& a, const Vec2& b, const Vec2& e) {
    const Vec2 p = r * a + s * b, q = r * b + s * e;
    return Jet{r * p + s * q, d * (q - p), d * (d - 1.0) * ((e - b) - (b - a))};
  };
  if (degree == 2) return finish(c[0], c[1], c[2]);
  geometry_kernel::PointBuffer<max_curve_points> storage;
  Vec2* w = storage.data();
  for (int i = 0; i < degree; ++i) w[i] = r * c[i] + s * c[i + 1];
  for (int n = degree - 1; n > 2; --n)
    for (int i = 0; i < n; ++i) w[i] = r * w[i] + s * w[i + 1];
  return finish(w[0], w[1], w[2]);
}

class Search {
 public:
  /// control: minus p, the largest coordinate `size` between 2^-200 and 2^200.
  Search(int degree, const Vec2* control, double size)
      : degree_(degree), control_(control), tie_((degree + 2) * 0x1p-53 * size) {}

  double run() {
    offer(0.0, control_[0]);
    offer(1.0, control_[degree_]);
    if (degree_ == 0 || settle(control_, 0.0, 1.0)) return foot_s_;
    split(control_, 0.0, 1.0);
    int parts = 1;
    for (; count_ > 0 && part_[0].lower <= limit_ && parts < max_parts; ++parts) {
      std::pop_heap(part_.begin(), part_.begin() + count_, further);
      const Part part = part_[static_cast<std::size_t>(--count_)];
      geometry_kernel::PointBuffer<max_curve_points> c;
      geometry_kernel::restrict_curve(degree_, control_, part.s0, part.s1, c.data());
      if (!settle(c.data(), part.s0, part.s1)) split(c.data(), part.s0, part.s1);
    }
    if (parts == max_parts || sample_squared_ < foot_squared_) {
      constexpr double width = 4.0 / max_parts;
      polish(std::max(0.0, sample_s_ - width), std::min(1.0, sample_s_ + width), sample_s_);
      // Nothing nearer than the sample, beyond rounding: then that is the answer.
      if (std::sqrt(sample_squared_) < std::sqrt(foot_squared_) - tie_) return sample_s_;
    }
    return foot_s_;
  }

 private:
  struct Part {
    double s0, s1;
    double lower;  // of f
  };
  static bool further(const Part& a, const Part& b) { return a.lower > b.lower; }

  /// A point of the curve, value = c(s) - p: an upper bound.
  void sample(double s, const Vec2& value) {
    const double squared = dot(value, value);
    if (squared >= sample_squared_) return;
    sample_squared_ = squared;
    sample_s_ = s;
    // What is only as far as this may be an equally near foot.
    const double distance = std::sqrt(squared) + tie_;
    limit_ = distance * distance;
  }
  /// A minimum on a part: an end of the curve or where Newton's method went.
  void offer(double s, const Vec2& value) {
    sample(s, value);
    const double squared = dot(value, value);
    const double difference = std::sqrt(squared) - std::sqrt(foot_squared_);
    const bool other = std::fabs(s - foot_s_) > same_foot && std::fabs(difference) <= tie_;
    if (other ? s < foot_s_ : squared < foot_squared_) {
      foot_squared_ = squared;
      foot_s_ = s;
    }
  }

  /// True when nothing more is to be found on [s0, s1] with control points c.
  bool settle(const Vec2* c, double s0, double s1) {
    const int d = degree_;
    geometry_kernel::PointBuffer<max_curve_points> storage;
    Vec2* h = storage.data();
    for (int i = 0; i < d; ++i) h[i] = c[i + 1] - c[i];
    const Box2 box = geometry_kernel::control_box(d, c);
    const Box2 first = geometry_kernel::control_box(d - 1, h);
    // f' / (2 d) = c . h
    const Interval slope = x_of(box) * x_of(first) + y_of(box) * y_of(first);
    if (slope.lo >= 0 || slope.hi <= 0) {
      if (slope.lo >= 0)
        offer(s0, c[0]);
      else
        offer(s1, c[d]);
      return true;
    }
    // f'' / (2 d) = d h . h + (d - 1) c . (second differences)
    double curvature = d * (smallest_square(x_of(first)) + smallest_square(y_of(first)));
    if (d >= 2) {
      for (int i = 0; i + 1 < d; ++i) h[i] = h[i + 1] - h[i];
      const Box2 second = geometry_kernel::control_box(d - 2, h);
      curvature += (d - 1) * (x_of(box) * x_of(second) + y_of(box) * y_of(second)).lo;
    }
    if (!(curvature > 0) && s1 - s0 > narrowest) return false;
    // Newton's method starts at the foot on the chord.
    const Vec2 chord = c[d] - c[0];
    const double length = dot(chord, chord);
    const double at = length > 0 ? -dot(c[0], chord) / length : 0.5;
    polish(s0, s1, s0 + std::clamp(at, 0.0, 1.0) * (s1 - s0));
    return true;
  }

  /// Halves the part and keeps what may hold a nearer point.
  void split(const Vec2* c, double s0, double s1) {
    geometry_kernel::PointBuffer<max_curve_points> left, right;
    geometry_kernel::halve(degree_, c, left.data(), right.data());
    const double middle = 0.5 * (s0 + s1);
    sample(middle, right.data()[0]);
    keep(left.data(), s0, middle);
    keep(right.data(), middle, s1);
  }
  void keep(const Vec2* c, double s0, double s1) {
    const double bound = lower_bound(c);
    if (bound > limit_) return;
    part_[static_cast<std::size_t>(count_++)] = {s0, s1, bound};
    std::push_heap(part_.begin(), part_.begin() + count_, further);
  }
  /// Of f on the part: by the box of the control points, and by the line across (c_0 + c_d) / 2
  /// seen from p, which is nearly tangential where the distance is smallest.
  double lower_bound(const Vec2* c) const {
    const Box2 box = geometry_kernel::control_box(degree_, c);
    const double by_box = smallest_square(x_of(box)) + smallest_square(y_of(box));
    const Vec2 across = c[0] + c[degree_];
    const double squared = dot(across, across);
    double nearest = squared;
    for (int i = 0; i <= degree_; ++i) nearest = std::min(nearest, dot(across, c[i]));
    return nearest > 0 ? std::max(by_box, nearest / squared * nearest) : by_box;
  }

  /// Newton's method on f' = 0, kept by bisection in [s0, s1] where f is convex.
  void polish(double s0, double s1, double s) {
    double lo = s0, hi = s1;
    bool lo_known = false, hi_known = false;
    Jet f = curve_jet(degree_, control_, s);
    for (int i = 0; i < 100; ++i) {
      const double slope = dot(f.value, f.first);
      const double curvature = dot(f.first, f.first) + dot(f.value, f.second);
      if (slope == 0) break;
      (slope > 0 ? hi : lo) = s;
      (slope > 0 ? hi_known : lo_known) = true;
      double next = curvature > 0 ? s - slope / curvature : slope > 0 ? lo : hi;
      const bool last = std::fabs(next - s) <= 1e-12;  // the error is of the order of its square
      if (!last && ((!(next > lo) && lo_known) || (!(next < hi) && hi_known)))
        next = 0.5 * (lo + hi);
      next = std::clamp(next, s0, s1);
      if (next == s) break;
      s = next;
      f = curve_jet(degree_, control_, s);
      if (last) break;
    }
    offer(s, f.value);
  }

  int degree_;
  const Vec2* control_;
  double tie_;  // distances that differ by less are equal
  double foot_s_ = 0.0, foot_squared_ = std::numeric_limits<double>::infinity();
  double sample_s_ = 0.0, sample_squared_ = std::numeric_limits<double>::infinity();
  double limit_ = std::numeric_limits<double>::infinity();  // of lower bounds still of interest
  std::array<Part, max_parts + 1> part_;  // a heap, the nearest first; a split adds at most one
  std::ptrdiff_t count_ = 0;
};

double largest_coordinate(std::span<const Vec2> points) {
  double largest = 0;
  for (const Vec2& p : points)
    largest = std::max(largest, std::max(std::fabs(p.x()), std::fabs(p.y())));
  return largest;
}

}  // namespace

FootPoint foot_point(std::span<const Vec2> curve, const Vec2& p) {
  geometry_kernel::checked_degree(curve);
  if (!std::isfinite(p.x()) || !std::isfinite(p.y())) throw InputError("the point is not finite");
  const int d = static_cast<int>(curve.size()) - 1;
  geometry_kernel::PointBuffer<max_curve_points> storage;
  Vec2* c = storage.data();
  const auto shifted = [&](double scale) {
    for (int i = 0; i <= d; ++i) c[i] = scale * curve[static_cast<std::size_t>(i)] - scale * p;
    return largest_coordinate({c, curve.size()});
  };
  double size = shifted(1.0);
  int exponent = 0;  // c = 2^-exponent (curve - p)
  if (!(size >= 0x1p-200 && size <= 0x1p200)) {
    if (size == 0) return {0.0, curve.front(), 0.0};
    if (!std::isfinite(size)) {
      size = shifted(0.25);
      exponent = 2;
    }
    const int shift = std::ilogb(size);
    for (int i = 0; i <= d; ++i)
      c[i] = Vec2{{std::ldexp(c[i].x(), -shift), std::ldexp(c[i].y(), -shift)}};
    size = std::ldexp(size, -shift);
    exponent += shift;
  }
  const double s = Search(d, c, size).run();
  const auto at = [&](const Vec2* b) {
    return s == 0.0 ? b[0] : s == 1.0 ? b[d] : geometry_kernel::curve_point(d, b, s).value;
  };
  const Vec2 value = at(c);
  const double squared = dot(value, value);
  double distance = squared > 0x1p-900 ? std::sqrt(squared) : std::hypot(value.x(), value.y());
  if (exponent != 0) distance = std::ldexp(distance, exponent);
  Vec2 point = at(curve.data());
  if (!std::isfinite(point.x()) || !std::isfinite(point.y())) {  // rounded up beyond the doubles
    constexpr double largest = std::numeric_limits<double>::max() / 4;
    for (int i = 0; i <= d; ++i) c[i] = 0.25 * curve[static_cast<std::size_t>(i)];
    const Vec2 quarter = at(c);
    point = 4.0 * Vec2{{std::clamp(quarter.x(), -largest, largest),
                        std::clamp(quarter.y(), -largest, largest)}};
  }
  return {s, point, distance};
}

}  // namespace bezel
