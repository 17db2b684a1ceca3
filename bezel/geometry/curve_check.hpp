#pragma once
// What the public functions on curves check at the door.

#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/curve_kernel.hpp"

namespace bezel::geometry_kernel {

/// Checks number and values of control points and returns the degree.
inline int checked_degree(std::span<const Vec2> curve) {
  if (curve.empty()) throw InputError("the curve has no control points, expected 1 to 61");
  if (curve.size() > static_cast<std::size_t>(max_curve_points))
    throw InputError("the curve has " + std::to_string(curve.size()) +
                     " control points, expected 1 to 61");
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (!std::isfinite(curve[i].x()) || !std::isfinite(curve[i].y()))
      throw InputError("control point " + std::to_string(i) + " of the curve is not finite");
  return static_cast<int>(curve.size()) - 1;
}

/// All that an intersection without a distance wants of a curve: its box, of unchecked points.
inline CurveCache box_cache(std::span<const Vec2> control) {
  CurveCache cache{};
  cache.control = control;
  cache.box = control_box(static_cast<int>(control.size()) - 1, control.data());
  cache.magnitude = largest_coordinate(cache.box);
  return cache;
}

inline void check_parameter(double s) {
  if (!std::isfinite(s)) throw InputError("the parameter is not finite");
}

inline void check_point(const Vec2& p) {
  if (!std::isfinite(p.x()) || !std::isfinite(p.y())) throw InputError("the point is not finite");
}

}  // namespace bezel::geometry_kernel
