#include "bezel/transfer/boundary_values.hpp"

#include <algorithm>

#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/overlay.hpp"

namespace bezel::detail {
namespace {

/// A point this far outside an element in its barycentrics still counts as inside it.
constexpr double outside_rounding = 1e-10;
constexpr std::size_t edges_per_task = 64;

bool is_inside(const OverlayMesh& donor, std::int32_t d, const Vec2& x) {
  std::array<double, 3> lambda{};
  return invert_map(donor.degree, donor.element(d), x, lambda, false) &&
         std::min({lambda[0], lambda[1], lambda[2]}) >= -outside_rounding;
}

void donor_value(const Group& g, const OverlayMesh& donor, const FrontSearch& search,
                 Uncovered policy, const Vec2& x, std::span<double> value) {
  const std::int32_t d = search.nearest(x);
  if (policy == Uncovered::zero && !is_inside(donor, d, x)) {
    std::fill(value.begin(), value.end(), 0.0);
    return;
  }
  std::array<double, 3> warm{};
  bool have_warm = false;
  const auto place = donor_place(g, donor, d, x, warm, have_warm);
  evaluate_scaled(g.donor_space->degree(ElementId(d)), g.components, g.donor_scaled(d).data(),
                  place[0], place[1], value.data());
}

}  // namespace

BoundaryValues boundary_values(const Group& g, const OverlayMesh& donor, const OverlayMesh& target,
                               const FrontSearch& search, Uncovered policy, int threads) {
  const Space& space = *g.continuous_space;
  const TriangleMesh& mesh = *target.mesh;
  const auto p = static_cast<std::size_t>(space.uniform_degree());
  const auto nc = static_cast<std::size_t>(g.components);
  std::vector<std::int32_t> edges;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e)
    if (mesh.is_boundary(EdgeId(e))) edges.push_back(static_cast<std::int32_t>(e));

  // Bernstein coefficients along each edge, shape (edges, p + 1, components).
  std::vector<double> along(edges.size() * (p + 1) * nc);
  parallel_for((edges.size() + edges_per_task - 1) / edges_per_task,
               [&](std::size_t task) {
                 std::vector<double> one(p + 1);
                 for (std::size_t k = task * edges_per_task;
                      k < std::min(edges.size(), (task + 1) * edges_per_task); ++k) {
                   double* values = along.data() + k * (p + 1) * nc;
                   for (std::size_t m = 0; m <= p; ++m) {
                     const double t = static_cast<double>(m) / static_cast<double>(p);
                     donor_value(g, donor, search, policy, curve_point(target.edge(edges[k]), t),
                                 {values + m * nc, nc});
                   }
                   for (std::size_t c = 0; c < nc; ++c) {
                     for (std::size_t m = 0; m <= p; ++m) one[m] = values[m * nc + c];
                     const std::vector<double> b = bernstein::from_lagrange<double>(one);
                     for (std::size_t m = 0; m <= p; ++m) values[m * nc + c] = b[m];
                   }
                 }
               },
               threads);

  BoundaryValues result;
  result.fixed.assign(space.dof_count(), 0);
  result.values.assign(space.dof_count() * nc, 0.0);
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const ElementSide side = mesh.adjacent(EdgeId(edges[k])).front();
    const auto dofs = space.dofs(side.element);
    for (std::size_t m = 0; m <= p; ++m) {
      const std::size_t at = side.reversed ? p - m : m;
      const auto d = static_cast<std::size_t>(dofs[static_cast<std::size_t>(
          bernstein::triangle_side_index(static_cast<int>(p), side.side, static_cast<int>(at)))]);
      result.fixed[d] = 1;
      for (std::size_t c = 0; c < nc; ++c)
        result.values[d * nc + c] = along[(k * (p + 1) + m) * nc + c];
    }
  }
  return result;
}

}  // namespace bezel::detail
