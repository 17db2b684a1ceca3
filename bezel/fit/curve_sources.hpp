#pragma once
// Where smooth curves come from: formulas, polynomials, Bezier, B-spline and NURBS control points,
// and points to be joined.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/fit/smooth_curve.hpp"
#include "bezel/formula/formula.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

// Every function here is instantiated for dim = 2 and 3, and gives a curve on [-1, 1]: the natural
// parameter runs linearly from its first to its last value, which may be the smaller one. All
// throw InputError for values that are not finite, for an empty interval, and for what the
// constructor of SmoothCurve refuses (zero speed, ...).

/// The curve with one formula for each coordinate.
///
/// @param components  dim formulas, each of one and the same variable
/// @param breaks      values of the variable where a derivative jumps, in any order; those outside
///                    the interval do not count
/// @throws   InputError also for another number of formulas or variables
/// @accuracy derivatives are exact up to rounding (forward differentiation)
template <int dim>
SmoothCurve<dim> formula_curve(std::span<const Formula> components, double from, double to,
                               std::span<const double> breaks = {});

/// Coordinates a_0 + a_1 u + a_2 u^2 + ..., u from `from` to `to`.
///
/// @param coefficients  per power one point, 2 to 61 of them
template <int dim>
SmoothCurve<dim> polynomial_curve(std::span<const Vec<dim>> coefficients, double from, double to);

/// A Bezier curve of degree 1..60, rational when weights are given.
///
/// @param weights  none, or one per control point, all > 0
template <int dim>
SmoothCurve<dim> bezier_curve(std::span<const Vec<dim>> control,
                              std::span<const double> weights = {});

/// A B-spline curve, rational (NURBS) when weights are given, over all of its domain
/// knots[degree] .. knots[n]. Its breakpoints are the knots inside (at one of
/// multiplicity `degree` there may be a corner).
///
/// @param degree   1..30
/// @param knots    n + degree + 1, ascending, for n control points (at most 10000)
/// @param weights  none, or n, all > 0
/// @throws   InputError also for a knot inside of multiplicity above `degree`
/// @accuracy about 3 degree u of the largest control point per coordinate
/// @cost     (degree+1) degree^2 / 2 combinations per piece to build; 0.05 us per point at degree 3
template <int dim>
SmoothCurve<dim> nurbs_curve(int degree, std::span<const double> knots,
                             std::span<const Vec<dim>> control,
                             std::span<const double> weights = {});

/// What a spline does at its ends.
enum class SplineEnds : std::uint8_t {
  not_a_knot,  ///< the first two pieces are one cubic, and the last two: fourth order up to the
               ///< ends (three points: a parabola)
  natural,     ///< no second derivative at the ends: second order there
  closed       ///< from the last point to the first, twice continuously differentiable there
};

/// The cubic spline through points, twice continuously differentiable. The parameter grows from
/// one point to the next by the distance to the power `exponent`: 1 is chord length, 0.5
/// centripetal. Its breakpoints are the points inside.
///
/// @param points    2 to 10000 (closed: 3 at least; a last point equal to the first is left out),
///                  no two in a row equal
/// @param exponent  0..1
/// @throws   InputError also naming the first point that equals the one before it
/// @accuracy it passes through the points within 4 u of their size
template <int dim>
SmoothCurve<dim> spline_curve(std::span<const Vec<dim>> points,
                              SplineEnds ends = SplineEnds::not_a_knot, double exponent = 1.0);

/// The same curve from its end to its start.
template <int dim>
SmoothCurve<dim> reversed(const SmoothCurve<dim>& curve);

/// The curve p -> shift + scale R p, with R the rotation by `angle` (radians, counter-clockwise).
///
/// @param scale  not 0; a negative one also turns by pi
SmoothCurve<2> moved(const SmoothCurve<2>& curve, double scale, double angle, const Vec2& shift);

}  // namespace bezel
