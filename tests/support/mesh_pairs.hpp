#pragma once
// Pairs of small meshes made to hurt an overlay: edges that nearly or partly coincide, touch, or
// meet in vertices.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/mesh/generate.hpp"
#include "support/meshes.hpp"

namespace bezel::test {

using MeshPtr = std::shared_ptr<const TriangleMesh>;

/// The mesh with every control point mapped (for affine maps, or any map of control points).
template <class Map>
MeshPtr with_control(const MeshPtr& mesh, const Map& map) {
  std::vector<Vec2> control(mesh->control().begin(), mesh->control().end());
  for (std::size_t i = 0; i < control.size(); ++i) control[i] = map(control[i], i);
  return std::make_shared<const TriangleMesh>(
      mesh->degree(), std::move(control),
      std::vector<NodeId>(mesh->connectivity().begin(), mesh->connectivity().end()));
}

inline bool all_valid(const TriangleMesh& mesh) {
  for (std::size_t e = 0; e < mesh.element_count(); ++e) {
    const auto control = mesh.gather(ElementId(e));
    if (check_validity(mesh.degree(), control).status != Validity::valid) return false;
  }
  return true;
}

/// A mesh with the topology of another and elements of degree g made one by one: corners and edges
/// are those of the element that comes first.
template <class Make>
MeshPtr with_elements(const MeshPtr& mesh, int g, const Make& make) {
  std::vector<Vec2> control;
  std::vector<NodeId> nodes;
  std::vector<std::int32_t> corner_node(mesh->node_count(), -1);
  std::vector<std::int32_t> edge_node(mesh->edge_count() * static_cast<std::size_t>(g + 1), -1);
  const int og = mesh->degree();
  const std::array<int, 3> corner_index = {bernstein::triangle_index(og, 0, 0),
                                           bernstein::triangle_index(og, og, 0),
                                           bernstein::triangle_index(og, 0, og)};
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    const std::vector<Vec2> b = make(ElementId(e));
    const auto edges = mesh->edges(ElementId(e));
    for (int k = 0; k <= g; ++k) {
      for (int j = 0; j + k <= g; ++j) {
        const std::array<int, 3> m = {g - j - k, j, k};
        std::int32_t own = -1;
        std::int32_t* shared = &own;
        for (std::size_t c = 0; c < 3; ++c) {
          if (m[c] == g) {
            const auto at = static_cast<std::size_t>(corner_index[c]);
            shared = &corner_node[mesh->nodes(ElementId(e))[at].index()];
          } else if (m[(c + 2) % 3] == 0 && m[(c + 1) % 3] < g) {  // side c joins corners c, c + 1
            const auto along = static_cast<std::size_t>(edges[c].reversed ? m[c] : g - m[c]);
            shared = &edge_node[edges[c].edge.index() * static_cast<std::size_t>(g + 1) + along];
          }
        }
        if (*shared < 0) {
          *shared = static_cast<std::int32_t>(control.size());
          control.push_back(b[static_cast<std::size_t>(bernstein::triangle_index(g, j, k))]);
        }
        nodes.push_back(NodeId(*shared));
      }
    }
  }
  return std::make_shared<const TriangleMesh>(g, std::move(control), std::move(nodes));
}

/// The same elements written with a higher degree.
inline MeshPtr raised(const MeshPtr& mesh, int by) {
  return with_elements(mesh, mesh->degree() + by, [&](ElementId e) {
    return bernstein::elevate<Vec2>(mesh->degree(), mesh->gather(e), by);
  });
}

/// The same elements, every edge run at another speed: of degree 2 g, equal up to rounding. On an
/// edge the parameter becomes t + shift t (1 - t), |shift| <= amount < 0.5.
inline MeshPtr reparametrised(const MeshPtr& mesh, double amount, RandomStream& random) {
  std::vector<double> shift(mesh->edge_count());
  for (double& s : shift) s = random.uniform(-amount, amount);
  const int g = 2 * mesh->degree();
  return with_elements(mesh, g, [&](ElementId e) {
    const auto b = mesh->gather(e);
    const auto edges = mesh->edges(e);
    std::vector<Vec2> values;
    for (int k = 0; k <= g; ++k) {
      for (int j = 0; j + k <= g; ++j) {
        const double n = g;
        const Lambda at{(g - j - k) / n, j / n, k / n};
        Lambda to = at;
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t d = (c + 1) % 3;
          const double s = shift[edges[c].edge.index()] * (edges[c].reversed ? -1.0 : 1.0);
          to[c] -= s * at[c] * at[d];
          to[d] += s * at[c] * at[d];
        }
        values.push_back(bernstein::evaluate<Vec2>(mesh->degree(), b, to));
      }
    }
    return bernstein::from_lagrange<Vec2>(g, values);
  });
}

