#pragma once
// Whether a point lies on a plane Bezier curve: where on it, or a proof that it does not.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

enum class CurveLocation : std::uint8_t {
  on,        ///< proven within the tolerance of the curve
  off,       ///< proven further away than the tolerance
  undecided  ///< neither within the work allowed; the contacts say where the curve may come that
             ///< near
};
/// Parameters where the curve is, or may be, within the tolerance.
struct CurveContact {
  double s;               ///< the nearest point seen
  double lo, hi;          ///< lo <= s <= hi
  double distance_bound;  ///< some parameter in [lo, hi] has at most this distance (tolerance > 0:
                          ///< s has); 0 when the point is exactly on the curve
  bool proven;            ///< distance_bound <= tolerance
};
struct CurveLocateResult {
  CurveLocation status;
  /// Ascending and disjoint. Every parameter whose distance is within the tolerance is in one of
  /// them.
  std::vector<CurveContact> contacts;
  double distance_lower_bound;  ///< off: no point of the curve is nearer than this; else 0
};

/// Locates a point on a curve.
///
/// With tolerance > 0 a contact is an interval, at its ends up to tolerance (1 + 1/32) away; a
/// contact that is not proven has a smallest distance between tolerance (1 - 1/32) and tolerance (1
/// + 1/32), or lies where rounding, (2 + 45 d) u max|b - p|, decides. With tolerance 0 incidence is
/// decided exactly, for control points and p as given: contacts are parameters (lo == hi) or
/// neighbouring doubles with the parameter strictly between.
///
/// @param curve      1 to 61 finite control points
/// @param p          finite
/// @param tolerance  distance, length units of the input, >= 0, finite
/// @return    off: distance_lower_bound > tolerance, as a rule at least half the distance when that
///            is larger; with tolerance 0 it is 0 where the distance is lost in rounding, yet
///            proven not to vanish
/// @throws    InputError for bad control points, point or tolerance
/// @limits    tolerance 0: a parameter that is no binary fraction of at most 120 bits is proven on
///            lines only (one coordinate of curve - p a multiple of the other); else such an
///            incidence is undecided. tolerance > 0: undecided after 20000 pieces
/// @cost      1 us at degree 3 when off, 9 us when on with a tolerance or exactly; 2 us, 23 us and
///            70 us at degree 10
/// @source    docs/methods/geometry.md
[[nodiscard]] CurveLocateResult locate(std::span<const Vec2> curve, const Vec2& p,
                                       double tolerance = 0.0);

}  // namespace bezel
