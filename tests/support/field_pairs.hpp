#pragma once
// Pairs of meshes whose elements differ much from one to the next, for checks of what transfers
// leave in the fields: thin rows of elements between ordinary ones, slivers, holes, several parts.

#include <cmath>
#include <vector>

#include "support/mesh_pairs.hpp"

namespace bezel::test {

/// Kinds of field_pair().
inline constexpr int field_pair_kinds = 8;

namespace field_pairs {

/// A monotone map of [-1, 1] to itself, linear on n equal intervals, some of which become thin: by
/// 1/2 to 1/200 of the others.
inline std::function<double(double)> graded(int n, RandomStream& random) {
  std::vector<double> at = {0.0};
  const bool thin = random.below(4) != 0;
  for (int i = 0; i < n; ++i) {
    double width = 1.0;
    if (thin && random.below(3) == 0) width = 0.5 * std::pow(10.0, -2.0 * random.uniform());
    at.push_back(at.back() + width);
  }
  for (double& x : at) x = 2.0 * x / at.back() - 1.0;
  return [at, n](double x) {
    const double s = 0.5 * (x + 1.0) * n;
    const auto i = static_cast<std::size_t>(std::clamp(static_cast<int>(std::floor(s)), 0, n - 1));
    return at[i] + (s - static_cast<double>(i)) * (at[i + 1] - at[i]);
  };
}

/// A bent grid of n x n squares, its rows and columns of those widths; smaller bends, until no
/// element is inverted.
inline MeshPtr graded_grid(int n, int g, bool thin, double half, RandomStream& random) {
  double a = 0.2 * random.uniform(-1, 1), b = 0.2 * random.uniform(-1, 1);
  const auto x = thin ? graded(n, random) : [](double s) { return s; };
  const auto y = thin ? graded(n, random) : [](double s) { return s; };
  for (;; a *= 0.5, b *= 0.5) {
    const PlaneMap bent = bend(a, b);
    auto mesh = grid_mesh(n, g, 1.0, [&](const Vec2& p) {
      return half * bent(Vec2{{x(p[0]), y(p[1])}});
    });
    if (all_valid(*mesh)) return mesh;
  }
}

/// Straight elements, some of them cut in three at a point near one of their sides.
inline MeshPtr with_slivers(const MeshPtr& mesh, RandomStream& random) {
  std::vector<Vec2> control(mesh->control().begin(), mesh->control().end());
  std::vector<NodeId> nodes;
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    const auto own = mesh->nodes(ElementId(e));
    if (random.below(2) == 0) {
      nodes.insert(nodes.end(), own.begin(), own.end());
      continue;
    }
    const double near = 0.3 * std::pow(10.0, -2.5 * random.uniform());
    const double along = random.uniform(0.2, 0.8);
    const std::array<double, 3> l = {near, (1 - near) * along, (1 - near) * (1 - along)};
    const std::size_t first = random.below(3);
    Vec2 p;
    for (std::size_t k = 0; k < 3; ++k) p += control[own[(first + k) % 3].index()] * l[k];
    const NodeId inner(static_cast<std::int32_t>(control.size()));
    control.push_back(p);
    for (std::size_t k = 0; k < 3; ++k) {
      nodes.push_back(own[k]);
      nodes.push_back(own[(k + 1) % 3]);
      nodes.push_back(inner);
    }
  }
  return std::make_shared<const TriangleMesh>(1, std::move(control), std::move(nodes));
}

/// The straight mesh with a higher degree, its curves bent a little, less until all is valid.
inline MeshPtr curved(const MeshPtr& mesh, int g, RandomStream& random) {
  if (g == 1) return mesh;
  const MeshPtr straight = raised(mesh, g - 1);
  std::vector<char> corner(straight->node_count(), 0);
  for (std::size_t e = 0; e < straight->element_count(); ++e)
    for (const int c : {0, 1, 2})
      corner[straight
                 ->nodes(ElementId(e))[static_cast<std::size_t>(bernstein::triangle_corner(g, c))]
                 .index()] = 1;
  std::vector<Vec2> step(straight->node_count());
  for (Vec2& s : step) s = Vec2{{random.uniform(-1, 1), random.uniform(-1, 1)}};
  for (double size = 0.05;; size *= 0.25) {
    auto moved = with_control(straight, [&](const Vec2& p, std::size_t i) {
      return corner[i] != 0 ? p : p + size * step[i];
    });
    if (all_valid(*moved)) return moved;
  }
}

/// Without some of the elements.
inline MeshPtr with_holes(const MeshPtr& mesh, RandomStream& random) {
  std::vector<NodeId> nodes;
  const std::uint64_t every = 3 + random.below(12);
  for (std::size_t e = 0; e < mesh->element_count(); ++e) {
    if (e > 0 && random.below(every) == 0) continue;
    const auto own = mesh->nodes(ElementId(e));
    nodes.insert(nodes.end(), own.begin(), own.end());
  }
  return std::make_shared<const TriangleMesh>(
      mesh->degree(), std::vector<Vec2>(mesh->control().begin(), mesh->control().end()),
      std::move(nodes));
}

inline MeshPtr turned(const MeshPtr& mesh, double angle, double scale, const Vec2& to) {
  const double c = scale * std::cos(angle), s = scale * std::sin(angle);
  return with_control(mesh, [&](const Vec2& p, std::size_t) {
    return Vec2{{c * p[0] - s * p[1] + to[0], s * p[0] + c * p[1] + to[1]}};
  });
}

}  // namespace field_pairs