struct MeshPair {
  std::string kind;
  MeshPtr donor, target;
};

/// Kinds of mesh_pair().
inline constexpr int mesh_pair_kinds = 14;

/// A pair of meshes of 2 to 50 elements. The kind is seed % mesh_pair_kinds.
inline MeshPair mesh_pair(std::uint64_t seed) {
  RandomStream random("mesh pairs", seed);
  const auto kind = static_cast<int>(seed % mesh_pair_kinds);
  const auto small = [&](int first, int last) {  // 10^-first .. 10^-last
    return std::pow(10.0, -first - static_cast<int>(
                                       random.below(static_cast<std::uint64_t>(last - first + 1))));
  };
  const auto sign = [&] { return random.uniform(-1.0, 1.0); };
  const auto count = [&] { return 1 + static_cast<int>(random.below(4)); };
  const auto degree = [&] {
    return random.below(2) == 0 ? 1 : 2 + static_cast<int>(random.below(3));
  };
  // A bent grid; smaller bends, until no element is inverted.
  const auto grid = [&](int n, int g) {
    double a = 0.25 * sign();
    double b = 0.25 * sign();
    for (;;) {
      auto mesh = grid_mesh(n, g, 1.0, bend(a, b));
      if (all_valid(*mesh)) return mesh;
      a *= 0.5;
      b *= 0.5;
    }
  };
  // Control points moved by up to `size` of a cell; smaller steps, until no element is inverted.
  const auto jittered = [&](const MeshPtr& mesh, double size, bool corners_too) {
    std::vector<char> corner(mesh->node_count(), 0);
    for (std::size_t e = 0; e < mesh->element_count(); ++e) {
      const auto nodes = mesh->nodes(ElementId(e));
      const int g = mesh->degree();
      for (const int i : {bernstein::triangle_index(g, 0, 0), bernstein::triangle_index(g, g, 0),
                          bernstein::triangle_index(g, 0, g)})
        corner[nodes[static_cast<std::size_t>(i)].index()] = 1;
    }
    for (;; size *= 0.25) {
      auto moved = with_control(mesh, [&](const Vec2& p, std::size_t i) {
        if (!corners_too && corner[i] != 0) return p;
        const double x = p[0] + size * sign();
        return Vec2{{x, p[1] + size * sign()}};
      });
      if (all_valid(*moved)) return moved;
    }
  };
  const auto affine = [](const MeshPtr& mesh, double xx, double xy, double yx, double yy,
                         const Vec2& shift) {
    return with_control(mesh, [&](const Vec2& p, std::size_t) {
      return Vec2{{xx * p[0] + xy * p[1] + shift[0], yx * p[0] + yy * p[1] + shift[1]}};
    });
  };

  MeshPair out;
  switch (kind) {
    case 0: {  // lattices that share points and stretches of edges
      out.kind = "lattices";
      const double scale = random.below(2) == 0 ? 1.0 : sign();
      out.donor = grid_mesh(count(), 1, std::abs(scale) + 0.01, same_place);
      out.target = grid_mesh(count(), degree(), std::abs(scale) + 0.01, same_place);
      break;
    }
    case 1: {
      out.kind = "perturbed lattices";
      out.donor = grid_mesh(count(), degree(), 1.0, same_place);
      out.target = jittered(grid_mesh(count(), degree(), 1.0, same_place), small(1, 17), true);
      break;
    }
    case 2: {
      out.kind = "nudged by ulps";
      const int g = degree();
      out.donor = grid(count(), g);
      out.target = with_control(out.donor, [&](Vec2 p, std::size_t) {
        for (auto k = random.below(4); k > 0; --k) {
          double& x = p[random.below(2) == 0 ? 0 : 1];
          x = std::nextafter(x, sign());
        }
        return p;
      });
      break;
    }
    case 3: {
      out.kind = "sheared";
      out.donor = grid(count(), degree());
      out.target = affine(out.donor, 1, small(1, 16) * sign(), 0, 1, Vec2{});
      break;
    }
    case 4: {
      out.kind = "turned about a vertex";
      out.donor = grid(count(), degree());
      const Vec2 about = out.donor->control(out.donor->nodes(ElementId(0))[0]);
      const double angle = small(0, 16) * sign();
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      out.target = affine(out.donor, c, -s, s, c,
                          about - Vec2{{c * about[0] - s * about[1], s * about[0] + c * about[1]}});
      break;
    }
    case 5: {
      out.kind = "shifted along lattice lines";
      const int n = 1 + static_cast<int>(random.below(3));
      out.donor = grid_mesh(n, degree(), 1.0, same_place);
      out.target = affine(grid_mesh(n, degree(), 1.0, same_place), 1, 0, 0, 1,
                          Vec2{{random.below(2) == 0 ? 2.0 / n : small(0, 16),
                                random.below(2) == 0 ? 0.0 : small(12, 17)}});
      break;
    }
    case 6: {
      out.kind = "refined";
      out.donor = grid(1 + static_cast<int>(random.below(2)), degree());
      out.target = std::make_shared<const TriangleMesh>(refine_uniform(*out.donor));
      if (random.below(2) == 0) out.target = jittered(out.target, small(2, 17), true);
      break;
    }
    case 7: {
      out.kind = "curved edges between the same vertices";
      out.donor = grid(count(), 2 + static_cast<int>(random.below(3)));
      out.target = jittered(out.donor, small(1, 17), false);
      break;
    }
    case 8: {
      out.kind = "degree raised";
      out.donor = grid(count(), 1 + static_cast<int>(random.below(3)));
      out.target = raised(out.donor, 1 + static_cast<int>(random.below(2)));
      if (random.below(2) == 0) out.target = jittered(out.target, small(3, 17), true);
      break;
    }
    case 9: {
      out.kind = "other parametrisation";
      out.donor = grid(count(), 1 + static_cast<int>(random.below(2)));
      out.target = reparametrised(out.donor, 0.3, random);
      break;
    }
    case 10: {  // parabolas that touch the lines of a lattice, or miss them by a little
      out.kind = "tangent";
      const int n = 1 + static_cast<int>(random.below(3));
      const double bow = 0.3 / n * sign();
      const double x0 = random.below(2) == 0 ? 0.0 : sign();
      const double off = random.below(2) == 0 ? 0.0 : small(3, 17) * sign();
      out.donor = grid_mesh(n, 1, 1.0, same_place);
      out.target = grid_mesh(n, 2, 1.0, [&](const Vec2& p) {
        return Vec2{{p[0], p[1] + bow * (p[0] - x0) * (p[0] - x0) + off}};
      });
      break;
    }
    case 11: {
      out.kind = "slivers";
      const double flat = small(1, 6);
      const auto base = grid(count(), degree());
      const auto other = random.below(2) == 0 ? base : grid(count(), degree());
      const double eps = small(0, 12) * sign();
      out.donor = affine(base, 1, 0, 0, flat, Vec2{});
      out.target = affine(other, 1, eps, eps * flat, flat, Vec2{});
      break;
    }
    case 12: {  // a small mesh anywhere, or at a vertex
      out.kind = "size ratio";
      out.donor = grid(count(), degree());
      out.target = grid(count(), degree());
      const double scale = small(1, 3);
      const Vec2 to = random.below(2) == 0 ? Vec2{{0.9 * sign(), 0.9 * sign()}}
                                           : out.donor->control(out.donor->nodes(ElementId(0))[1]);
      out.target = affine(out.target, scale, 0, 0, scale, to);
      if (random.below(2) == 0) std::swap(out.donor, out.target);
      break;
    }
    default: {
      out.kind = "far from the origin";
      const Vec2 to{{sign() / small(0, 6), sign() / small(0, 6)}};
      out.donor = affine(grid(count(), degree()), 1, 0, 0, 1, to);
      out.target = random.below(2) == 0 ? jittered(out.donor, small(2, 16), true)
                                        : affine(grid(count(), degree()), 0.8, -0.3, 0.3, 0.8, to);
      break;
    }
  }
  return out;
}

}  // namespace bezel::test
