#include "bezel/io/nodal.hpp"

#include <algorithm>
#include <utility>

#include "bezel/bernstein/interval.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel::files {
namespace {

using bernstein::triangle_corner;
using bernstein::triangle_index;
using bernstein::triangle_side_index;
using bernstein::triangle_size;
using short_names::at;

std::vector<double> convert_interval(std::span<const double> b, Conversion conversion) {
  return conversion == Conversion::to_nodal ? bernstein::to_lagrange<double>(b)
                                            : bernstein::from_lagrange<double>(b);
}

std::vector<double> convert_triangle(int d, std::span<const double> b, Conversion conversion) {
  return conversion == Conversion::to_nodal ? bernstein::to_lagrange<double>(d, b)
                                            : bernstein::from_lagrange<double>(d, b);
}

std::uint64_t end_key(NodeId a, NodeId b) {
  if (b < a) std::swap(a, b);
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(a.value)) << 32 |
         static_cast<std::uint32_t>(b.value);
}

}  // namespace

NodeLayout node_layout(const TriangleMesh& mesh) {
  const int g = mesh.degree();
  const auto size = at(triangle_size(g));
  NodeLayout layout;
  layout.elements.assign(mesh.connectivity().begin(), mesh.connectivity().end());
  layout.origin.resize(mesh.node_count());
  for (std::size_t n = 0; n < layout.origin.size(); ++n) layout.origin[n] = NodeId(n);
  if (g == 1) return layout;  // corners only

  // A part is 0 for corners, else a number for the place in the edge or in the element.
  constexpr std::uint64_t unset = ~std::uint64_t{0};
  std::vector<std::uint64_t> part_of(mesh.node_count(), unset);
  std::vector<std::unordered_map<std::uint64_t, NodeId>> copies;  // per node, seldom used
  std::unordered_map<std::size_t, std::size_t> copies_of;
  const auto claim = [&](NodeId& node, std::uint64_t part) {
    if (part_of[node.index()] == unset) part_of[node.index()] = part;
    if (part_of[node.index()] == part) return;
    const auto [place, is_new] = copies_of.try_emplace(node.index(), copies.size());
    if (is_new) copies.emplace_back();
    const auto [copy, added] =
        copies[place->second].try_emplace(part, NodeId(layout.origin.size()));
    if (added) layout.origin.push_back(node);
    node = copy->second;
  };
  const std::uint64_t inner_start = 1 + mesh.edge_count() * at(g + 1);
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    NodeId* const nodes = layout.elements.data() + e * size;
    for (int corner = 0; corner < 3; ++corner) claim(nodes[triangle_corner(g, corner)], 0);
  }
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    NodeId* const nodes = layout.elements.data() + e * size;
    const auto edges = mesh.edges(ElementId(e));
    for (int side = 0; side < 3; ++side)
      for (int m = 1; m < g; ++m) {
        const SideEdge& edge = edges[at(side)];
        const auto place = at(edge.reversed ? g - m : m);
        claim(nodes[triangle_side_index(g, side, m)], 1 + edge.edge.index() * at(g + 1) + place);
      }
    for (int k = 1; k < g; ++k)
      for (int j = 1; j + k < g; ++j) {
        const int n = triangle_index(g, j, k);
        claim(nodes[n], inner_start + e * size + at(n));
      }
  }
  return layout;
}

std::vector<double> convert_nodes(const TriangleMesh& mesh, const NodeLayout& layout,
                                  std::span<const double> values, int components,
                                  Conversion conversion) {
  const int g = mesh.degree();
  const auto size = at(triangle_size(g));
  const auto width = at(components);
  std::vector<double> out(values.begin(), values.end());
  if (g == 1) return out;
  std::vector<double> line(at(g + 1)), patch(size);
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const ElementSide& side = mesh.adjacent(EdgeId(e)).front();
    const NodeId* const nodes = layout.elements.data() + side.element.index() * size;
    const auto node = [&](int m) {
      return nodes[triangle_side_index(g, side.side, side.reversed ? g - m : m)].index();
    };
    for (std::size_t c = 0; c < width; ++c) {
      for (int m = 0; m <= g; ++m) line[at(m)] = values[node(m) * width + c];
      const std::vector<double> converted = convert_interval(line, conversion);
      for (int m = 1; m < g; ++m) out[node(m) * width + c] = converted[at(m)];
    }
  }
  if (g == 2) return out;
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const NodeId* const nodes = layout.elements.data() + e * size;
    for (std::size_t c = 0; c < width; ++c) {
      for (std::size_t i = 0; i < size; ++i) patch[i] = values[nodes[i].index() * width + c];
      const std::vector<double> converted = convert_triangle(g, patch, conversion);
      for (int k = 1; k < g; ++k)
        for (int j = 1; j + k < g; ++j) {
          const auto i = at(triangle_index(g, j, k));
          out[nodes[i].index() * width + c] = converted[i];
        }
    }
  }
  return out;
}

TriangleMesh convert_mesh(const TriangleMesh& mesh, Conversion conversion) {
  NodeLayout layout = node_layout(mesh);
  std::vector<double> values(layout.origin.size() * 2);
  for (std::size_t n = 0; n < layout.origin.size(); ++n)
    for (int axis = 0; axis < 2; ++axis)
      values[2 * n + at(axis)] = mesh.control(layout.origin[n])[axis];
  values = convert_nodes(mesh, layout, values, 2, conversion);
  std::vector<Vec2> control(layout.origin.size());
  for (std::size_t n = 0; n < control.size(); ++n) control[n] = {values[2 * n], values[2 * n + 1]};
  return TriangleMesh(mesh.degree(), std::move(control), std::move(layout.elements), mesh.tags());
}

