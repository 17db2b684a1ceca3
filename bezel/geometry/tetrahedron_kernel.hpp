#pragma once
// Raw kernels on a curved tetrahedron's control points, unchecked: hodographs, determinant, value
// and gradient of the map. The determinant is a template on the scalar.

#include <array>
#include <cstddef>
#include <vector>

#include "bezel/bernstein/tetrahedron_kernel.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

template <class Scalar>
Vec<3, Scalar> cross3(const Vec<3, Scalar>& a, const Vec<3, Scalar>& b) {
  return {{Scalar(Scalar(a[1] * b[2]) - Scalar(a[2] * b[1])),
           Scalar(Scalar(a[2] * b[0]) - Scalar(a[0] * b[2])),
           Scalar(Scalar(a[0] * b[1]) - Scalar(a[1] * b[0]))}};
}

/// Differences of the control points along u, v, w (the derivatives' coefficients over g), degree
/// g - 1 each.
template <class Scalar>
std::array<std::vector<Vec<3, Scalar>>, 3> hodographs(int g, const Vec<3, Scalar>* b) {
  using bernstein::tetrahedron_index;
  std::array<std::vector<Vec<3, Scalar>>, 3> out;
  const int e = g - 1;
  for (auto& h : out) h.reserve(static_cast<std::size_t>(bernstein::tetrahedron_size(e)));
  for (int l = 0; l <= e; ++l)
    for (int k = 0; k <= e - l; ++k)
      for (int j = 0; j <= e - l - k; ++j) {
        const Vec<3, Scalar>& base = b[tetrahedron_index(g, j, k, l)];
        out[0].push_back(b[tetrahedron_index(g, j + 1, k, l)] - base);
        out[1].push_back(b[tetrahedron_index(g, j, k + 1, l)] - base);
        out[2].push_back(b[tetrahedron_index(g, j, k, l + 1)] - base);
      }
  return out;
}

/// det(u, v, w) of three hodographs of degree g - 1, times g^3: tetrahedron_size(3 (g-1))
/// coefficients. Each is a mean, with weights M M M / M, of determinants of differences; 2
/// size(g-1) + 13 roundings of a sum of absolute products of at most 6 g^3 (largest difference)^3.
template <class Scalar>
void hodograph_determinant(int g, std::array<std::vector<Vec<3, Scalar>>, 3> hodograph,
                           Scalar* out) {
  namespace tk = bernstein::tetrahedron::kernel;
  using Point = Vec<3, Scalar>;
  const int e = g - 1, d = 3 * e;
  const std::vector<Scalar> weight = tk::multinomials<Scalar>(e);
  for (auto& h : hodograph)
    for (std::size_t n = 0; n < h.size(); ++n) h[n] *= weight[n];
  const Point zero{{Scalar(0), Scalar(0), Scalar(0)}};
  std::vector<Point> normal(static_cast<std::size_t>(bernstein::tetrahedron_size(2 * e)), zero);
  tk::accumulate_products(e, hodograph[0].data(), e, hodograph[1].data(), normal.data(),
                          [](const Point& a, const Point& b) { return cross3(a, b); });
  const std::vector<Scalar> divisor = tk::multinomials<Scalar>(d);
  for (std::size_t n = 0; n < divisor.size(); ++n) out[n] = Scalar(0);
  tk::accumulate_products(e, hodograph[2].data(), 2 * e, normal.data(), out,
                          [](const Point& a, const Point& b) { return dot(a, b); });
  const Scalar scale(g * g * g);
  for (const Scalar& m : divisor) {
    *out = Scalar(*out * Scalar(scale / m));
    ++out;
  }
}

using MapValue3 = bernstein::tetrahedron::ValueAndGradient<Vec3>;

/// Any degree g <= G; the stack space is that of G, and up to 3 the compiler knows the degree.
template <int G>
MapValue3 map_gradient_fixed(int degree, const Vec3* b, const std::array<double, 4>& lambda,
                             const Vec3& p) {
  namespace tk = bernstein::tetrahedron::kernel;
  const int g = G <= 3 ? G : degree;
  std::array<Vec3, static_cast<std::size_t>(bernstein::tetrahedron_size(G))> storage;
  Vec3* q = storage.data();
  for (int i = 0; i < bernstein::tetrahedron_size(g); ++i) q[i] = b[i] - p;
  for (int d = g; d >= 2; --d) tk::step(q, q, d, lambda);
  const double f = g;
  return {tk::combine(lambda, q[0], q[1], q[2], q[3]), f * (q[1] - q[0]), f * (q[2] - q[0]),
          f * (q[3] - q[0])};
}

/// Value and gradient of the map minus the point p, by de Casteljau on b - p (accurate near p);
/// 1 <= g <= 7.
inline MapValue3 map_gradient(int g, const Vec3* b, const std::array<double, 4>& lambda,
                              const Vec3& p) {
  if (g == 1) return map_gradient_fixed<1>(g, b, lambda, p);
  if (g == 2) return map_gradient_fixed<2>(g, b, lambda, p);
  if (g == 3) return map_gradient_fixed<3>(g, b, lambda, p);
  return map_gradient_fixed<7>(g, b, lambda, p);
}

}  // namespace bezel::geometry_kernel
