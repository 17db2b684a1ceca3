// Mass matrices of target elements and the solution on one element.

#include <algorithm>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {

namespace {

/// An element is covered when its overlaps add up to its area within this fraction.
constexpr double full_cover = 1e-9;

/// x := scale (L L^T)^-1 x. N: the size when known at compile time.
template <std::size_t N>
void solve_in_place(std::size_t size, const double* lower, const double* inverse, double scale,
                    double* x) {
  const std::size_t n = N > 0 ? N : size;
  for (std::size_t i = 0; i < n; ++i) {
    double sum = x[i];
    for (std::size_t k = 0; k < i; ++k) sum -= lower[i * n + k] * x[k];
    x[i] = sum * inverse[i];
  }
  for (std::size_t i = n; i-- > 0;) {
    double sum = x[i];
    for (std::size_t k = i + 1; k < n; ++k) sum -= lower[k * n + i] * x[k];
    x[i] = sum * inverse[i];
  }
  for (std::size_t i = 0; i < n; ++i) x[i] *= scale;
}

}  // namespace

const MassRule& ElementTransfer::mass_rule(int degree) {
  for (const MassRule& known : mass_rules_) {
    if (known.degree == degree) return known;
  }
  mass_rules_.push_back(make_mass_rule(target_.degree, degree));
  return mass_rules_.back();
}

bool ElementTransfer::factorize(std::size_t n, Factor& factor) {
  if (!cholesky(n, factor.lower)) return false;
  factor.inverse.resize(n);
  for (std::size_t i = 0; i < n; ++i) factor.inverse[i] = 1.0 / factor.lower[i * n + i];
  return true;
}

const ElementTransfer::Factor& ElementTransfer::factor(const Group& g, std::int32_t t,
                                                       std::span<const double> whole) {
  const int p = g.target_space->degree(ElementId(t));
  const int gd = target_.degree;
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
  Factor& f = factor_;
  if (gd == 1) {
    // A straight triangle's own barycentrics: one matrix for all, times twice the area.
    if (reference_degree_ != p) {
      reference_factor_.lower = bernstein::mass_matrix(p);
      factorize(n, reference_factor_);
      reference_degree_ = p;
    }
    const double area = target_.element_area[static_cast<std::size_t>(t)];
    reference_factor_.scale = 0.5 / area;
    reference_factor_.integrals.assign(n, area / static_cast<double>(n));
    return reference_factor_;
  }
  if (moment_factor(g, t, whole)) return f;
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
  if (!factorize(n, f)) {
    throw NumericsError("target triangle " + std::to_string(target_.number_of(t)) +
                        ": its mass matrix is singular in double precision (degree " +
                        std::to_string(p) + " on a degenerate element)");
  }
  return f;
}

bool ElementTransfer::finish_straight(std::size_t i, std::int32_t t, std::span<const double> mass,
                                      double area, std::span<double> result,
                                      ElementOutcome& outcome) {
  const Group& g = groups_[i];
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  if (target_.degree != 1 || have_moments_[i] == 0 ||
      std::abs(area - own_area) > full_cover * own_area)
    return false;
  if (extended_[i] != 0 || g.in_other_frame(t)) return false;
  const Accumulators& sums = moment_sums_[i];
  const double defect =
      solve_straight({g.target_space->degree(ElementId(t)), g.components, own_area, area,
                      sums.product.data(), sums.basis.data(), mass.data(), base_[i].data()},
                     result.data());
  outcome.max_mass_defect = std::max(outcome.max_mass_defect, defect);
  return true;
}

void ElementTransfer::finish(const Group& g, std::int32_t t, const Accumulators& sums,
                             std::span<const double> whole, std::span<const double> mass,
                             std::span<const double> base, double area, std::span<double> result,
                             ElementOutcome& outcome) {
  const int p = g.target_space->degree(ElementId(t));
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
  const std::size_t nc = mass.size();
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  const bool full = std::abs(area - own_area) <= full_cover * own_area;
  const Factor& f = factor(g, t, whole);
  const auto factors = multinomials(p);
  std::vector<double>& rhs = scratch_;
  std::array<Lambda, 3> to_frame{};  // the space's frame seen from the triangle computed on
  const bool other_frame = g.in_other_frame(t);
  if (other_frame) {
    const auto corners = g.target_space->frame(ElementId(t)).corners();
    for (std::size_t k = 0; k < 3; ++k)
      to_frame[k] = g.target_frame[static_cast<std::size_t>(t)].lambda(corners[k]);
  }
  for (std::size_t c = 0; c < nc; ++c) {
    rhs.assign(n, 0.0);
    // Around the element's mean: what remains is small, so a constant comes back constant whatever
    // the rule.
    const double mean = full ? mass[c] / area : 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      rhs[i] = (sums.product[i * nc + c] - (mean - base[c]) * sums.basis[i]) * factors[i];
      sum += rhs[i];
    }
    const double excess = (mass[c] - mean * own_area) - sum;
    for (std::size_t i = 0; i < n; ++i) rhs[i] += excess * f.integrals[i] / own_area;
    switch (n) {
      case 3:
        solve_in_place<3>(n, f.lower.data(), f.inverse.data(), f.scale, rhs.data());
        break;
      case 6:
        solve_in_place<6>(n, f.lower.data(), f.inverse.data(), f.scale, rhs.data());
        break;
      case 10:
        solve_in_place<10>(n, f.lower.data(), f.inverse.data(), f.scale, rhs.data());
        break;
      default:
        solve_in_place<0>(n, f.lower.data(), f.inverse.data(), f.scale, rhs.data());
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
    if (other_frame) {
      const auto own = bernstein::specialize<double>(p, rhs, to_frame);
      std::copy(own.begin(), own.end(), rhs.begin());
    }
    for (std::size_t i = 0; i < n; ++i) result[i * nc + c] = rhs[i];
  }
}

}  // namespace bezel::detail
