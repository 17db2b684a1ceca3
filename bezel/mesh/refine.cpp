// Uniform refinement.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <unordered_map>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/mesh/edge_finder.hpp"
#include "bezel/mesh/generate.hpp"
#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using short_names::at;

/// A new control point as a combination of an element's old ones. The weights are dyadic and sum
/// to 1.
struct Combination {
  std::vector<std::pair<int, double>> terms;

  Vec2 operator()(const std::vector<Vec2>& b) const {
    Vec2 sum{};
    for (const auto& [n, weight] : terms) sum += weight * b[at(n)];
    return sum;
  }
};

/// Blossom of a degree-g polynomial at `times[c]` copies of each of three points; every point is a
/// corner or the midpoint of two corners, given by its two ends.
Combination blossom(int g, const std::array<std::array<int, 2>, 3>& point,
                    const std::array<int, 3>& times) {
  std::vector<double> weight(at(bernstein::triangle_size(g)), 0.0);
  std::array<int, 3> chosen{};  // of the copies of a midpoint, how many go to its second end
  for (chosen[0] = 0; chosen[0] <= times[0]; ++chosen[0])
    for (chosen[1] = 0; chosen[1] <= times[1]; ++chosen[1])
      for (chosen[2] = 0; chosen[2] <= times[2]; ++chosen[2]) {
        std::array<int, 3> index{};
        double w = 1;
        for (int c = 0; c < 3; ++c) {
          index[at(point[at(c)][0])] += times[at(c)] - chosen[at(c)];
          index[at(point[at(c)][1])] += chosen[at(c)];
          w *= std::ldexp(binomial(times[at(c)], chosen[at(c)]), -times[at(c)]);
        }
        weight[at(bernstein::triangle_index(g, index[1], index[2]))] += w;
      }
  Combination combination;
  for (int n = 0; n < bernstein::triangle_size(g); ++n)
    if (weight[at(n)] > 0) combination.terms.emplace_back(n, weight[at(n)]);
  return combination;
}

/// Corners of the four children; {a, a} is corner a, {a, b} the midpoint of a and b.
constexpr std::array<std::array<std::array<int, 2>, 3>, 4> child_corners{{
    {{{0, 0}, {0, 1}, {2, 0}}},
    {{{0, 1}, {1, 1}, {1, 2}}},
    {{{2, 0}, {1, 2}, {2, 2}}},
    {{{1, 2}, {2, 0}, {0, 1}}},
}};

/// The halves of a curve of degree g: 2g + 1 control points, the middle one shared (de Casteljau).
void halve(std::vector<Vec2> b, std::vector<Vec2>& out) {
  const std::size_t g = b.size() - 1;
  out.resize(2 * g + 1);
  for (std::size_t level = 0; level <= g; ++level) {
    out[level] = b[0];
    out[2 * g - level] = b[g - level];
    for (std::size_t i = 0; i + level < g; ++i) b[i] = 0.5 * b[i] + 0.5 * b[i + 1];
  }
}

class UniformRefinement {
 public:
  explicit UniformRefinement(const TriangleMesh& mesh) : mesh_(mesh), g_(mesh.degree()) {
    const std::size_t per_edge = at(2 * g_ - 1),
                      per_element = at(3 * (g_ - 1) + 2 * (g_ - 1) * (g_ - 2));
    const std::size_t nodes = mesh.node_count() +
                              per_edge * (mesh.edge_count() + mesh.tags().edges.size()) +
                              per_element * mesh.element_count();
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
    if (nodes > most || 12 * mesh.element_count() > most)
      throw InputError("the refined mesh would have " + std::to_string(4 * mesh.element_count()) +
                       " elements and about " + std::to_string(nodes) +
                       " nodes, expected at most " + std::to_string(most) + " nodes and edges");
    control_.reserve(nodes);
  }

  TriangleMesh run() {
    keep_corners();
    halve_edges();
    split_elements();
    Tags tags = inherit_tags();
    return TriangleMesh(g_, std::move(control_), std::move(elements_), std::move(tags));
  }

 private:
  NodeId add(const Vec2& p) {
    control_.push_back(p);
    return NodeId(control_.size() - 1);
  }

  /// Corners and tagged points stay, in the old order.
  void keep_corners() {
    std::vector<bool> keep(mesh_.node_count(), false);
    for (std::size_t e = 0; e < mesh_.element_count(); ++e)
      for (int c = 0; c < 3; ++c)
        keep[mesh_.nodes(ElementId(e))[at(bernstein::triangle_corner(g_, c))].index()] = true;
    for (const TaggedPoint& point : mesh_.tags().points) keep[point.node.index()] = true;
    for (const TaggedEdge& edge : mesh_.tags().edges)
      keep[edge.nodes.front().index()] = keep[edge.nodes.back().index()] = true;
    kept_.assign(mesh_.node_count(), NodeId());
    for (std::size_t n = 0; n < keep.size(); ++n)
      if (keep[n]) kept_[n] = add(mesh_.control(NodeId(n)));
  }

