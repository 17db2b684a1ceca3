#pragma once
// Named random streams: the same (name, seed) gives the same numbers on every machine.

#include <cstdint>
#include <string_view>

namespace bezel {

/// A 64-bit generator (xoshiro256**), seeded from a name and a number.
class RandomStream {
 public:
  RandomStream(std::string_view name, std::uint64_t seed);
  std::uint64_t next();
  double uniform();                        ///< in [0, 1), 53 random bits
  double uniform(double lo, double hi);    ///< in [lo, hi)
  std::uint64_t below(std::uint64_t n);    ///< in 0..n-1, unbiased, n >= 1

 private:
  std::uint64_t state_[4];
};

}  // namespace bezel
