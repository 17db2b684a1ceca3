// Identities of meshes, generators, refinement and search for random and degenerate input.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/mesh/bvh.hpp"
#include "bezel/mesh/generate.hpp"
#include "unit/mesh/mesh_checks.hpp"

namespace bezel {
namespace {

using namespace test;

struct Shape {
  TriangleMesh mesh;
  long euler;
  double area;
};

/// A random shape with random options.
Shape random_shape(RandomStream& random) {
  GenerateOptions o;
  o.degree = 1 + static_cast<int>(random.below(5));
  o.size = random.uniform(0.15, 0.6);
  o.pattern = random.below(3) == 0 ? Pattern::structured : Pattern::unstructured;
  o.seed = random.next();
  o.centre = Vec2{{random.uniform(-3, 3), random.uniform(-3, 3)}};
  o.curve_jitter = random.below(2) == 0 ? 0 : random.uniform(0, 0.3);
  const double a = random.uniform(0.3, 1), b = random.uniform(0.3, 1);
  constexpr double pi = 3.141592653589793;
  switch (random.below(4)) {
    case 0:
      return {generate_rectangle(a, b, o), 1, a * b};
    case 1:
      return {generate_disc(a, o), 1, pi * a * a};
    case 2:
      return {generate_annulus(a, a + b, o), 0, pi * b * (2 * a + b)};
    default:
      return {generate_lshape(a, o), 1, 0.75 * a * a};
  }
}

TEST(MeshProperty, GeneratedAndRefinedMeshesAreWellFormed) {
  RandomStream random("GeneratedAndRefinedMeshesAreWellFormed", 1);
  for (int round = 0; round < 60; ++round) {
    SCOPED_TRACE(round);
    const auto [mesh, expected_euler, area] = random_shape(random);
    expect_consistent(mesh);
    expect_all_valid(mesh);
    EXPECT_EQ(euler(mesh), expected_euler);
    // A circle of eight chords or more covers 2 sqrt(2) / pi of its disc; six, 0.82.
    EXPECT_NEAR(total_area(mesh) / area, 1, mesh.degree() == 1 ? 0.2 : 1e-2);
    boundary_lengths(mesh);
    const auto fine = refine_uniform(mesh);
    expect_consistent(fine);
    expect_all_valid(fine);
    EXPECT_EQ(euler(fine), expected_euler);
    EXPECT_NEAR(total_area(fine), total_area(mesh), 1e-13);
    boundary_lengths(fine);
  }
}

// Triangles over few nodes: sides shared by many, in both directions.
TEST(MeshProperty, AdjacencyOfRandomTriangleSoupsAgreesWithAMap) {
  RandomStream random("AdjacencyOfRandomTriangleSoupsAgreesWithAMap", 1);
  for (int round = 0; round < 200; ++round) {
    SCOPED_TRACE(round);
    const int g = 1 + static_cast<int>(random.below(4));
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(g));
    const std::uint64_t nodes = 3 + random.below(8), count = random.below(40);
    std::vector<NodeId> elements;
    while (elements.size() < count * size) {
      std::vector<NodeId> one;
      for (std::size_t i = 0; i < size; ++i)
        one.emplace_back(static_cast<std::int32_t>(random.below(nodes)));
      std::set<NodeId> corners;
      for (int c = 0; c < 3; ++c)
        corners.insert(one[static_cast<std::size_t>(bernstein::triangle_corner(g, c))]);
      if (corners.size() == 3) elements.insert(elements.end(), one.begin(), one.end());
    }
    const TriangleMesh mesh(g, std::vector<Vec2>(nodes), elements);
    std::map<std::vector<NodeId>, std::vector<ElementSide>> expected;
    for (std::size_t e = 0; e < count; ++e)
      for (int s = 0; s < 3; ++s) {
        std::vector<NodeId> along;
        for (int m = 0; m <= g; ++m)
          along.push_back(elements[e * size + static_cast<std::size_t>(
                                                  bernstein::triangle_side_index(g, s, m))]);
        const bool reversed = along.front() > along.back();
        if (reversed) std::reverse(along.begin(), along.end());
        expected[along].push_back({ElementId(e), s, reversed});
      }
    ASSERT_EQ(mesh.edge_count(), expected.size());
    for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
      const auto along = mesh.edge_nodes(EdgeId(e));
      const auto adjacent = mesh.adjacent(EdgeId(e));
      EXPECT_EQ(std::vector<ElementSide>(adjacent.begin(), adjacent.end()),
                expected.at({along.begin(), along.end()}));
      for (const ElementSide& side : adjacent)
        EXPECT_EQ(mesh.edges(side.element)[static_cast<std::size_t>(side.side)].edge, EdgeId(e));
    }
  }
}

