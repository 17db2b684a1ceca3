#pragma once
// Internal: shared by the .cpp files of ElementTransfer.

#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/element_transfer.hpp"

namespace bezel::detail {

/// Extra degree of exactness where an integrand is not a polynomial (a map inverted along a curve).
inline constexpr int inexact_extra = 4;

/// How large powers of barycentrics may be at points of a rule, in and around a region.
inline constexpr double steepest_value = 256.0;

/// Points along a curve that is pulled back by an inverse map.
inline int pulled_points(int degree) {
  return degree / 2 + 1 + inexact_extra / 2;
}

/// Donors smaller than this fraction of the target's area get their areas and integrals from rays
/// of their own: about a place in the target, masses are known to its rounding.
inline constexpr double small_area = 1.0 / 64.0;

/// A point of an element and the derivatives of its map.
struct MapPoint {
  Vec2 x, du, dv;
  double det;
};
inline MapPoint map_point(int degree, std::span<const Vec2> control,
                          const std::array<double, 2>& q) {
  const auto value = bernstein::kernel::evaluate_gradient_unchecked<Vec2, double>(
      degree, control.data(), {1.0 - q[0] - q[1], q[0], q[1]});
  return {value.value, value.du, value.dv, cross(value.du, value.dv)};
}
inline MapPoint map_point(const OverlayMesh& mesh, std::int32_t e, const std::array<double, 2>& q) {
  return map_point(mesh.degree, mesh.element(e), q);
}

/// Calls visit(weight, q, x) at the points q of the fan of rays from `centre` to the reference
/// nodes, x being the element's point there and the weight that of the plane's area: exact for
/// polynomials of the given degree in the reference coordinates.
template <class Visit>
void ElementTransfer::reference_fan(const OverlayMesh& mesh, std::int32_t element,
                                    const std::array<double, 2>& centre, int degree,
                                    const Visit& visit) {
  const IntervalRule& radial = rule((degree + 3) / 2);
  const std::size_t count = nodes_.size() * radial.node.size();
  const std::size_t blocks = padded_to_lanes(count) / lanes;
  reserve_points(count);
  for (std::vector<double>* array : {&fan_w_, &fan_u_, &fan_v_, &fan_x_, &fan_y_, &fan_det_})
    if (array->size() < blocks * lanes) array->resize(2 * blocks * lanes);
  std::size_t at = 0;
  for (const Node& node : nodes_) {
    const std::array<double, 2> arm{node.q[0] - centre[0], node.q[1] - centre[1]};
    const double kappa = arm[0] * node.dq[1] - arm[1] * node.dq[0];
    for (std::size_t i = 0; i < radial.node.size(); ++i, ++at) {
      const double tau = radial.node[i];
      fan_w_[at] = kappa * radial.weight[i] * tau;
      fan_u_[at] = centre[0] + tau * arm[0];
      fan_v_[at] = centre[1] + tau * arm[1];
    }
  }
  for (; at < blocks * lanes; ++at) fan_u_[at] = fan_v_[at] = 0.0;
  map_points(mesh.degree, mesh.element(element).data(), blocks, fan_u_.data(), fan_v_.data(),
             fan_x_.data(), fan_y_.data(), fan_det_.data());
  for (std::size_t i = 0; i < count; ++i) {
    visit(fan_w_[i] * fan_det_[i], std::array<double, 2>{fan_u_[i], fan_v_[i]},
          Vec2{{fan_x_[i], fan_y_[i]}});
  }
}

template <class Visit>
void ElementTransfer::reference_rays(const std::array<double, 2>& centre, int degree,
                                     const Visit& visit) {
  const IntervalRule& radial = rule((degree + 3) / 2);
  reserve_points(nodes_.size() * radial.node.size());
  for (const Node& node : nodes_) {
    const std::array<double, 2> arm{node.q[0] - centre[0], node.q[1] - centre[1]};
    const double kappa = arm[0] * node.dq[1] - arm[1] * node.dq[0];
    for (std::size_t i = 0; i < radial.node.size(); ++i) {
      const double tau = radial.node[i];
      const std::array<double, 2> q{centre[0] + tau * arm[0], centre[1] + tau * arm[1]};
      visit(kappa * radial.weight[i] * tau, q);
    }
  }
}

}  // namespace bezel::detail
