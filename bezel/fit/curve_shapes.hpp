#pragma once
// Named curves in the plane, each in a parameter that is regular everywhere on it.

#include <cstdint>
#include <string_view>

#include "bezel/fit/smooth_curve.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

// All throw InputError for values that are not finite or outside the range stated.

/// Part of the ellipse centre + R (a cos phi, b sin phi), phi from `from` to `to` (radians), R the
/// rotation by `angle`; a = b: an arc of a circle.
///
/// @param a, b      > 0
/// @param from, to  different, at most one turn apart, within 1e6 of 0
SmoothCurve<2> ellipse_arc(const Vec2& centre, double a, double b, double from, double to,
                           double angle = 0.0);

/// Part of the superellipse |x/a|^n + |y/b|^n = 1 around 0, from the direction `from` to `to`:
/// x = a r cos phi, y = b r sin phi with r = (|cos phi|^n + |sin phi|^n)^(-1/n). Breakpoints on the
/// axes unless n is even (derivatives above the n-th jump there).
///
/// @param n         exponent, 2..100: below 2 the curvature is infinite on the axes
/// @param from, to  different, at most one turn apart, within 1e6 of 0
SmoothCurve<2> superellipse_arc(double a, double b, double n, double from, double to);

/// The curve that starts at a point in the direction `heading` (radians), with a curvature that
/// grows linearly with arc length from `start_curvature` to `end_curvature` over `length` > 0. Its
/// speed is constant.
///
/// @accuracy 4 u of the length, times 1 + total turn
/// @cost     built at once with one step per radian of turn, at most 1e5 of them; then 0.3 us per
///           point
/// @throws   InputError also for more turn than that
SmoothCurve<2> clothoid(const Vec2& start, double heading, double start_curvature,
                        double end_curvature, double length);

enum class AerofoilPart : std::uint8_t {
  upper,  ///< from the nose to the trailing edge
  lower,  ///< from the nose to the trailing edge
  all     ///< from the trailing edge over the upper side, the nose, and the lower side
};
enum class TrailingEdge : std::uint8_t {
  blunt,  ///< the thickness of the original definition, 0.0021 of the chord thick at the edge for
          ///< 12 %
  sharp   ///< the last coefficient of the thickness is -0.1036 instead of -0.1015: it vanishes at
          ///< the edge
};
/// An aerofoil of the NACA four-digit series with chord [0, chord] on the x axis, thickness added
/// at right angles to the camber line. The parameter is the square root of x/chord along the chord,
/// in which the round nose is regular (x itself is not).
///
/// Breakpoints: the nose (for `all`), and where the two parabolas of the camber line meet; the
/// tangent turns there by a small angle (2412: 3e-4), as the definition has it.
///
/// @param digits  "0012": camber and its place, then the thickness in percent of the chord, 01..40;
///                camber and place are both 0 or both not
/// @source   [jacobs1933]
SmoothCurve<2> naca4(std::string_view digits, AerofoilPart side = AerofoilPart::all,
                     TrailingEdge edge = TrailingEdge::sharp, double chord = 1.0);

}  // namespace bezel
