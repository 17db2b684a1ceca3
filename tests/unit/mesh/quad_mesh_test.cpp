#include "bezel/mesh/quad_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "bezel/base/error.hpp"

namespace bezel {
namespace {

std::vector<NodeId> ids(std::initializer_list<int> values) {
  std::vector<NodeId> out;
  for (const int v : values) out.emplace_back(v);
  return out;
}

std::string message_of(int degree, std::vector<Vec2> control, std::vector<NodeId> elements) {
  try {
    QuadMesh mesh(degree, std::move(control), std::move(elements));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

// 3---4---5
// | 0 | 1 |
// 0---1---2
const std::vector<Vec2> points{{0, 0}, {1, 0}, {2.5, 0}, {0, 1}, {1, 1.5}, {2.5, 1}};

TEST(QuadMesh, TwoQuadrilateralsShareASide) {
  // The second one is turned by a right angle: its corner 0 is node 2.
  const QuadMesh mesh(1, points, ids({0, 1, 3, 4, 2, 5, 1, 4}));
  EXPECT_EQ(mesh.element_count(), 2u);
  EXPECT_EQ(mesh.vertex_count(), 6u);
  ASSERT_EQ(mesh.edge_count(), 7u);
  std::size_t boundary = 0;
  for (std::size_t e = 0; e < 7; ++e) boundary += mesh.is_boundary(EdgeId(e)) ? 1 : 0;
  EXPECT_EQ(boundary, 6u);
  const auto first = mesh.edges(ElementId(0)), second = mesh.edges(ElementId(1));
  EXPECT_EQ(first[1].edge, second[2].edge);
  EXPECT_FALSE(first[1].reversed);
  EXPECT_TRUE(second[2].reversed);
  const auto adjacent = mesh.adjacent(first[1].edge);
  ASSERT_EQ(adjacent.size(), 2u);
  EXPECT_EQ(adjacent[0], (ElementSide{ElementId(0), 1, false}));
  EXPECT_EQ(adjacent[1], (ElementSide{ElementId(1), 2, true}));
  EXPECT_EQ(mesh.corner(ElementId(1), 2), NodeId(4));
  EXPECT_EQ(mesh.area(), 1.25 + 1.875);
  EXPECT_EQ(mesh.validity(ElementId(0)).status, Validity::valid);
  EXPECT_EQ(mesh.validity(ElementId(1)).status, Validity::valid);
  EXPECT_EQ(QuadMesh(1, points, ids({0, 3, 1, 4})).validity(ElementId(0)).status,
            Validity::inverted);
  EXPECT_EQ(mesh.box().hi, (Vec2{2.5, 1.5}));
}

TEST(QuadMesh, DifferentCurvesBetweenTheSameCornersAreASlit) {
  std::vector<Vec2> control;
  for (int j = 0; j <= 2; ++j)
    for (int i = 0; i <= 4; ++i) control.push_back(Vec2{0.5 * i, 0.5 * j});
  const std::vector<NodeId> shared = ids({0, 1, 2, 5, 6, 7, 10, 11, 12,  //
                                          2, 3, 4, 7, 8, 9, 12, 13, 14});
  EXPECT_EQ(QuadMesh(2, control, shared).edge_count(), 7u);
  control.push_back(Vec2{1.1, 0.5});
  std::vector<NodeId> slit = shared;
  slit[12] = NodeId(15);
  EXPECT_EQ(QuadMesh(2, control, slit).edge_count(), 8u);
}

TEST(QuadMesh, BadInput) {
  EXPECT_EQ(message_of(0, points, {}), "found geometric degree 0, expected 1 to 30");
  EXPECT_EQ(message_of(1, points, ids({0, 1, 3})),
            "found 3 element nodes, expected a multiple of 4 for degree 1");
  EXPECT_EQ(message_of(1, points, ids({0, 1, 3, 9})),
            "quadrilateral 0: node 9 does not exist, the mesh has 6");
  EXPECT_EQ(message_of(1, points, ids({0, 1, 3, 4, 1, 2, 1, 5})),
            "quadrilateral 1: corners 0 and 3 are both node 1, expected different nodes");
  std::vector<Vec2> nan = points;
  nan[4] = Vec2{0.0, std::nan("")};
  EXPECT_EQ(message_of(1, nan, ids({0, 1, 3, 4})),
            "quadrilateral 0: node 4 has y = nan, expected a finite value");
  nan = points;
  nan[2] = Vec2{std::nan(""), 0.0};
  EXPECT_EQ(message_of(1, nan, ids({0, 1, 3, 4})), "node 2 is not finite");
}

}  // namespace
}  // namespace bezel
