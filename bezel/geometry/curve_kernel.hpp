#pragma once
// Raw kernels on a plane curve's control points: unchecked, on the stack, for the inner loops of
// geometry.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

inline constexpr int max_curve_points = bernstein::max_interval_degree + 1;

/// Room for N points on the stack, not set to zero (a Vec2 is an implicit-lifetime aggregate).
template <int N>
class PointBuffer {
 public:
  Vec2* data() { return std::launder(reinterpret_cast<Vec2*>(raw_)); }

 private:
  alignas(Vec2) std::byte raw_[static_cast<std::size_t>(N) * sizeof(Vec2)];
};

struct CurvePoint {
  Vec2 value, derivative;
};

template <int N>
CurvePoint curve_point_fixed(int degree, const Vec2* b, double s, const Vec2& origin) {
  PointBuffer<N> storage;
  Vec2* q = storage.data();
  for (int i = 0; i <= degree; ++i) q[i] = b[i] - origin;
  const double r = 1.0 - s;
  for (int d = degree; d >= 2; --d)
    for (int i = 0; i < d; ++i) q[i] = r * q[i] + s * q[i + 1];
  return {r * q[0] + s * q[1], static_cast<double>(degree) * (q[1] - q[0])};
}

/// Value minus origin, and derivative, by de Casteljau on b - origin (accurate near the origin).
inline CurvePoint curve_point(int degree, const Vec2* b, double s, const Vec2& origin = {}) {
  const double r = 1.0 - s;
  switch (degree) {
    case 0:
      return {b[0] - origin, {}};
    case 1:
      return {r * (b[0] - origin) + s * (b[1] - origin), b[1] - b[0]};
    case 2: {
      const Vec2 q0 = b[0] - origin, q1 = b[1] - origin, q2 = b[2] - origin;
      const Vec2 p0 = r * q0 + s * q1, p1 = r * q1 + s * q2;
      return {r * p0 + s * p1, 2.0 * (p1 - p0)};
    }
    case 3: {
      const Vec2 q0 = b[0] - origin, q1 = b[1] - origin, q2 = b[2] - origin, q3 = b[3] - origin;
      const Vec2 p0 = r * q0 + s * q1, p1 = r * q1 + s * q2, p2 = r * q2 + s * q3;
      const Vec2 w0 = r * p0 + s * p1, w1 = r * p1 + s * p2;
      return {r * w0 + s * w1, 3.0 * (w1 - w0)};
    }
    default:
      break;
  }
  return degree < 12 ? curve_point_fixed<12>(degree, b, s, origin)
                     : curve_point_fixed<max_curve_points>(degree, b, s, origin);
}

/// Halves a curve: left and right get degree+1 points each; left[degree] == right[0].
/// D: the degree when known at compile time, else 0.
template <int D = 0>
inline void halve(int run_time_degree, const Vec2* b, Vec2* left, Vec2* right) {
  const int degree = D > 0 ? D : run_time_degree;
  for (int i = 0; i <= degree; ++i) right[i] = b[i];
  left[0] = right[0];
  for (int r = 1; r <= degree; ++r) {
    for (int i = 0; i <= degree - r; ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
    left[r] = right[0];
  }
}

/// The curve on [s0, s1] into out (degree+1 points): two de Casteljau splits.
inline void restrict_curve(int degree, const Vec2* b, double s0, double s1, Vec2* out) {
  for (int i = 0; i <= degree; ++i) out[i] = b[i];
  if (s1 != 1.0) {  // keep the left part of the split at s1
    const double r = 1.0 - s1;
    for (int k = 1; k <= degree; ++k)
      for (int i = degree; i >= k; --i) out[i] = r * out[i - 1] + s1 * out[i];
  }
  const double s = s1 == 0.0 ? 0.0 : s0 / s1;
  if (s != 0.0) {  // keep the right part of the split at s0 / s1
    const double r = 1.0 - s;
    for (int k = 1; k <= degree; ++k)
      for (int i = 0; i <= degree - k; ++i) out[i] = r * out[i] + s * out[i + 1];
  }
}

inline Box2 control_box(int degree, const Vec2* b) {
  double lo_x = b[0].x(), hi_x = lo_x, lo_y = b[0].y(), hi_y = lo_y;
  for (int i = 1; i <= degree; ++i) {
    const double x = b[i].x(), y = b[i].y();
    lo_x = x < lo_x ? x : lo_x;
    hi_x = x > hi_x ? x : hi_x;
    lo_y = y < lo_y ? y : lo_y;
    hi_y = y > hi_y ? y : hi_y;
  }
  Box2 box;
  box.lo = Vec2{{lo_x, lo_y}};
  box.hi = Vec2{{hi_x, hi_y}};
  return box;
}

inline double largest_coordinate(const Box2& box) {
  return std::max(std::max(std::fabs(box.lo.x()), std::fabs(box.hi.x())),
                  std::max(std::fabs(box.lo.y()), std::fabs(box.hi.y())));
}

}  // namespace bezel::geometry_kernel
