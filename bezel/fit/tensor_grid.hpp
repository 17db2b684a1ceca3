#pragma once
// Polynomials on the square [-1, 1]^2 by their values on a tensor grid of Gauss-Lobatto points:
// sampled on another tensor grid. Rows of constant eta, xi running fastest.

#include <cstddef>
#include <span>
#include <vector>

#include "bezel/fit/lobatto.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel::fit_detail {

/// Gauss-Lobatto points and weights on [-1, 1]. @param degree 1..199: one more point
inline IntervalRule lobatto_rule(int degree) {
  IntervalRule rule = gauss_lobatto(degree + 1);
  for (double& x : rule.node) x = 2.0 * x - 1.0;
  for (double& w : rule.weight) w *= 2.0;
  return rule;
}

/// The Lagrange polynomials of a basis and their derivatives at some points: row q holds those at
/// point q.
struct LobattoSample {
  std::size_t points, nodes;
  std::vector<double> value, derivative;
};

inline LobattoSample sample(const LobattoBasis& basis, std::span<const double> xi) {
  const auto n = static_cast<std::size_t>(basis.degree()) + 1;
  LobattoSample out{xi.size(), n, std::vector<double>(xi.size() * n),
                    std::vector<double>(xi.size() * n)};
  for (std::size_t q = 0; q < xi.size(); ++q) {
    basis.values(xi[q], std::span(out.value).subspan(q * n, n));
    basis.derivatives(xi[q], std::span(out.derivative).subspan(q * n, n));
  }
  return out;
}

/// The basis at its own nodes.
inline LobattoSample sample_at_nodes(const LobattoBasis& basis) {
  const auto n = static_cast<std::size_t>(basis.degree()) + 1;
  LobattoSample out{n, n, std::vector<double>(n * n, 0.0), {}};
  for (std::size_t i = 0; i < n; ++i) out.value[i * n + i] = 1.0;
  out.derivative.assign(basis.derivative_matrix().begin(), basis.derivative_matrix().end());
  return out;
}

/// out(p, q) = sum over (i, j) of a(p, i) b(q, j) nodal(i, j), a and b with `points` rows of
/// `nodes`.
template <class Value>
std::vector<Value> apply(const LobattoSample& size, std::span<const double> a,
                         std::span<const double> b, std::span<const Value> nodal) {
  const std::size_t m = size.points, n = size.nodes;
  std::vector<Value> half(m * n), out(m * m);
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t p = 0; p < m; ++p) {
      Value sum{};
      for (std::size_t i = 0; i < n; ++i) sum += a[p * n + i] * nodal[j * n + i];
      half[j * m + p] = sum;
    }
  for (std::size_t q = 0; q < m; ++q)
    for (std::size_t j = 0; j < n; ++j) {
      const double weight = b[q * n + j];
      for (std::size_t p = 0; p < m; ++p) out[q * m + p] += weight * half[j * m + p];
    }
  return out;
}

/// Value and derivatives on a tensor grid of points.
template <class Value>
struct GridValues {
  std::vector<Value> value, d_xi, d_eta;
};
template <class Value>
GridValues<Value> evaluate_grid(const LobattoSample& at, std::span<const Value> nodal) {
  return {apply(at, at.value, at.value, nodal), apply(at, at.derivative, at.value, nodal),
          apply(at, at.value, at.derivative, nodal)};
}

}  // namespace bezel::fit_detail
