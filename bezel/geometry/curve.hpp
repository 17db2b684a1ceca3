#pragma once
// Bezier curves in the plane and their intersections.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// A Bezier curve of degree >= 0 in the plane, owning its control points.
class Curve {
 public:
  explicit Curve(std::vector<Vec2> control);
  int degree() const { return static_cast<int>(control_.size()) - 1; }
  std::span<const Vec2> control() const { return control_; }
  Vec2 operator()(double s) const;
  Vec2 derivative(double s) const;
  Box2 box() const;  ///< of the control points
  double length() const;

 private:
  std::vector<Vec2> control_;
};

/// A certified simple root: one curve passes through the other (or an end point lies on it).
struct Crossing {
  double s, t;                    ///< parameters on the first and second curve, in [0, 1]
  double s_lo, s_hi, t_lo, t_hi;  ///< boxes known to hold exactly this root
  double condition;               ///< condition number of the parameters
  bool certified;
  Vec2 point_a, point_b;  ///< both curves there
  int sign;  ///< of cross(a', b'): +1 when b passes from right to left of a as t increases, -1 the
             ///< other way, 0 when tangential or unknown
};
/// The curves touch without being proven to cross.
struct Tangency {
  double s, t;
  int order;  ///< contact order where provable, 0 when not
};
/// The curves coincide (within the coincidence tolerance) on matching intervals.
struct Overlap {
  double s0, s1;  ///< s0 < s1 on the first curve
  double t0, t1;  ///< C2(t0) = C1(s0), C2(t1) = C1(s1); t0 > t1 when the directions are opposite
  double gap;     ///< largest distance seen between the two on the interval
};
struct UnresolvedBox {
  double s_lo, s_hi, t_lo, t_hi;
  std::string reason;
};

struct CurveIntersections {
  std::vector<Crossing> crossings;   ///< ascending s
  std::vector<Tangency> tangencies;  ///< ascending s
  std::vector<Overlap> overlaps;     ///< ascending s
  std::vector<UnresolvedBox> unresolved;
};

struct IntersectOptions {
  /// Distance (length units of the input) below which the curves count as coincident and an end
  /// point counts as lying on the other curve. 0: only exact coincidence (to rounding) is reported
  /// as Overlap.
  double coincidence_distance = 0.0;
};

/// Every intersection of two curves. Never a silent miss: what cannot be decided is `unresolved`.
CurveIntersections intersect(std::span<const Vec2> a, std::span<const Vec2> b,
                             const IntersectOptions& options = {});

/// What `intersect` wants to know of a curve again and again: for callers that meet one curve with
/// many. The control points are not copied: the span must outlive the cache.
struct CurveCache {
  std::span<const Vec2> control;
  Box2 box;                 ///< of the control points
  Vec2 chord;               ///< last minus first control point
  double chord_length;      ///< its length
  double band_lo, band_hi;  ///< range of cross(chord, c_i - c_0) over the control points
  double magnitude;         ///< largest |coordinate|
};
/// @throws InputError when there are no control points, more than 61, or one is not finite
CurveCache cache_curve(std::span<const Vec2> control);

/// The same; `out` is cleared and its storage reused.
void intersect(std::span<const Vec2> a, std::span<const Vec2> b, const IntersectOptions& options,
               CurveIntersections& out);
void intersect(const CurveCache& a, const CurveCache& b, const IntersectOptions& options,
               CurveIntersections& out);

/// The nearest point of a curve to p.
struct FootPoint {
  double s;
  Vec2 point;
  double distance;
};
FootPoint foot_point(std::span<const Vec2> curve, const Vec2& p);

}  // namespace bezel
