#include "bezel/transfer/continuous.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "bezel/numeric/sum.hpp"
#include "bezel/transfer/boundary_values.hpp"
#include "bezel/transfer/limit_continuous.hpp"
#include "bezel/transfer/mass_solve.hpp"

namespace bezel::detail {
namespace {

/// Per element the mass of c - A x.
std::vector<double> missing_masses(const ContinuousMass& mass, std::span<const double> c,
                                   std::span<const double> x) {
  const Space& space = *mass.space();
  std::vector<double> missing(space.mesh()->element_count());
  for (std::size_t e = 0; e < missing.size(); ++e) {
    const auto dofs = space.dofs(ElementId(e));
    const std::size_t first = space.offset(ElementId(e));
    double sum = 0.0;
    for (std::size_t i = 0; i < dofs.size(); ++i) {
      sum += mass.integrals()[first + i] * (c[first + i] - x[static_cast<std::size_t>(dofs[i])]);
    }
    missing[e] = sum;
  }
  return missing;
}

}  // namespace

ContinuousOutcome make_continuous(ContinuousMass& mass, int components,
                                  std::span<const double> given, std::span<double> coefficients,
                                  const ContinuousLimit& limit) {
  const auto nc = static_cast<std::size_t>(components);
  const Space& space = *mass.space();
  ContinuousOutcome outcome;
  std::vector<double> c(space.coefficient_count());
  std::vector<double> own(given.size() / nc);
  for (std::size_t i = 0; i < nc; ++i) {
    for (std::size_t n = 0; n < c.size(); ++n) c[n] = coefficients[n * nc + i];
    for (std::size_t d = 0; d < own.size(); ++d) own[d] = given[d * nc + i];
    MassSolution solution = mass.solve(c, own);
    std::vector<double> missing = missing_masses(mass, c, solution.dofs);
    if (given.empty()) {
      const double shift = sum(missing) / sum(mass.integrals());
      for (double& x : solution.dofs) x += shift;
      missing = missing_masses(mass, c, solution.dofs);
    }
    double largest = 0.0;
    for (const double m : missing) largest = std::max(largest, std::abs(m));
    outcome.max_element_change.push_back(largest);
    outcome.solve.push_back({solution.dofs.size(), mass.method(), solution.iterations,
                             solution.relative_residual, given.empty() ? 0.0 : -sum(missing)});
    std::vector<double> expanded = space.expand(solution.dofs);
    if (limit) {
      outcome.limited.push_back(limit(i, c, solution.dofs));
      expanded = outcome.limited.back().coefficients;
    }
    for (std::size_t n = 0; n < c.size(); ++n) coefficients[n * nc + i] = expanded[n];
  }
  return outcome;
}

std::vector<ContinuousOutcome> make_continuous(std::span<Group> groups, const OverlayMesh& donor,
                                               const OverlayMesh& target, const FrontSearch& search,
                                               const TransferOptions& options,
                                               const MassSystemMaker& make_system,
                                               const BoundsOf& bounds) {
  std::vector<ContinuousOutcome> outcomes;
  std::vector<std::unique_ptr<ContinuousMass>> masses;  // one per space
  for (Group& g : groups) {
    BoundaryValues boundary;
    if (options.keep_boundary)
      boundary = boundary_values(g, donor, target, search, options.uncovered, options.threads);
    auto known = std::find_if(masses.begin(), masses.end(),
                              [&](const auto& m) { return m->space() == g.continuous_space; });
    if (known == masses.end()) {
      masses.push_back(std::make_unique<ContinuousMass>(g.continuous_space, boundary.fixed,
                                                        options.threads, options.mass_method,
                                                        nullptr, make_system));
      known = masses.end() - 1;
    }
    const auto limit = [&](std::size_t i, std::span<const double> c, std::span<const double> dofs) {
      const ComponentBounds own = bounds(outcomes.size(), i);
      return limit_continuous(**known, c, dofs, own.values, own.what, options.threads);
    };
    outcomes.push_back(make_continuous(**known, g.components, boundary.values, g.out,
                                       bounds ? ContinuousLimit(limit) : ContinuousLimit()));
    g.target_space = g.continuous_space;
  }
  return outcomes;
}

}  // namespace bezel::detail
