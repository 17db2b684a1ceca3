#include "bezel/mesh/bend.hpp"

#include <array>

#include "bezel/bernstein/index.hpp"
#include "bezel/mesh/mesh.hpp"

namespace bezel::planar {

void extend_bend(int g, int side, std::span<const Vec2> bend, std::span<Vec2> control) {
  if (g < 3) return;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  std::array<Vec2, TriangleMesh::max_degree> eta;
  for (int m = 1; m < g; ++m) eta[at(m - 1)] = bend[at(m - 1)] * (g * (g - 1.0) / (m * (g - m)));
  // (a, b, c): powers at the side's start, its end and the opposite corner. The Bernstein
  // coefficient of the extension is a b / (g (g-1)) times the blossom of eta at 0 (a-1 times), 1
  // (b-1), 1/2 (c).
  for (int c = 1; c <= g - 2; ++c) {
    for (int b = 0; b < g - 1 - c; ++b) eta[at(b)] = 0.5 * (eta[at(b)] + eta[at(b + 1)]);
    for (int b = 1; b < g - c; ++b) {
      const int a = g - b - c;
      const int j = side == 0 ? b : side == 1 ? a : c, k = side == 0 ? c : side == 1 ? b : a;
      control[at(bernstein::triangle_index(g, j, k))] += (a * b / (g * (g - 1.0))) * eta[at(b - 1)];
    }
  }
}

}  // namespace bezel::planar
