// The common part of two curved triangles: identities that hold for any pair, and straight
// triangles against clipping in rational numbers.

#include <gmpxx.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "support/triangle_regions.hpp"

namespace {

using bezel::RandomStream;
using bezel::TriangleRelation;
using bezel::Vec2;
using support::check_regions;
using support::CurvedTriangle;

TEST(TriangleRegions, OfRandomTriangles) {
  RandomStream random("TriangleRegions.OfRandomTriangles", 1);
  for (int i = 0; i < 3000; ++i) {
    const int g = 1 + static_cast<int>(random.below(4)), h = 1 + static_cast<int>(random.below(4));
    const CurvedTriangle a = support::random_triangle(random, g, 1.0, {}, 0.5),
                         b = support::random_triangle(
                             random, h, random.uniform(0.2, 1.2),
                             {{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)}}, 0.5);
    const auto result = check_regions(a, b, random, 3);
    EXPECT_FALSE(result.unresolved) << show(a, b, intersect(a, b));
    EXPECT_EQ(result.wrong, "") << show(a, b, intersect(a, b));
  }
}

TEST(TriangleRegions, OfTrianglesOnALattice) {
  RandomStream random("TriangleRegions.OfTrianglesOnALattice", 1);
  int unresolved = 0;
  for (int i = 0; i < 1500; ++i) {
    const int g = 1 + static_cast<int>(random.below(3)), h = 1 + static_cast<int>(random.below(3)),
              steps = 1 << random.below(4);
    const CurvedTriangle a = support::lattice_triangle(random, g, 2 * steps),
                         b = support::lattice_triangle(random, h, 2 * steps);
    const auto result = check_regions(a, b, random, 3);
    unresolved += result.unresolved ? 1 : 0;
    EXPECT_EQ(result.wrong, "") << show(a, b, intersect(a, b));
  }
  EXPECT_EQ(unresolved, 0);
}

TEST(TriangleRegions, ScaleByPowersOfTwo) {
  RandomStream random("TriangleRegions.ScaleByPowersOfTwo", 1);
  for (int i = 0; i < 300; ++i) {
    const int g = 1 + static_cast<int>(random.below(4));
    const bool lattice = random.below(2) == 0;
    const auto triangle = [&] {
      return lattice ? support::lattice_triangle(random, g, 4)
                     : support::random_triangle(random, g, 1.0, {{random.uniform(), 0.3}}, 0.5);
    };
    const CurvedTriangle a = triangle(), b = triangle();
    const auto found = intersect(a, b);
    for (const double scale : {0x1p-300, 0x1p200}) {
      CurvedTriangle p = a, q = b;
      for (CurvedTriangle* t : {&p, &q})
        for (Vec2& c : t->control) c *= scale;
      const auto scaled = intersect(p, q);
      ASSERT_EQ(scaled.relation, found.relation) << show(a, b, found);
      ASSERT_EQ(scaled.polygons.size(), found.polygons.size()) << show(a, b, found);
      EXPECT_NEAR(support::total_area(scaled.polygons) / scale / scale,
                  support::total_area(found.polygons), 1e-13)
          << show(a, b, found);
    }
  }
}

TEST(TriangleRegions, OfHighDegree) {
  RandomStream random("TriangleRegions.OfHighDegree", 1);
  for (const int g : {7, 12, 20}) {
    const CurvedTriangle a = support::random_triangle(random, g, 1.0, {}, 0.2),
                         b = support::random_triangle(random, 5, 1.0, {{0.5, 0.3}}, 0.2);
    const auto result = check_regions(a, b, random, 2);
    EXPECT_FALSE(result.unresolved) << show(a, b, intersect(a, b));
    EXPECT_EQ(result.wrong, "") << show(a, b, intersect(a, b));
  }
}

using RationalPoint = std::array<mpq_class, 2>;

mpq_class rational_area(const std::vector<RationalPoint>& p) {
  mpq_class twice = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const RationalPoint &s = p[i], &e = p[(i + 1) % p.size()];
    twice += s[0] * e[1] - s[1] * e[0];
  }
  return twice / 2;
}

/// The part of a convex polygon to the left of the line from s to e.
std::vector<RationalPoint> clipped(const std::vector<RationalPoint>& p, const RationalPoint& s,
                                   const RationalPoint& e) {
  std::vector<RationalPoint> out;
  const auto side = [&](const RationalPoint& q) {
    return mpq_class((e[0] - s[0]) * (q[1] - s[1]) - (e[1] - s[1]) * (q[0] - s[0]));
  };
  for (std::size_t i = 0; i < p.size(); ++i) {
    const RationalPoint &q = p[i], &r = p[(i + 1) % p.size()];
    const mpq_class at_q = side(q), at_r = side(r);
    if (at_q >= 0) out.push_back(q);
    if (sgn(at_q) * sgn(at_r) < 0) {
      const mpq_class f = at_q / (at_q - at_r);
      out.push_back({mpq_class(q[0] + f * (r[0] - q[0])), mpq_class(q[1] + f * (r[1] - q[1]))});
    }
  }
  return out;
}

std::vector<RationalPoint> rational(const CurvedTriangle& t) {
  std::vector<RationalPoint> out;
  for (int k = 0; k < 3; ++k) {
    const Vec2& p =
        t.control[static_cast<std::size_t>(bezel::bernstein::triangle_corner(t.degree, k))];
    out.push_back({mpq_class(p.x()), mpq_class(p.y())});
  }
  return out;
}

