// Mass matrices of target elements and the solution on one element.

#include <algorithm>
#include <cmath>
#include <optional>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {

namespace {

/// Geometric and field degree in all up to which mass matrices come from tables of products.
constexpr int max_mapped_mass = 12;

/// An element is covered when its overlaps add up to its area within this fraction.
constexpr double full_cover = 1e-9;

constexpr std::size_t max_functions =
    static_cast<std::size_t>(bernstein::triangle_size(Space::max_degree));

/// Values of several components: the compiler makes vectors of the loops. Each component has the
/// bits that it has alone.
template <std::size_t width>
struct Pack {
  double v[width];

  friend Pack operator+(Pack a, const Pack& b) {
    for (std::size_t c = 0; c < width; ++c) a.v[c] += b.v[c];
    return a;
  }
  friend Pack operator*(double s, Pack a) {
    for (std::size_t c = 0; c < width; ++c) a.v[c] = s * a.v[c];
    return a;
  }
};

/// x := scale (L L^T)^-1 x. N: the size when known at compile time.
template <std::size_t N, std::size_t width>
void solve_in_place(std::size_t size, const double* lower, const double* inverse, double scale,
                    Pack<width>* x) {
  const std::size_t n = N > 0 ? N : size;
  const auto eliminate = [&](double factor, const Pack<width>& known, Pack<width>& from) {
    for (std::size_t c = 0; c < width; ++c) from.v[c] -= factor * known.v[c];
  };
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) eliminate(lower[i * n + k], x[k], x[i]);
    x[i] = inverse[i] * x[i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) eliminate(lower[k * n + i], x[k], x[i]);
    x[i] = inverse[i] * x[i];
  }
  for (std::size_t i = 0; i < n; ++i) x[i] = scale * x[i];
}

