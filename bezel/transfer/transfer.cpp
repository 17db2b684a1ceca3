#include "bezel/transfer/transfer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <tuple>

#include "bezel/base/parallel.hpp"
#include "bezel/numeric/sum.hpp"
#include "bezel/transfer/conserve.hpp"
#include "bezel/transfer/continuous.hpp"
#include "bezel/transfer/element_transfer.hpp"
#include "bezel/transfer/limit.hpp"
#include "bezel/transfer/overlay.hpp"
#include "bezel/transfer/overlay_mesh.hpp"
#include "bezel/transfer/sweep.hpp"
#include "bezel/transfer/weighted.hpp"

namespace bezel {
namespace {

using detail::chunk_size;
using detail::exterior;
using clock = std::chrono::steady_clock;

/// Uncovered parts below this fraction of an element are rounding.
constexpr double silent_gap = 1e-10;
/// Donor area outside the target, and target area without donor for Conserve::total, below this
/// fraction of the element is rounding of the sums.
constexpr double outside_rounding = 1e-13;
/// Elements that share less than this fraction of the smaller one only touch.
constexpr double touching = 1e-13;

double seconds_since(clock::time_point start) {
  return std::chrono::duration<double>(clock::now() - start).count();
}

/// What a chunk of target elements leaves behind, in the order of the elements.
struct ChunkResult {
  detail::GivenList given;
  detail::OverlayCounts counts;
  std::vector<double> made;
  detail::ElementMasses element_made;  // with Conserve::total
  std::vector<std::pair<ElementId, double>> uncovered;
  double uncovered_area = 0;
  double max_partition_residual = 0, max_joint_gap = 0, max_mass_defect = 0;
  double overlay = 0, integrate = 0, solve = 0;
  std::int32_t inconsistent = -1;
  std::int64_t inconsistent_count = 0;
};

struct Worker {
  Worker(const detail::OverlayMesh& donor, const detail::OverlayMesh& target,
         const detail::FrontSearch& search, std::span<detail::Group> groups, Uncovered policy)
      : overlay(donor, target, search), element(donor, target, search, groups, policy) {}
  detail::ElementOverlay overlay;
  detail::ElementTransfer element;
  std::vector<detail::Segment> segments;  // of a chunk's elements
  std::vector<std::size_t> segment_end;

  void find_segments(std::span<const std::int32_t> elements, detail::OverlayCounts& counts) {
    overlay.begin_chunk();
    segments.clear();
    segment_end.clear();
    for (const std::int32_t t : elements) {
      const auto own = overlay.segments(t, counts);
      segments.insert(segments.end(), own.begin(), own.end());
      segment_end.push_back(segments.size());
    }
  }
  std::span<const detail::Segment> segments_of(std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : segment_end[i - 1];
    return std::span(segments).subspan(begin, segment_end[i] - begin);
  }
};

/// Hands out workers to the running bodies of a parallel loop: at most one per thread is ever made.
class WorkerPool {
 public:
  explicit WorkerPool(std::function<std::unique_ptr<Worker>()> make) : make_(std::move(make)) {}
  std::unique_ptr<Worker> take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) return make_();
    auto worker = std::move(free_.back());
    free_.pop_back();
    return worker;
  }
  void give(std::unique_ptr<Worker> worker) {
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(worker));
  }

 private:
  std::function<std::unique_ptr<Worker>()> make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<Worker>> free_;
};

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
    if (!space) space = Space::discontinuous(target_mesh, keys[k].degree, keys[k].basis);
    std::vector<const Field*> fields;
    for (const std::size_t i : plan.members[k]) fields.push_back(&donors[i]);
    plan.groups.emplace_back(donor, target, fields, std::move(space));
    plan.groups.back().continuous_space = std::move(continuous_space);
  }
  return plan;
}

std::string number(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", x);
  return text;
}

void check_bounds(const Bounds& bounds) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (bounds.kind != Bounds::Kind::global) return;
  if (!(bounds.lo <= bounds.hi) || bounds.lo == infinity || bounds.hi == -infinity) {
    throw InputError("transfer: found bounds " + number(bounds.lo) + " to " + number(bounds.hi) +
                     ", expected two numbers in ascending order");
  }
}

