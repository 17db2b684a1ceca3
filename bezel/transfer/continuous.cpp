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

/// One component: the dofs, and what is reported.
MassSolution solve_component(ContinuousMass& mass, std::span<const double> c,
                             std::span<const double> given, bool keep_boundary, MassSolve& report,
                             double& max_element_change) {
  MassSolution solution = mass.solve(c, given);
  std::vector<double> missing = missing_masses(mass, c, solution.dofs);
  if (!keep_boundary) {
    const double shift = sum(missing) / sum(mass.integrals());
    for (double& x : solution.dofs) x += shift;
    missing = missing_masses(mass, c, solution.dofs);
  }
  report.dofs = solution.dofs.size();
  report.iterations = solution.iterations;
  report.relative_residual = solution.relative_residual;
  report.boundary_mass_change = keep_boundary ? -sum(missing) : 0.0;
  max_element_change = 0.0;
  for (const double m : missing) max_element_change = std::max(max_element_change, std::abs(m));
  return solution;
}

}  // namespace

std::vector<ContinuousOutcome> make_continuous(std::span<Group> groups, const OverlayMesh& donor,
                                               const OverlayMesh& target, const FrontSearch& search,
                                               const TransferOptions& options,
                                               const BoundsOf& bounds) {
  std::vector<ContinuousOutcome> outcomes(groups.size());
  std::vector<std::unique_ptr<ContinuousMass>> masses;  // one per space
  for (std::size_t k = 0; k < groups.size(); ++k) {
    Group& g = groups[k];
    const auto nc = static_cast<std::size_t>(g.components);
    BoundaryValues boundary;
    if (options.keep_boundary)
      boundary = boundary_values(g, donor, target, search, options.uncovered, options.threads);
    auto known = std::find_if(masses.begin(), masses.end(),
                              [&](const auto& m) { return m->space() == g.continuous_space; });
    if (known == masses.end()) {
      masses.push_back(
          std::make_unique<ContinuousMass>(g.continuous_space, boundary.fixed, options.threads));
      known = masses.end() - 1;
    }
    outcomes[k].solve.resize(nc);
    outcomes[k].max_element_change.resize(nc);
    const std::size_t rows = g.continuous_space->coefficient_count();
    std::vector<double> c(rows);
    std::vector<double> given(boundary.fixed.size());
    for (std::size_t i = 0; i < nc; ++i) {
      for (std::size_t n = 0; n < rows; ++n) c[n] = g.out[n * nc + i];
      for (std::size_t d = 0; d < given.size(); ++d) given[d] = boundary.values[d * nc + i];
      const MassSolution solution =
          solve_component(**known, c, given, options.keep_boundary, outcomes[k].solve[i],
                          outcomes[k].max_element_change[i]);
      std::vector<double> expanded = g.continuous_space->expand(solution.dofs);
      if (bounds) {
        const ComponentBounds own = bounds(k, i);
        outcomes[k].limited.push_back(
            limit_continuous(**known, c, solution.dofs, own.values, own.what, options.threads));
        expanded = outcomes[k].limited.back().coefficients;
      }
      for (std::size_t n = 0; n < rows; ++n) g.out[n * nc + i] = expanded[n];
    }
    g.target_space = g.continuous_space;
  }
  return outcomes;
}

}  // namespace bezel::detail