template <std::size_t width>
void solve_in_place(std::size_t n, const double* lower, const double* inverse, double scale,
                    Pack<width>* x) {
  if (n == 3) return solve_in_place<3>(n, lower, inverse, scale, x);
  if (n == 6) return solve_in_place<6>(n, lower, inverse, scale, x);
  if (n == 10) return solve_in_place<10>(n, lower, inverse, scale, x);
  solve_in_place<0>(n, lower, inverse, scale, x);
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
  // A thin element in the plane of the files is integrated where it is round.
  std::optional<RoundControl> round;
  if (target_.rounding == 0.0 && is_flat(target_, t)) round.emplace(target_.element(t));
  const std::span<const Vec2> control = round ? round->points() : target_.element(t);
  // No plane holds the Jacobian of a bent element.
  std::vector<double> bent_det;
  if (is_flat(target_, t) && is_bent(target_, t))
    bent_det = bent_jacobian(gd, given_element(target_, t));
  if (!round && bent_det.empty() && moment_factor(g, t, whole)) return f;
  f.scale = 1.0;
  if (g.target_mapped && gd + p <= max_mapped_mass) {
    const MappedMass& mass = mapped_mass(p);
    f.lower.resize(n * n);
    f.integrals.resize(n);
    if (bent_det.empty()) {
      mass.compute(control, f.lower, f.integrals);
    } else {
      mass.compute_from(bent_det, f.lower, f.integrals);
    }
    if (factorize(n, f)) return f;
  }
  const int degree = g.target_mapped ? 2 * p + 2 * (gd - 1) : 2 * p * gd + 2 * (gd - 1);
  const MassRule& points = mass_rule(degree);
  const std::size_t count = points.weight.size(), padded = padded_to_lanes(count);
  scratch_.assign(6 * padded + n * (n + 1) / 2, 0.0);
  double *u = scratch_.data(), *v = u + padded, *x = v + padded, *y = x + padded, *w = y + padded;
  double *det = w + padded, *products = det + padded;
  for (std::size_t q = 0; q < count; ++q) {
    u[q] = points.place[q][0];
    v[q] = points.place[q][1];
  }
  fit_map(MapPolynomial(gd, control), padded / lanes, u, v, x, y, det);
  if (!bent_det.empty())
    bernstein::evaluate(2 * (gd - 1), bent_det, {u, count}, {v, count}, {det, count});
  Frame frame;
  if (!g.target_mapped) {
    frame = g.target_frame[static_cast<std::size_t>(t)];
    if (round) frame = field_detail::moved(round->map(), frame);
  }
  for (std::size_t q = 0; q < count; ++q) {
    w[q] = points.weight[q] * det[q];
    if (g.target_mapped) continue;
    const auto lambda = frame.lambda({{x[q], y[q]}});
    const std::array<double, 2> place{lambda[1], lambda[2]};
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
  const GroupState& own = element_.groups[i];
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  if (target_.degree != 1 || !own.has_moments || own.has_sums ||
      std::abs(area - own_area) > full_cover * own_area || g.in_other_frame(t))
    return false;
  const Accumulators& sums = own.moments;
  const double defect =
      solve_straight({g.target_space->degree(ElementId(t)), g.components, own_area, area,
                      sums.product.data(), sums.basis.data(), mass.data(), own.base.data()},
                     result.data());
  outcome.max_mass_defect = std::max(outcome.max_mass_defect, defect);
  return true;
}

/// What the solution on one element needs besides its right-hand sides.
struct ElementTransfer::Solution {
  const Factor& factor;
  std::span<const double> multinomials;
  const std::array<Lambda, 3>* to_frame;  // the space's frame seen from the triangle computed on
  int degree;
  double received_area, own_area;
  bool full;  // the element is covered
};

template <std::size_t width>
void ElementTransfer::finish_components(const Solution& s, const Accumulators& sums,
                                        std::span<const double> mass, std::span<const double> base,
                                        std::size_t c0, std::span<double> result,
                                        ElementOutcome& outcome) {
  const std::size_t n = s.multinomials.size(), nc = mass.size();
  const std::size_t count = std::min(width, nc - c0);
  std::array<Pack<width>, max_functions> rhs;
  // Around the element's mean: what remains is small, so a constant comes back constant whatever
  // the rule.
  Pack<width> goal{}, mean{}, lacking{}, excess{};
  for (std::size_t c = 0; c < count; ++c) {
    goal.v[c] = mass[c0 + c];
    mean.v[c] = s.full ? goal.v[c] / s.received_area : 0.0;
    lacking.v[c] = mean.v[c] - base[c0 + c];
  }
  for (std::size_t i = 0; i < n; ++i) {
    rhs[i] = {};
    const double* product = sums.product.data() + i * nc + c0;
    for (std::size_t c = 0; c < count; ++c) {
      rhs[i].v[c] = (product[c] - lacking.v[c] * sums.basis[i]) * s.multinomials[i];
      excess.v[c] += rhs[i].v[c];
    }
  }
  for (std::size_t c = 0; c < count; ++c)
    excess.v[c] = (goal.v[c] - mean.v[c] * s.own_area) - excess.v[c];
  const Factor& f = s.factor;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t c = 0; c < width; ++c)
      rhs[i].v[c] += excess.v[c] * f.integrals[i] / s.own_area;
  solve_in_place(n, f.lower.data(), f.inverse.data(), f.scale, rhs.data());
  // The constant part of what rounding left over.
  for (int sweep = 0; sweep < 2; ++sweep) {
    Pack<width> missing{};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < width; ++c)
        missing.v[c] += (rhs[i].v[c] + mean.v[c]) * f.integrals[i];
    for (std::size_t c = 0; c < width; ++c) missing.v[c] = goal.v[c] - missing.v[c];
    if (sweep == 1) {
      for (std::size_t c = 0; c < count; ++c)
        outcome.max_mass_defect = std::max(outcome.max_mass_defect, std::abs(missing.v[c]));
      break;
    }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < width; ++c) rhs[i].v[c] += missing.v[c] / s.own_area;
  }
  for (std::size_t i = 0; i < n; ++i) rhs[i] = rhs[i] + mean;
  if (s.to_frame != nullptr) {
    std::array<Pack<width>, max_functions> from;
    std::copy_n(rhs.begin(), n, from.begin());
    bernstein::kernel::specialize_triangle(s.degree, from.data(), *s.to_frame, {0, 1, 2},
                                           rhs.data());
  }
  for (std::size_t i = 0; i < n; ++i) std::copy_n(rhs[i].v, count, result.data() + i * nc + c0);
}

void ElementTransfer::finish(const Group& g, std::int32_t t, const Accumulators& sums,
                             std::span<const double> whole, std::span<const double> mass,
                             std::span<const double> base, double area, std::span<double> result,
                             ElementOutcome& outcome) {
  const int p = g.target_space->degree(ElementId(t));
  const double own_area = target_.element_area[static_cast<std::size_t>(t)];
  std::array<Lambda, 3> to_frame{};
  const bool other_frame = g.in_other_frame(t);
  if (other_frame) {
    const auto corners = g.target_space->frame(ElementId(t)).corners();
    for (std::size_t k = 0; k < 3; ++k)
      to_frame[k] = g.target_frame[static_cast<std::size_t>(t)].lambda(corners[k]);
  }
  const Solution solution{factor(g, t, whole),
                          multinomials(p),
                          other_frame ? &to_frame : nullptr,
                          p,
                          area,
                          own_area,
                          std::abs(area - own_area) <= full_cover * own_area};
  constexpr std::size_t together = 8;
  for (std::size_t c = 0; c < mass.size();) {
    if (mass.size() - c > 2) {
      finish_components<together>(solution, sums, mass, base, c, result, outcome);
      c += together;
    } else {
      finish_components<1>(solution, sums, mass, base, c++, result, outcome);
    }
  }
}

}  // namespace bezel::detail