/// Of a curved polygon: half the integral of cross(c, c') over its edges, exactly.
mpq_class rational_area(const bezel::CurvedPolygon& polygon) {
  const auto choose = [](int n, int k) {
    mpz_class out;
    mpz_bin_uiui(out.get_mpz_t(), static_cast<unsigned long>(n), static_cast<unsigned long>(k));
    return mpq_class(out);
  };
  mpq_class sum = 0;
  for (std::size_t e = 0; e < polygon.size(); ++e) {
    const auto c = polygon.control(e);
    const int d = static_cast<int>(c.size()) - 1;
    for (int i = 0; i <= d; ++i)
      for (int j = 0; j < d; ++j) {
        const Vec2 &p = c[static_cast<std::size_t>(i)], &q = c[static_cast<std::size_t>(j)],
                   &r = c[static_cast<std::size_t>(j + 1)];
        sum += choose(d, i) * choose(d - 1, j) / choose(2 * d - 1, i + j) *
               (p.x() * (mpq_class(r.y()) - q.y()) - p.y() * (mpq_class(r.x()) - q.x()));
      }
  }
  return sum / 4;
}

TEST(CurvedPolygonArea, IsWithinItsBound) {
  RandomStream random("CurvedPolygonArea.IsWithinItsBound", 1);
  double worst = 0.0;
  for (int i = 0; i < 300; ++i) {
    const int g = 1 + static_cast<int>(random.below(6)), h = 1 + static_cast<int>(random.below(6));
    const double x = std::exp2(random.uniform(-10.0, 20.0));
    const CurvedTriangle a = support::random_triangle(random, g, 1.0, {{x, -x}}, 0.3),
                         b = support::random_triangle(random, h, 1.0, {{x + 0.3, -x}}, 0.3);
    for (const bezel::CurvedPolygon& p : intersect(a, b).polygons) {
      double radius = 0.0, degrees = 0.0, terms = 0.0;
      for (std::size_t e = 0; e < p.size(); ++e) {
        const double d = static_cast<double>(p.control(e).size()) - 1.0;
        degrees += d;
        terms += d * (d + 1.0);
        for (const Vec2& c : p.control(e))
          radius = std::max({radius, std::fabs(c.x() - p.control(0)[0].x()),
                             std::fabs(c.y() - p.control(0)[0].y())});
      }
      const double bound = 0x1p-52 * radius * radius * degrees * (terms + 12.0);
      const mpq_class error = abs(mpq_class(area(p)) - rational_area(p));
      worst = std::max(worst, error.get_d() / bound);
    }
  }
  EXPECT_LT(worst, 0.02);  // 0.006 seen
  EXPECT_GT(worst, 0.0);
}

CurvedTriangle elevated(const CurvedTriangle& t, int by) {
  return {t.degree + by, bezel::bernstein::elevate<Vec2>(t.degree, t.control, by)};
}

/// Corners on a lattice of 7 x 7 points: of 17 million pairs a sample, in which every way to touch
/// occurs. Coordinates are multiples of 12, so elevation is exact.
TEST(TriangleRegions, OfStraightTrianglesAgreeWithRationalClipping) {
  RandomStream random("TriangleRegions.OfStraightTriangles", 1);
  std::array<int, 7> count{};
  for (int i = 0; i < 6000; ++i) {
    const auto elevation = static_cast<int>(random.below(3));
    const bool mixed = random.below(4) == 0;
    const auto triangle = [&] {
      CurvedTriangle t;
      do {
        t.control.clear();
        for (int k = 0; k < 3; ++k)
          t.control.push_back({{12.0 * static_cast<double>(random.below(7)),
                                12.0 * static_cast<double>(random.below(7))}});
      } while (area(t) <= 0.0);
      return elevated(t, mixed ? static_cast<int>(random.below(3)) : elevation);
    };
    const CurvedTriangle a = triangle(), b = triangle();
    std::vector<RationalPoint> p = rational(a), q = rational(b), common = p;
    for (std::size_t k = 0; k < 3; ++k) common = clipped(common, q[k], q[(k + 1) % 3]);
    const mpq_class both = rational_area(common), of_a = rational_area(p), of_b = rational_area(q);
    const TriangleRelation expected = both == of_a && both == of_b ? TriangleRelation::same
                                      : both == of_a   ? TriangleRelation::first_in_second
                                      : both == of_b   ? TriangleRelation::second_in_first
                                      : both != 0      ? TriangleRelation::overlapping
                                      : common.empty() ? TriangleRelation::disjoint
                                                       : TriangleRelation::touching;
    const auto found = intersect(a, b);
    ++count[static_cast<std::size_t>(found.relation)];
    const auto result = check_regions(a, b, random, 0);
    EXPECT_EQ(result.wrong, "") << show(a, b, found);
    EXPECT_FALSE(result.unresolved) << show(a, b, found);
    EXPECT_EQ(found.relation, expected) << show(a, b, found);
    EXPECT_NEAR(support::total_area(found.polygons), both.get_d(), 1e-10) << show(a, b, found);
    EXPECT_EQ(found.polygons.size(), both == 0 ? 0u : 1u) << show(a, b, found);
  }
  for (const TriangleRelation r :
       {TriangleRelation::disjoint, TriangleRelation::touching, TriangleRelation::overlapping,
        TriangleRelation::first_in_second, TriangleRelation::second_in_first})
    EXPECT_GE(count[static_cast<std::size_t>(r)], 20) << static_cast<int>(r);
}

}  // namespace
