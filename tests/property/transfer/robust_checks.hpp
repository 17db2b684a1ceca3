#pragma once
// What must hold for every transfer: mass, constants, partition; and meshes to try it on.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bezel/mesh/generate.hpp"
#include "bezel/transfer/transfer.hpp"
#include "support/mesh_pairs.hpp"

namespace bezel::test {

inline constexpr std::array<Basis, 2> bases = {Basis::reference, Basis::physical};

/// A vector field: a constant, and 0 or 1 on each element at random.
inline Field constant_and_checks(const std::shared_ptr<const Space>& space) {
  std::vector<double> c(space->coefficient_count() * 2);
  RandomStream random("constant and checks", 1);
  for (std::size_t e = 0; e < space->mesh()->element_count(); ++e) {
    const double value = static_cast<double>(random.below(2));
    const auto size =
        static_cast<std::size_t>(bernstein::triangle_size(space->degree(ElementId(e))));
    for (std::size_t i = 0; i < size; ++i) {
      c[(space->offset(ElementId(e)) + i) * 2] = 3.25;
      c[(space->offset(ElementId(e)) + i) * 2 + 1] = value;
    }
  }
  return {"constant and checks", space, c, 2};
}

/// Largest distance of the first component from the constant, at a lattice of points.
inline double off_constant(const Field& f) {
  double worst = 0.0;
  std::array<double, 2> value{};
  for (std::size_t e = 0; e < f.mesh().element_count(); ++e) {
    for (int k = 0; k <= 4; ++k) {
      for (int j = 0; j + k <= 4; ++j) {
        f.evaluate(ElementId(e), {(4 - j - k) / 4.0, j / 4.0, k / 4.0}, value);
        worst = std::max(worst, std::abs(value[0] - 3.25) / 3.25);
      }
    }
  }
  return worst;
}

/// Transfers between all bases; what must hold on every pair of meshes.
/// @param rounding  by which coordinates are rounded, relative to the smallest width of an element,
///                  in units of 1e-13: partitions and constants are no better than that
inline void expect_kept(const MeshPtr& donor, const MeshPtr& target, int from_degree, int to_degree,
                        const std::string& where, double rounding = 1.0) {
  // The condition of the mass matrix shows from degree 6 on: 4e4 at degree 8.
  const double constants = rounding * (to_degree < 6 ? 1e-13 : 1e-12);
  for (const Basis from : bases) {
    std::vector<Field> fields = {
        constant_and_checks(Space::discontinuous(donor, from_degree, from))};
    for (const Basis to : bases) {
      TransferOptions options;
      options.degree = to_degree;
      options.same_basis = false;
      options.basis = to;
      options.uncovered = Uncovered::extend;
      options.threads = 1;
      const TransferResult result = transfer(fields, target, options);
      const std::string at = where + " p" + std::to_string(from_degree) + "->" +
                             std::to_string(to_degree) + " bases " +
                             std::to_string(static_cast<int>(from)) + "->" +
                             std::to_string(static_cast<int>(to));
      EXPECT_LE(off_constant(result.fields[0]), constants) << at;
      EXPECT_LE(result.report.max_partition_residual, rounding * 1e-13) << at;
      EXPECT_EQ(result.report.unresolved, 0) << at;
      for (const FieldReport& f : result.report.fields)
        EXPECT_LE(f.relative_mass_defect, 1e-14) << at << " component " << f.component;
    }
  }
}

/// Both ways, at a few field degrees.
inline void expect_kept_both_ways(const MeshPtr& a, const MeshPtr& b, const std::string& where) {
  for (const auto& [from, to] : {std::pair(0, 1), std::pair(2, 2), std::pair(3, 1)}) {
    expect_kept(a, b, from, to, where);
    expect_kept(b, a, from, to, where + " back");
  }
}

/// Every third element refined, its neighbours not: vertices hang on their edges.
inline MeshPtr locally_refined(const MeshPtr& mesh) {
  const TriangleMesh fine = refine_uniform(*mesh);
  std::vector<Vec2> control(mesh->control().begin(), mesh->control().end());
  std::vector<NodeId> nodes;
  const auto coarse_count = static_cast<std::int32_t>(control.size());
  control.insert(control.end(), fine.control().begin(), fine.control().end());
  // Fine corners that are coarse corners keep the coarse name.
  std::vector<std::int32_t> name(fine.node_count());
  for (std::size_t n = 0; n < name.size(); ++n) {
    name[n] = coarse_count + static_cast<std::int32_t>(n);
    for (std::int32_t c = 0; c < coarse_count; ++c) {
      if (fine.control()[n] == mesh->control()[static_cast<std::size_t>(c)]) name[n] = c;
    }
  }
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    if (e % 3 != 0) {
      const auto own = mesh->nodes(ElementId(e));
      nodes.insert(nodes.end(), own.begin(), own.end());
      continue;
    }
    for (std::size_t k = 4 * e; k < 4 * e + 4; ++k) {
      for (const NodeId n : fine.nodes(ElementId(k))) nodes.push_back(NodeId(name[n.index()]));
    }
  }
  return std::make_shared<const TriangleMesh>(mesh->degree(), std::move(control), std::move(nodes));
}

inline MeshPtr joined(const MeshPtr& a, const MeshPtr& b) {
  std::vector<Vec2> control(a->control().begin(), a->control().end());
  control.insert(control.end(), b->control().begin(), b->control().end());
  std::vector<NodeId> nodes(a->connectivity().begin(), a->connectivity().end());
  for (const NodeId n : b->connectivity())
    nodes.push_back(NodeId(n.value + static_cast<std::int32_t>(a->node_count())));
  return std::make_shared<const TriangleMesh>(a->degree(), std::move(control), std::move(nodes));
}

inline MeshPtr stretched(const MeshPtr& mesh, double x, double y, const Vec2& shift = {}) {
  return with_control(mesh, [&](const Vec2& p, std::size_t) {
    return Vec2{{x * p[0] + shift[0], y * p[1] + shift[1]}};
  });
}

}  // namespace bezel::test