namespace {

std::vector<double> change_interval(std::span<const double> b, int by) {
  return by >= 0 ? bernstein::elevate<double>(b, by) : bernstein::reduce<double>(b, -by);
}

std::vector<double> change_triangle(int d, std::span<const double> b, int by) {
  return by >= 0 ? bernstein::elevate<double>(d, b, by) : bernstein::reduce<double>(d, b, -by);
}

}  // namespace

TriangleMesh change_degree(const TriangleMesh& mesh, int degree) {
  const int g = mesh.degree();
  const int by = degree - g;
  if (by == 0) return mesh;
  const auto size = at(triangle_size(degree));
  const auto per_edge = at(degree - 1);

  std::vector<NodeId> vertex(mesh.node_count());
  for (std::size_t e = 0; e < mesh.element_count(); ++e)
    for (int corner = 0; corner < 3; ++corner)
      vertex[mesh.nodes(ElementId(e))[at(triangle_corner(g, corner))].index()] = NodeId(0);
  std::vector<Vec2> control;
  for (std::size_t n = 0; n < vertex.size(); ++n)
    if (vertex[n].valid()) {
      vertex[n] = NodeId(control.size());
      control.push_back(mesh.control(NodeId(n)));
    }

  const std::size_t edge_start = control.size();
  control.resize(edge_start + mesh.edge_count() * per_edge);
  std::vector<double> line(at(g + 1));
  for (std::size_t e = 0; e < mesh.edge_count(); ++e)
    for (int axis = 0; axis < 2; ++axis) {
      const auto nodes = mesh.edge_nodes(EdgeId(e));
      for (std::size_t m = 0; m < line.size(); ++m) line[m] = mesh.control(nodes[m])[axis];
      const std::vector<double> changed = change_interval(line, by);
      for (std::size_t m = 0; m < per_edge; ++m)
        control[edge_start + e * per_edge + m][axis] = changed[m + 1];
    }

  std::vector<NodeId> elements(mesh.element_count() * size);
  std::vector<double> patch(at(triangle_size(g)));
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const auto nodes = mesh.nodes(ElementId(e));
    NodeId* const out = elements.data() + e * size;
    for (int corner = 0; corner < 3; ++corner)
      out[triangle_corner(degree, corner)] = vertex[nodes[at(triangle_corner(g, corner))].index()];
    const auto edges = mesh.edges(ElementId(e));
    for (int side = 0; side < 3; ++side)
      for (int m = 1; m < degree; ++m) {
        const SideEdge& edge = edges[at(side)];
        const auto place = at(edge.reversed ? degree - m : m) - 1;
        out[triangle_side_index(degree, side, m)] =
            NodeId(edge_start + edge.edge.index() * per_edge + place);
      }
    if (degree < 3) continue;
    const std::size_t inner_start = control.size();
    for (int k = 1; k < degree; ++k)
      for (int j = 1; j + k < degree; ++j) {
        out[triangle_index(degree, j, k)] = NodeId(control.size());
        control.emplace_back();
      }
    for (int axis = 0; axis < 2; ++axis) {
      for (std::size_t i = 0; i < patch.size(); ++i) patch[i] = mesh.control(nodes[i])[axis];
      const std::vector<double> changed = change_triangle(g, patch, by);
      std::size_t next = inner_start;
      for (int k = 1; k < degree; ++k)
        for (int j = 1; j + k < degree; ++j)
          control[next++][axis] = changed[at(triangle_index(degree, j, k))];
    }
  }

  Tags tags = mesh.tags();
  tags.edges.clear();
  tags.points.clear();
  if (!mesh.tags().edges.empty()) {
    const EdgeFinder finder(mesh);
    for (const TaggedEdge& edge : mesh.tags().edges) {
      const auto found = finder.find(edge.nodes);
      if (!found) continue;
      TaggedEdge changed{std::vector<NodeId>(at(degree + 1)), edge.entity};
      const auto old = mesh.edge_nodes(found->edge);
      for (int m = 0; m <= degree; ++m) {
        const NodeId node = m == 0 ? vertex[old.front().index()]
                            : m == degree
                                ? vertex[old.back().index()]
                                : NodeId(edge_start + found->edge.index() * per_edge + at(m - 1));
        changed.nodes[at(found->reversed ? degree - m : m)] = node;
      }
      tags.edges.push_back(std::move(changed));
    }
  }
  for (const TaggedPoint& point : mesh.tags().points)
    if (vertex[point.node.index()].valid())
      tags.points.push_back({vertex[point.node.index()], point.entity});
  return TriangleMesh(degree, std::move(control), std::move(elements), std::move(tags));
}

EdgeFinder::EdgeFinder(const TriangleMesh& mesh) : mesh_(mesh) {
  by_ends_.reserve(mesh.edge_count());
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const auto nodes = mesh.edge_nodes(EdgeId(e));
    by_ends_.emplace(end_key(nodes.front(), nodes.back()), EdgeId(e));
  }
}

std::optional<EdgeFinder::Found> EdgeFinder::find(std::span<const NodeId> nodes) const {
  if (nodes.size() != at(mesh_.degree() + 1)) return std::nullopt;
  const auto [first, last] = by_ends_.equal_range(end_key(nodes.front(), nodes.back()));
  for (auto it = first; it != last; ++it) {
    const auto edge = mesh_.edge_nodes(it->second);
    if (std::equal(nodes.begin(), nodes.end(), edge.begin())) return Found{it->second, false};
    if (std::equal(nodes.rbegin(), nodes.rend(), edge.begin())) return Found{it->second, true};
  }
  return std::nullopt;
}

}  // namespace bezel::files
