// The identities of triangle_intersection_test.cpp for many more pairs.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bezel/base/random.hpp"
#include "support/triangle_regions.hpp"

namespace {

using bezel::RandomStream;
using support::CurvedTriangle;

TEST(TriangleRegionsLong, OfRandomTriangles) {
  RandomStream random("TriangleRegionsLong.OfRandomTriangles", 1);
  int unresolved = 0;
  for (int i = 0; i < 100000; ++i) {
    const int g = 1 + static_cast<int>(random.below(4)), h = 1 + static_cast<int>(random.below(4));
    const double size = std::exp2(random.uniform(-6.0, 0.5));
    const CurvedTriangle a = support::random_triangle(random, g, 1.0, {}, 0.5),
                         b = support::random_triangle(
                             random, h, size,
                             {{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)}}, 0.5);
    const auto result = support::check_regions(a, b, random, 2);
    unresolved += result.unresolved ? 1 : 0;
    EXPECT_EQ(result.wrong, "") << show(a, b, intersect(a, b));
  }
  EXPECT_EQ(unresolved, 0);
}

TEST(TriangleRegionsLong, OfTrianglesOnALattice) {
  RandomStream random("TriangleRegionsLong.OfTrianglesOnALattice", 1);
  int unresolved = 0;
  for (int i = 0; i < 15000; ++i) {
    const int g = 1 + static_cast<int>(random.below(3)), h = 1 + static_cast<int>(random.below(3)),
              steps = 1 << random.below(4);
    const CurvedTriangle a = support::lattice_triangle(random, g, 2 * steps),
                         b = support::lattice_triangle(random, h, 2 * steps);
    const auto result = support::check_regions(a, b, random, 2);
    unresolved += result.unresolved ? 1 : 0;
    EXPECT_EQ(result.wrong, "") << show(a, b, intersect(a, b));
  }
  EXPECT_EQ(unresolved, 0);
}

/// One triangle a copy of the other with its control points moved by 2^-53 to 2^-1, some not at
/// all: sides that agree to the last bits, wholly or in part.
TEST(TriangleRegionsLong, OfATriangleAndItsPerturbedCopy) {
  RandomStream random("TriangleRegionsLong.OfATriangleAndItsPerturbedCopy", 1);
  int unresolved = 0;
  for (int i = 0; i < 3000; ++i) {
    const int g = 1 + static_cast<int>(random.below(3));
    const CurvedTriangle a = support::random_triangle(random, g, 1.0, {}, 0.4);
    CurvedTriangle b;
    do {
      b = a;
      const double by = std::exp2(random.uniform(-53.0, -2.0));
      for (bezel::Vec2& p : b.control)
        if (random.below(2) == 0)
          p += bezel::Vec2{{random.uniform(-by, by), random.uniform(-by, by)}};
    } while (bezel::check_validity(g, b.control).status != bezel::Validity::valid);
    const auto result = support::check_regions(a, b, random, 0);
    unresolved += result.unresolved ? 1 : 0;
    EXPECT_EQ(result.wrong, "") << show(a, b, intersect(a, b));
  }
  EXPECT_EQ(unresolved, 0);
}

}  // namespace