  /// The 2g + 1 nodes of a curve and its midpoint, in its own direction.
  void halve_nodes(std::span<const NodeId> nodes, std::vector<NodeId>& out) {
    curve_.clear();
    for (const NodeId n : nodes) curve_.push_back(mesh_.control(n));
    halve(curve_, halves_);
    out.push_back(kept_[nodes.front().index()]);
    for (std::size_t m = 1; m + 1 < halves_.size(); ++m) out.push_back(add(halves_[m]));
    out.push_back(kept_[nodes.back().index()]);
  }

  void halve_edges() {
    edges_.reserve(at(2 * g_ + 1) * mesh_.edge_count());
    for (std::size_t e = 0; e < mesh_.edge_count(); ++e)
      halve_nodes(mesh_.edge_nodes(EdgeId(e)), edges_);
  }

  /// Node m = 0..2g of a refined side, in the element's direction.
  NodeId side_node(const SideEdge& side, int m) const {
    return edges_[side.edge.index() * at(2 * g_ + 1) + at(side.reversed ? 2 * g_ - m : m)];
  }

  void split_elements() {
    const std::size_t size = at(bernstein::triangle_size(g_));
    elements_.resize(4 * size * mesh_.element_count());
    // Child corner c, side r: the three sides the middle child shares, seen from the corner
    // children. Middle side 0 runs from the middle of side 1 to that of side 2: child 2, its side 0
    // reversed.
    constexpr std::array<std::array<int, 2>, 3> partner{{{2, 0}, {0, 1}, {1, 2}}};
    struct Inner {
      int child, position;
      Combination value;
    };
    std::vector<Inner> inner;
    for (int child = 0; child < 4; ++child)
      for (int n = 0; n < static_cast<int>(size); ++n) {
        const auto index = bernstein::triangle_multi_index(g_, n);
        const int zeros = static_cast<int>(std::count(index.begin(), index.end(), 0));
        if (zeros == 0 || (child == 3 && zeros == 1))
          inner.push_back({child, n, blossom(g_, child_corners[at(child)], index)});
      }

    std::vector<Vec2> b(size);
    for (std::size_t e = 0; e < mesh_.element_count(); ++e) {
      mesh_.gather(ElementId(e), b);
      NodeId* children = elements_.data() + 4 * size * e;
      const auto node = [&](int child, int position) -> NodeId& {
        return children[at(child) * size + at(position)];
      };
      const auto sides = mesh_.edges(ElementId(e));
      // Old sides: side s runs through child s (its side s) and then child s+1 (its side s).
      for (int s = 0; s < 3; ++s)
        for (int m = 0; m <= g_; ++m) {
          node(s, bernstein::triangle_side_index(g_, s, m)) = side_node(sides[at(s)], m);
          node((s + 1) % 3, bernstein::triangle_side_index(g_, s, m)) =
              side_node(sides[at(s)], g_ + m);
        }
      for (int c = 0; c < 3; ++c)
        node(3, bernstein::triangle_corner(g_, c)) = side_node(sides[at((c + 1) % 3)], g_);
      for (const Inner& point : inner) node(point.child, point.position) = add(point.value(b));
      for (int r = 0; r < 3; ++r)
        for (int m = 1; m < g_; ++m)
          node(partner[at(r)][0], bernstein::triangle_side_index(g_, partner[at(r)][1], g_ - m)) =
              node(3, bernstein::triangle_side_index(g_, r, m));
    }
  }

  Tags inherit_tags() {
    const Tags& old = mesh_.tags();
    Tags tags;
    tags.groups = old.groups;
    tags.entities = old.entities;
    tags.element_entity.reserve(4 * old.element_entity.size());
    for (const int entity : old.element_entity)
      tags.element_entity.insert(tags.element_entity.end(), 4, entity);
    for (const TaggedPoint& point : old.points)
      tags.points.push_back({kept_[point.node.index()], point.entity});
    if (old.edges.empty()) return tags;
    const EdgeFinder finder(mesh_);
    std::vector<NodeId> nodes;
    tags.edges.reserve(2 * old.edges.size());
    for (const TaggedEdge& edge : old.edges) {
      nodes.clear();
      const SideEdge found = finder.find(edge.nodes);
      if (found.edge.valid())
        for (int m = 0; m <= 2 * g_; ++m) nodes.push_back(side_node(found, m));
      else  // a curve beside the mesh
        halve_nodes(edge.nodes, nodes);
      tags.edges.push_back({{nodes.begin(), nodes.begin() + g_ + 1}, edge.entity});
      tags.edges.push_back({{nodes.begin() + g_, nodes.end()}, edge.entity});
    }
    return tags;
  }

  const TriangleMesh& mesh_;
  int g_;
  std::vector<Vec2> control_;
  std::vector<NodeId> kept_;   // new number of an old node
  std::vector<NodeId> edges_;  // 2g + 1 per old edge, canonical direction
  std::vector<NodeId> elements_;
  std::vector<Vec2> curve_, halves_;
};

}  // namespace

TriangleMesh refine_uniform(const TriangleMesh& mesh) {
  return UniformRefinement(mesh).run();
}

}  // namespace bezel
