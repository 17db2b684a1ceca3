// Seeded random bytes through `intersect`: any bits, special values, small integers (which make
// exact contacts, overlaps and shared ends) and coordinates whose exponents are far apart.

#include "tests/fuzz/intersect_fuzz.hpp"

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

double coordinate(RandomStream& random, std::uint64_t kind) {
  static const double special[] = {
      0.0,        -0.0,        1.0,       0x1p-1074,
      -0x1p-1022, 1 - 0x1p-53, 0x1p+1023, -std::numeric_limits<double>::max()};
  const auto whole = [&](std::uint64_t n) {
    return static_cast<double>(random.below(2 * n + 1)) - static_cast<double>(n);
  };
  switch (kind) {
    case 0:
      return fuzz::any_bits(random);
    case 1:
      return special[random.below(8)];
    case 2:
      return whole(2);
    case 3:
      return std::ldexp(whole(32), static_cast<int>(random.below(60)) - 50);
    default:
      return random.uniform(-1.0, 1.0);
  }
}

TEST(IntersectFuzz, RandomBytesAreIntersectedOrRefused) {
  RandomStream random("intersect fuzz", 1);
  const auto make = [&] {
    // Small integers most often: they meet exactly.
    const std::uint64_t draw = random.below(16);
    const std::uint64_t kind = draw < 4 ? draw % 2 : draw < 10 ? 2 : draw < 12 ? 3 : 4;
    const std::uint64_t most = kind < 2 && random.below(8) == 0 ? 69 : 6;
    Bytes bytes{static_cast<std::uint8_t>(random.below(most + 1)),
                static_cast<std::uint8_t>(random.below(most + 1)),
                static_cast<std::uint8_t>(random.below(3) == 0 ? random.below(256) : 0)};
    for (int i = 0; i < 2 * (bytes[0] + bytes[1]); ++i) append(bytes, coordinate(random, kind));
    // A common first point.
    if (random.below(4) == 0 && bytes[0] > 0 && bytes[1] > 0)
      std::memcpy(bytes.data() + 3 + 16 * bytes[0], bytes.data() + 3, 16);
    return bytes;
  };
  fuzz::try_many(
      {4000, std::chrono::seconds(4), 0.02, 0.25}, make,
      [](const Bytes& bytes) { return intersect_fuzz::intersect_bytes(bytes); },
      [](const Bytes&) { return "of seed 1"; });
}

TEST(IntersectFuzz, ShortInputs) {
  EXPECT_FALSE(intersect_fuzz::intersect_bytes({}));
  for (std::size_t n = 0; n < 80; ++n) intersect_fuzz::intersect_bytes(Bytes(n, 0x3f));
  EXPECT_TRUE(intersect_fuzz::intersect_bytes(Bytes{3, 4, 0}));
}

TEST(IntersectFuzz, ChecksCanFail) {
  const std::vector<Vec2> a{{{0, 0}}, {{1, 1}}}, b{{{0, 1}}, {{1, 0}}};
  const auto refuses = [&](auto change) {
    CurveIntersections found = intersect(a, b);
    intersect_fuzz::check(a, b, found, 0.0);
    change(found);
    EXPECT_THROW(intersect_fuzz::check(a, b, found, 0.0), std::logic_error);
  };
  refuses([](CurveIntersections& f) { f.crossings.at(0).s = f.crossings.at(0).s_hi = 1.5; });
  refuses([](CurveIntersections& f) { f.crossings.at(0).s = f.crossings.at(0).s_hi = 0.75; });
  refuses([](CurveIntersections& f) { f.crossings.at(0).s_lo = 0.75; });
  refuses([](CurveIntersections& f) { f.crossings.at(0).sign = 2; });
  refuses([](CurveIntersections& f) { f.tangencies.push_back({0.5, 0.5, 1}); });
  refuses([](CurveIntersections& f) { f.tangencies.push_back({0.25, 0.5, 2}); });
  refuses([](CurveIntersections& f) { f.overlaps.push_back({0.25, 0.5, 0.5, 0.75, 0.0}); });
  refuses([](CurveIntersections& f) { f.unresolved.push_back({0.5, 0.25, 0, 1, "why"}); });
  refuses([](CurveIntersections& f) { f.unresolved.push_back({0, 1, 0, 1, ""}); });
}

}  // namespace
}  // namespace bezel
