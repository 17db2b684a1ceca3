#include "bezel/mesh/quality.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/geometry/triangle.hpp"

namespace bezel {
namespace {

constexpr double degrees = 180 / 3.14159265358979323846;

/// (smallest / largest) coefficient of the determinant; -infinity when it is nowhere positive.
double jacobian_ratio(int degree, std::span<const Vec2> control) {
  const auto det = jacobian_determinant(degree, control);
  const auto [least, most] = std::minmax_element(det.begin(), det.end());
  return *most > 0 ? *least / *most : -std::numeric_limits<double>::infinity();
}

}  // namespace

MeshQuality mesh_quality(const TriangleMesh& mesh) {
  MeshQuality q;
  if (mesh.element_count() == 0) return q;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  q.min_angle = q.min_edge = q.min_jacobian_ratio = infinity;
  q.max_angle = -infinity;
  const int g = mesh.degree();
  std::vector<Vec2> control(static_cast<std::size_t>(mesh.nodes_per_element()));
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    mesh.gather(ElementId(e), control);
    for (int c = 0; c < 3; ++c) {
      const auto corner = [&](int k) -> const Vec2& {
        return control[static_cast<std::size_t>(bernstein::triangle_corner(g, (c + k) % 3))];
      };
      const Vec2 a = corner(1) - corner(0), b = corner(2) - corner(0);
      const double angle = std::atan2(cross(a, b), dot(a, b)) * degrees;
      q.max_angle = std::max(q.max_angle, angle);
      if (angle < q.min_angle) {
        q.min_angle = angle;
        q.min_angle_element = ElementId(e);
      }
    }
    const double ratio = jacobian_ratio(g, control);
    if (ratio < q.min_jacobian_ratio || !q.min_jacobian_element.valid()) {
      q.min_jacobian_ratio = ratio;
      q.min_jacobian_element = ElementId(e);
    }
  }
  double sum = 0;
  for (std::size_t e = 0; e < mesh.edge_count(); ++e) {
    const auto nodes = mesh.edge_nodes(EdgeId(e));
    const double length = norm(mesh.control(nodes.back()) - mesh.control(nodes.front()));
    q.min_edge = std::min(q.min_edge, length);
    q.max_edge = std::max(q.max_edge, length);
    sum += length;
  }
  q.mean_edge = sum / static_cast<double>(mesh.edge_count());
  return q;
}

}  // namespace bezel
