#include "bezel/transfer/conserve.hpp"

#include <algorithm>

#include "bezel/mesh/bvh.hpp"

namespace bezel::detail {
namespace {

std::vector<std::int32_t> boundary_elements(const OverlayMesh& mesh) {
  std::vector<std::int32_t> elements;
  for (const auto& [left, right] : mesh.edge_sides) {
    if (left == exterior || right == exterior) elements.push_back(left == exterior ? right : left);
  }
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
}

}  // namespace

ElementMasses spread(const OverlayMesh& donor, const OverlayMesh& target,
                     const ElementMasses& outside, const ElementMasses& made) {
  const std::size_t nc = std::max(outside.components, made.components);
  const std::vector<std::int32_t> receivers = boundary_elements(target);
  std::vector<Box2> boxes;
  for (const std::int32_t e : receivers)
    boxes.push_back(target.element_box[static_cast<std::size_t>(e)]);
  const Bvh tree(boxes);

  std::vector<double> change(target.element_count() * nc, 0.0);
  std::vector<char> concerned(target.element_count(), 0);
  const auto give = [&](std::int32_t e, const double* mass, double share) {
    concerned[static_cast<std::size_t>(e)] = 1;
    for (std::size_t c = 0; c < nc; ++c)
      change[static_cast<std::size_t>(e) * nc + c] += share * mass[c];
  };
  const auto give_by_area = [&](std::span<const std::int32_t> elements, const double* mass) {
    double area = 0.0;
    for (const std::int32_t e : elements) area += target.element_area[static_cast<std::size_t>(e)];
    for (const std::int32_t e : elements)
      give(e, mass, target.element_area[static_cast<std::size_t>(e)] / area);
  };
  std::vector<double> far(nc, 0.0);
  bool any_far = false;
  std::vector<std::int32_t> near;
  for (std::size_t i = 0; i < outside.element.size(); ++i) {
    const double* mass = outside.mass.data() + i * nc;
    near.clear();
    tree.query(donor.element_box[static_cast<std::size_t>(outside.element[i])], near);
    std::sort(near.begin(), near.end());
    for (std::int32_t& e : near) e = receivers[static_cast<std::size_t>(e)];
    if (!near.empty()) {
      give_by_area(near, mass);
      continue;
    }
    any_far = true;
    for (std::size_t c = 0; c < nc; ++c) far[c] += mass[c];
  }
  if (any_far) give_by_area(receivers, far.data());
  for (std::size_t i = 0; i < made.element.size(); ++i)
    give(made.element[i], made.mass.data() + i * nc, -1.0);

  ElementMasses out;
  out.components = nc;
  for (std::size_t e = 0; e < target.element_count(); ++e) {
    if (concerned[e] != 0)
      out.add(static_cast<std::int32_t>(e), std::span<const double>(change).subspan(e * nc, nc));
  }
  return out;
}

}  // namespace bezel::detail
