#pragma once
// Cusps and self-intersections of a plane Bezier curve.

#include <span>
#include <vector>

#include "bezel/geometry/curve.hpp"

namespace bezel {

/// A parameter where the speed vanishes.
struct Cusp {
  double s;       ///< lo
  double lo, hi;  ///< lo == hi: exactly there; else strictly between neighbouring doubles
  bool proven;    ///< false: that both derivatives vanish there could not be excluded
};

struct SelfIntersections {
  bool closed;              ///< the curve ends where it begins, exactly; not among the crossings
  std::vector<Cusp> cusps;  ///< ascending; also where the curve only stops and goes on smoothly
  /// Pairs s < t with b(s) = b(t), as for two different curves: `certified` crossings are proven to
  /// exist, and alone in their box; crossings and tangencies that are not come from `intersect` on
  /// the two pieces. Unresolved boxes are all that could not be excluded.
  CurveIntersections pairs;
};

/// Every cusp and every pair of different parameters with the same point.
///
/// Roots of D(s, t) = (b(s) - b(t)) / (s - t), a polynomial that is b' where s = t, by subdivision
/// of s <= t: a box is dropped when D's coefficients lie on one side of a line, or by Krawczyk's
/// test. Around a proven cusp, and around the joint of a closed curve, a direction in which the
/// curve is monotone excludes the rest. Small boxes far from s = t that stay open, where two pieces
/// are nearly parallel, go to `intersect`.
///
/// @param curve  1 to 61 finite control points
/// @return    every self-intersection is in one of the lists (in the boxes left to `intersect`, to
///            its standards); a curve that is a point has `closed` set and nothing else
/// @throws    InputError for bad control points
/// @accuracy  certified crossings: exactly one root in the box, parameters within 4 u condition, as
///            `intersect`. Tangencies: to the square root of rounding
/// @cost      means for random curves: cubics 3 us; degrees 5, 10, 20 and 60: 20 us, 0.2 ms, 3 ms
///            and 0.2 s. Bounded: 20000 boxes (4e8 / d^3 when that is less), d^3 operations each
/// @limits    a curve that runs along itself (traced twice) is unresolved along that part. A cusp
///            off the doubles, or lost by rounding, leaves an unresolved box around it, 2^-20 wide
///            as a rule
/// @source    docs/methods/geometry.md
[[nodiscard]] SelfIntersections self_intersections(std::span<const Vec2> curve);

}  // namespace bezel
