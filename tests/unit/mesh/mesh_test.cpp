#include "bezel/mesh/mesh.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "bezel/base/error.hpp"

namespace bezel {
namespace {

std::vector<NodeId> ids(std::initializer_list<int> values) {
  std::vector<NodeId> out;
  for (const int v : values) out.emplace_back(v);
  return out;
}

std::vector<NodeId> copy(std::span<const NodeId> nodes) {
  return {nodes.begin(), nodes.end()};
}
std::vector<ElementSide> copy(std::span<const ElementSide> s) {
  return {s.begin(), s.end()};
}

const std::vector<Vec2> square{Vec2{{0.1, 0.2}}, Vec2{{1.1, 0.2}}, Vec2{{1.1, 1.2}},
                               Vec2{{0.1, 1.2}}};

std::string message_of(int degree, std::vector<Vec2> control, std::vector<NodeId> elements,
                       Tags tags = {}) {
  try {
    TriangleMesh mesh(degree, std::move(control), std::move(elements), std::move(tags));
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Mesh, TwoTrianglesShareTheirDiagonal) {
  // 3---2
  // | / |
  // 0---1
  const TriangleMesh mesh(1, square, ids({0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(mesh.degree(), 1);
  EXPECT_EQ(mesh.element_count(), 2u);
  EXPECT_EQ(mesh.node_count(), 4u);
  EXPECT_EQ(mesh.vertex_count(), 4u);
  ASSERT_EQ(mesh.edge_count(), 5u);
  // Edges in order of first appearance, each from the smaller corner to the larger.
  const std::vector<std::vector<NodeId>> expected{ids({0, 1}), ids({1, 2}), ids({0, 2}),
                                                  ids({2, 3}), ids({0, 3})};
  for (std::size_t e = 0; e < 5; ++e) EXPECT_EQ(copy(mesh.edge_nodes(EdgeId(e))), expected[e]);
  const auto first = mesh.edges(ElementId(0)), second = mesh.edges(ElementId(1));
  EXPECT_EQ(first[0].edge, EdgeId(0));
  EXPECT_EQ(first[1].edge, EdgeId(1));
  EXPECT_EQ(first[2].edge, EdgeId(2));
  EXPECT_FALSE(first[0].reversed);
  EXPECT_FALSE(first[1].reversed);
  EXPECT_TRUE(first[2].reversed);
  EXPECT_EQ(second[0].edge, EdgeId(2));
  EXPECT_FALSE(second[0].reversed);
  EXPECT_EQ(copy(mesh.adjacent(EdgeId(2))),
            (std::vector<ElementSide>{{ElementId(0), 2, true}, {ElementId(1), 0, false}}));
  EXPECT_EQ(copy(mesh.adjacent(EdgeId(4))), (std::vector<ElementSide>{{ElementId(1), 2, true}}));
  EXPECT_FALSE(mesh.is_boundary(EdgeId(2)));
  EXPECT_TRUE(mesh.is_boundary(EdgeId(0)));
}

// Two quadratic triangles; node 8 is the inner control point of the diagonal.
std::vector<Vec2> quadratic_control() {
  auto control = square;
  for (const auto& p : {Vec2{{0.6, 0.2}}, Vec2{{1.1, 0.7}}, Vec2{{0.6, 1.2}}, Vec2{{0.1, 0.7}},
                        Vec2{{0.5, 0.8}}, Vec2{{0.7, 0.7}}})
    control.push_back(p);
  return control;
}

TEST(Mesh, CurvedEdgeHasOneGeometryInCanonicalDirection) {
  const TriangleMesh mesh(2, quadratic_control(), ids({0, 4, 1, 8, 5, 2, 2, 6, 3, 8, 7, 0}));
  ASSERT_EQ(mesh.edge_count(), 5u);
  EXPECT_EQ(mesh.vertex_count(), 4u);
  const SideEdge diagonal = mesh.edges(ElementId(0))[2];
  EXPECT_TRUE(diagonal.reversed);
  EXPECT_EQ(copy(mesh.edge_nodes(diagonal.edge)), ids({0, 8, 2}));
  EXPECT_EQ(mesh.edges(ElementId(1))[2].edge, diagonal.edge);
  EXPECT_FALSE(mesh.edges(ElementId(1))[2].reversed);
  std::vector<Vec2> curve(3);
  mesh.gather_edge(diagonal.edge, curve);
  EXPECT_EQ(curve, (std::vector<Vec2>{square[0], Vec2{{0.5, 0.8}}, square[2]}));
  EXPECT_EQ(mesh.gather(ElementId(1))[4], (Vec2{{0.1, 0.7}}));
}

TEST(Mesh, SameCornersWithAnotherCurveAreAnotherEdge) {
  const TriangleMesh mesh(2, quadratic_control(), ids({0, 4, 1, 8, 5, 2, 2, 6, 3, 9, 7, 0}));
  EXPECT_EQ(mesh.edge_count(), 6u);
  EXPECT_TRUE(mesh.is_boundary(mesh.edges(ElementId(0))[2].edge));
  EXPECT_TRUE(mesh.is_boundary(mesh.edges(ElementId(1))[2].edge));
}

TEST(Mesh, ThreeElementsOnAnEdgeAreAllListed) {
  auto control = square;
  control.push_back(Vec2{{0.3, 1.7}});
  const TriangleMesh mesh(1, control, ids({0, 1, 2, 0, 2, 3, 0, 2, 4}));
  const EdgeId diagonal = mesh.edges(ElementId(2))[0].edge;
  EXPECT_EQ(copy(mesh.adjacent(diagonal)),
            (std::vector<ElementSide>{
                {ElementId(0), 2, true}, {ElementId(1), 0, false}, {ElementId(2), 0, false}}));
}

TEST(Mesh, UnusedNodesAreAllowedAndLeftOutOfTheBox) {
  auto control = square;
  control.push_back(Vec2{{70.7, -3.3}});
  const TriangleMesh mesh(1, control, ids({0, 1, 2}));
  EXPECT_EQ(mesh.node_count(), 5u);
  EXPECT_EQ(mesh.vertex_count(), 3u);
  EXPECT_EQ(mesh.box().hi, (Vec2{{1.1, 1.2}}));
  EXPECT_EQ(mesh.box(ElementId(0)).lo, (Vec2{{0.1, 0.2}}));
}

TEST(Mesh, WithoutElementsIsEmpty) {
  const TriangleMesh mesh(3, {}, {});
  EXPECT_EQ(mesh.element_count(), 0u);
  EXPECT_EQ(mesh.edge_count(), 0u);
  EXPECT_TRUE(mesh.box().empty());
}

TEST(Mesh, TagsAreKept) {
  Tags tags;
  tags.groups = {{2, 7, "plate"}};
  tags.entities = {{2, 1, {7}}};
  tags.element_entity = {1, 1};
  tags.edges = {{ids({1, 0}), 4}};
  tags.points = {{NodeId(3), 2}};
  const TriangleMesh mesh(1, square, ids({0, 1, 2, 0, 2, 3}), tags);
  EXPECT_EQ(mesh.tags(), tags);
}

TEST(Mesh, EveryDegreeSharesEdges) {
  for (int g = 1; g <= TriangleMesh::max_degree; ++g) {
    // Two triangles with separate inner points; side 2 of the first is side 0 of the second,
    // reversed.
    const auto n = static_cast<std::size_t>(bernstein::triangle_size(g));
    std::vector<NodeId> elements(2 * n);
    int next = 0;
    for (std::size_t i = 0; i < n; ++i) elements[i] = NodeId(next++);
    for (std::size_t i = 0; i < n; ++i) elements[n + i] = NodeId(next++);
    for (int m = 0; m <= g; ++m)
      elements[n + static_cast<std::size_t>(bernstein::triangle_side_index(g, 0, g - m))] =
          elements[static_cast<std::size_t>(bernstein::triangle_side_index(g, 2, m))];
    std::vector<Vec2> control(static_cast<std::size_t>(next));
    const TriangleMesh mesh(g, control, elements);
    ASSERT_EQ(mesh.edge_count(), 5u) << g;
    const SideEdge a = mesh.edges(ElementId(0))[2], b = mesh.edges(ElementId(1))[0];
    EXPECT_EQ(a.edge, b.edge);
    EXPECT_NE(a.reversed, b.reversed);
    EXPECT_LT(mesh.edge_nodes(a.edge).front(), mesh.edge_nodes(a.edge).back());
    EXPECT_EQ(mesh.adjacent(a.edge).size(), 2u);
  }
}

TEST(MeshBadInput, Degree) {
  EXPECT_EQ(message_of(0, square, ids({0, 1, 2})), "found geometric degree 0, expected 1 to 10");
  EXPECT_EQ(message_of(11, square, {}), "found geometric degree 11, expected 1 to 10");
}

TEST(MeshBadInput, Size) {
  EXPECT_EQ(message_of(2, square, ids({0, 1, 2, 3})),
            "found 4 element nodes, expected a multiple of 6 for degree 2");
}

TEST(MeshBadInput, MissingNode) {
  EXPECT_EQ(message_of(1, square, ids({0, 1, 2, 0, 2, 4})),
            "triangle 1: node 4 does not exist, the mesh has 4");
  EXPECT_EQ(message_of(1, square, ids({0, 1, -1})),
            "triangle 0: node -1 does not exist, the mesh has 4");
  try {
    TriangleMesh mesh(1, square, ids({0, 1, 2, 0, 2, 4}));
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.place().element_kind, "triangle");
    EXPECT_EQ(error.place().element, 1);
  }
}

TEST(MeshBadInput, RepeatedCorner) {
  EXPECT_EQ(message_of(1, square, ids({0, 1, 2, 3, 2, 3})),
            "triangle 1: corners 0 and 2 are both node 3, expected different nodes");
}

TEST(MeshBadInput, NotFinite) {
  auto control = square;
  control[3][1] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(message_of(1, control, ids({0, 1, 2, 0, 2, 3})),
            "triangle 1: node 3 has y = inf, expected a finite value");
  EXPECT_EQ(message_of(1, control, ids({0, 1, 2})), "node 3 has y = inf, expected a finite value");
}

TEST(MeshBadInput, Tags) {
  Tags tags;
  tags.element_entity = {1};
  EXPECT_EQ(message_of(1, square, ids({0, 1, 2, 0, 2, 3}), tags),
            "the tags name an entity for 1 elements, the mesh has 2");
  tags = {};
  tags.edges = {{ids({0, 1}), 1}, {ids({0, 1, 2}), 1}};
  EXPECT_EQ(message_of(1, square, ids({0, 1, 2}), tags),
            "tagged edge 1: found 3 nodes, expected 2 for degree 1");
  tags.edges = {{ids({0, 9}), 1}};
  EXPECT_EQ(message_of(1, square, ids({0, 1, 2}), tags),
            "tagged edge 0: node 9 does not exist, the mesh has 4");
  tags = {};
  tags.points = {{NodeId(-1), 1}};
  EXPECT_EQ(message_of(1, square, ids({0, 1, 2}), tags),
            "tagged point 0: node -1 does not exist, the mesh has 4");
}

}  // namespace
}  // namespace bezel
