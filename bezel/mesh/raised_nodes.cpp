#include "bezel/mesh/raised_nodes.hpp"

#include "bezel/bernstein/index.hpp"

namespace bezel {

RaisedNodes::RaisedNodes(const TriangleMesh& straight, int g)
    : straight_(&straight),
      g_(g),
      edge_nodes_(static_cast<std::size_t>(g - 1)),
      inner_nodes_(static_cast<std::size_t>((g - 1) * (g - 2) / 2)),
      edge_base_(straight.control().size()),
      inner_base_(edge_base_ + edge_nodes_ * straight.edge_count()) {}

std::size_t RaisedNodes::count() const {
  return inner_base_ + inner_nodes_ * straight_->element_count();
}

std::vector<NodeId> RaisedNodes::elements() const {
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(g_));
  std::vector<NodeId> all(size * straight_->element_count());
  for (std::size_t e = 0; e < straight_->element_count(); ++e) {
    NodeId* nodes = all.data() + e * size;
    const auto corners = straight_->nodes(ElementId(e));
    for (int c = 0; c < 3; ++c)
      nodes[bernstein::triangle_corner(g_, c)] = corners[static_cast<std::size_t>(c)];
    const auto sides = straight_->edges(ElementId(e));
    for (int s = 0; s < 3; ++s)
      for (int m = 1; m < g_; ++m)
        nodes[bernstein::triangle_side_index(g_, s, m)] =
            edge(sides[static_cast<std::size_t>(s)], m);
    std::size_t next = inner(ElementId(e));
    for (int k = 1; k < g_ - 1; ++k)
      for (int j = 1; j < g_ - k; ++j) nodes[bernstein::triangle_index(g_, j, k)] = NodeId(next++);
  }
  return all;
}

}  // namespace bezel
