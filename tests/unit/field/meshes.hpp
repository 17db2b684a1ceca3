#pragma once
// Small curved meshes made by hand for the tests of this module.

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/mesh/mesh.hpp"

namespace bezel::field_test {

using MeshPtr = std::shared_ptr<const TriangleMesh>;

/// The square [-1, 1]^2 cut into 2 n^2 triangles of geometric degree g, every control point moved
/// by `move`. Corners start at a different one from element to element and nodes are numbered out
/// of order, so that about half of the shared edges are reversed in one neighbour.
inline MeshPtr square(int n, int g, const std::function<Vec2(const Vec2&)>& move) {
  const int m = n * g + 1;
  const int nodes = m * m;
  // A multiplier coprime to the number of nodes scatters the numbers.
  int step = 7;
  const auto gcd = [](int a, int b) {
    while (b != 0) a = std::exchange(b, a % b);
    return a;
  };
  while (gcd(step, nodes) != 1) ++step;
  const auto number = [&](int i, int j) { return ((j * m + i) * step + 3) % nodes; };
  std::vector<Vec2> control(static_cast<std::size_t>(nodes));
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i)
      control[static_cast<std::size_t>(number(i, j))] =
          move({-1.0 + 2.0 * i / (m - 1), -1.0 + 2.0 * j / (m - 1)});
  std::vector<NodeId> elements;
  int turn = 0;
  const auto add = [&](std::array<std::array<int, 2>, 3> corner) {
    std::array<std::array<int, 2>, 3> c;
    for (std::size_t k = 0; k < 3; ++k) c[k] = corner[(k + static_cast<std::size_t>(turn)) % 3];
    turn = (turn + 1) % 3;
    for (int index = 0; index < bernstein::triangle_size(g); ++index) {
      const std::array<int, 3> w = bernstein::triangle_multi_index(g, index);
      elements.emplace_back(number(w[0] * c[0][0] + w[1] * c[1][0] + w[2] * c[2][0],
                                   w[0] * c[0][1] + w[1] * c[1][1] + w[2] * c[2][1]));
    }
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      if ((i + j) % 2 == 0) {
        add({{{i, j}, {i + 1, j}, {i + 1, j + 1}}});
        add({{{i, j}, {i + 1, j + 1}, {i, j + 1}}});
      } else {
        add({{{i, j}, {i + 1, j}, {i, j + 1}}});
        add({{{i + 1, j}, {i + 1, j + 1}, {i, j + 1}}});
      }
    }
  return std::make_shared<TriangleMesh>(g, std::move(control), std::move(elements));
}

/// Straight elements.
inline MeshPtr straight(int n, int g = 1) {
  return square(n, g, [](const Vec2& p) { return p; });
}

/// Curved elements, inside and on the boundary; all valid for n >= 2 (and n = 1 at amplitude 0.08).
inline MeshPtr wavy(int n, int g, double amplitude = 0.08) {
  return square(n, g, [amplitude](const Vec2& p) {
    const double pi = std::numbers::pi;
    return Vec2{p.x() + amplitude * std::sin(pi * p.y() + 0.3) * std::cos(1.1 * p.x()),
                p.y() + amplitude * std::cos(pi * p.x()) * std::cos(0.7 * p.y() + 0.2)};
  });
}

/// Two quadratic triangles with a bulging common edge, coordinates with infinite binary digits.
inline MeshPtr two_quadratic() {
  std::vector<Vec2> control{{0.1, 0.2},  {1.3, 0.1},   {0.2, 1.1}, {1.4, 1.3},  {0.7, 0.05},
                            {0.9, 0.77}, {0.07, 0.61}, {1.5, 0.7}, {0.83, 1.37}};
  std::vector<NodeId> elements;
  for (const int n : {0, 4, 1, 6, 5, 2, 3, 8, 2, 7, 5, 1}) elements.emplace_back(n);
  return std::make_shared<TriangleMesh>(2, std::move(control), std::move(elements));
}

}  // namespace bezel::field_test
