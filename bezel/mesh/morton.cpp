#include "bezel/mesh/morton.hpp"

#include <algorithm>
#include <array>

namespace bezel {
namespace {

constexpr std::uint64_t spread_bits(std::uint64_t x) {
  x &= 0xffffffffULL;
  x = (x | (x << 16)) & 0x0000ffff0000ffffULL;
  x = (x | (x << 8)) & 0x00ff00ff00ff00ffULL;
  x = (x | (x << 4)) & 0x0f0f0f0f0f0f0f0fULL;
  x = (x | (x << 2)) & 0x3333333333333333ULL;
  x = (x | (x << 1)) & 0x5555555555555555ULL;
  return x;
}

bool comes_before(const MortonPlace& a, const MortonPlace& b) {
  return a.key != b.key ? a.key < b.key : a.number < b.number;
}

/// Sorts by key what is sorted by number: by the upper half of the bits digit after digit from the
/// lowest, which leaves few equal, and those by comparisons.
void sort_by_digits(std::vector<MortonPlace>& places) {
  constexpr unsigned digit_bits = 11, digits = 3, low_bits = 64 - digits * digit_bits;
  constexpr std::size_t values = std::size_t{1} << digit_bits;
  std::vector<std::array<std::uint32_t, values>> counts(digits);
  const auto digit = [](std::uint64_t key, unsigned d) {
    return static_cast<std::size_t>(key >> (low_bits + d * digit_bits)) & (values - 1);
  };
  for (const MortonPlace& k : places)
    for (unsigned d = 0; d < digits; ++d) ++counts[d][digit(k.key, d)];
  std::vector<MortonPlace> sorted(places.size());
  for (unsigned d = 0; d < digits; ++d) {
    std::uint32_t before = 0;
    for (std::uint32_t& count : counts[d]) {
      const std::uint32_t here = count;
      count = before;
      before += here;
    }
    for (const MortonPlace& k : places) sorted[counts[d][digit(k.key, d)]++] = k;
    places.swap(sorted);
  }
  for (auto run = places.begin(); run != places.end();) {
    auto end = run + 1;
    while (end != places.end() && end->key >> low_bits == run->key >> low_bits) ++end;
    if (end - run > 1) std::sort(run, end, comes_before);
    run = end;
  }
}

}  // namespace

std::vector<MortonPlace> morton_places(std::span<const Vec2> points) {
  Box2 box;
  for (const Vec2& p : points) box.include(p);
  constexpr double largest = 4294967295.0;
  const double width = std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], 1e-300});
  const double scale = largest / width;
  std::vector<MortonPlace> places(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 c = points[i] - box.lo;
    const auto cell = [&](double x) {
      return spread_bits(static_cast<std::uint64_t>(std::clamp(x * scale, 0.0, largest)));
    };
    places[i] = {cell(c[0]) | (cell(c[1]) << 1), static_cast<std::int32_t>(i)};
  }
  // The tables of digits pay off for more than a few points.
  constexpr std::size_t many = 2048;
  if (places.size() >= many) {
    sort_by_digits(places);
  } else {
    std::sort(places.begin(), places.end(), comes_before);
  }
  return places;
}

std::vector<std::int32_t> morton_order(std::span<const Vec2> points) {
  const std::vector<MortonPlace> places = morton_places(points);
  std::vector<std::int32_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = places[i].number;
  return order;
}

}  // namespace bezel