/// Bounds of each target element's values, for one component after the other.
class ElementBounds {
 public:
  ElementBounds(const Bounds& bounds, const detail::OverlayMesh& donor,
                const detail::OverlayMesh& target, std::span<const ChunkResult> results,
                const TransferReport& report, const TransferOptions& options)
      : bounds_(bounds), targets_(target.element_count()), threads_(options.threads) {
    if (options.uncovered == Uncovered::zero) {
      for (const auto& part : report.uncovered_elements) zero_.push_back(part.first.value);
    }
    if (bounds.kind == Bounds::Kind::global && !zero_.empty() &&
        (bounds.lo > 0.0 || bounds.hi < 0.0)) {
      throw InputError("transfer: " + std::to_string(zero_.size()) +
                       " uncovered triangles count as 0, which the bounds " + number(bounds.lo) +
                       " to " + number(bounds.hi) + " leave out");
    }
    if (bounds.kind != Bounds::Kind::local) return;
    for (const ChunkResult& r : results) {
      for (std::size_t i = 0; i < r.given.donor.size(); ++i) {
        const std::int32_t d = r.given.donor[i];
        const std::int32_t t = r.given.target[i];
        const double smaller = std::min(donor.element_area[static_cast<std::size_t>(d)],
                                        target.element_area[static_cast<std::size_t>(t)]);
        if (r.given.area[i] > touching * smaller) pairs_.push_back({t, d});
      }
    }
  }
  detail::ValueBounds operator()(const Field& donor, int component) const {
    if (bounds_.kind == Bounds::Kind::global) return {{bounds_.lo}, {bounds_.hi}};
    return detail::local_bounds(donor, component, pairs_, targets_, zero_, threads_);
  }

 private:
  Bounds bounds_;
  std::size_t targets_;
  int threads_;
  std::vector<std::int32_t> zero_;
  std::vector<detail::Overlapping> pairs_;
};

void check_arguments(std::span<const Field> donors,
                     const std::shared_ptr<const TriangleMesh>& target,
                     const TransferOptions& options) {
  if (donors.empty()) throw InputError("transfer: no field given, expected at least one");
  if (!target) throw InputError("transfer: no target mesh given");
  if (options.degree < -1 || options.degree > Space::max_degree) {
    throw InputError("transfer: degree " + std::to_string(options.degree) +
                     " is not supported, expected 0 to " + std::to_string(Space::max_degree));
  }
  check_bounds(options.bounds);
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

std::string uncovered_message(const std::vector<std::pair<ElementId, double>>& elements,
                              double area) {
  std::string message = "the donor mesh does not cover the target mesh: area " + number(area) +
                        " in " + std::to_string(elements.size()) +
                        (elements.size() == 1 ? " triangle (" : " triangles (");
  const std::size_t shown = std::min<std::size_t>(elements.size(), 5);
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) message += ", ";
    message += std::to_string(elements[i].first.value) + ": " + number(elements[i].second);
  }
  if (shown < elements.size()) message += ", ...";
  return message +
         "); use extend to continue the nearest donor polynomial there, or zero to count the field "
         "as 0";
}

