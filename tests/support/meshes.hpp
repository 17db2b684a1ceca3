#pragma once
// Small curved meshes for tests, made without the library's generators.

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/mesh/mesh.hpp"

namespace bezel::test {

using PlaneMap = std::function<Vec2(const Vec2&)>;

/// An n x n grid of squares on [-half, half]^2, each cut into two triangles (diagonals alternate),
/// whose degree-g nodes are moved by `map`.
inline std::shared_ptr<const TriangleMesh> grid_mesh(int n, int g, double half,
                                                     const PlaneMap& map) {
  const int side = n * g + 1;
  const auto id = [&](int i, int j) { return NodeId(static_cast<std::int32_t>(j * side + i)); };
  std::vector<Vec2> value(static_cast<std::size_t>(side * side));
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      const double step = 2.0 * half / (side - 1);
      value[id(i, j).index()] = map(Vec2{{-half + step * i, -half + step * j}});
    }
  }
  std::vector<Vec2> control = value;
  std::vector<char> done(value.size(), 0);
  std::vector<NodeId> elements;
  for (int b = 0; b < n; ++b) {
    for (int a = 0; a < n; ++a) {
      const std::array<std::array<int, 2>, 4> q = {
          {{a * g, b * g}, {a * g + g, b * g}, {a * g + g, b * g + g}, {a * g, b * g + g}}};
      const bool flip = (a + b) % 2 == 1;
      const std::array<std::array<int, 3>, 2> cut =
          flip ? std::array<std::array<int, 3>, 2>{{{0, 1, 3}, {1, 2, 3}}}
               : std::array<std::array<int, 3>, 2>{{{0, 1, 2}, {0, 2, 3}}};
      for (const auto& corners : cut) {
        std::vector<NodeId> nodes;
        std::vector<Vec2> values;
        for (int k = 0; k <= g; ++k) {
          for (int j = 0; j <= g - k; ++j) {
            const std::array<int, 3> m = {g - j - k, j, k};
            std::array<int, 2> at = {0, 0};
            for (std::size_t c = 0; c < 3; ++c) {
              at[0] += m[c] * q[static_cast<std::size_t>(corners[c])][0];
              at[1] += m[c] * q[static_cast<std::size_t>(corners[c])][1];
            }
            nodes.push_back(id(at[0] / g, at[1] / g));
            values.push_back(value[nodes.back().index()]);
          }
        }
        const auto bezier = bernstein::from_lagrange<Vec2>(g, values);
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          if (!done[nodes[i].index()]) control[nodes[i].index()] = bezier[i];
          done[nodes[i].index()] = 1;
        }
        elements.insert(elements.end(), nodes.begin(), nodes.end());
      }
    }
  }
  return std::make_shared<const TriangleMesh>(g, std::move(control), std::move(elements));
}

inline Vec2 same_place(const Vec2& p) {
  return p;
}

/// Keeps the boundary of [-1, 1]^2 in place and bends everything inside.
inline PlaneMap bend(double a, double b) {
  return [a, b](const Vec2& p) {
    const double bubble = (1.0 - p[0] * p[0]) * (1.0 - p[1] * p[1]);
    return Vec2{{p[0] + a * bubble * std::sin(2.0 * p[1] + 0.3),
                 p[1] + b * bubble * std::cos(2.5 * p[0] - 0.2)}};
  };
}

/// The map, then moved.
inline PlaneMap moved(const PlaneMap& first, const Vec2& by) {
  return [first, by](const Vec2& p) { return first(p) + by; };
}

/// Rotation by an angle after scaling.
inline PlaneMap turn(double angle, double scale, const PlaneMap& first = same_place) {
  return [=](const Vec2& p) {
    const Vec2 q = first(p) * scale;
    return Vec2{{std::cos(angle) * q[0] - std::sin(angle) * q[1],
                 std::sin(angle) * q[0] + std::cos(angle) * q[1]}};
  };
}

}  // namespace bezel::test
