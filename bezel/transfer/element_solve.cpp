// Mass matrices of target elements and the solution on one element.

#include <algorithm>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {

const MassRule& ElementTransfer::mass_rule(int degree) {
  for (const MassRule& known : mass_rules_) {
    if (known.degree == degree) return known;
  }
  mass_rules_.push_back(make_mass_rule(target_.degree, degree));
  return mass_rules_.back();
}

const ElementTransfer::Factor& ElementTransfer::factor(const Group& g, std::int32_t t) {
  const int p = g.target_space->degree(ElementId(t));
  const int gd = target_.degree;
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
  Factor& f = factor_;
  if (gd == 1) {
    // A straight triangle's own barycentrics: one matrix for all, times twice the area.
    if (reference_degree_ != p) {
      reference_lower_ = bernstein::mass_matrix(p);
      cholesky(n, reference_lower_);
      reference_degree_ = p;
    }
    const double area = target_.element_area[static_cast<std::size_t>(t)];
    const double scale = std::sqrt(2.0 * area);
    f.lower.resize(n * n);
    for (std::size_t i = 0; i < n * n; ++i) f.lower[i] = reference_lower_[i] * scale;
    f.integrals.assign(n, area / static_cast<double>(n));
    return f;
  }
  const int degree = g.target_mapped ? 2 * p + 2 * (gd - 1) : 2 * p * gd + 2 * (gd - 1);
  const MassRule& points = mass_rule(degree);
  f.lower.assign(n * n, 0.0);
  f.integrals.assign(n, 0.0);
  std::vector<double>& phi = scratch_;
  phi.resize(n);
  const auto control = target_.element(t);
  for (std::size_t q = 0; q < points.weight.size(); ++q) {
    const MassPoint map = mass_point(points, control, q);
    const auto place = g.target_mapped ? points.place[q] : target_place(g, t, map.x);
    basis_at(p, place[0], place[1], phi.data());
    const double w = points.weight[q] * map.det;
    for (std::size_t i = 0; i < n; ++i) {
      const double wi = w * phi[i];
      f.integrals[i] += wi;
      for (std::size_t j = 0; j <= i; ++j) f.lower[i * n + j] += wi * phi[j];
    }
  }
  if (!cholesky(n, f.lower)) {
    throw NumericsError("target triangle " + std::to_string(t) +
                        ": its mass matrix is singular in double precision (degree " +
                        std::to_string(p) + " on a degenerate element)");
  }
  return f;
}

void ElementTransfer::finish(Group& g, std::int32_t t, Accumulators& sums,
                             std::span<const double> mass, double area, ElementOutcome& outcome) {
  const int p = g.target_space->degree(ElementId(t));
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
  const auto nc = static_cast<std::size_t>(g.components);
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  const bool full = std::abs(area - own_area) <= 1e-9 * own_area;
  const Factor& f = factor(g, t);
  const auto factors = multinomials(p);
  const std::span<double> result = g.target_out(t);
  std::vector<double>& rhs = scratch_;
  std::array<Lambda, 3> to_frame{};  // the space's frame seen from the triangle computed on
  if (g.target_space->basis() == Basis::physical) {
    const auto corners = g.target_space->frame(ElementId(t)).corners();
    for (std::size_t k = 0; k < 3; ++k) {
      to_frame[k] = g.target_frame[static_cast<std::size_t>(t)].lambda(corners[k]);
    }
  }
  for (std::size_t c = 0; c < nc; ++c) {
    rhs.assign(n, 0.0);
    // Around the element's mean: what remains is small, so a constant comes back constant whatever
    // the rule.
    const double mean = full ? mass[c] / area : 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      rhs[i] = (sums.product[i * nc + c] - mean * sums.basis[i]) * factors[i];
      sum += rhs[i];
    }
    const double excess = (mass[c] - mean * own_area) - sum;
    for (std::size_t i = 0; i < n; ++i) rhs[i] += excess * f.integrals[i] / own_area;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) rhs[i] -= f.lower[i * n + k] * rhs[k];
      rhs[i] /= f.lower[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) rhs[i] -= f.lower[k * n + i] * rhs[k];
      rhs[i] /= f.lower[i * n + i];
    }
    // The constant part of what rounding left over.
    for (int sweep = 0; sweep < 2; ++sweep) {
      double got = 0.0;
      for (std::size_t i = 0; i < n; ++i) got += (rhs[i] + mean) * f.integrals[i];
      const double missing = mass[c] - got;
      if (sweep == 1) {
        outcome.max_mass_defect = std::max(outcome.max_mass_defect, std::abs(missing));
        break;
      }
      for (std::size_t i = 0; i < n; ++i) rhs[i] += missing / own_area;
    }
    for (std::size_t i = 0; i < n; ++i) rhs[i] += mean;
    if (g.target_space->basis() == Basis::physical) {
      const auto own = bernstein::specialize<double>(p, rhs, to_frame);
      std::copy(own.begin(), own.end(), rhs.begin());
    }
    for (std::size_t i = 0; i < n; ++i) result[i * nc + c] = rhs[i];
  }
}

}  // namespace bezel::detail
