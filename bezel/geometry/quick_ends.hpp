#pragma once
// The common cases of two edges that meet where one of them ends: in a common vertex, with the end
// of one on the other, or along a common part.

#include <cstdint>

#include "bezel/geometry/curve.hpp"

namespace bezel::geometry_kernel {

enum class EndMeeting : std::uint8_t {
  point,   ///< one common point, an end of one of the curves
  part,    ///< one common part, from end to end
  unclear  ///< anything else, or not seen quickly: ask `intersect`
};

/// Parameters are exactly 0 or 1 at ends that are within the distance of an end of the other.
struct QuickEnds {
  double s, t;          ///< the point, or where the part begins on a
  double s_end, t_end;  ///< where the part ends: s < s_end
  double gap;           ///< largest distance of the curves' points there, in length units
};

/// Whether the directions of two curves are seen to be nowhere nearly parallel, whichever points
/// are compared: they have one common point at most.
///
/// @param a, b  from cache_curve
/// @limits  curves that turn by more than about 45 degrees are never seen to be
bool nowhere_parallel(const CurveCache& a, const CurveCache& b);

/// Decides quickly how two curves meet in their ends, for a pair that `meet_quickly` does not
/// decide.
///
/// @param a, b      from cache_curve
/// @param distance  curves nearer than this count as coincident
/// @param out       filled in for a point or a part
/// @accuracy as `intersect` with this coincidence distance: the same common points and parts, with
///           the same parameters
/// @cost     about 350 instructions for a common vertex, 1500 where one end lies inside the other
/// @limits   curves that turn by more than about 45 degrees are always unclear
/// @source   docs/methods/geometry.md, "Edges that cross once, and edges that end on each other"
EndMeeting meet_at_ends(const CurveCache& a, const CurveCache& b, double distance, QuickEnds& out);

}  // namespace bezel::geometry_kernel
