#pragma once
// Any bytes as two plane curves: `intersect` throws InputError or returns what it promises.

#include <cstddef>
#include <cstdint>
#include <span>

#include "bezel/geometry/curve.hpp"

namespace bezel::intersect_fuzz {

/// Bytes: one for each degree, one for the coincidence distance (0: none), then doubles of any
/// bits: the control points; what is missing is 0. Throws std::logic_error when a promise is
/// broken.
/// @return whether the input was accepted; false after an InputError
bool intersect_bytes(std::span<const std::uint8_t> bytes);

/// Throws std::logic_error unless all parameters are in [0, 1] and in their boxes, in order, and
/// the two curves within rounding of each other at every certified crossing, tangency and overlap.
void check(std::span<const Vec2> a, std::span<const Vec2> b, const CurveIntersections& found,
           double distance);

}  // namespace bezel::intersect_fuzz
