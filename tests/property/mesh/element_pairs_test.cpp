// The common parts of all pairs of elements of two meshes of one domain fill every element.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "bezel/geometry/triangle.hpp"
#include "bezel/geometry/triangle_intersection.hpp"
#include "bezel/mesh/mesh.hpp"
#include "support/meshes.hpp"

namespace {

using bezel::ElementId;
using bezel::TriangleMesh;
using bezel::TriangleRelation;
using bezel::Vec2;

struct Sums {
  std::vector<double> first, second;  ///< common area of each element; NaN: a pair is unresolved
  int overlapping = 0, unresolved = 0;
  std::string reason;
  double smallest = std::numeric_limits<double>::infinity();  ///< area of a region
};

Sums add_up(const TriangleMesh& a, const TriangleMesh& b,
            const bezel::TriangleIntersectOptions& options) {
  Sums out;
  out.first.assign(a.element_count(), 0.0);
  out.second.assign(b.element_count(), 0.0);
  bezel::TriangleIntersector intersector(options);
  bezel::TriangleIntersections found;
  for (std::size_t i = 0; i < a.element_count(); ++i) {
    const auto p = a.gather(ElementId(static_cast<std::int32_t>(i)));
    for (std::size_t j = 0; j < b.element_count(); ++j) {
      const auto q = b.gather(ElementId(static_cast<std::int32_t>(j)));
      intersector.intersect(a.degree(), p, b.degree(), q, found);
      if (found.relation == TriangleRelation::unresolved) {
        ++out.unresolved;
        out.reason = found.reason;
        out.first[i] = out.second[j] = std::numeric_limits<double>::quiet_NaN();
      }
      if (found.relation == TriangleRelation::overlapping) ++out.overlapping;
      for (const bezel::CurvedPolygon& polygon : found.polygons) {
        const double area = bezel::area(polygon);
        out.first[i] += area;
        out.second[j] += area;
        out.smallest = std::min(out.smallest, area);
      }
    }
  }
  return out;
}

void expect_filled(const TriangleMesh& mesh, const std::vector<double>& sum, double tolerance) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (std::isnan(sum[i])) continue;
    const auto p = mesh.gather(ElementId(static_cast<std::int32_t>(i)));
    EXPECT_NEAR(sum[i], bezel::area(mesh.degree(), p), tolerance) << "element " << i;
  }
}

/// Straight sides of the square: both meshes' boundaries coincide exactly.
TEST(ElementPairs, OfTwoMeshesOfASquare) {
  for (int g = 1; g <= 3; ++g)
    for (int h = 1; h <= 3; ++h) {
      SCOPED_TRACE(std::to_string(g) + " and " + std::to_string(h));
      const auto a = bezel::test::grid_mesh(4, g, 1.0, bezel::test::bend(0.15, 0.1)),
                 b = bezel::test::grid_mesh(5, h, 1.0, bezel::test::bend(-0.1, 0.15));
      const Sums sums = add_up(*a, *b, {});
      EXPECT_EQ(sums.unresolved, 0) << sums.reason;
      expect_filled(*a, sums.first, 1e-14);
      expect_filled(*b, sums.second, 1e-14);
    }
}

/// The same mesh twice: shared corners and sides.
TEST(ElementPairs, OfAMeshWithItself) {
  for (int g = 1; g <= 3; ++g) {
    SCOPED_TRACE(g);
    const auto a = bezel::test::grid_mesh(4, g, 1.0, bezel::test::bend(0.2, 0.15));
    const Sums sums = add_up(*a, *a, {});
    EXPECT_EQ(sums.unresolved, 0) << sums.reason;
    EXPECT_EQ(sums.overlapping, 0);
    expect_filled(*a, sums.first, 1e-15);
  }
}

/// Turned and scaled, so that coordinates are rounded: the boundaries agree to the last bits only.
TEST(ElementPairs, OfTwoMeshesOfATurnedSquare) {
  const auto turned = [](double a, double b) {
    return bezel::test::turn(0.3, 0.7, bezel::test::bend(a, b));
  };
  for (int g = 1; g <= 3; ++g) {
    SCOPED_TRACE(g);
    const auto a = bezel::test::grid_mesh(4, g, 1.0, turned(0.15, 0.1)),
               b = bezel::test::grid_mesh(6, g, 1.0, turned(-0.1, 0.15));
    const Sums sums = add_up(*a, *b, {});
    EXPECT_EQ(sums.unresolved, 0) << sums.reason;
    expect_filled(*a, sums.first, 1e-14);
    expect_filled(*b, sums.second, 1e-14);
  }
}

/// A quadratic map: both meshes follow the same parabolas, but their control points are rounded, so
/// that sides agree to the last bits along all of their length.
TEST(ElementPairs, OfTwoMeshesOfACurvedDomain) {
  const auto map = [](const Vec2& p) {
    return Vec2{{p.x() + 0.21 * p.y() * p.y() - 0.13 * p.x() * p.y(),
                 p.y() - 0.17 * p.x() * p.x() + 0.11 * p.x()}};
  };
  for (int g = 2; g <= 3; ++g) {
    SCOPED_TRACE(g);
    const auto a = bezel::test::grid_mesh(4, g, 1.0, map),
               b = bezel::test::grid_mesh(6, g, 1.0, map);
    const Sums sums = add_up(*a, *b, {});
    EXPECT_EQ(sums.unresolved, 0) << sums.reason;
    expect_filled(*a, sums.first, 1e-14);
    expect_filled(*b, sums.second, 1e-14);
  }
}

/// The same meshes with a coincidence distance: sides that agree to rounding are common, and no
/// region is thinner than the distance.
TEST(ElementPairs, WithACoincidenceDistance) {
  const auto map = [](const Vec2& p) {
    return Vec2{{p.x() + 0.21 * p.y() * p.y() - 0.13 * p.x() * p.y(),
                 p.y() - 0.17 * p.x() * p.x() + 0.11 * p.x()}};
  };
  bezel::TriangleIntersectOptions options;
  options.coincidence_distance = 1e-12;
  for (int g = 2; g <= 3; ++g) {
    SCOPED_TRACE(g);
    const auto a = bezel::test::grid_mesh(4, g, 1.0, map),
               b = bezel::test::grid_mesh(6, g, 1.0, map);
    const Sums sums = add_up(*a, *b, options);
    EXPECT_EQ(sums.unresolved, 0) << sums.reason;
    EXPECT_GT(sums.smallest, 1e-3);
    expect_filled(*a, sums.first, 1e-11);
    expect_filled(*b, sums.second, 1e-11);
  }
}

}  // namespace
