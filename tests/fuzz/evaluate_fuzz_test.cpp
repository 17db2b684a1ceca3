// Seeded random bytes through compensated and certified evaluation: any bits, bits of moderate
// doubles, and mixtures of special values.

#include "tests/fuzz/evaluate_fuzz.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <vector>

#include "bezel/base/random.hpp"
#include "tests/fuzz/bytes.hpp"
#include "tests/fuzz/try_many.hpp"

namespace bezel {
namespace {

using fuzz::append;
using fuzz::Bytes;

double any_double(RandomStream& random, std::uint64_t kind) {
  static const double special[] = {
      0.0,       -0.0,        1.0,           0.5,     0x1p-1074, -0x1p-1022,
      0x1p-537,  1 - 0x1p-53, 0x1p+1023,     -1.0,    3.0,       std::numeric_limits<double>::max(),
      0x1p-1021, 0x1p-60,     1.0 + 0x1p-52, 0x1p+300};
  if (kind == 0 || random.below(40) == 0) {
    const double x = fuzz::any_bits(random);
    if (std::isfinite(x) || kind == 0) return x;
  }
  if (kind == 1 || random.below(4) == 0) return special[random.below(16)];
  const double x = random.uniform(-1.0, 1.0);
  return kind == 2 ? x : std::ldexp(x, static_cast<int>(random.below(2000)) - 1000);
}

TEST(EvaluateFuzz, RandomBytesAreEvaluatedOrRefused) {
  RandomStream random("evaluate fuzz", 1);
  const auto make = [&] {
    const std::uint64_t kind = random.below(4);
    const bool valid = random.below(3) > 0;
    // Mostly small degrees: time goes with the square.
    const std::uint64_t degree =
        valid ? random.below(random.below(8) == 0 ? 61 : 12) : random.below(64);
    Bytes bytes{static_cast<std::uint8_t>(valid ? 2 + random.below(4) : random.below(256)),
                static_cast<std::uint8_t>(valid ? degree + 1 : random.below(256)),
                static_cast<std::uint8_t>(random.below(256))};
    for (std::uint64_t i = random.below(4) == 0 ? random.below(90) : 80; i > 0; --i)
      append(bytes, any_double(random, kind));
    bytes.resize(bytes.size() - random.below(9) % bytes.size());
    return bytes;
  };
  fuzz::try_many(
      {5000, std::chrono::seconds(3), 0.02, 0.25}, make,
      [](const Bytes& bytes) { return evaluate_fuzz::evaluate_bytes(bytes); },
      [](const Bytes&) { return "of seed 1"; });
}

TEST(EvaluateFuzz, ShortInputs) {
  EXPECT_FALSE(evaluate_fuzz::evaluate_bytes({}));
  for (std::size_t n = 0; n < 64; ++n) evaluate_fuzz::evaluate_bytes(Bytes(n, 0x3f));
  EXPECT_TRUE(evaluate_fuzz::evaluate_bytes(Bytes{3, 4, 5}));
}

// The check refuses a value moved by two last places and a bound below the error.
TEST(EvaluateFuzz, ChecksCanFail) {
  using evaluate_fuzz::check_certified;
  const std::vector<double> b{0.1, 0.7, -0.3}, zero{-1.0, 1.0};
  const double value = 0.1 * 0.49 + 0.7 * 0.42 - 0.3 * 0.09;  // near p(0.3)
  EXPECT_THROW(check_certified(b, 0.3, value + 0x1p-51, 1.0), std::logic_error);
  EXPECT_THROW(check_certified(b, 0.3, value - 0x1p-51, 1.0), std::logic_error);
  EXPECT_THROW(check_certified(b, 0.3, value, 0.0), std::logic_error);
  EXPECT_THROW(check_certified(b, 0.3, HUGE_VAL, HUGE_VAL), std::logic_error);
  EXPECT_THROW(check_certified(b, 0.3, std::nan(""), 1.0), std::logic_error);
  EXPECT_THROW(check_certified(b, 0.3, value, HUGE_VAL), std::logic_error);
  EXPECT_THROW(check_certified(zero, 0.5, 0x1p-1074, 1.0), std::logic_error);
  EXPECT_NO_THROW(check_certified(zero, 0.5, 0.0, 0.0));
}

}  // namespace
}  // namespace bezel
