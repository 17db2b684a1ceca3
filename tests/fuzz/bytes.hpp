#pragma once
// What the seeded fuzz tests share: inputs of bytes.

#include <cstdint>
#include <cstring>
#include <vector>

#include "bezel/base/random.hpp"

namespace fuzz {

using Bytes = std::vector<std::uint8_t>;

inline void append(Bytes& bytes, double x) {
  std::uint8_t raw[sizeof x];
  std::memcpy(raw, &x, sizeof x);
  bytes.insert(bytes.end(), raw, raw + sizeof x);
}

/// A double of any 64 bits.
inline double any_bits(bezel::RandomStream& random) {
  const std::uint64_t bits = random.next();
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

}  // namespace fuzz
