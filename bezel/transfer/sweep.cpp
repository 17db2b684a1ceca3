#include "bezel/transfer/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "bezel/base/parallel.hpp"
#include "bezel/numeric/box.hpp"
#include "bezel/transfer/flat_sweep.hpp"
#include "bezel/transfer/overlay.hpp"

namespace bezel::detail {
namespace {

using clock = std::chrono::steady_clock;

/// Donor area outside the target, and target area without donor for Conserve::total, below this
/// fraction of the element is rounding of the sums.
constexpr double area_rounding = 3e-14;

struct Worker {
  Worker(const OverlayMesh& donor, const OverlayMesh& target, const FrontSearch& search,
         std::span<Group> groups, const TransferOptions& options, std::span<const std::uint8_t> rim,
         bool with_blocks)
      : overlay(donor, target, search),
        element(donor, target, search, groups, options.uncovered),
        flat(donor, target, search, groups, options, rim, with_blocks) {
    element.keep_masses_of(rim);
  }
  ElementOverlay overlay;
  ElementTransfer element;
  FlatSweep flat;
  std::vector<std::uint8_t> done;  // by place in a chunk: worked on by `flat`
  std::vector<std::int32_t> others;
  OverlayList overlays;  // of a chunk's elements

  void find_overlays(std::span<const std::int32_t> elements, OverlayCounts& counts) {
    overlay.begin_chunk(elements);
    overlays.clear();
    for (const std::int32_t t : elements) overlay.add(t, overlays, counts);
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

std::string uncovered_message(const std::vector<std::pair<ElementId, double>>& elements,
                              double area) {
  std::string message = "the donor mesh does not cover the target mesh: area " +
                        fmt::format("{:.3g}", area) + " in " + std::to_string(elements.size()) +
                        (elements.size() == 1 ? " triangle (" : " triangles (");
  const std::size_t shown = std::min<std::size_t>(elements.size(), 5);
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) message += ", ";
    message +=
        std::to_string(elements[i].first.value) + ": " + fmt::format("{:.3g}", elements[i].second);
  }
  if (shown < elements.size()) message += ", ...";
  return message +
         "); use extend to continue the nearest donor polynomial there, or zero to count the field "
         "as 0";
}

}  // namespace

std::vector<std::uint8_t> rim_donors(const OverlayMesh& donor, const OverlayMesh& target,
                                     const FrontSearch& search) {
  std::vector<std::uint8_t> rim(donor.element_count(), 0);
  FrontSearch::Memory memory;
  std::vector<std::int32_t> near, found;
  for (std::size_t e = 0; e < target.edge_sides.size(); ++e) {
    const auto& sides = target.edge_sides[e];
    if (sides[0] != exterior && sides[1] != exterior) continue;
    const Box2 box = target.edge_box(static_cast<std::int32_t>(e));
    near.swap(found);
    if (near.empty()) near.push_back(search.towards(box.centre()));
    search.query(grown(box, 1e-9 * box.diameter()), near, memory, found);
    for (const std::int32_t d : found) rim[static_cast<std::size_t>(d)] = 1;
  }
  return rim;
}

std::vector<ChunkResult> sweep_elements(const OverlayMesh& donor, const OverlayMesh& target,
                                        const FrontSearch& search, std::span<Group> groups,
                                        std::span<const std::int32_t> elements,
                                        const TransferOptions& options, const Progress& progress,
                                        const VisitBlocks& visit,
                                        std::span<const std::uint8_t> part_rim) {
  const std::size_t components = component_count(groups);
  const std::size_t chunks = (elements.size() + chunk_size - 1) / chunk_size;
  std::vector<ChunkResult> results(chunks);
  std::vector<std::uint8_t> rim(part_rim.begin(), part_rim.end());
  if (donor.numbers.empty()) {
    // Without fields there are no masses to keep.
    rim = components > 0 ? rim_donors(donor, target, search)
                         : std::vector<std::uint8_t>(donor.element_count(), 0);
  }
  const bool with_blocks = static_cast<bool>(visit);
  WorkerPool pool([&] {
    return std::make_unique<Worker>(donor, target, search, groups, options, rim, with_blocks);
  });
  std::mutex progress_mutex;
  std::size_t chunks_done = 0;
  parallel_for(
      chunks,
      [&](std::size_t chunk) {
        auto worker = pool.take();
        ChunkResult& result = results[chunk];
        result.made.assign(components, 0.0);
        std::vector<double> made_here;
        ElementBlocks blocks;
        const std::size_t begin = chunk * chunk_size,
                          end = std::min(elements.size(), (chunk + 1) * chunk_size);
        const std::span<const std::int32_t> own = elements.subspan(begin, end - begin);
        worker->flat.work_on(own, worker->done, result);
        std::vector<std::int32_t>& others = worker->others;
        others.clear();
        for (std::size_t i = 0; i < own.size(); ++i)
          if (worker->done[i] == 0) others.push_back(own[i]);
        const auto t0 = clock::now();
        worker->find_overlays(others, result.counts);
        const auto t1 = clock::now();
        std::size_t next = 0, together_begin = 0, together_end = 0;  // among the others
        double solve = 0.0;
        for (std::size_t i = begin; i < end; ++i) {
          const std::int32_t t = elements[i];
          if (worker->done[i - begin] != 0) {
            if (visit) visit(i, t, worker->flat.block_of(i - begin));
            continue;
          }
          const std::size_t at = next++;
          const ElementPieces pieces = worker->overlays[at];
          made_here.assign(components, 0.0);
          if (at >= together_end && !visit) {
            together_begin = at;
            together_end = at + worker->element.begin_together(others, worker->overlays, at);
          }
          const bool ready = at < together_end && worker->element.together(at - together_begin);
          const ElementOutcome outcome =
              ready ? worker->element.take(at - together_begin, t, pieces, result.given)
                    : worker->element.process(t, pieces, result.given, made_here,
                                              visit ? &blocks : nullptr);
          if (visit) visit(i, t, blocks);
          for (std::size_t c = 0; c < components; ++c) result.made[c] += made_here[c];
          if (options.conserve == Conserve::total &&
              outcome.uncovered_area >
                  area_rounding * target.element_area[static_cast<std::size_t>(t)])
            result.element_made.add(t, made_here);
          solve += outcome.solve_seconds;
          result.counts.pairs += outcome.pairs;
          result.max_partition_residual =
              std::max(result.max_partition_residual, outcome.partition_residual);
          result.max_joint_gap = std::max(result.max_joint_gap, outcome.max_joint_gap);
          result.max_mass_defect = std::max(result.max_mass_defect, outcome.max_mass_defect);
          if (outcome.uncovered_area >
              silent_gap(target, t) * target.element_area[static_cast<std::size_t>(t)]) {
            result.uncovered.push_back({ElementId(t), outcome.uncovered_area});
          }
          result.uncovered_area += outcome.uncovered_area;
          result.extension.add(outcome.extension);
          if (outcome.inconsistent) {
            ++result.inconsistent_count;
            if (result.inconsistent < 0) result.inconsistent = t;
          }
        }
        result.overlay += std::chrono::duration<double>(t1 - t0).count();
        // The solves are timed in a sample of the elements: more than all the time in a bad one.
        const double elements_took = seconds_since(t1);
        solve = std::min(solve, elements_took);
        result.solve += solve;
        result.integrate += elements_took - solve;
        pool.give(std::move(worker));
        if (progress) {
          const std::lock_guard lock(progress_mutex);
          tell(progress, static_cast<double>(++chunks_done) / static_cast<double>(chunks));
        }
      },
      options.threads);

  return results;
}

Swept balance(std::span<const ChunkResult> chunks, std::span<const double> donor_area,
              std::size_t components, Uncovered policy) {
  Swept swept;
  TransferReport& report = swept.report;
  std::vector<double>& given_area = swept.given_area;
  std::vector<double>& given_mass = swept.given_mass;
  given_area.assign(donor_area.size(), 0.0);
  swept.mass_row.assign(donor_area.size(), -1);
  std::int32_t rows = 0;
  swept.made.assign(components, 0.0);
  ExtensionReport extension;
  std::int32_t inconsistent = -1;
  std::int64_t inconsistent_count = 0;
  for (const ChunkResult& r : chunks) {
    for (std::size_t i = 0; i < r.given.donor.size(); ++i)
      given_area[static_cast<std::size_t>(r.given.donor[i])] += r.given.area[i];
    for (std::size_t i = 0; i < r.given.massed.size(); ++i) {
      const auto entry = static_cast<std::size_t>(r.given.massed[i]);
      std::int32_t& row = swept.mass_row[static_cast<std::size_t>(r.given.donor[entry])];
      if (row < 0) {
        row = rows++;
        given_mass.resize(given_mass.size() + components, 0.0);
      }
      double* const to = given_mass.data() + static_cast<std::size_t>(row) * components;
      for (std::size_t c = 0; c < components; ++c) to[c] += r.given.mass[i * components + c];
    }
    for (std::size_t c = 0; c < components; ++c) swept.made[c] += r.made[c];
    report.pairs += r.counts.pairs;
    report.crossings += r.counts.crossings;
    report.tangencies += r.counts.tangencies;
    report.overlaps += r.counts.overlaps;
    report.unresolved += r.counts.unresolved;
    report.uncovered_area += r.uncovered_area;
    extension.add(r.extension);
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
  report.extension_growth = extension.max_growth;
  report.extension_moved_area = extension.moved_area;
  report.extension_held_area = extension.held_area;
  std::sort(report.uncovered_elements.begin(), report.uncovered_elements.end());
  if (inconsistent >= 0) {
    throw NumericsError(
        "the common refinement is inconsistent at target triangle " + std::to_string(inconsistent) +
        " and " + std::to_string(inconsistent_count - 1) + " others (largest open joint " +
        std::to_string(report.max_joint_gap) + " of the smaller element); no field was made");
  }
  if (!report.uncovered_elements.empty() && policy == Uncovered::error) {
    double area = 0.0;
    for (const auto& entry : report.uncovered_elements) area += entry.second;
    throw UncoveredError(uncovered_message(report.uncovered_elements, area),
                         report.uncovered_elements, area);
  }

  for (std::size_t d = 0; d < donor_area.size(); ++d) {
    const double rest = donor_area[d] - given_area[d];
    if (rest <= area_rounding * donor_area[d]) continue;
    // Not near the target's boundary: rounding, which shows in the mass.
    if (given_area[d] != 0.0 && swept.mass_row[d] < 0) continue;
    report.outside_area += rest;
    swept.outside.push_back(static_cast<std::int32_t>(d));
  }
  return swept;
}

std::vector<ChunkResult> sweep_here(const OverlayMesh& donor, const OverlayMesh& target,
                                    const FrontSearch& search, std::span<Group> groups,
                                    const TransferOptions& options, const Progress& progress,
                                    const VisitBlocks& visit) {
  return sweep_elements(donor, target, search, groups, target.spatial_order(), options, progress,
                        visit);
}

std::size_t component_count(std::span<const Group> groups) {
  std::size_t components = 0;
  for (const Group& g : groups) components += static_cast<std::size_t>(g.components);
  return components;
}

}  // namespace bezel::detail
