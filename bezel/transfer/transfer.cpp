#include "bezel/transfer/transfer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "bezel/transfer/conserve.hpp"
#include "bezel/transfer/continuous.hpp"
#include "bezel/transfer/limit.hpp"
#include "bezel/transfer/local_bounds.hpp"
#include "bezel/transfer/overlay_mesh.hpp"
#include "bezel/transfer/report.hpp"
#include "bezel/transfer/sweep.hpp"
#include "bezel/transfer/weighted.hpp"

namespace bezel {
namespace {

using clock = std::chrono::steady_clock;
using detail::seconds_since;

/// Donor fields that can be integrated together, and where their components go.
struct Plan {
  std::vector<detail::Group> groups;
  std::vector<std::vector<std::size_t>> members;  // per group, indices of the donor fields
};

Plan make_plan(std::span<const Field> donors,
               const std::shared_ptr<const TriangleMesh>& target_mesh,
               const detail::OverlayMesh& donor, const detail::OverlayMesh& target,
               const TransferOptions& options) {
  struct Key {
    const Space* space;
    int degree;
    Basis basis;
    bool operator==(const Key&) const = default;
  };
  const bool continuous = options.continuity == Continuity::continuous;
  std::vector<Key> keys;
  Plan plan;
  for (std::size_t i = 0; i < donors.size(); ++i) {
    const Space& space = donors[i].space();
    const Key key{&space, options.degree >= 0 ? options.degree : space.highest_degree(),
                  continuous           ? Basis::reference
                  : options.same_basis ? space.basis()
                                       : options.basis};
    const auto at =
        static_cast<std::size_t>(std::find(keys.begin(), keys.end(), key) - keys.begin());
    if (at == keys.size()) {
      keys.push_back(key);
      plan.members.emplace_back();
    }
    plan.members[at].push_back(i);
  }
  for (std::size_t k = 0; k < keys.size(); ++k) {
    std::shared_ptr<const Space> space;
    std::shared_ptr<const Space> continuous_space;
    for (std::size_t m = 0; m < k && !space; ++m) {
      if (keys[m].degree == keys[k].degree && keys[m].basis == keys[k].basis) {
        space = plan.groups[m].target_space;
        continuous_space = plan.groups[m].continuous_space;
      }
    }
    if (continuous && !continuous_space)
      continuous_space = Space::continuous(target_mesh, keys[k].degree);
    if (!space) {
      space = Space::discontinuous(target_mesh, keys[k].degree, keys[k].basis, options.threads);
    }
    std::vector<const Field*> fields;
    for (const std::size_t i : plan.members[k]) fields.push_back(&donors[i]);
    plan.groups.emplace_back(donor, target, fields, std::move(space), options.threads);
    plan.groups.back().continuous_space = std::move(continuous_space);
  }
  return plan;
}

void check_arguments(std::span<const Field> donors,
                     const std::shared_ptr<const TriangleMesh>& target,
                     const TransferOptions& options) {
  if (donors.empty()) throw InputError("transfer: no field given, expected at least one");
  if (!target) throw InputError("transfer: no target mesh given");
  if (options.degree < -1 || options.degree > Space::max_degree) {
    throw InputError("transfer: degree " + std::to_string(options.degree) +
                     " is not supported, expected 0 to " + std::to_string(Space::max_degree));
  }
  detail::check_bounds(options.bounds);
  if (options.continuity == Continuity::continuous) {
    if (!options.same_basis && options.basis == Basis::physical) {
      throw InputError(
          "transfer: a continuous field cannot use the physical basis: a polynomial in x and y has "
          "a higher degree along a curved edge than the edge has coefficients; use the reference "
          "basis, or a discontinuous field");
    }
    for (const Field& f : donors) {
      if (options.degree == 0 || (options.degree < 0 && f.space().highest_degree() == 0)) {
        throw InputError("transfer: field '" + f.name() +
                         "': a continuous field of degree 0 is one constant, expected degree 1 or "
                         "more");
      }
    }
    if (!is_available(options.mass_method))
      throw InputError("transfer: this build of bezel has no PETSc, expected another mass method");
    if (options.conserve == Conserve::total) {
      throw InputError(
          "transfer: the total mass is kept by constants on single triangles, which continuous "
          "fields do not have: expected a discontinuous target, or the covered mass kept");
    }
    if (options.keep_boundary && options.bounds.kind != Bounds::Kind::none) {
      throw InputError(
          "transfer: bounds need the freedom that kept boundary values take: expected one of them");
    }
  } else if (options.keep_boundary) {
    throw InputError("transfer: boundary values are kept by continuous targets only");
  }
  for (const Field& f : donors) {
    if (&f.mesh() != &donors.front().mesh()) {
      throw InputError("transfer: field '" + f.name() + "' lives on another mesh than field '" +
                       donors.front().name() + "', expected all donor fields on one mesh");
    }
  }
}

}  // namespace

TransferResult transfer(std::span<const Field> donors, std::shared_ptr<const TriangleMesh> target,
                        const TransferOptions& options, const Progress& progress) {
  return detail::transfer_by({}, donors, target, options, progress);
}

TransferResult detail::transfer_by(const Crew& crew, std::span<const Field> donors,
                                   const std::shared_ptr<const TriangleMesh>& target_mesh,
                                   const TransferOptions& options, const Progress& progress) {
  const auto start = clock::now();
  check_arguments(donors, target_mesh, options);
  if (options.weight || !options.density.empty())
    return detail::transfer_weighted(crew, donors, target_mesh, options, progress);
  const detail::OverlayMesh donor(donors.front().space().mesh(), "donor", options.threads);
  const detail::OverlayMesh target(target_mesh, "target", options.threads);
  Plan plan = make_plan(donors, target_mesh, donor, target, options);
  const detail::FrontSearch search(donor);
  const double prepared = seconds_since(start);
  std::vector<detail::ChunkResult> chunks =
      crew.sweep(donor, target, search, plan.groups, options, progress, {});
  const auto swept_at = clock::now();
  detail::Swept swept = detail::balance(chunks, donor.element_area,
                                        detail::component_count(plan.groups), options.uncovered);
  const std::size_t components = swept.made.size();
  TransferResult transferred;
  transferred.report = std::move(swept.report);
  TransferReport& report = transferred.report;

  std::vector<double> outside(components, 0.0);
  detail::ElementMasses element_outside{components, {}, {}};
  std::vector<double> rest_mass(components);
  for (const std::int32_t id : swept.outside) {
    const auto d = static_cast<std::size_t>(id);
    const std::span<const double> given = swept.given_by(id);
    std::size_t c0 = 0;
    for (const detail::Group& g : plan.groups) {
      const auto nc = static_cast<std::size_t>(g.components);
      for (std::size_t c = 0; c < nc; ++c) {
        rest_mass[c0 + c] = g.donor_mass[d * nc + c] - (given.empty() ? 0.0 : given[c0 + c]);
        outside[c0 + c] += rest_mass[c0 + c];
      }
      c0 += nc;
    }
    if (options.conserve == Conserve::total)
      element_outside.add(static_cast<std::int32_t>(d), rest_mass);
  }
  detail::ElementMasses added{components, {}, {}};
  if (options.conserve == Conserve::total) {
    detail::ElementMasses element_made{components, {}, {}};
    for (const detail::ChunkResult& r : chunks) {
      for (std::size_t i = 0; i < r.element_made.element.size(); ++i) {
        element_made.add(r.element_made.element[i],
                         std::span(r.element_made.mass).subspan(i * components, components));
      }
    }
    added = detail::spread(donor, target, element_outside, element_made);
    report.spread_elements = static_cast<std::int64_t>(added.element.size());
  }

  std::optional<detail::ElementBounds> bounds;
  if (options.bounds.kind != Bounds::Kind::none)
    bounds.emplace(donor.element_area, target.element_area, chunks, report, options);
  std::vector<detail::ContinuousOutcome> continuous;
  double solve_seconds = 0.0;
  if (options.continuity == Continuity::continuous) {
    detail::BoundsOf limits;
    if (bounds) {
      limits = [&](std::size_t group, std::size_t component) {
        auto member = plan.members[group].begin();
        while (component >= static_cast<std::size_t>(donors[*member].components()))
          component -= static_cast<std::size_t>(donors[*member++].components());
        const Field& field = donors[*member];
        return detail::ComponentBounds{(*bounds)(field, static_cast<int>(component)),
                                       detail::component_name(field, static_cast<int>(component))};
      };
    }
    const auto solve_start = clock::now();
    continuous = detail::make_continuous(plan.groups, donor, target, search, options,
                                         crew.mass_system, limits);
    solve_seconds = seconds_since(solve_start);
    report.seconds.solve += solve_seconds;
  }

  // What is not needed any more makes room.
  chunks.clear();
  for (detail::Group& g : plan.groups) g.drop_donor();

  std::vector<std::optional<Field>> fields(donors.size());
  detail::Reports reports(donors.size(), options.threads);
  for (const detail::Group& g : plan.groups) reports.know(g.donor_measures);
  // What is taken as it was found is measured on the way.
  const bool as_found = !bounds && added.element.empty();
  std::size_t c0 = 0;
  for (std::size_t k = 0; k < plan.groups.size(); ++k) {
    detail::Group& g = plan.groups[k];
    const std::vector<std::size_t>& members = plan.members[k];
    const auto nc = static_cast<std::size_t>(g.components);
    std::vector<std::size_t> field_components;
    for (const std::size_t i : members)
      field_components.push_back(static_cast<std::size_t>(donors[i].components()));
    field_detail::SurveyAim aim;
    if (as_found) {
      field_detail::SpaceMeasures& measures = reports.measures(g.target_space);
      aim = {measures.basis_integrals(), nullptr, &measures.ranges()};
    }
    field_detail::Survey after;
    std::vector<std::vector<double>> parted =
        detail::take_fields(g, field_components, aim, after, options.threads);
    std::vector<double> spread_mass(nc, 0.0), spread_change(nc, 0.0);
    for (std::size_t a = 0; a < added.element.size(); ++a) {
      const ElementId e(added.element[a]);
      const auto size =
          static_cast<std::size_t>(bernstein::triangle_size(g.target_space->degree(e)));
      std::size_t place = 0;
      for (std::size_t m = 0; m < members.size(); ++m) {
        const std::size_t own = field_components[m];
        for (std::size_t c = 0; c < own; ++c, ++place) {
          const double mass = added.mass[a * components + c0 + place];
          const double step = mass / target.element_area[e.index()];
          for (std::size_t n = 0; n < size; ++n)
            parted[m][(g.target_space->offset(e) + n) * own + c] += step;
          spread_mass[place] += mass;
          spread_change[place] = std::max(spread_change[place], std::abs(step));
        }
      }
    }
    std::vector<const Field*> given, moved;
    std::vector<detail::Limited> limited;
    for (std::size_t m = 0; m < members.size(); ++m) {
      const Field& donor_field = donors[members[m]];
      std::optional<Field>& field = fields[members[m]];
      field.emplace(donor_field.name(), g.target_space, std::move(parted[m]),
                    donor_field.components());
      const std::size_t first = limited.size();
      for (int c = 0; bounds && c < donor_field.components(); ++c) {
        if (!continuous.empty()) {
          limited.push_back(std::move(continuous[k].limited[limited.size()]));
        } else {
          limited.push_back(detail::limit_discontinuous(*field, c, (*bounds)(donor_field, c),
                                                        target.element_area, options.threads));
        }
      }
      if (bounds)
        field.emplace(detail::with_coefficients(*field, std::span(limited).subspan(first)));
      given.push_back(&donor_field);
      moved.push_back(&*field);
    }
    const std::vector<double> element_defect = continuous.empty()
                                                   ? std::vector<double>(nc, swept.max_mass_defect)
                                                   : continuous[k].max_element_change;
    g.donor_survey.integrals = std::move(g.donor_mass);
    reports.add(members, {given, moved, std::span(outside).subspan(c0, nc),
                          std::span(swept.made).subspan(c0, nc), spread_mass, element_defect,
                          &g.donor_survey, as_found ? &after : nullptr});
    std::size_t place = 0;
    for (const std::size_t i : members) {
      for (FieldReport& line : reports.lines(i)) {
        line.max_spread_change = spread_change[place];
        if (!continuous.empty()) line.mass_solve = continuous[k].solve[place];
        if (bounds) {
          // Both enclose the values; the limiter's is the sharper one at the bounds.
          line.min_after = limited[place].range.lo;
          line.max_after = limited[place].range.hi;
          line.bounds = limited[place].report;
        }
        ++place;
      }
    }
    c0 += nc;
  }
  report.fields = reports.finish();
  for (std::optional<Field>& field : fields) transferred.fields.push_back(std::move(*field));
  report.seconds.prepare = prepared;
  report.seconds.report = seconds_since(swept_at) - solve_seconds;
  report.seconds.total = seconds_since(start);
  return transferred;
}

std::vector<OverlapArea> overlap_areas(std::shared_ptr<const TriangleMesh> donor_mesh,
                                       std::shared_ptr<const TriangleMesh> target_mesh,
                                       int threads) {
  const detail::OverlayMesh donor(std::move(donor_mesh), "donor", threads);
  const detail::OverlayMesh target(std::move(target_mesh), "target", threads);
  const detail::FrontSearch search(donor);
  TransferOptions options;
  options.uncovered = Uncovered::zero;
  options.threads = threads;
  std::vector<OverlapArea> all;
  for (const detail::ChunkResult& chunk :
       detail::sweep_here(donor, target, search, {}, options, {})) {
    if (chunk.inconsistent >= 0) {
      throw NumericsError("the common refinement is inconsistent at target triangle " +
                          std::to_string(chunk.inconsistent));
    }
    for (std::size_t k = 0; k < chunk.given.donor.size(); ++k) {
      all.push_back(
          {ElementId(chunk.given.target[k]), ElementId(chunk.given.donor[k]), chunk.given.area[k]});
    }
  }
  std::sort(all.begin(), all.end(), [](const OverlapArea& a, const OverlapArea& b) {
    return std::tie(a.target, a.donor) < std::tie(b.target, b.donor);
  });
  return all;
}

}  // namespace bezel
