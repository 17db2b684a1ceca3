// Mass matrices of target elements and the solution on one element.

#include <algorithm>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {

namespace {

/// Geometric and field degree in all up to which mass matrices come from tables of products.
constexpr int max_mapped_mass = 12;

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

/// The target's polynomials may stay on the triangle they were computed on when the space's frame
/// is that triangle, up to the rounding of barycentric coordinates at its place in the plane.
bool is_frame(const Frame& frame, const std::array<Vec2, 3>& corners) {
  double slope = 0.0;
  for (const Vec2& g : frame.gradient) slope = std::max({slope, std::abs(g[0]), std::abs(g[1])});
  const double reach = std::max(std::abs(frame.centre[0]), std::abs(frame.centre[1]));
  double largest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Lambda l = frame.lambda(corners[k]);
    for (std::size_t i = 0; i < 3; ++i)
      largest = std::max(largest, std::abs(l[i] - (i == k ? 1.0 : 0.0)));
  }
  return largest <= 0x1p-51 * (2.0 + reach * slope);
}

}  // namespace

const MassRule& ElementTransfer::mass_rule(int degree) {
  for (const MassRule& known : mass_rules_) {
    if (known.degree == degree) return known;
  }
  mass_rules_.push_back(make_mass_rule(target_.degree, degree));
  return mass_rules_.back();
}

const MappedMass& ElementTransfer::mapped_mass(int degree) {
  for (const MappedMass& known : mapped_masses_) {
    if (known.degree == degree) return known;
  }
  return mapped_masses_.emplace_back(target_.degree, degree);
}

bool ElementTransfer::factorize(std::size_t n, Factor& factor) {
  if (!cholesky(n, factor.lower)) return false;
  factor.inverse.resize(n);
  for (std::size_t i = 0; i < n; ++i) factor.inverse[i] = 1.0 / factor.lower[i * n + i];
  return true;
}

const ElementTransfer::Factor& ElementTransfer::factor(const Group& g, std::int32_t t) {
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
  if (moment_factor(g, t)) return f;
  f.scale = 1.0;
  if (g.target_mapped && gd + p <= max_mapped_mass) {
    const MappedMass& mass = mapped_mass(p);
    f.lower.resize(n * n);
    f.integrals.resize(n);
    mass.compute(target_.element(t), f.lower, f.integrals);
    if (factorize(n, f)) return f;
  }
  const int degree = g.target_mapped ? 2 * p + 2 * (gd - 1) : 2 * p * gd + 2 * (gd - 1);
  const MassRule& points = mass_rule(degree);
  const std::size_t count = points.weight.size(), padded = fit_padded(count);
  scratch_.assign(6 * padded + n * (n + 1) / 2, 0.0);
  double *u = scratch_.data(), *v = u + padded, *x = v + padded, *y = x + padded, *w = y + padded;
  double *det = w + padded, *products = det + padded;
  for (std::size_t q = 0; q < count; ++q) {
    u[q] = points.place[q][0];
    v[q] = points.place[q][1];
  }
  fit_map(MapPolynomial(gd, target_.element(t)), padded / fit_lanes, u, v, x, y, det);
  for (std::size_t q = 0; q < count; ++q) {
    w[q] = points.weight[q] * det[q];
    if (g.target_mapped) continue;
    const auto place = target_place(g, t, Vec2{{x[q], y[q]}});
    u[q] = place[0];
    v[q] = place[1];
  }
  f.lower.resize(n * n);
  f.integrals.resize(n);
  fit_products(p, padded, w, u, v, products, f.integrals.data());
  const auto factors = multinomials(p);
  for (std::size_t i = 0; i < n; ++i) {
    f.integrals[i] *= factors[i];
    for (std::size_t j = 0; j <= i; ++j, ++products)
      f.lower[i * n + j] = factors[i] * factors[j] * *products;
  }
  if (!factorize(n, f)) {
    throw NumericsError("target triangle " + std::to_string(t) +
                        ": its mass matrix is singular in double precision (degree " +
                        std::to_string(p) + " on a degenerate element)");
  }
  return f;
}

bool ElementTransfer::in_other_frame(const Group& g, std::int32_t t) const {
  return g.target_space->basis() == Basis::physical &&
         !(target_.degree == 1 &&
           is_frame(g.target_space->frame(ElementId(t)), target_.corners(t)));
}

bool ElementTransfer::finish_straight(std::size_t i, std::int32_t t, std::span<const double> mass,
                                      double area, std::span<double> result,
                                      ElementOutcome& outcome) {
  const Group& g = groups_[i];
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  if (target_.degree != 1 || have_moments_[i] == 0 ||
      std::abs(area - own_area) > full_cover * own_area)
    return false;
  for (const double m : sums_[i].basis)
    if (m != 0.0) return false;  // extensions
  if (in_other_frame(g, t)) return false;
  const Accumulators& sums = moment_sums_[i];
  const double defect =
      solve_straight({g.target_space->degree(ElementId(t)), g.components, own_area, area,
                      sums.product.data(), sums.basis.data(), mass.data(), base_[i].data()},
                     result.data());
  outcome.max_mass_defect = std::max(outcome.max_mass_defect, defect);
  return true;
}

void ElementTransfer::finish(const Group& g, std::int32_t t, const Accumulators& sums,
                             std::span<const double> mass, std::span<const double> base,
                             double area, std::span<double> result, ElementOutcome& outcome) {
  const int p = g.target_space->degree(ElementId(t));
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(p));
  const std::size_t nc = mass.size();
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  const bool full = std::abs(area - own_area) <= full_cover * own_area;
  const Factor& f = factor(g, t);
  const auto factors = multinomials(p);
  std::vector<double>& rhs = scratch_;
  std::array<Lambda, 3> to_frame{};  // the space's frame seen from the triangle computed on
  const bool other_frame = in_other_frame(g, t);
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
