#pragma once
// Integrals over elements of any shape in double-double arithmetic.

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/field/field.hpp"
#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/double_double.hpp"

namespace bezel::test {

/// Of the Bernstein polynomials of degree p of the reference triangle times the Jacobian of a
/// triangle of degree g, whose control points are taken as they are.
inline std::vector<DoubleDouble> exact_integrals(int g, std::span<const Vec2> control, int p) {
  using bernstein::triangle_index;
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  const auto multinomial = [](int n, int j, int k) {
    return DoubleDouble(binomial(n, k) * binomial(n - k, j));
  };
  const auto step = [&](int to, int from, int axis) {
    return DoubleDouble(control[at(to)][axis]) - DoubleDouble(control[at(from)][axis]);
  };
  const int e = g - 1, d = 2 * e;
  std::vector<DoubleDouble> det(at(bernstein::triangle_size(d)));  // times multinomials over g^2
  for (int k = 0; k <= e; ++k)
    for (int j = 0; j + k <= e; ++j)
      for (int q = 0; q <= e; ++q)
        for (int r = 0; r + q <= e; ++r) {
          const int a = triangle_index(g, j, k), u = triangle_index(g, j + 1, k);
          const int b = triangle_index(g, r, q), v = triangle_index(g, r, q + 1);
          const DoubleDouble cross = step(u, a, 0) * step(v, b, 1) - step(u, a, 1) * step(v, b, 0);
          det[at(triangle_index(d, j + r, k + q))] +=
              multinomial(e, j, k) * multinomial(e, r, q) * cross;
        }
  const DoubleDouble scale =
      DoubleDouble(static_cast<double>(g) * g) / DoubleDouble((p + d + 1.0) * (p + d + 2.0));
  std::vector<DoubleDouble> out(at(bernstein::triangle_size(p)));
  for (int k = 0; k <= p; ++k)
    for (int j = 0; j + k <= p; ++j) {
      DoubleDouble sum;
      for (int q = 0; q <= d; ++q)
        for (int r = 0; r + q <= d; ++r)
          sum += multinomial(p, j, k) / multinomial(p + d, j + r, k + q) *
                 det[at(triangle_index(d, r, q))];
      out[at(triangle_index(p, j, k))] = sum * scale;
    }
  return out;
}

/// The integral of a component of a field in reference coordinates, and the sum of the sizes of its
/// integrals over elements.
struct ExactMass {
  DoubleDouble total;
  double size = 0.0;
};

inline ExactMass exact_mass(const Field& f, std::size_t component) {
  ExactMass mass;
  const auto nc = static_cast<std::size_t>(f.components());
  for (std::size_t e = 0; e < f.mesh().element_count(); ++e) {
    const ElementId id(e);
    const auto own = exact_integrals(f.mesh().degree(), f.mesh().gather(id), f.space().degree(id));
    const auto c = f.coefficients(id);
    DoubleDouble sum;
    for (std::size_t i = 0; i < own.size(); ++i)
      sum += own[i] * DoubleDouble(c[i * nc + component]);
    mass.total += sum;
    mass.size += std::abs(sum.hi);
  }
  return mass;
}

}  // namespace bezel::test
