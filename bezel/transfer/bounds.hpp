#pragma once
// Bounds on transferred fields.

#include <cstdint>

#include "bezel/base/error.hpp"

namespace bezel {

/// What the values of a transferred field may be, everywhere in every element.
struct Bounds {
  enum class Kind {
    none,    ///< anything: the L2 projection over- and undershoots
    global,  ///< lo..hi, for every component of every field
    local    ///< on each target element the range of the donor elements that overlap it
  };
  Kind kind = Kind::none;
  double lo = 0.0, hi = 0.0;  ///< Kind::global only; infinite values leave a side open

  static Bounds between(double lo, double hi) { return {Kind::global, lo, hi}; }
  static Bounds local() { return {Kind::local, 0.0, 0.0}; }
};

/// What keeping the bounds took, for one component.
struct BoundsReport {
  std::int64_t elements_limited = 0;  ///< elements whose polynomial changed by more than rounding
  double mass_moved = 0.0;  ///< cut off where means were out of bounds, and given to other elements
};

}  // namespace bezel
