#pragma once
// Internal: weighted values moved into bounds without changing their weighted sum.

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace bezel::detail {

/// Bounds of every value: one entry for all, or one a value. lo <= hi; one entry may
/// be infinite: then that side is open.
struct ValueBounds {
  std::vector<double> lo, hi;
  double least(std::size_t i) const { return lo[lo.size() == 1 ? 0 : i]; }
  double most(std::size_t i) const { return hi[hi.size() == 1 ? 0 : i]; }
};

/// What redistribute() did.
struct Redistribution {
  double moved = 0.0;      ///< sum of weight * |excess| over the values out of bounds
  double left_over = 0.0;  ///< weighted sum that no value had room for: 0 when everything fits
};

/// Appends the neighbours of value i to a list; may name i itself and name one twice.
using Neighbours = std::function<void(std::int32_t i, std::vector<std::int32_t>& out)>;

/// Clips the values to their bounds and gives what was cut off to values with room: to the
/// neighbours, in proportion to their room, or to the smallest neighbourhood that has enough (at
/// most 256 values), and what is then left, with all amounts that are rounding, to all values.
///
/// One value after the other in ascending order, so the result is one for any number of threads.
///
/// @param value   finite
/// @param weight  positive, as many
/// @accuracy the weighted sum changes by rounding only (plus left_over)
/// @cost     one pass, and a walk over the neighbourhood of each value out of bounds
Redistribution redistribute(std::span<double> value, std::span<const double> weight,
                            const ValueBounds& bounds, const Neighbours& neighbours);

}  // namespace bezel::detail
