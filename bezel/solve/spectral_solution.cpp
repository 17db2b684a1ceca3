// What one does with a spectral solution: values, gradients, errors.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/fit/tensor_grid.hpp"
#include "bezel/solve/function_value.hpp"
#include "bezel/solve/spectral.hpp"

namespace bezel {

using fit_detail::LobattoSample;

namespace {

/// Derivatives with respect to x and y from those with respect to xi and eta.
Vec2 physical_gradient(double u_xi, double u_eta, const Vec2& d_xi, const Vec2& d_eta) {
  const double det = cross(d_xi, d_eta);
  return {(u_xi * d_eta.y() - u_eta * d_xi.y()) / det, (u_eta * d_xi.x() - u_xi * d_eta.x()) / det};
}

}  // namespace

std::size_t QuadTopology::skeleton_node(std::size_t element, int side, int k, int m) const {
  const Element& e = elements[element];
  const auto s = static_cast<std::size_t>(side);
  if (k == 0) return e.vertex[s];
  if (k == m) return e.vertex[(s + 1) % 4];
  return vertices + e.edge[s] * static_cast<std::size_t>(m - 1) +
         static_cast<std::size_t>(e.reversed[s] ? m - 1 - k : k - 1);
}

std::size_t SpectralSolution::checked(ElementId e) const {
  if (!e.valid() || e.index() >= values_.size())
    throw InputError(
        fmt::format("element {} does not exist, the solution has {}", e.value, values_.size()));
  return e.index();
}

std::span<const double> SpectralSolution::values(ElementId e) const {
  return values_[checked(e)];
}

std::vector<Vec2> SpectralSolution::points(ElementId e) const {
  const std::vector<Vec2>& nodes = nodes_[checked(e)];
  if (map_.degree() == basis_.degree()) return nodes;
  const LobattoSample at = fit_detail::sample(map_, basis_.nodes());
  return fit_detail::apply(at, at.value, at.value, std::span<const Vec2>(nodes));
}

SpectralValue SpectralSolution::evaluate(ElementId e, double xi, double eta) const {
  const std::size_t element = checked(e);
  if (!std::isfinite(xi) || !std::isfinite(eta))
    throw InputError("a parameter is not finite, expected finite xi and eta");
  const std::array<double, 1> at_xi{xi}, at_eta{eta};
  const auto evaluate_all = [&](const LobattoBasis& basis, auto nodal) {
    const LobattoSample a = fit_detail::sample(basis, at_xi), b = fit_detail::sample(basis, at_eta);
    return std::array{fit_detail::apply(a, a.value, b.value, nodal)[0],
                      fit_detail::apply(a, a.derivative, b.value, nodal)[0],
                      fit_detail::apply(a, a.value, b.derivative, nodal)[0]};
  };
  const auto x = evaluate_all(map_, std::span<const Vec2>(nodes_[element]));
  const auto u = evaluate_all(basis_, std::span<const double>(values_[element]));
  return {x[0], u[0], physical_gradient(u[1], u[2], x[1], x[2])};
}

SpectralErrors SpectralSolution::errors(const PlaneFunction& exact,
                                        const PlaneGradient& exact_gradient, int degree) const {
  if (!exact || !exact_gradient)
    throw InputError("the exact solution or its gradient is empty, expected functions of x and y");
  if (degree < 0 || degree > 3 * max_degree)
    throw InputError(
        fmt::format("an error rule of degree {}, expected 1 to {}, or 0", degree, 3 * max_degree));
  const IntervalRule rule = fit_detail::lobatto_rule(degree == 0 ? 3 * basis_.degree() : degree);
  const std::size_t m = rule.node.size();
  const LobattoSample map_at = fit_detail::sample(map_, rule.node);
  const LobattoSample at = fit_detail::sample(basis_, rule.node);
  double energy = 0.0, l2 = 0.0, max = 0.0;
  for (std::size_t e = 0; e < values_.size(); ++e) {
    const auto x = fit_detail::evaluate_grid(map_at, std::span<const Vec2>(nodes_[e]));
    const auto u = fit_detail::evaluate_grid(at, std::span<const double>(values_[e]));
    for (std::size_t q = 0; q < m * m; ++q) {
      const Vec2& p = x.value[q];
      const double weight = rule.weight[q % m] * rule.weight[q / m] * cross(x.d_xi[q], x.d_eta[q]);
      const double value = solve_detail::finite(exact(p.x(), p.y()), p, "the exact solution");
      const Vec2 gradient = exact_gradient(p.x(), p.y());
      for (const double part : gradient.c)
        solve_detail::finite(part, p, "the gradient of the exact solution");
      const double difference = u.value[q] - value;
      const Vec2 slope = physical_gradient(u.d_xi[q], u.d_eta[q], x.d_xi[q], x.d_eta[q]) - gradient;
      energy += weight * dot(slope, slope);
      l2 += weight * difference * difference;
      max = std::max(max, std::fabs(difference));
    }
  }
  return {std::sqrt(energy), std::sqrt(l2), max};
}

}  // namespace bezel
