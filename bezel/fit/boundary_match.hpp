#pragma once
// Which part of which curve a boundary edge lies on.

#include <optional>
#include <span>
#include <vector>

#include "bezel/fit/smooth_curve.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::fit {

/// Finds parameters of points on one curve.
class CurveFeet {
 public:
  explicit CurveFeet(const SmoothCurve<2>& curve);

  /// Every parameter, ascending, where the distance to p is smallest nearby and within the
  /// tolerance. Ends and breakpoints of the curve that are within it stand for the places around.
  std::vector<double> feet(const Vec2& p, double tolerance) const;
  bool closed(double tolerance) const;
  const SmoothCurve<2>& curve() const { return curve_; }

 private:
  std::optional<double> nearest(const Vec2& p, double lo, double hi) const;

  SmoothCurve<2> curve_;
  std::vector<double> t_, reach_;  // ends of intervals, and their lengths
  std::vector<Vec2> x_;
  std::vector<double> special_;  // ends and breakpoints
};

/// A part of a curve between two parameters. Through the seam of a closed curve: from t0 up to 1
/// and on from -1 to t1 < t0.
struct CurvePart {
  std::size_t curve = 0;
  double t0 = 0.0, t1 = 0.0;
  bool seam = false;
  bool reversed = false;  ///< it runs from the second point to the first
  double length = 0.0;
};

/// The shortest part of one of the curves between two points that lie on it, at most 4 times as
/// long as their distance; nothing when there is none.
std::optional<CurvePart> find_part(std::span<const CurveFeet> curves, const Vec2& a, const Vec2& b,
                                   double tolerance);

/// The part as a curve of its own.
SmoothCurve<2> cut(const SmoothCurve<2>& curve, const CurvePart& part);

}  // namespace bezel::fit
