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

/// A simple common point: one curve passes through the other; or an end point of one on the other.
///
/// End points, and only they, have s or t exactly 0 or 1. Without a coincidence distance they count
/// only when they are on the other curve exactly; all parameters are functions of the curves alone,
/// to the last bit where exact numbers were needed: edges ending in one vertex get the same bits on
/// a crossed edge. With a distance, an end point within it counts, and its parameter on the other
/// curve comes from a computation that sees only that point and that curve.
struct Crossing {
  double s, t;            ///< parameters on the first and second curve, in [0, 1]
  double s_lo, s_hi;      ///< with t_lo, t_hi: box around it, which holds no other root when
  double t_lo, t_hi;      ///< `certified`
  double condition;       ///< largest |coordinate| / (slower speed * sine of the angle); infinite
                          ///< for an end point that only touches
  bool certified;         ///< proven to exist, to be simple or an end point, and alone in its box
  Vec2 point_a, point_b;  ///< both curves there
  int sign;  ///< of cross(a', b'): +1 when b passes from right to left of a as t increases, -1 the
             ///< other way, 0 when tangential or unknown
};
/// The curves touch inside both.
struct Tangency {
  double s, t;
  int order;  ///< order of contact, the multiplicity of the common point: 2 touching, 3 osculating
              ///< and crossing (odd orders cross, even ones do not), ...; proven. With a
              ///< coincidence distance 0: unknown
  int sign = 0;  ///< of odd orders, as that of a Crossing: +1 when b passes from right to left of a
                 ///< as t increases, -1 the other way; proven. 0 for even and unknown orders
};
/// The curves coincide on matching intervals: exactly, or within the coincidence distance.
struct Overlap {
  double s0, s1;  ///< s0 < s1 on the first curve
  double t0, t1;  ///< C2(t0) = C1(s0), C2(t1) = C1(s1); t0 > t1 when the directions are opposite
  double gap;     ///< largest distance seen between the two on the interval; 0 when exact
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
  /// point counts as lying on the other curve; such answers are not `certified`, and `gap` says how
  /// far overlaps are apart. 0: no tolerance at all.
  double coincidence_distance = 0.0;
};

/// Every intersection of two curves.
///
/// With coincidence_distance 0 every verdict is a proof about the control points as given: no
/// tolerance, at any scale, however nearly parallel the curves are. With tol > 0 the answer is
/// meant in a band of that width: end points within tol are on the other curve; where the curves
/// stay within tol of each other over a length above 64 sqrt(tol * extent of the smaller) they
/// overlap, and nothing else is reported there; shorter encounters are one Crossing (the sides
/// change) or one Tangency (they do not).
///
/// @param a, b control points, 1 to 61 each, finite; a curve that is a point (with tol > 0: to
///          rounding) counts as its point at parameter 0
/// @return   crossings, tangencies, overlaps in ascending s; overlaps are disjoint in s unless a
///           curve folds back. What could not be decided is in `unresolved` with the reason: every
///           common point is in one of the lists
/// @throws   InputError for bad control points or a negative or infinite distance
/// @accuracy tol = 0: parameters within 4 u condition (1.5 seen) up to a condition of 2^20; beyond,
///           and for tangencies, overlaps and end points, the double nearest to the exact one.
///           tol > 0: crossings within 4 u condition up to 2^20, then compensated; ends of an
///           overlap inside the curves are where the distance passes tol, known to tol / 128 from
///           a measured (not proven) interpolation error
/// @cost     means on one core: random quadratics 0.3 us, cubics 0.4 us, quintics 1.5 us, no
///           allocation; each nearly parallel or touching place, and each end point on the other
///           curve that is no common end, 20 to 300 us more, in exact numbers. Quadratic mesh edges
///           with tol > 0: 0.05 us when apart, 0.2 us when crossing or identical. Bounded: 2000
///           boxes in doubles, 60000 / (product of the degrees) polynomials in exact numbers; up to
///           2 s for coordinates whose exponents are 2000 apart
/// @limits   tol = 0 leaves unresolved: contact of order two or more where a parameter is no
///           fraction of some 100 bits (on a straight curve it need not be), in boxes below 2^-50;
///           parts that coincide under a change of parameter that is not affine, unless on a
///           straight line; a cusp of one on a cusp of the other, or on a part that coincides when
///           its parameter is no fraction. tol > 0: crossings between nearly parallel pieces come
///           from an interpolated distance, not `certified`
/// @source   docs/methods/geometry.md; [hermes2018, ch. 2] posed the problem
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
  double diameter;          ///< of the box
  /// Range of the tangent of the angle from the chord to the derivative, for parameters from -1/4
  /// to 5/4; infinite where it reaches 90 degrees or the chord is a point.
  double slope_lo, slope_hi;
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
