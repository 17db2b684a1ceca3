#pragma once
// Raw kernels on a triangle's Bernstein coefficients: unchecked, on the stack, for the inner loops
// of geometry.

#include <array>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

/// Splits at the midpoint of side 0 (corner 0 to corner 1). A row of constant k is a univariate
/// polynomial of degree d-k along that side, so each row is halved by itself. Children: (corner 2,
/// corner 0, middle) and (corner 1, corner 2, middle): same orientation, the newest corner last, so
/// that repeated bisection cycles through the sides.
template <class Value>
void bisect(int d, const Value* b, Value* first, Value* second) {
  std::array<Value, bernstein::max_interval_degree + 1> row;
  using bernstein::triangle_index;
  for (int k = 0; k <= d; ++k) {
    const int n = d - k;
    for (int j = 0; j <= n; ++j) row[static_cast<std::size_t>(j)] = b[triangle_index(d, j, k)];
    // Left child corners (0, m, 2): coefficient (n-r, r, k); as (2, 0, m) that is (k, n-r, r).
    // Right child corners (m, 1, 2): coefficient (r, n-r, k); as (1, 2, m) that is (n-r, k, r).
    for (int r = 0; r <= n; ++r) {
      first[triangle_index(d, n - r, r)] = row[0];
      second[triangle_index(d, k, r)] = row[static_cast<std::size_t>(n - r)];
      for (int j = 0; j + r < n; ++j) {
        const auto i = static_cast<std::size_t>(j);
        row[i] = 0.5 * (row[i] + row[i + 1]);
      }
    }
  }
}

/// The barycentrics of a piece's corners in the whole triangle.
using TriangleCorners = std::array<std::array<double, 3>, 3>;
inline constexpr TriangleCorners whole_triangle{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// The corners of the children of `bisect`.
inline void bisect_corners(const TriangleCorners& corner, TriangleCorners& first,
                           TriangleCorners& second) {
  std::array<double, 3> middle{};
  for (std::size_t i = 0; i < 3; ++i) middle[i] = 0.5 * (corner[0][i] + corner[1][i]);
  first = {corner[2], corner[0], middle};
  second = {corner[1], corner[2], middle};
}

struct MapValue {
  Vec2 value, du, dv;
};

/// Any degree g <= G; the stack space is that of G.
template <int G>
MapValue map_gradient_fixed(int degree, const Vec2* b, double u, double v, const Vec2& p) {
  const int g = G <= 3 ? G : degree;
  const double w = 1.0 - u - v;
  std::array<Vec2, static_cast<std::size_t>(bernstein::triangle_size(G))> storage;
  Vec2* q = storage.data();
  const int n = bernstein::triangle_size(g);
  for (int i = 0; i < n; ++i) q[i] = b[i] - p;
  for (int d = g; d >= 2; --d) {
    int at = 0, low = 0;  // rows of degree d-1 (written) and d (read)
    for (int k = 0; k < d; ++k) {
      const int high = low + (d - k) + 1;
      for (int j = 0; j < d - k; ++j, ++at)
        q[at] = w * q[low + j] + u * q[low + j + 1] + v * q[high + j];
      low = high;
    }
  }
  const double f = g;
  return {w * q[0] + u * q[1] + v * q[2], f * (q[1] - q[0]), f * (q[2] - q[0])};
}

/// Value and gradient of the map minus the point p, by de Casteljau on b - p (accurate near p).
inline MapValue map_gradient(int g, const Vec2* b, double u, double v, const Vec2& p) {
  const double w = 1.0 - u - v;
  if (g == 1) {
    const Vec2 q = b[0] - p, du = b[1] - b[0], dv = b[2] - b[0];
    return {q + u * du + v * dv, du, dv};
  }
  if (g == 2) {
    const Vec2 q0 = b[0] - p, q1 = b[1] - p, q2 = b[2] - p, q3 = b[3] - p, q4 = b[4] - p,
               q5 = b[5] - p;
    const Vec2 r0 = w * q0 + u * q1 + v * q3;
    const Vec2 r1 = w * q1 + u * q2 + v * q4;
    const Vec2 r2 = w * q3 + u * q4 + v * q5;
    return {w * r0 + u * r1 + v * r2, 2.0 * (r1 - r0), 2.0 * (r2 - r0)};
  }
  if (g == 3) return map_gradient_fixed<3>(g, b, u, v, p);
  if (g <= 5) return map_gradient_fixed<5>(g, b, u, v, p);
  if (g <= 10) return map_gradient_fixed<10>(g, b, u, v, p);
  return map_gradient_fixed<bernstein::max_triangle_degree>(g, b, u, v, p);
}

}  // namespace bezel::geometry_kernel
