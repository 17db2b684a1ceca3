#include "bezel/mesh/morton.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bezel/base/random.hpp"

namespace bezel {
namespace {

// Along the curve the first of two points is the one with the smaller coordinate at the highest bit
// in which a coordinate differs, y deciding before x.
bool before(const Vec2& a, const Vec2& b) {
  const auto cell = [](double x) { return static_cast<std::uint64_t>(x * 4294967295.0); };
  const std::uint64_t dx = cell(a.x()) ^ cell(b.x()), dy = cell(a.y()) ^ cell(b.y());
  const bool by_x = dy < dx && dy < (dx ^ dy);
  return by_x ? cell(a.x()) < cell(b.x()) : cell(a.y()) < cell(b.y());
}

// Few points and many are sorted in two ways; repeated places stay in the order of their numbers.
TEST(MortonOrder, FollowsTheCurve) {
  for (const std::size_t n : {2u, 700u, 5000u}) {
    RandomStream random("morton order", n);
    std::vector<Vec2> points{{0.0, 0.0}, {1.0, 1.0}};
    points.resize(n);
    for (std::size_t i = 2; i < n; ++i) {
      points[i] = i % 7 == 0 ? points[i / 2] : Vec2{random.uniform(), random.uniform()};
      if (i % 11 == 0) points[i] = {points[i].x() * 0x1p-30, points[i].y()};
    }
    const std::vector<std::int32_t> order = morton_order(points);
    ASSERT_EQ(order.size(), n);
    std::vector<int> seen(n, 0);
    for (const std::int32_t i : order) ++seen[static_cast<std::size_t>(i)];
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(n));
    for (std::size_t k = 1; k < n; ++k) {
      const Vec2 &a = points[static_cast<std::size_t>(order[k - 1])],
                 &b = points[static_cast<std::size_t>(order[k])];
      EXPECT_FALSE(before(b, a)) << n << " " << k;
      if (a == b) {
        EXPECT_LT(order[k - 1], order[k]);
      }
    }
  }
}

// All but a few points in one place of the upper half of the bits.
TEST(MortonOrder, SortsPointsThatAreFarCloserThanTheSquareIsWide) {
  RandomStream random("morton cluster", 1);
  std::vector<Vec2> points{{0.0, 0.0}, {1.0, 1.0}};
  for (int i = 0; i < 4000; ++i)
    points.push_back({0.25 + 0x1p-26 * random.uniform(), 0.5 + 0x1p-26 * random.uniform()});
  const std::vector<MortonPlace> places = morton_places(points);
  for (std::size_t k = 1; k < places.size(); ++k) {
    EXPECT_TRUE(places[k - 1].key < places[k].key ||
                (places[k - 1].key == places[k].key && places[k - 1].number < places[k].number));
  }
}

}  // namespace
}  // namespace bezel
