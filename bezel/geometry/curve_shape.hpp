#pragma once
// Shape of plane Bezier curves: hodograph, frame, curvature, parts, degrees, nodes, tight box;
// closed chains of curves: winding number, area, centroid.
//
// A curve is given by its 1 to 61 control points, finite; parameters are dimensionless and finite.
// Every function checks both and throws InputError otherwise. u = 2^-53; control points are taken
// as exact.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bezel/geometry/curve.hpp"

namespace bezel {

/// Control points of the derivative curve, degree d-1 (degree 0: one zero vector); two roundings
/// each.
std::vector<Vec2> hodograph(std::span<const Vec2> curve);

/// The curve on [s0, s1] as a curve on [0, 1]; s0 > s1 reverses, outside [0, 1] it extrapolates.
/// @accuracy as bernstein::specialize: for s0, s1 in [0, 1] within 3 d u max|b| per coordinate
std::vector<Vec2> specialize(std::span<const Vec2> curve, double s0, double s1);

/// The parts on [0, s] and [s, 1]; they share the point at s bit for bit.
/// @throws    also InputError when s is outside [0, 1]
std::pair<std::vector<Vec2>, std::vector<Vec2>> split(std::span<const Vec2> curve, double s);

/// The same curve with degree d + by <= 60. @accuracy within 4 by u max|b|
std::vector<Vec2> elevate(std::span<const Vec2> curve, int by = 1);

/// A curve of degree d - by.
struct ReducedCurve {
  std::vector<Vec2> control;
  double error_bound;  ///< no point moves further than this: |b(s) - control(s)| for s in [0, 1]
};
/// Lowers the degree: the best approximation in L2, coordinate by coordinate; 0 <= by <= d. End
/// points move too unless the degree was elevated.
///
/// @accuracy  error_bound is proven (from the difference of control points at equal degree), and at
///            rounding, 16 (d+1) by u max|b|, when the curve is one of degree d - by
ReducedCurve reduce(std::span<const Vec2> curve, int by = 1);

/// The points at s = i/d, i = 0..d, through which the curve is the Lagrange interpolant, and back.
/// @accuracy  as bernstein::to_lagrange and from_lagrange: the latter amplifies the rounding of the
///            nodes, 2e2 times at d = 10, 2e7 times at d = 20
std::vector<Vec2> to_nodes(std::span<const Vec2> curve);
std::vector<Vec2> from_nodes(std::span<const Vec2> nodes);

enum class SpeedStatus : std::uint8_t {
  regular,   ///< the derivative does not vanish (frame, curvature)
  singular,  ///< it vanishes exactly: a cusp, an inflection of higher order or the like
  point      ///< all derivatives vanish: the curve is a point
};

/// Directions of a curve at a parameter.
struct CurveFrame {
  SpeedStatus status;
  Vec2 tangent;         ///< unit; singular: its limit from larger parameters; point: zero
  Vec2 normal;          ///< tangent turned left by a right angle
  Vec2 tangent_before;  ///< the limit from smaller parameters: -tangent where `order` is even
  int order;            ///< of the first derivative that does not vanish; point: 0
};
/// Unit tangent and normal at s; outside [0, 1] of the extended curve.
///
/// @return    where the derivative vanishes, exactly decided, the direction of the first one that
///            does not: the limit of the tangents
/// @accuracy  each coordinate within 6 u of the exact unit vector, 1.6 u seen
/// @cost      one de Casteljau in double-double; exact arithmetic where that cannot tell, and
///            outside [0, 1]
CurveFrame frame(std::span<const Vec2> curve, double s);

struct CurvatureResult {
  SpeedStatus status;
  double value;  ///< signed, positive where the curve turns left, 1/length; NaN unless regular
};
/// cross(b', b'') / |b'|^3.
///
/// @accuracy  16 u relative, 6.8 u seen, however small or ill-conditioned: exactly 0 only where it
///            is 0. Overflow gives an infinity, values below 2^-1022 are rounded to subnormals
/// @cost      as frame
CurvatureResult curvature(std::span<const Vec2> curve, double s);

/// The box of the curve itself, not of its control points.
///
/// @return    a box that contains the exact curve: extrema at proven roots of each coordinate's
///            derivative, evaluated exactly, rounded outwards
/// @accuracy  each side is the true extremum rounded outwards, after adding the sum of the rounding
///            errors of the differences b_{i+1} - b_i (zero when these are doubles, else at most u
///            times the variation of the coordinates)
/// @cost      the roots of two polynomials and an exact value for each: 8 us for cubics, 0.1 ms at
///            degree 10, 2 ms at degree 60
Box2 tight_box(std::span<const Vec2> curve);

// ---- Closed chains: each curve begins at the very point where the one before ends, the first
// ---- where the last ends. They throw InputError when the chain is empty or does not close.

enum class WindingStatus : std::uint8_t {
  proven,    ///< value is the winding number
  on_curve,  ///< the point lies on a curve of the chain, proven
  undecided  ///< neither could be shown: on the curve, or within rounding of 2^-120 of a parameter
};
struct WindingNumber {
  WindingStatus status;
  int value;          ///< counter-clockwise turns; 0 unless proven
  std::size_t curve;  ///< on_curve, undecided: the first curve that is to blame
};
/// How often a closed chain goes round p, decided by exact signs.
///
/// @limits    undecided only where both coordinates may share a root that is not a double: see
///            `locate` in curve_locate.hpp
/// @cost      0.2 us per cubic away from p; exact arithmetic where p is within rounding of a curve:
///            60 us for cubics, 20 ms at degree 60
WindingNumber winding_number(std::span<const Curve> chain, const Vec2& p);

struct ChainArea {
  double area;         ///< signed: positive when counter-clockwise
  double error_bound;  ///< |area - exact area| <= error_bound
  Vec2 centroid;       ///< of the region weighted with the winding number
  bool has_centroid;   ///< false when |area| <= 2 error_bound: the centroid is left at zero
};
/// Area and centroid of what a closed chain encloses, each part counted with its winding number.
///
/// @accuracy  error_bound is the sum of 40 d (d+1) u r^2 over the curves, r the largest coordinate
///            relative to the chain's first point, 0.002 of it seen. Centroid: within
///            error_bound r / |area| or so, not proven
/// @cost      Gauss rules with 3 d / 2 points or so for each curve
ChainArea area_and_centroid(std::span<const Curve> chain);

}  // namespace bezel
