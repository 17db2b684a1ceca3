#pragma once
// What every well-formed mesh satisfies; shared by the mesh tests.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "bezel/bernstein/interval.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/mesh/edge_finder.hpp"
#include "bezel/mesh/mesh.hpp"

namespace bezel::test {

inline double total_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    sum += area(mesh.degree(), mesh.gather(ElementId(e)));
  return sum;
}

/// V - E + F of the mesh.
inline long euler(const TriangleMesh& mesh) {
  return static_cast<long>(mesh.vertex_count() + mesh.element_count()) -
         static_cast<long>(mesh.edge_count());
}

/// Smallest angle between corners, in degrees.
inline double min_angle(const TriangleMesh& mesh) {
  double least = 180;
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (int c = 0; c < 3; ++c) {
      const auto corner = [&](int k) {
        return mesh.control(mesh.nodes(ElementId(
            e))[static_cast<std::size_t>(bernstein::triangle_corner(mesh.degree(), (c + k) % 3))]);
      };
      const Vec2 a = corner(1) - corner(0), b = corner(2) - corner(0);
      least = std::min(least, std::atan2(cross(a, b), dot(a, b)) * 180 / 3.141592653589793);
    }
  return least;
}

inline void expect_all_valid(const TriangleMesh& mesh) {
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    ASSERT_EQ(check_validity(mesh.degree(), mesh.gather(ElementId(e))).status, Validity::valid)
        << "triangle " << e;
}

/// Elements and edges name each other; sides carry the edge's nodes; every side has one or two
/// elements.
inline void expect_consistent(const TriangleMesh& mesh) {
  std::size_t sides = 0;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const auto along = mesh.edge_nodes(EdgeId(e));
    ASSERT_LT(along.front(), along.back());
    const auto adjacent = mesh.adjacent(EdgeId(e));
    ASSERT_GE(adjacent.size(), 1u);
    ASSERT_LE(adjacent.size(), 2u);
    sides += adjacent.size();
    if (adjacent.size() == 2) {
      ASSERT_NE(adjacent[0].reversed, adjacent[1].reversed);
    }
    for (const ElementSide& side : adjacent) {
      const SideEdge back = mesh.edges(side.element)[static_cast<std::size_t>(side.side)];
      ASSERT_EQ(back.edge, EdgeId(e));
      ASSERT_EQ(back.reversed, side.reversed);
      for (int m = 0; m <= mesh.degree(); ++m) {
        const auto n =
            static_cast<std::size_t>(bernstein::triangle_side_index(mesh.degree(), side.side, m));
        ASSERT_EQ(mesh.nodes(side.element)[n],
                  along[static_cast<std::size_t>(side.reversed ? mesh.degree() - m : m)]);
      }
    }
  }
  ASSERT_EQ(sides, 3 * mesh.element_count());
}

/// Every boundary edge is tagged once, with the domain on its left. @return length per group name
inline std::map<std::string, double> boundary_lengths(const TriangleMesh& mesh) {
  const EdgeFinder finder(mesh);
  std::vector<int> seen(mesh.edge_count(), 0);
  std::map<std::string, double> length;
  for (const TaggedEdge& edge : mesh.tags().edges) {
    const SideEdge found = finder.find(edge.nodes);
    EXPECT_TRUE(found.edge.valid());
    if (!found.edge.valid()) continue;
    ++seen[found.edge.index()];
    EXPECT_EQ(mesh.adjacent(found.edge)[0].reversed, found.reversed)
        << "the domain is not on the left";
    std::string name;
    for (const Entity& entity : mesh.tags().entities)
      if (entity.dim == 1 && entity.tag == edge.entity)
        for (const PhysicalGroup& group : mesh.tags().groups)
          if (group.dim == 1 && group.tag == entity.physical.front()) name = group.name;
    std::vector<Vec2> curve;
    for (const NodeId n : edge.nodes) curve.push_back(mesh.control(n));
    Vec2 last = curve.front();
    for (int i = 1; i <= 64; ++i) {
      const Vec2 next = bernstein::evaluate<Vec2>(curve, i / 64.0);
      length[name] += norm(next - last);
      last = next;
    }
  }
  for (std::size_t e = 0; e < seen.size(); ++e)
    EXPECT_EQ(seen[e], mesh.is_boundary(EdgeId(e)) ? 1 : 0) << "edge " << e;
  return length;
}

}  // namespace bezel::test
