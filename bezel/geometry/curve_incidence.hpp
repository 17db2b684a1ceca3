#pragma once
// Exact position of a point relative to one curve: the pieces of an exact search, shared by
// winding numbers and location. Internal.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "bezel/numeric/dyadic.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

/// A parameter, or a place between neighbouring doubles (or within 2^-120), where the curve meets a
/// point.
struct Incidence {
  double lo, hi;  ///< lo == hi: exactly there; else strictly between
  bool proven;    ///< false: common roots of both coordinates could not be excluded there
};

struct PointOnCurve {
  std::vector<Incidence> incidences;  ///< ascending; empty: the point is proven off the curve
  /// Crossings of the horizontal ray from p to the right, upwards minus downwards, a point of the
  /// curve at the height of p counting as below it. Meaningful when there are no incidences.
  int ray_crossings = 0;
};

/// curve: 1 to 61 finite control points; p finite; both unchecked.
///
/// Pieces whose coordinates, minus p, keep a sign are done: first in doubles with a bound of their
/// rounding, then exactly, 75 halvings beyond the 45 in doubles at most.
PointOnCurve point_on_curve(std::span<const Vec2> curve, const Vec2& p);

/// The exact point of a curve at a parameter: rounded, and exact when asked.
class ExactCurvePoint {
 public:
  /// curve: 1 to 61 finite control points, which must outlive this; s in [0, 1].
  ExactCurvePoint(std::span<const Vec2> curve, double s);
  const Vec2& rounded() const { return rounded_; }
  double error() const { return error_; }  ///< bound of each coordinate's
  const std::array<Dyadic, 2>& exact() const;

 private:
  std::span<const Vec2> curve_;
  double s_;
  Vec2 rounded_;
  double error_;
  mutable std::optional<std::array<Dyadic, 2>> exact_;
};

/// The same for a point that is not a pair of doubles.
PointOnCurve point_on_curve(std::span<const Vec2> curve, const ExactCurvePoint& p);

/// Where the derivative of a curve of degree >= 1 vanishes, by the same search.
std::vector<Incidence> vanishing_speed(std::span<const Vec2> curve);

}  // namespace bezel::geometry_kernel