/// A pair of meshes of 2 to 400 elements; the kind is seed % field_pair_kinds.
inline MeshPair field_pair(std::uint64_t seed) {
  using namespace field_pairs;
  RandomStream random("field pairs", seed);
  const auto size = [&](int lo, int hi) {
    return lo + static_cast<int>(random.below(static_cast<std::uint64_t>(hi - lo + 1)));
  };
  // Mostly of one degree on both sides: that is the way of most elements.
  const int g = std::array{1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 5}[random.below(11)];
  const int h = random.below(8) == 0 ? size(1, 5) : g;
  const Vec2 to{{random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1)}};
  const double angle = random.uniform(0, 6.28), scale = random.uniform(0.4, 0.63);
  MeshPair out;
  switch (seed % field_pair_kinds) {
    case 0:
      out = mesh_pair(random.next() % 1000000);
      break;
    case 1:
      out.kind = "thin donors";
      out.donor = graded_grid(size(6, 16), h, true, 1.0, random);
      out.target = turned(graded_grid(size(3, 8), g, false, 1.0, random), angle, scale, to);
      break;
    case 2:
      out.kind = "thin targets";
      out.donor = graded_grid(size(4, 10), h, false, 1.0, random);
      out.target = turned(graded_grid(size(4, 12), g, true, 1.0, random), angle, scale, to);
      break;
    case 3:
      out.kind = "thin rows crossed";
      out.donor = graded_grid(size(4, 10), h, true, 1.0, random);
      out.target = turned(graded_grid(size(3, 9), g, true, 1.0, random),
                          random.below(3) == 0 ? 0.0 : angle, scale, to);
      break;
    case 4: {
      out.kind = "slivers between";
      const auto straight = [&](int lo, int hi) {
        const MeshPtr grid = graded_grid(size(lo, hi), 1, false, 1.0, random);
        return random.below(3) == 0 ? grid : with_slivers(grid, random);
      };
      out.donor = curved(straight(4, 9), h, random);
      out.target = turned(curved(straight(2, 6), g, random), angle, scale, to);
      break;
    }
    case 5: {
      out.kind = "holes and parts";
      const bool thin = random.below(2) == 0;
      out.donor = with_holes(graded_grid(size(3, 8), h, thin, 1.0, random), random);
      out.target = turned(graded_grid(size(2, 6), g, !thin, 1.0, random), angle,
                          random.uniform(0.4, 1.1), to);
      if (random.below(2) == 0) out.target = with_holes(out.target, random);
      break;
    }
    case 6: {
      out.kind = "one domain";
      out.donor = graded_grid(size(3, 8), h, random.below(2) == 0, 1.0, random);
      out.target = graded_grid(size(2, 7), g, random.below(2) == 0, 1.0, random);
      break;
    }
    default: {
      out.kind = "refinement of thin rows";
      out.donor = graded_grid(size(2, 5), g, true, 1.0, random);
      out.target = std::make_shared<const TriangleMesh>(refine_uniform(*out.donor));
      if (random.below(2) == 0) std::swap(out.donor, out.target);
      break;
    }
  }
  return out;
}

}  // namespace bezel::test
