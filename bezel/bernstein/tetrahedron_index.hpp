#pragma once
// Corners and faces of the tetrahedron in the ordering of index.hpp: (i, j, k, l) with
// i + j + k + l = d, layers of constant l, each ordered like a triangle; degree 1: corners 0 1 2 3.
//
// lambda = (1-u-v-w, u, v, w): i belongs to corner 0, j to 1, k to 2, l to 3. Face f is opposite to
// corner f; its corners are listed counter-clockwise seen from outside:
//   face 0: 1 2 3    face 1: 0 3 2    face 2: 0 1 3    face 3: 0 2 1

#include <array>
#include <cstddef>

#include "bezel/bernstein/index.hpp"

namespace bezel::bernstein {

/// Largest degree supported on the tetrahedron; above it every function throws InputError.
inline constexpr int max_tetrahedron_degree = 20;

/// The corners of face f in the orientation above.
inline constexpr std::array<std::array<int, 3>, 4> tetrahedron_face_corners{
    {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}}};

/// Flat position of the multi-index x, whose sum is the degree.
constexpr int tetrahedron_index(const std::array<int, 4>& x) {
  return tetrahedron_index(x[0] + x[1] + x[2] + x[3], x[1], x[2], x[3]);
}

/// (i, j, k, l) of flat position n, 0 <= n < tetrahedron_size(d). Cost O(d).
constexpr std::array<int, 4> tetrahedron_multi_index(int d, int n) {
  int l = 0;
  while (n >= triangle_size(d - l)) n -= triangle_size(d - l), ++l;
  const std::array<int, 3> x = triangle_multi_index(d - l, n);
  return {x[0], x[1], x[2], l};
}

/// Flat position of corner 0, 1, 2, 3.
constexpr int tetrahedron_corner(int d, int corner) {
  return corner == 3 ? tetrahedron_size(d) - 1 : triangle_corner(d, corner);
}

/// Flat position of coefficient (d-j-k, j, k) of the polynomial on a face.
constexpr int tetrahedron_face_index(int d, int face, int j, int k) {
  const std::array<int, 3>& corner = tetrahedron_face_corners[static_cast<std::size_t>(face)];
  std::array<int, 4> x{};
  x[static_cast<std::size_t>(corner[0])] = d - j - k;
  x[static_cast<std::size_t>(corner[1])] = j;
  x[static_cast<std::size_t>(corner[2])] = k;
  return tetrahedron_index(x);
}

}  // namespace bezel::bernstein