/// One pass over all target elements; `results` by chunk.
detail::Swept pass(const detail::OverlayMesh& donor, const detail::OverlayMesh& target,
                   const detail::FrontSearch& search, std::span<detail::Group> groups,
                   const TransferOptions& options, const Progress& progress,
                   const detail::VisitBlocks& visit, std::vector<ChunkResult>& results) {
  std::size_t components = 0;
  for (const detail::Group& g : groups) components += static_cast<std::size_t>(g.components);
  const std::vector<std::int32_t> order = target.spatial_order();
  const std::size_t chunks = (order.size() + chunk_size - 1) / chunk_size;
  results.clear();
  results.resize(chunks);
  WorkerPool pool(
      [&] { return std::make_unique<Worker>(donor, target, search, groups, options.uncovered); });
  std::mutex progress_mutex;
  std::size_t chunks_done = 0;
  parallel_for(
      chunks,
      [&](std::size_t chunk) {
        auto worker = pool.take();
        ChunkResult& result = results[chunk];
        result.made.assign(components, 0.0);
        std::vector<double> made_here;
        detail::ElementBlocks blocks;
        const std::size_t begin = chunk * chunk_size,
                          end = std::min(order.size(), (chunk + 1) * chunk_size);
        const auto t0 = clock::now();
        worker->find_segments(std::span(order).subspan(begin, end - begin), result.counts);
        const auto t1 = clock::now();
        for (std::size_t i = begin; i < end; ++i) {
          const std::int32_t t = order[i];
          made_here.assign(components, 0.0);
          const detail::ElementOutcome outcome =
              worker->element.process(t, worker->segments_of(i - begin), result.given, made_here,
                                      visit ? &blocks : nullptr);
          if (visit) visit(i, t, blocks);
          for (std::size_t c = 0; c < components; ++c) result.made[c] += made_here[c];
          if (options.conserve == Conserve::total &&
              outcome.uncovered_area >
                  outside_rounding * target.element_area[static_cast<std::size_t>(t)])
            result.element_made.add(t, made_here);
          result.solve += outcome.solve_seconds;
          result.counts.pairs += outcome.pairs;
          result.max_partition_residual =
              std::max(result.max_partition_residual, outcome.partition_residual);
          result.max_joint_gap = std::max(result.max_joint_gap, outcome.max_joint_gap);
          result.max_mass_defect = std::max(result.max_mass_defect, outcome.max_mass_defect);
          if (outcome.uncovered_area >
              silent_gap * target.element_area[static_cast<std::size_t>(t)]) {
            result.uncovered.push_back({ElementId(t), outcome.uncovered_area});
          }
          result.uncovered_area += outcome.uncovered_area;
          if (outcome.inconsistent) {
            ++result.inconsistent_count;
            if (result.inconsistent < 0) result.inconsistent = t;
          }
        }
        result.overlay = std::chrono::duration<double>(t1 - t0).count();
        result.integrate = seconds_since(t1) - result.solve;
        pool.give(std::move(worker));
        if (progress) {
          const std::lock_guard lock(progress_mutex);
          tell(progress, static_cast<double>(++chunks_done) / static_cast<double>(chunks));
        }
      },
      options.threads);

  detail::Swept swept;
  TransferReport& report = swept.report;
  std::vector<double>& given_area = swept.given_area;
  std::vector<double>& given_mass = swept.given_mass;
  given_area.assign(donor.element_count(), 0.0);
  given_mass.assign(donor.element_count() * components, 0.0);
  swept.made.assign(components, 0.0);
  std::int32_t inconsistent = -1;
  std::int64_t inconsistent_count = 0;
  for (const ChunkResult& r : results) {
    for (std::size_t i = 0; i < r.given.donor.size(); ++i) {
      const auto d = static_cast<std::size_t>(r.given.donor[i]);
      given_area[d] += r.given.area[i];
      for (std::size_t c = 0; c < components; ++c) {
        given_mass[d * components + c] += r.given.mass[i * components + c];
      }
    }
    for (std::size_t c = 0; c < components; ++c) swept.made[c] += r.made[c];
    report.pairs += r.counts.pairs;
    report.crossings += r.counts.crossings;
    report.tangencies += r.counts.tangencies;
    report.overlaps += r.counts.overlaps;
    report.unresolved += r.counts.unresolved;
    report.uncovered_area += r.uncovered_area;
    report.uncovered_elements.insert(report.uncovered_elements.end(), r.uncovered.begin(),
                                     r.uncovered.end());
    report.max_partition_residual =
        std::max(report.max_partition_residual, r.max_partition_residual);
    report.max_joint_gap =
        std::max({report.max_joint_gap, r.max_joint_gap, r.counts.max_joint_gap});
    swept.max_mass_defect = std::max(swept.max_mass_defect, r.max_mass_defect);
    report.seconds.overlay += r.overlay;
    report.seconds.integrate += r.integrate;
    report.seconds.solve += r.solve;
    inconsistent_count += r.inconsistent_count;
    if (r.inconsistent >= 0 && inconsistent < 0) inconsistent = r.inconsistent;
  }
  std::sort(report.uncovered_elements.begin(), report.uncovered_elements.end());
  if (inconsistent >= 0) {
    throw NumericsError(
        "the common refinement is inconsistent at target triangle " + std::to_string(inconsistent) +
        " and " + std::to_string(inconsistent_count - 1) + " others (largest open joint " +
        number(report.max_joint_gap) + " of the smaller element); no field was made");
  }
  if (!report.uncovered_elements.empty() && options.uncovered == Uncovered::error) {
    double area = 0.0;
    for (const auto& entry : report.uncovered_elements) area += entry.second;
    throw UncoveredError(uncovered_message(report.uncovered_elements, area),
                         report.uncovered_elements, area);
  }

  for (std::size_t d = 0; d < donor.element_count(); ++d) {
    const double rest = donor.element_area[d] - given_area[d];
    if (rest <= outside_rounding * donor.element_area[d]) continue;
    report.outside_area += rest;
    swept.outside.push_back(static_cast<std::int32_t>(d));
  }
  return swept;
}

}  // namespace

detail::Swept detail::sweep(const OverlayMesh& donor, const OverlayMesh& target,
                            std::span<Group> groups, const TransferOptions& options,
                            const Progress& progress, const VisitBlocks& visit) {
  const FrontSearch search(donor);
  std::vector<ChunkResult> results;
  return pass(donor, target, search, groups, options, progress, visit, results);
}

