#pragma once
// Nice numbers for axes.

#include <string>
#include <vector>

namespace bezel::view {

struct Ticks {
  std::vector<double> major;
  std::vector<std::string>
      labels;  ///< of the major ticks; on a logarithmic axis "10" when it has an exponent
  std::vector<std::string>
      superscripts;  ///< exponents of the labels, mostly empty on a linear axis
  std::vector<double> minor;
};

/// Multiples of 1, 2, 2.5 or 5 times a power of ten within [lo, hi], at most about `count` of them.
/// lo < hi, finite.
Ticks linear_ticks(double lo, double hi, int count);
/// Powers of ten within [lo, hi] (every second, third ... when there are more than `count`),
/// with 2..9 times them between; a range below two decades adds labels at 2 and 5. 0 < lo < hi.
Ticks log_ticks(double lo, double hi, int count);

}  // namespace bezel::view
