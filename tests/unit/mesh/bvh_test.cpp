#include "bezel/mesh/bvh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace bezel {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Box2 box(double x0, double y0, double x1, double y1) {
  Box2 b;
  b.lo = Vec2{{x0, y0}};
  b.hi = Vec2{{x1, y1}};
  return b;
}

std::vector<std::int32_t> found(const Bvh& tree, const Box2& query) {
  std::vector<std::int32_t> out;
  tree.query(query, out);
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::int32_t> brute_force(std::span<const Box2> boxes, const Box2& query) {
  std::vector<std::int32_t> out;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (boxes[i].overlaps(query)) out.push_back(static_cast<std::int32_t>(i));
  return out;
}

double distance(const Box2& b, const Vec2& p) {
  return std::hypot(std::max({b.lo[0] - p[0], p[0] - b.hi[0], 0.0}),
                    std::max({b.lo[1] - p[1], p[1] - b.hi[1], 0.0}));
}

/// Boxes from points to the whole square, many with equal corners.
std::vector<Box2> random_boxes(std::size_t n, unsigned seed, double size) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(0, 1);
  std::vector<Box2> boxes;
  for (std::size_t i = 0; i < n; ++i) {
    double x = place(random), y = place(random);
    if (i % 3 == 0) x = std::round(x * 8) / 8, y = std::round(y * 8) / 8;
    const double w = i % 5 == 0 ? 0 : size * place(random),
                 h = i % 7 == 0 ? 0 : size * place(random);
    boxes.push_back(box(x, y, x + w, y + h));
  }
  return boxes;
}

TEST(Bvh, WithoutBoxesFindsNothing) {
  const Bvh none, empty{std::span<const Box2>()};
  EXPECT_TRUE(found(none, box(-1, -1, 1, 1)).empty());
  EXPECT_TRUE(found(empty, box(-1, -1, 1, 1)).empty());
  EXPECT_EQ(empty.nearest(Vec2{{0.3, 0.7}}, [](std::int32_t) { return 0.0; }), -1);
}

TEST(Bvh, TouchingBoxesOverlap) {
  const std::vector<Box2> boxes{box(0, 0, 1, 1), box(1, 1, 2, 2), box(1.1, 0, 2, 0.5)};
  const Bvh tree(boxes);
  EXPECT_EQ(found(tree, box(1, 1, 1, 1)), (std::vector<std::int32_t>{0, 1}));
  EXPECT_EQ(found(tree, box(1, 0, 1.1, 0)), (std::vector<std::int32_t>{0, 2}));
  EXPECT_TRUE(found(tree, box(1.01, 0, 1.09, 0.9)).empty());
}

TEST(Bvh, QueryAgreesWithBruteForce) {
  for (const std::size_t n : {1u, 4u, 5u, 17u, 300u, 2000u})
    for (const double size : {0.0, 0.02, 0.7}) {
      const auto boxes = random_boxes(n, 17 + static_cast<unsigned>(n), size);
      const Bvh tree(boxes);
      for (const Box2& query : random_boxes(60, 99, 0.2))
        ASSERT_EQ(found(tree, query), brute_force(boxes, query)) << n << ' ' << size;
    }
}

TEST(Bvh, ManyEqualAndNestedBoxesDoNotDeepenTheTree) {
  // Each box half as large as the one before: surface-area splits peel off one box at a time.
  std::vector<Box2> boxes;
  for (int i = 0; i < 1000; ++i)
    boxes.push_back(box(0, 0, std::ldexp(1.0, -i), std::ldexp(1.0, -i)));
  for (int i = 0; i < 1000; ++i) boxes.push_back(box(0.5, 0.25, 0.5, 0.25));
  const Bvh tree(boxes);
  for (const Box2& query : {box(0.5, 0.25, 0.5, 0.25), box(0, 0, 0, 0), box(0.7, 0.1, 0.8, 0.2),
                            box(1e-200, 0, 1e-190, 1)})
    EXPECT_EQ(found(tree, query), brute_force(boxes, query));
}