void detail::append_reports(const Field& donor, const Field& moved, std::span<const double> outside,
                            std::span<const double> made, std::span<const double> spread,
                            std::span<const double> element_defect, int threads,
                            std::vector<FieldReport>& out) {
  const auto before = integral(donor, threads);
  const auto after = integral(moved, threads);
  const auto size = integral_abs(donor, threads);
  for (std::size_t c = 0; c < before.size(); ++c) {
    FieldReport line;
    line.name = donor.name();
    line.component = static_cast<int>(c);
    line.mass_before = before[c];
    line.mass_after = after[c];
    line.mass_outside = outside[c];
    line.mass_made = made[c];
    if (!spread.empty()) line.mass_spread = spread[c];
    const double defect =
        after[c] - (before[c] - line.mass_outside + line.mass_made + line.mass_spread);
    const double scale = size[c] > 0.0 ? size[c] : 1.0;
    line.relative_mass_defect = std::abs(defect) / scale;
    line.max_element_defect = element_defect[c] / scale;
    const auto range_before = value_range(donor, static_cast<int>(c));
    const auto range_after = value_range(moved, static_cast<int>(c));
    line.min_before = range_before.lo;
    line.max_before = range_before.hi;
    line.min_after = range_after.lo;
    line.max_after = range_after.hi;
    out.push_back(line);
  }
}

