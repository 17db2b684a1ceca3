// A spectral solution as a field on triangles.

#include <fmt/format.h>

#include <array>
#include <memory>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/fit/tensor_grid.hpp"
#include "bezel/mesh/mesh.hpp"
#include "bezel/solve/spectral.hpp"

namespace bezel {
namespace {

/// Numbers of an element's (m+1)^2 lattice points: those on vertices and edges as the topology has
/// them, the others after these, element by element.
std::vector<NodeId> lattice_nodes(const QuadTopology& topology, std::size_t element, int m) {
  const int inner = m - 1;
  std::vector<NodeId> out(static_cast<std::size_t>(quad_size(m)));
  std::size_t next = topology.skeleton_size(m) + element * static_cast<std::size_t>(inner * inner);
  for (int j = 1; j < m; ++j)
    for (int i = 1; i < m; ++i) out[static_cast<std::size_t>(quad_index(m, i, j))] = NodeId(next++);
  for (int side = 0; side < 4; ++side)
    for (int k = 0; k < m; ++k)
      out[static_cast<std::size_t>(quad_side_index(m, side, k))] =
          NodeId(topology.skeleton_node(element, side, k, m));
  return out;
}

/// The lattice points of a triangle of degree d in the cell whose corner is (i, j): the one at this
/// corner, or the one at the opposite corner.
std::vector<std::size_t> triangle_points(int m, int d, int i, int j, bool opposite) {
  std::vector<std::size_t> out;
  for (int k = 0; k <= d; ++k)
    for (int l = 0; l + k <= d; ++l)
      out.push_back(static_cast<std::size_t>(
          quad_index(m, opposite ? i + d - l : i + l, opposite ? j + d - k : j + k)));
  return out;
}

}  // namespace

Field SpectralSolution::field(const std::string& name, int cells, int degree) const {
  if (degree < 1 || degree > TriangleMesh::max_degree)
    throw InputError(
        fmt::format("triangles of degree {}, expected 1 to {}", degree, TriangleMesh::max_degree));
  constexpr std::size_t most = 1000000;
  const auto count = static_cast<std::size_t>(cells < 0 ? 0 : cells);
  if (cells < 1 || count > most || 2 * count * count * element_count() > most)
    throw InputError(
        fmt::format("{} cells on {} elements, expected at least 1 and no more than {} "
                    "triangles",
                    cells, element_count(), most));
  const int m = cells * degree;
  std::vector<double> lattice;
  for (int i = 0; i <= m; ++i) lattice.push_back(static_cast<double>(2 * i - m) / m);
  const fit_detail::LobattoSample map_at = fit_detail::sample(map_, lattice);
  const fit_detail::LobattoSample at = fit_detail::sample(basis_, lattice);

  const std::size_t nodes =
      topology_.skeleton_size(m) + element_count() * static_cast<std::size_t>((m - 1) * (m - 1));
  std::vector<Vec2> control(nodes);
  std::vector<double> coefficient(nodes);
  std::vector<bool> known(nodes, false);  // on common sides the first triangle decides
  std::vector<NodeId> elements;
  for (std::size_t e = 0; e < element_count(); ++e) {
    const std::vector<NodeId> number = lattice_nodes(topology_, e, m);
    const auto x =
        fit_detail::apply(map_at, map_at.value, map_at.value, std::span<const Vec2>(nodes_[e]));
    const auto u = fit_detail::apply(at, at.value, at.value, std::span<const double>(values_[e]));
    for (int j = 0; j < m; j += degree)
      for (int i = 0; i < m; i += degree)
        for (const bool opposite : {false, true}) {
          const auto points = triangle_points(m, degree, i, j, opposite);
          std::vector<Vec2> x_here;
          std::vector<double> u_here;
          for (const std::size_t p : points) {
            x_here.push_back(x[p]);
            u_here.push_back(u[p]);
          }
          const auto b = bernstein::from_lagrange(degree, std::span<const Vec2>(x_here));
          const auto c = bernstein::from_lagrange(degree, std::span<const double>(u_here));
          for (std::size_t k = 0; k < points.size(); ++k) {
            const NodeId n = number[points[k]];
            elements.push_back(n);
            if (known[n.index()]) continue;
            known[n.index()] = true;
            control[n.index()] = b[k];
            coefficient[n.index()] = c[k];
          }
        }
  }
  std::vector<double> coefficients;
  coefficients.reserve(elements.size());
  for (const NodeId n : elements) coefficients.push_back(coefficient[n.index()]);
  const auto mesh =
      std::make_shared<const TriangleMesh>(degree, std::move(control), std::move(elements));
  return {name, Space::discontinuous(mesh, degree), std::move(coefficients)};
}

}  // namespace bezel
