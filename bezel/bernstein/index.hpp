#pragma once
// The one ordering of multi-indices (i, j, k), i + j + k = d, of the triangle.
//
// Rows of constant k from the bottom edge, j ascending within a row; degree 2:
//   200 110 020 101 011 002
// lambda = (1-u-v, u, v): i belongs to corner 0, j to corner 1, k to corner 2.
// Side 0 runs from corner 0 to corner 1 (k = 0), side 1 from corner 1 to corner 2 (i = 0), side 2
// from corner 2 to corner 0 (j = 0): counter-clockwise. The interval uses i = 0..d, basis C(d,i)
// s^i (1-s)^(d-i). The tetrahedron (i, j, k, l) is layers of constant l, each ordered like a
// triangle of degree d-l.

#include <array>
#include <cstddef>

namespace bezel::bernstein {

/// Largest degrees supported; above them every function throws InputError.
inline constexpr int max_interval_degree = 60;
inline constexpr int max_triangle_degree = 40;

/// Number of coefficients of degree d >= 0 on the triangle: (d+1)(d+2)/2.
constexpr int triangle_size(int d) {
  return (d + 1) * (d + 2) / 2;
}
/// Number of coefficients of degree d >= 0 on the tetrahedron.
constexpr int tetrahedron_size(int d) {
  return (d + 1) * (d + 2) * (d + 3) / 6;
}
/// Number of coefficients of degree d on the simplex of the given dimension (1, 2, 3).
constexpr int simplex_size(int dim, int d) {
  return dim == 1 ? d + 1 : dim == 2 ? triangle_size(d) : tetrahedron_size(d);
}

/// Position of (d-j-k, j, k) in the flat array.
constexpr int triangle_index(int d, int j, int k) {
  return k * (2 * d + 3 - k) / 2 + j;
}

/// (i, j, k) of flat position n, 0 <= n < triangle_size(d). Cost O(d).
constexpr std::array<int, 3> triangle_multi_index(int d, int n) {
  int k = 0;
  while (n > d - k) n -= d - k + 1, ++k;
  return {d - n - k, n, k};
}

/// Flat position of corner 0, 1, 2.
constexpr int triangle_corner(int d, int corner) {
  return corner == 0 ? 0 : corner == 1 ? d : triangle_size(d) - 1;
}

/// Flat position of the m-th coefficient (0..d) along a side, in the side's own direction.
constexpr int triangle_side_index(int d, int side, int m) {
  return side == 0   ? triangle_index(d, m, 0)
         : side == 1 ? triangle_index(d, d - m, m)
                     : triangle_index(d, 0, d - m);
}

/// Flat position of (d-j-k-l, j, k, l) on the tetrahedron.
constexpr int tetrahedron_index(int d, int j, int k, int l) {
  return tetrahedron_size(d) - tetrahedron_size(d - l) + triangle_index(d - l, j, k);
}

}  // namespace bezel::bernstein
