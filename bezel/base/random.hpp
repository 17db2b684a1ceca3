#pragma once
// Named random streams: the same (name, seed) gives the same numbers on every machine.

#include <cstdint>
#include <string_view>

namespace bezel {

/// A 64-bit generator with its own state: period 2^256 - 1, the same numbers everywhere. Not for
/// secrets.
///
/// @source  xoshiro256** 1.0 by D. Blackman and S. Vigna (2018), state filled by splitmix64 (S.
/// Vigna, 2015)
///          started at the 64-bit FNV-1a hash of the name's bytes and the seed's (least significant
///          first)
class RandomStream {
 public:
  /// Streams of different names are unrelated, also with the same seed.
  RandomStream(std::string_view name, std::uint64_t seed);
  std::uint64_t next();  ///< 64 random bits
  double uniform();      ///< in [0, 1), a multiple of 2^-53
  double uniform(double lo,
                 double hi);  ///< in [lo, hi); lo when they are equal; lo <= hi, hi - lo finite
  std::uint64_t below(std::uint64_t n);  ///< in 0..n-1, unbiased, n >= 1

 private:
  std::uint64_t state_[4];
};

}  // namespace bezel
