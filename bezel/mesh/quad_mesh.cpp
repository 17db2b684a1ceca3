#include "bezel/mesh/quad_mesh.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/mesh/edge_table.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel {
namespace {

[[noreturn]] void fail(std::size_t element, const std::string& message) {
  throw InputError({{}, 0, "quadrilateral", static_cast<std::int64_t>(element)}, message);
}

}  // namespace

QuadMesh::QuadMesh(int degree, std::vector<Vec2> control, std::vector<NodeId> elements)
    : degree_(degree), control_(std::move(control)), elements_(std::move(elements)) {
  if (degree < 1 || degree > max_degree)
    throw InputError("found geometric degree " + std::to_string(degree) + ", expected 1 to " +
                     std::to_string(max_degree));
  const auto size = static_cast<std::size_t>(nodes_per_element());
  if (elements_.size() % size != 0)
    throw InputError("found " + std::to_string(elements_.size()) +
                     " element nodes, expected a multiple of " + std::to_string(size) +
                     " for degree " + std::to_string(degree));
  constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  if (control_.size() > most || elements_.size() / size > most / 4)
    throw InputError("found " + std::to_string(control_.size()) + " nodes and " +
                     std::to_string(elements_.size() / size) + " elements, expected at most " +
                     std::to_string(most) + " nodes and edges");
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    const NodeId n = elements_[i];
    if (!n.valid() || n.index() >= control_.size())
      fail(i / size, "node " + std::to_string(n.value) + " does not exist, the mesh has " +
                         std::to_string(control_.size()));
    for (int axis = 0; axis < 2; ++axis)
      if (!std::isfinite(control_[n.index()][axis]))
        fail(i / size, "node " + std::to_string(n.value) + " has " + "xy"[axis] + " = " +
                           std::to_string(control_[n.index()][axis]) + ", expected a finite value");
  }
  for (std::size_t n = 0; n < control_.size(); ++n)
    if (!std::isfinite(control_[n].x()) || !std::isfinite(control_[n].y()))
      throw InputError("node " + std::to_string(n) + " is not finite");

  std::vector<bool> is_corner(control_.size(), false);
  for (std::size_t e = 0; e < element_count(); ++e)
    for (int a = 0; a < 4; ++a) {
      const NodeId n = corner(ElementId(e), a);
      for (int b = 0; b < a; ++b)
        if (corner(ElementId(e), b) == n)
          fail(e, "corners " + std::to_string(b) + " and " + std::to_string(a) + " are both node " +
                      std::to_string(n.value) + ", expected different nodes");
      if (!is_corner[n.index()]) ++vertex_count_;
      is_corner[n.index()] = true;
    }

  std::vector<std::size_t> positions;
  for (int side = 0; side < 4; ++side)
    for (int m = 0; m <= degree; ++m)
      positions.push_back(static_cast<std::size_t>(quad_side_index(degree, side, m)));
  mesh_detail::EdgeTable table = mesh_detail::build_edge_table(
      elements_, size, positions, static_cast<std::size_t>(degree) + 1);
  edge_nodes_ = std::move(table.nodes);
  element_edges_ = std::move(table.sides);
  adjacent_offset_ = std::move(table.offset);
  adjacent_ = std::move(table.adjacent);
}

NodeId QuadMesh::corner(ElementId e, int corner) const {
  return nodes(e)[static_cast<std::size_t>(quad_side_index(degree_, corner, 0))];
}

std::vector<Vec2> QuadMesh::gather(ElementId e) const {
  std::vector<Vec2> out;
  for (const NodeId n : nodes(e)) out.push_back(control(n));
  return out;
}

Box2 QuadMesh::box() const {
  Box2 box;
  for (const NodeId n : elements_) box.include(control(n));
  return box;
}

std::array<SideEdge, 4> QuadMesh::edges(ElementId e) const {
  std::array<SideEdge, 4> sides;
  for (std::size_t s = 0; s < 4; ++s) sides[s] = element_edges_[4 * e.index() + s];
  return sides;
}

QuadValidity QuadMesh::validity(ElementId e) const {
  return check_quad_validity(degree_, gather(e));
}

double QuadMesh::area() const {
  std::vector<double> areas;
  for (std::size_t e = 0; e < element_count(); ++e)
    areas.push_back(quad_area(degree_, gather(ElementId(e))));
  return sum(areas);
}

}  // namespace bezel
