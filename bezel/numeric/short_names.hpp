#pragma once
// Short names for what formulas need all the time. Sources take them with `using`, in an unnamed
// namespace: unlike their own definitions, several such sources can be compiled as one.

#include <cstddef>
#include <limits>

namespace bezel::short_names {

/// Unit roundoff of double: a rounded result is within a factor 1 + u of the exact one, barring
/// underflow.
inline constexpr double u = 0x1p-53;

inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// A number that is never negative, as an index.
constexpr std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace bezel::short_names
