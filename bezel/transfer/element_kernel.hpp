#pragma once
// Internal: shared by the .cpp files of ElementTransfer.

#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/transfer/element_transfer.hpp"

namespace bezel::detail {

/// Extra degree of exactness where an integrand is not a polynomial (a map inverted along a curve).
inline constexpr int inexact_extra = 4;

/// Joints open by more than this fraction of the smaller element mean that the overlay is wrong
/// there.
inline constexpr double largest_joint_gap = 1e-10;

/// A point of an element and the derivatives of its map.
struct MapPoint {
  Vec2 x, du, dv;
  double det;
};
inline MapPoint map_point(const OverlayMesh& mesh, std::int32_t e, const std::array<double, 2>& q) {
  const auto value = bernstein::kernel::evaluate_gradient_unchecked<Vec2, double>(
      mesh.degree, mesh.element(e).data(), {1.0 - q[0] - q[1], q[0], q[1]});
  return {value.value, value.du, value.dv, cross(value.du, value.dv)};
}

/// Calls visit(weight, q, map) at the points of the fan of rays from `centre` to the reference
/// nodes, the weight being that of the plane's area: exact for polynomials of the given degree in
/// the reference coordinates.
template <class Visit>
void ElementTransfer::reference_fan(const OverlayMesh& mesh, std::int32_t element,
                                    const std::array<double, 2>& centre, int degree,
                                    const Visit& visit) {
  const IntervalRule& radial = rule((degree + 3) / 2);
  reserve_points(nodes_.size() * radial.node.size());
  for (const Node& node : nodes_) {
    const std::array<double, 2> arm{node.q[0] - centre[0], node.q[1] - centre[1]};
    const double kappa = arm[0] * node.dq[1] - arm[1] * node.dq[0];
    for (std::size_t i = 0; i < radial.node.size(); ++i) {
      const double tau = radial.node[i];
      const std::array<double, 2> q{centre[0] + tau * arm[0], centre[1] + tau * arm[1]};
      const MapPoint map = map_point(mesh, element, q);
      visit(kappa * radial.weight[i] * tau * map.det, q, map);
    }
  }
}

}  // namespace bezel::detail
