#pragma once
// What the seeded fuzz tests share: inputs of bytes, and how they are tried.

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <stdexcept>
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

/// Tries `most` inputs, or fewer in a few seconds: run(bytes) is false for those it refuses, and
/// throws std::logic_error where a check fails. Some must be refused, and many not.
template <class Make, class Run>
void try_many(int most, std::chrono::seconds time, const Make& make, const Run& run) {
  int tried = 0, refused = 0;
  const auto start = std::chrono::steady_clock::now();
  while (tried < most && std::chrono::steady_clock::now() - start < time) {
    const Bytes bytes = make();
    try {
      refused += run(bytes) ? 0 : 1;
    } catch (const std::logic_error& error) {
      FAIL() << "input " << tried << " of seed 1: " << error.what();
    }
    ++tried;
  }
  testing::Test::RecordProperty("tried", tried);
  EXPECT_GT(refused, tried / 50);
  EXPECT_GT(tried - refused, tried / 4);
}

}  // namespace fuzz