TEST(Bvh, BoxesFarFromTheOthersLeaveTheTreeGood) {
  // One box so far away that all others lie in one place of the space-filling curve.
  std::vector<Box2> boxes = random_boxes(3000, 21, 0.02);
  boxes[1500] = box(1e15, 1e15, 1e15, 1e15);
  const Bvh tree(boxes);
  for (const Box2& query : random_boxes(60, 22, 0.2))
    EXPECT_EQ(found(tree, query), brute_force(boxes, query));
  std::int64_t asked = 0;
  for (const Box2& b : random_boxes(100, 23, 0.0)) {
    tree.nearest(b.lo, [&](std::int32_t i) {
      ++asked;
      return distance(boxes[static_cast<std::size_t>(i)], b.lo);
    });
  }
  EXPECT_LT(asked, 100 * 60);
}

TEST(Bvh, EmptyAndInfiniteBoxes) {
  std::vector<Box2> boxes = random_boxes(50, 3, 0.1);
  boxes[7] = Box2();
  boxes[8].lo[1] = std::nan("");
  boxes[9] = box(-infinity, -infinity, infinity, infinity);
  boxes[10] = box(0, 0, 1.7e308, 1.7e308);
  boxes[11] = box(-1.7e308, 0, -1e308, 0);
  const Bvh tree(boxes);
  for (const Box2& query : random_boxes(20, 4, 0.5))
    EXPECT_EQ(found(tree, query), brute_force(boxes, query));
  EXPECT_EQ(found(tree, box(-1.5e308, -1, -1.2e308, 1)), (std::vector<std::int32_t>{9, 11}));
  EXPECT_TRUE(found(Bvh(random_boxes(50, 3, 0.1)), Box2()).empty());
}

TEST(Bvh, OrderOfVisitsIsReproducible) {
  const auto boxes = random_boxes(500, 5, 0.2);
  std::vector<std::int32_t> a, b;
  Bvh(boxes).query(box(0.2, 0.2, 0.6, 0.6), a);
  Bvh(boxes).query(box(0.2, 0.2, 0.6, 0.6), b);
  EXPECT_GT(a.size(), 100u);
  EXPECT_EQ(a, b);
}

TEST(Bvh, NearestAgreesWithBruteForceAndPrunes) {
  const auto boxes = random_boxes(2000, 11, 0.02);
  const Bvh tree(boxes);
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> place(-1, 2);
  std::int64_t asked = 0;
  for (int q = 0; q < 200; ++q) {
    const Vec2 p{{place(random), place(random)}};
    // A disc inside each box: its distance is at least the distance of the box.
    const auto exact = [&](std::int32_t i) {
      ++asked;
      const Box2& b = boxes[static_cast<std::size_t>(i)];
      const double radius = 0.5 * std::min(b.hi[0] - b.lo[0], b.hi[1] - b.lo[1]);
      return std::max(0.0, norm(p - b.centre()) - radius);
    };
    std::int32_t expected = -1;
    double best = infinity;
    for (std::int32_t i = 0; i < 2000; ++i)
      if (const double d = exact(i); d < best) best = d, expected = i;
    asked -= 2000;
    ASSERT_EQ(tree.nearest(p, exact), expected) << p[0] << ' ' << p[1];
  }
  EXPECT_LT(asked, 200 * 60);
}

TEST(Bvh, NearestTakesTheSmallestNumberOfATie) {
  std::vector<Box2> boxes;
  for (int i = 0; i < 40; ++i)
    boxes.push_back(box(i % 2 == 0 ? 1 : -2, -0.5, i % 2 == 0 ? 2 : -1, 0.5));
  const Bvh tree(boxes);
  const Vec2 p{{0, 0}};
  EXPECT_EQ(tree.nearest(
                p, [&](std::int32_t i) { return distance(boxes[static_cast<std::size_t>(i)], p); }),
            0);
  EXPECT_EQ(tree.nearest(p, [&](std::int32_t i) { return i < 3 ? std::nan("") : 4.5; }), 3);
}

}  // namespace
}  // namespace bezel