// Refinement gives the same function of the reference triangle: points of a child are points of its
// parent.
TEST(MeshProperty, ChildrenMapLikeTheirParent) {
  RandomStream random("ChildrenMapLikeTheirParent", 1);
  using bernstein::Lambda;
  const Lambda c0{1, 0, 0}, c1{0, 1, 0}, c2{0, 0, 1}, m0{0.5, 0.5, 0}, m1{0, 0.5, 0.5},
      m2{0.5, 0, 0.5};
  const std::array<std::array<Lambda, 3>, 4> corners{
      {{c0, m0, m2}, {m0, c1, m1}, {m2, m1, c2}, {m1, m2, m0}}};
  for (int round = 0; round < 30; ++round) {
    const TriangleMesh mesh = random_shape(random).mesh;
    const auto fine = refine_uniform(mesh);
    for (int probe = 0; probe < 50; ++probe) {
      const auto e = random.below(mesh.element_count()), c = random.below(4);
      const double v = random.uniform(), w = random.uniform() * (1 - v);
      const Lambda inside{1 - v - w, v, w};
      Lambda above{};
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t i = 0; i < 3; ++i) above[i] += inside[k] * corners[c][k][i];
      const Vec2 p =
          bernstein::evaluate<Vec2>(mesh.degree(), fine.gather(ElementId(4 * e + c)), inside);
      const Vec2 q = bernstein::evaluate<Vec2>(mesh.degree(), mesh.gather(ElementId(e)), above);
      EXPECT_LT(norm(p - q), 1e-14);
    }
  }
}

TEST(MeshProperty, TreeOverElementBoxesAgreesWithBruteForce) {
  RandomStream random("TreeOverElementBoxesAgreesWithBruteForce", 1);
  for (int round = 0; round < 20; ++round) {
    const TriangleMesh mesh = random_shape(random).mesh;
    std::vector<Box2> boxes;
    for (std::size_t e = 0; e < mesh.element_count(); ++e) boxes.push_back(mesh.box(ElementId(e)));
    const Bvh tree(boxes);
    for (int probe = 0; probe < 50; ++probe) {
      // Corners of boxes are the hard queries: they only touch.
      Box2 query = boxes[random.below(boxes.size())];
      if (probe % 2 == 0) query.hi = query.lo;
      std::vector<std::int32_t> found, expected;
      tree.query(query, found);
      std::sort(found.begin(), found.end());
      for (std::size_t i = 0; i < boxes.size(); ++i)
        if (boxes[i].overlaps(query)) expected.push_back(static_cast<std::int32_t>(i));
      EXPECT_EQ(found, expected);
    }
    for (int probe = 0; probe < 50; ++probe) {
      const Vec2 p{{random.uniform(-5, 5), random.uniform(-5, 5)}};
      const auto exact = [&](std::int32_t i) {  // to the nearest control point
        double best = 1e300;
        for (const NodeId n : mesh.nodes(ElementId(i)))
          best = std::min(best, norm(mesh.control(n) - p));
        return best;
      };
      std::int32_t nearest = 0;
      for (std::int32_t i = 1; i < static_cast<std::int32_t>(boxes.size()); ++i)
        if (exact(i) < exact(nearest)) nearest = i;
      EXPECT_EQ(tree.nearest(p, exact), nearest);
    }
  }
}

}  // namespace
}  // namespace bezel
