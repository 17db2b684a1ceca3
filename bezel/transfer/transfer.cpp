#include "bezel/transfer/transfer.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <mutex>
#include <optional>
#include <tuple>

#include "bezel/base/parallel.hpp"
#include "bezel/numeric/sum.hpp"
#include "bezel/transfer/element_transfer.hpp"
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
/// Donor area outside the target below this fraction of the element is rounding of the sums.
constexpr double outside_rounding = 1e-13;

double seconds_since(clock::time_point start) {
  return std::chrono::duration<double>(clock::now() - start).count();
}

/// What a chunk of target elements leaves behind, in the order of the elements.
struct ChunkResult {
  detail::GivenList given;
  detail::OverlayCounts counts;
  std::vector<double> made;
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
  std::vector<Key> keys;
  Plan plan;
  for (std::size_t i = 0; i < donors.size(); ++i) {
    const Space& space = donors[i].space();
    const Key key{&space, options.degree >= 0 ? options.degree : space.highest_degree(),
                  options.same_basis ? space.basis() : options.basis};
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
    for (std::size_t m = 0; m < k && !space; ++m) {
      if (keys[m].degree == keys[k].degree && keys[m].basis == keys[k].basis)
        space = plan.groups[m].target_space;
    }
    if (!space) space = Space::discontinuous(target_mesh, keys[k].degree, keys[k].basis);
    std::vector<const Field*> fields;
    for (const std::size_t i : plan.members[k]) fields.push_back(&donors[i]);
    plan.groups.emplace_back(donor, target, fields, std::move(space));
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
  for (const Field& f : donors) {
    if (&f.mesh() != &donors.front().mesh()) {
      throw InputError("transfer: field '" + f.name() + "' lives on another mesh than field '" +
                       donors.front().name() + "', expected all donor fields on one mesh");
    }
  }
}

std::string uncovered_message(const std::vector<std::pair<ElementId, double>>& elements,
                              double area) {
  const auto number = [](double x) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", x);
    return std::string(text);
  };
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

}  // namespace

detail::Swept detail::sweep(const OverlayMesh& donor, const OverlayMesh& target,
                            std::span<Group> groups, const TransferOptions& options,
                            const Progress& progress, const VisitBlocks& visit) {
  const FrontSearch search(donor);
  std::size_t components = 0;
  for (const Group& g : groups) components += static_cast<std::size_t>(g.components);

  const std::vector<std::int32_t> order = target.spatial_order();
  const std::size_t chunks = (order.size() + chunk_size - 1) / chunk_size;
  std::vector<ChunkResult> results(chunks);
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
        ElementBlocks blocks;
        const std::size_t begin = chunk * chunk_size,
                          end = std::min(order.size(), (chunk + 1) * chunk_size);
        const auto t0 = clock::now();
        worker->find_segments(std::span(order).subspan(begin, end - begin), result.counts);
        const auto t1 = clock::now();
        for (std::size_t i = begin; i < end; ++i) {
          const std::int32_t t = order[i];
          const ElementOutcome outcome =
              worker->element.process(t, worker->segments_of(i - begin), result.given, result.made,
                                      visit ? &blocks : nullptr);
          if (visit) visit(i, t, blocks);
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

  Swept swept;
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
        std::to_string(report.max_joint_gap) + " of the smaller element); no field was made");
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

void detail::append_reports(const Field& donor, const Field& moved, std::span<const double> outside,
                            std::span<const double> made, double max_mass_defect, int threads,
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
    const double defect = after[c] - (before[c] - line.mass_outside + line.mass_made);
    line.relative_mass_defect = size[c] > 0.0 ? std::abs(defect) / size[c] : std::abs(defect);
    line.max_element_defect = size[c] > 0.0 ? max_mass_defect / size[c] : max_mass_defect;
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
  detail::Swept swept = detail::sweep(donor, target, plan.groups, options, progress);
  const std::size_t components = swept.made.size();
  std::vector<double> outside(components, 0.0);
  for (const std::int32_t id : swept.outside) {
    const auto d = static_cast<std::size_t>(id);
    std::size_t c0 = 0;
    for (const detail::Group& g : plan.groups) {
      const auto nc = static_cast<std::size_t>(g.components);
      for (std::size_t c = 0; c < nc; ++c) {
        outside[c0 + c] += g.donor_mass[d * nc + c] - swept.given_mass[d * components + c0 + c];
      }
      c0 += nc;
    }
  }

  TransferResult transferred;
  transferred.report = std::move(swept.report);
  TransferReport& report = transferred.report;
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
      fields[i].emplace(donors[i].name(), g.target_space, std::move(coefficients),
                        donors[i].components());
      detail::append_reports(donors[i], *fields[i], std::span(outside).subspan(c0 + first, own),
                             std::span(swept.made).subspan(c0 + first, own), swept.max_mass_defect,
                             options.threads, field_reports[i]);
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
