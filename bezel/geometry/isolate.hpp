#pragma once
// The first stage of a curve-curve intersection: in double arithmetic with bounds on its rounding,
// it proves what subdivision can prove quickly and leaves the rest as boxes.

#include <span>

#include "bezel/geometry/inline_list.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

/// A simple common point, proven: exactly one root of a(s) = b(t) lies in the box, not on its
/// border, and the box lies in [0, 1]^2.
struct IsolatedRoot {
  double s, t;  ///< within 4 u condition of the root, and inside the box
  double s_lo, s_hi, t_lo, t_hi;
  int sign;  ///< of cross(a', b') in the whole box: +1 or -1
};

/// A closed box [s0, s1] x [t0, t1] in [0, 1]^2 about which more must be found out.
struct OpenBox {
  double s0, s1, t0, t1;
  /// 0: nothing is known. Else cross(a'(s), b'(t)) has this sign for all s, t in the box made
  /// larger by an eighth of its width on each side (also beyond [0, 1], where the polynomials go
  /// on), which holds at most one root of the two polynomials: one too near to the border of
  /// [0, 1]^2 to be decided in double.
  int sign;
  double s, t;  ///< sign != 0: where Newton's method ended, near the root; else the middle
};

/// Every common point with parameters in [0, 1] is in the box of one root, and of one only, or in
/// an open box.
struct Isolation {
  InlineList<IsolatedRoot, 12> roots;
  InlineList<OpenBox, 4> open;
  void clear() {
    roots.clear();
    open.clear();
  }
};

/// @param a, b   control points, 1 to 61 each, checked by the caller: finite, the largest
///               coordinate of both between 2^-300 and 2^300
/// @param out    cleared first; its storage is reused. A root on the border of an open box without
///               a sign may be in `roots` as well
/// @accuracy roots: largest seen 2.1 u condition at degrees 1 to 8
/// @cost     0.3 us per pair of cubics with control points uniform in the unit square, 0.6 us at
///           degree 4; at most 2000 boxes and 24 halvings of a curve. No allocation up to degree 7
/// @limits   nearly parallel pieces and cusps are left open, curves that coincide as some 50 boxes;
///           from degree 20 or so on, so are roots whose parameter is within rounding of a multiple
///           of 2^-k
/// @source   docs/methods/geometry.md, "Isolating common points"
void isolate(std::span<const Vec2> a, std::span<const Vec2> b, Isolation& out);

}  // namespace bezel::geometry_kernel
