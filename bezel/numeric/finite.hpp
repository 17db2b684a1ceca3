#pragma once
// Whether all values of an array are finite, at the speed of memory.

#include <span>

namespace bezel {

/// True when no value is infinite or NaN (an empty array has none).
bool all_finite(std::span<const double> values);

}  // namespace bezel