TransferResult transfer(std::span<const Field> donors,
                        std::shared_ptr<const TriangleMesh> target_mesh,
                        const TransferOptions& options, const Progress& progress) {
  const auto start = clock::now();
  check_arguments(donors, target_mesh, options);
  if (options.weight || !options.density.empty())
    return detail::transfer_weighted(donors, target_mesh, options, progress);
  const detail::OverlayMesh donor(donors.front().space().mesh(), "donor", options.threads);
  const detail::OverlayMesh target(target_mesh, "target", options.threads);
  Plan plan = make_plan(donors, target_mesh, donor, target, options);
  const detail::FrontSearch search(donor);
  std::vector<ChunkResult> results;
  detail::Swept swept = pass(donor, target, search, plan.groups, options, progress, {}, results);
  const std::size_t components = swept.made.size();
  TransferResult transferred;
  transferred.report = std::move(swept.report);
  TransferReport& report = transferred.report;

  std::vector<double> outside(components, 0.0);
  detail::ElementMasses element_outside{components, {}, {}};
  std::vector<double> rest_mass(components);
  for (const std::int32_t id : swept.outside) {
    const auto d = static_cast<std::size_t>(id);
    std::size_t c0 = 0;
    for (const detail::Group& g : plan.groups) {
      const auto nc = static_cast<std::size_t>(g.components);
      for (std::size_t c = 0; c < nc; ++c) {
        rest_mass[c0 + c] = g.donor_mass[d * nc + c] - swept.given_mass[d * components + c0 + c];
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
    for (const ChunkResult& r : results) {
      for (std::size_t i = 0; i < r.element_made.element.size(); ++i) {
        element_made.add(r.element_made.element[i],
                         std::span(r.element_made.mass).subspan(i * components, components));
      }
    }
    added = detail::spread(donor, target, element_outside, element_made);
    report.spread_elements = static_cast<std::int64_t>(added.element.size());
  }

  std::optional<ElementBounds> bounds;
  if (options.bounds.kind != Bounds::Kind::none)
    bounds.emplace(options.bounds, donor, target, results, report, options);
  std::vector<detail::ContinuousOutcome> continuous;
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
    continuous = detail::make_continuous(plan.groups, donor, target, search, options, limits);
    report.seconds.solve += seconds_since(solve_start);
  }

  std::vector<std::optional<Field>> fields(donors.size());
  std::vector<std::vector<FieldReport>> field_reports(donors.size());
  std::size_t c0 = 0;
  for (std::size_t k = 0; k < plan.groups.size(); ++k) {
    const detail::Group& g = plan.groups[k];
    const auto nc = static_cast<std::size_t>(g.components);
    const std::size_t rows = g.target_space->coefficient_count();
    std::size_t first = 0;
    for (const std::size_t i : plan.members[k]) {
      const auto own = static_cast<std::size_t>(donors[i].components());
      std::vector<double> coefficients(rows * own);
      for (std::size_t n = 0; n < rows; ++n) {
        for (std::size_t c = 0; c < own; ++c) coefficients[n * own + c] = g.out[n * nc + first + c];
      }
      std::vector<double> spread_mass(own, 0.0);
      std::vector<double> spread_change(own, 0.0);
      for (std::size_t a = 0; a < added.element.size(); ++a) {
        const ElementId e(added.element[a]);
        const auto size =
            static_cast<std::size_t>(bernstein::triangle_size(g.target_space->degree(e)));
        for (std::size_t c = 0; c < own; ++c) {
          const double mass = added.mass[a * components + c0 + first + c];
          const double step = mass / target.element_area[e.index()];
          for (std::size_t n = 0; n < size; ++n)
            coefficients[(g.target_space->offset(e) + n) * own + c] += step;
          spread_mass[c] += mass;
          spread_change[c] = std::max(spread_change[c], std::abs(step));
        }
      }
      fields[i].emplace(donors[i].name(), g.target_space, std::move(coefficients),
                        donors[i].components());
      std::vector<detail::Limited> limited;
      for (std::size_t c = 0; bounds && c < own; ++c) {
        const int component = static_cast<int>(c);
        if (!continuous.empty()) {
          limited.push_back(std::move(continuous[k].limited[first + c]));
        } else {
          limited.push_back(detail::limit_discontinuous(*fields[i], component,
                                                        (*bounds)(donors[i], component),
                                                        target.element_area, options.threads));
        }
      }
      if (bounds) fields[i].emplace(detail::with_coefficients(*fields[i], limited));
      std::vector<double> element_defect(own, swept.max_mass_defect);
      for (std::size_t c = 0; !continuous.empty() && c < own; ++c)
        element_defect[c] = continuous[k].max_element_change[first + c];
      detail::append_reports(donors[i], *fields[i], std::span(outside).subspan(c0 + first, own),
                             std::span(swept.made).subspan(c0 + first, own), spread_mass,
                             element_defect, options.threads, field_reports[i]);
      for (std::size_t c = 0; c < own; ++c) {
        FieldReport& line = field_reports[i][c];
        line.max_spread_change = spread_change[c];
        if (!continuous.empty()) line.mass_solve = continuous[k].solve[first + c];
        if (bounds) {
          // Both enclose the values; the limiter's is the sharper one at the bounds.
          line.min_after = std::max(line.min_after, limited[c].range.lo);
          line.max_after = std::min(line.max_after, limited[c].range.hi);
          line.bounds = limited[c].report;
        }
      }
      first += own;
    }
    c0 += nc;
  }
  for (std::size_t i = 0; i < donors.size(); ++i) {
    transferred.fields.push_back(std::move(*fields[i]));
    report.fields.insert(report.fields.end(), field_reports[i].begin(), field_reports[i].end());
  }
  report.seconds.total = seconds_since(start);
  return transferred;
}

std::vector<OverlapArea> overlap_areas(std::shared_ptr<const TriangleMesh> donor_mesh,
                                       std::shared_ptr<const TriangleMesh> target_mesh,
                                       int threads) {
  const detail::OverlayMesh donor(std::move(donor_mesh), "donor", threads);
  const detail::OverlayMesh target(std::move(target_mesh), "target", threads);
  const detail::FrontSearch search(donor);
  const std::vector<std::int32_t> order = target.spatial_order();
  const std::size_t chunks = (order.size() + chunk_size - 1) / chunk_size;
  std::vector<std::vector<OverlapArea>> parts(chunks);
  WorkerPool pool([&] {
    return std::make_unique<Worker>(donor, target, search, std::span<detail::Group>(),
                                    Uncovered::zero);
  });
  parallel_for(
      chunks,
      [&](std::size_t chunk) {
        auto worker = pool.take();
        worker->overlay.begin_chunk();
        detail::OverlayCounts counts;
        for (std::size_t i = chunk * chunk_size;
             i < std::min(order.size(), (chunk + 1) * chunk_size); ++i) {
          const std::int32_t t = order[i];
          detail::GivenList given;
          const auto outcome =
              worker->element.process(t, worker->overlay.segments(t, counts), given, {});
          if (outcome.inconsistent) {
            throw NumericsError("the common refinement is inconsistent at target triangle " +
                                std::to_string(t));
          }
          for (std::size_t k = 0; k < given.donor.size(); ++k) {
            parts[chunk].push_back({ElementId(t), ElementId(given.donor[k]), given.area[k]});
          }
        }
        pool.give(std::move(worker));
      },
      threads);
  std::vector<OverlapArea> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  std::sort(all.begin(), all.end(), [](const OverlapArea& a, const OverlapArea& b) {
    return std::tie(a.target, a.donor) < std::tie(b.target, b.donor);
  });
  return all;
}

}  // namespace bezel
