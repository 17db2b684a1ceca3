#include "bezel/mesh/mesh.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/mesh/edge_table.hpp"

namespace bezel {
namespace {

template <int dim>
constexpr const char* element_kind = dim == 2 ? "triangle" : "tetrahedron";

/// The two corners of an element's local edge; in 2D these are the sides in their own direction.
constexpr std::array<std::array<int, 2>, 6> local_edges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};

/// Flat position of the multi-index that is d - m at corner a and m at corner b.
template <int dim>
constexpr int edge_index(int d, int a, int b, int m) {
  std::array<int, 4> index{};
  index[static_cast<std::size_t>(a)] = d - m;
  index[static_cast<std::size_t>(b)] += m;
  if constexpr (dim == 2)
    return bernstein::triangle_index(d, index[1], index[2]);
  else
    return bernstein::tetrahedron_index(d, index[1], index[2], index[3]);
}

template <int dim>
constexpr int corner_index(int d, int corner) {
  return edge_index<dim>(d, corner, corner == 0 ? 1 : 0, 0);
}

[[noreturn]] void fail(const char* kind, std::size_t number, const std::string& message) {
  InputPlace place;
  place.element_kind = kind;
  place.element = static_cast<std::int64_t>(number);
  throw InputError(std::move(place), message);
}

std::string missing_node(NodeId n, std::size_t count) {
  return "node " + std::to_string(n.value) + " does not exist, the mesh has " +
         std::to_string(count);
}

void check_tags(const Tags& tags, int degree, std::size_t element_count, std::size_t node_count) {
  if (!tags.element_entity.empty() && tags.element_entity.size() != element_count)
    throw InputError("the tags name an entity for " + std::to_string(tags.element_entity.size()) +
                     " elements, the mesh has " + std::to_string(element_count));
  const auto exists = [&](NodeId n) { return n.valid() && n.index() < node_count; };
  for (std::size_t e = 0; e < tags.edges.size(); ++e) {
    const auto& nodes = tags.edges[e].nodes;
    if (nodes.size() != static_cast<std::size_t>(degree) + 1)
      fail("tagged edge", e,
           "found " + std::to_string(nodes.size()) + " nodes, expected " +
               std::to_string(degree + 1) + " for degree " + std::to_string(degree));
    for (const NodeId n : nodes)
      if (!exists(n)) fail("tagged edge", e, missing_node(n, node_count));
  }
  for (std::size_t p = 0; p < tags.points.size(); ++p)
    if (!exists(tags.points[p].node))
      fail("tagged point", p, missing_node(tags.points[p].node, node_count));
}

}  // namespace

template <int dim>
SimplexMesh<dim>::SimplexMesh(int degree, std::vector<Vec<dim>> control,
                              std::vector<NodeId> elements, Tags tags)
    : degree_(degree),
      control_(std::move(control)),
      elements_(std::move(elements)),
      tags_(std::move(tags)) {
  if (degree < 1 || degree > max_degree)
    throw InputError("found geometric degree " + std::to_string(degree) + ", expected 1 to " +
                     std::to_string(max_degree));
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  const auto size = static_cast<std::size_t>(nodes_per_element());
  if (elements_.size() % size != 0)
    throw InputError("found " + std::to_string(elements_.size()) +
                     " element nodes, expected a multiple of " + std::to_string(size) +
                     " for degree " + std::to_string(degree));
  element_count_ = elements_.size() / size;
  if (control_.size() > most || element_count_ > most / edges_per_element)
    throw InputError("found " + std::to_string(control_.size()) + " nodes and " +
                     std::to_string(element_count_) + " elements, expected at most " +
                     std::to_string(most) + " nodes and edges");

  for (std::size_t i = 0; i < elements_.size(); ++i)
    if (!elements_[i].valid() || elements_[i].index() >= control_.size())
      fail(element_kind<dim>, i / size, missing_node(elements_[i], control_.size()));

  for (std::size_t n = 0; n < control_.size(); ++n)
    for (int axis = 0; axis < dim; ++axis) {
      if (std::isfinite(control_[n][axis])) continue;
      const std::string message = "node " + std::to_string(n) + " has " + "xyz"[axis] + " = " +
                                  std::to_string(control_[n][axis]) + ", expected a finite value";
      for (std::size_t i = 0; i < elements_.size(); ++i)
        if (elements_[i].index() == n) fail(element_kind<dim>, i / size, message);
      throw InputError(message);
    }

  std::vector<bool> is_corner(control_.size(), false);
  for (std::size_t e = 0; e < element_count_; ++e) {
    std::array<NodeId, static_cast<std::size_t>(dim) + 1> corner;
    for (int a = 0; a <= dim; ++a) {
      const NodeId n = elements_[e * size + static_cast<std::size_t>(corner_index<dim>(degree, a))];
      for (int b = 0; b < a; ++b)
        if (corner[static_cast<std::size_t>(b)] == n)
          fail(element_kind<dim>, e,
               "corners " + std::to_string(b) + " and " + std::to_string(a) + " are both node " +
                   std::to_string(n.value) + ", expected different nodes");
      corner[static_cast<std::size_t>(a)] = n;
      if (!is_corner[n.index()]) ++vertex_count_;
      is_corner[n.index()] = true;
    }
  }
  check_tags(tags_, degree, element_count_, control_.size());
  build_edges();
}

template <int dim>
void SimplexMesh<dim>::build_edges() {
  const auto length = static_cast<std::size_t>(degree_) + 1;
  std::vector<std::size_t> positions;
  for (std::size_t s = 0; s < edges_per_element; ++s)
    for (int m = 0; m <= degree_; ++m)
      positions.push_back(static_cast<std::size_t>(
          edge_index<dim>(degree_, local_edges[s][0], local_edges[s][1], m)));
  mesh_detail::EdgeTable table = mesh_detail::build_edge_table(
      elements_, static_cast<std::size_t>(nodes_per_element()), positions, length);
  edge_nodes_ = std::move(table.nodes);
  element_edges_ = std::move(table.sides);
  adjacent_offset_ = std::move(table.offset);
  adjacent_ = std::move(table.adjacent);
}

template <int dim>
void SimplexMesh<dim>::gather(ElementId e, std::span<Vec<dim>> out) const {
  const auto from = nodes(e);
  assume(out.size() == from.size(), "gather: wrong output size");
  for (std::size_t i = 0; i < from.size(); ++i) out[i] = control(from[i]);
}

template <int dim>
std::vector<Vec<dim>> SimplexMesh<dim>::gather(ElementId e) const {
  std::vector<Vec<dim>> out(static_cast<std::size_t>(nodes_per_element()));
  gather(e, out);
  return out;
}

template <int dim>
void SimplexMesh<dim>::gather_edge(EdgeId e, std::span<Vec<dim>> out) const {
  const auto from = edge_nodes(e);
  assume(out.size() == from.size(), "gather_edge: wrong output size");
  for (std::size_t i = 0; i < from.size(); ++i) out[i] = control(from[i]);
}

template <int dim>
Box<dim> SimplexMesh<dim>::box(ElementId e) const {
  Box<dim> box;
  for (const NodeId n : nodes(e)) box.include(control(n));
  return box;
}

template <int dim>
Box<dim> SimplexMesh<dim>::box() const {
  Box<dim> box;
  for (const NodeId n : elements_) box.include(control(n));
  return box;
}

template class SimplexMesh<2>;

}  // namespace bezel
