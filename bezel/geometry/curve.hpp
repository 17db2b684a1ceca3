#pragma once
// Bezier curves in the plane and their intersections.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// A Bezier curve of degree 0..60 in the plane, owning its control points.
class Curve {
 public:
  /// @throws   InputError when there are no control points, more than 61, or one is not finite
  explicit Curve(std::vector<Vec2> control);
  int degree() const { return static_cast<int>(control_.size()) - 1; }
  std::span<const Vec2> control() const { return control_; }
  /// The point at s, by de Casteljau. @param s dimensionless; outside [0, 1] it extrapolates
  Vec2 operator()(double s) const;
  /// d/ds at s.
  Vec2 derivative(double s) const;
  Box2 box() const;  ///< of the control points: contains the curve
  /// Arc length, by Gauss rules with 16 points on adaptively halved pieces.
  ///
  /// @accuracy estimated, not proven: 1e-13 of the control polygon's length, also at cusps
  double length() const;

 private:
  std::vector<Vec2> control_;
};

/// One curve passes through the other, or an end point of one lies on the other.
///
/// An end point within the coincidence distance of the other curve gives s or t exactly 0 or 1
/// (both, when two end points are that close) and the other parameter from a computation that sees
/// only that point and the other curve: all edges ending in one vertex get the same bits on a
/// crossed edge.
struct Crossing {
  double s, t;            ///< parameters on the first and second curve, in [0, 1]
  double s_lo, s_hi;      ///< with t_lo, t_hi: box of the search around it, which holds no
  double t_lo, t_hi;      ///< other root when `certified`
  double condition;       ///< largest |coordinate| / (slower speed * sine of the angle)
  bool certified;         ///< proven simple and alone in its box
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

/// Every intersection of two curves.
///
/// With coincidence_distance = tol > 0 the answer is meant in a band of that width: end points
/// within tol are on the other curve; where the curves stay within tol of each other over a length
/// above 64 sqrt(tol * extent of the smaller) they overlap, and nothing else is reported there;
/// shorter encounters are one Crossing (the sides change) or one Tangency (they do not). With tol
/// = 0 end points count when within 2 u of the largest coordinate, overlaps when they agree to
/// that everywhere between two such end points, and other encounters by the signs of a distance
/// evaluated in doubled precision.
///
/// @param a, b control points, 1 to 61 each, finite; a curve whose control points coincide to
///          rounding counts as a point at parameter 0
/// @return   crossings, tangencies, overlaps in ascending s; overlaps are disjoint in s unless a
///           curve folds back; what could not be decided within 20000 boxes and 128 zooms into
///           nearly coincident parts, or where a curve is singular (a cusp on the other curve), is
///           in `unresolved` with the reason
/// @throws   InputError for bad control points or a negative or infinite distance
/// @accuracy crossings: parameters within 4 u condition up to a condition of 2^20; beyond that the
///           residuals are compensated: within 4 u up to a condition of 1/u or so, where it
///           converges (as a rule; else 4 u condition). Ends of an overlap inside the curves:
///           where the distance passes tol, known to tol / 128 from a measured (not proven)
///           interpolation error
/// @cost     quadratic mesh edges 0.05 us when apart, 0.2 us when crossing or identical; random
///           cubics 1 us; nearly coincident curves 5 to 40 us (one core); no allocation unless
///           pieces are nearly parallel
/// @limits   extents between 2^-480 and 2^480 (products must not overflow or vanish). Crossings
///           between nearly parallel pieces come from an interpolated distance, not `certified`
/// @source   docs/methods/geometry.md; the test for at most one root: [hermes2018] posed the
///           problem, the bound is Krawczyk's with the hodographs' control points
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
/// @throws   InputError when there are no control points, more than 61, or one is not finite
CurveCache cache_curve(std::span<const Vec2> control);

/// The same; `out` is cleared and its storage reused.
void intersect(std::span<const Vec2> a, std::span<const Vec2> b, const IntersectOptions& options,
               CurveIntersections& out);
void intersect(const CurveCache& a, const CurveCache& b, const IntersectOptions& options,
               CurveIntersections& out);

/// A point of a curve and its distance to the point asked for.
struct FootPoint {
  double s;
  Vec2 point;
  double distance;
};
/// The nearest point of a curve to p, end points included; of feet whose distances are equal to
/// (d + 2) u of the largest distance of a control point's coordinate from p's, the one with the
/// smallest s.
///
/// @param curve  control points, 1 to 61, finite
/// @param p      finite
/// @return   `distance` is infinite when it exceeds the largest double
/// @throws   InputError for bad control points, or when p is not finite
/// @accuracy distance within 4 (d + 1) u of the control points' coordinates' largest distance from
///           p (worst seen 0.2 of that); s within the same, times the largest speed, over half the
///           second derivative of the squared distance, so to its square root where that vanishes
/// @cost     0.3 us at degree 2, 0.5 us at degree 3, 2 us at degree 10 (half where the curve is
///           nearly straight); at most 512 parts of the curve are looked at (0.1 ms at degree 3, 3
///           ms at degree 60), used up only where the curve is nearly an arc about p: then the
///           answer is the nearest point seen
/// @source   docs/methods/geometry.md
FootPoint foot_point(std::span<const Vec2> curve, const Vec2& p);

}  // namespace bezel
