// Ordinary target elements together: all fields by moments, on closed regions that cover the
// element and have donors of no much smaller size.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "bezel/transfer/element_kernel.hpp"

namespace bezel::detail {
namespace {

/// The solutions of every so many batches are timed: reading the clock takes as long as one.
constexpr std::uint64_t timed_batches = 8;

}  // namespace

// Also notes the donors' sizes.
bool ElementTransfer::may_be_ordinary(std::int32_t t, const ElementPieces& own,
                                      std::size_t first_region) {
  if (own.loose() || own.donors.empty() || keep_masses_of_.empty()) return false;
  if (has_thin_donor(own) || is_flat(target_, t)) return false;
  for (const Group& g : groups_)
    if (g.in_other_frame(t)) return false;
  const double least = small_area * target_.element_area[static_cast<std::size_t>(t)];
  ordinary_.resize(first_region + own.donors.size());
  bool all = true;
  for (std::size_t k = 0; k < own.donors.size(); ++k) {
    if (own.donors[k] == exterior) return false;
    const auto d = static_cast<std::size_t>(own.donors[k]);
    const double area = donor_.element_area[d];
    ordinary_.donor_area[first_region + k] = area;
    ordinary_.donor_size[first_region + k] = donor_.element_diameter[d];
    all = all && area >= least && keep_masses_of_[d] == 0;
  }
  return all;
}

std::size_t ElementTransfer::begin_together(std::span<const std::int32_t> elements,
                                            const OverlayList& overlays, std::size_t first) {
  if (!some_together_) return 0;
  ElementBatch& batch = ordinary_;
  std::size_t pieces = 0, regions = 0, count = 0;
  const std::size_t most = std::min(lanes, elements.size() - first);
  while (count < most) {
    const std::int32_t t = elements[first + count];
    const ElementPieces own = overlays[first + count];
    if (!may_be_ordinary(t, own, regions)) break;
    batch.count[count] = {static_cast<std::uint32_t>(own.pieces.size()),
                          static_cast<std::uint32_t>(own.donors.size())};
    batch.first_region[count] = regions;
    std::fill_n(batch.owner.begin() + static_cast<std::ptrdiff_t>(regions), own.donors.size(),
                static_cast<std::int64_t>(count));
    regions += own.donors.size();
    pieces += own.pieces.size();
    ++count;
  }
  batch.elements = count;
  batch.first_region[count] = regions;
  if (count == 0) return 0;
  const std::span<const std::int32_t> here = elements.subspan(first, count);
  // The lists of elements that follow each other do, too.
  const std::span<const BoundaryPiece> all_pieces{overlays[first].pieces.data(), pieces};
  const std::span<const std::int32_t> donors{overlays[first].donors.data(), regions};
  for (std::size_t k = 0; k < lanes; ++k) {
    const auto t = static_cast<std::size_t>(here[std::min(k, count - 1)]);
    batch.area[k] = target_.element_area[t];
    batch.size[k] = target_.element_diameter[t];
  }
  fill_batch(batch.pieces, all_pieces);
  std::size_t piece = 0;
  for (std::size_t k = 0; k < count; ++k) {
    std::fill_n(batch.pieces.owner.begin() + static_cast<std::ptrdiff_t>(piece),
                batch.count[k].pieces, static_cast<std::int64_t>(k));
    piece += batch.count[k].pieces;
  }
  std::fill_n(batch.pieces.owner.begin() + static_cast<std::ptrdiff_t>(pieces),
              batch.pieces.stride - pieces, static_cast<std::int64_t>(count - 1));
  for (std::size_t r = regions; r < padded_to_lanes(regions); ++r) {
    batch.owner[r] = batch.owner[regions - 1];
    batch.donor_area[r] = batch.donor_area[regions - 1];
    batch.donor_size[r] = batch.donor_size[regions - 1];
  }
  for (std::size_t i = 0; i < groups_.size(); ++i) sum_together(i, here, all_pieces, donors);
  for (std::size_t k = 0; k < count; ++k) {
    bool ordinary = true;
    for (const ElementSums& sums : together_sums_) {
      const double own_area = batch.area[k], covered = sums.row(k)[sums.area];
      ordinary = ordinary && std::abs(covered - own_area) <= largest_joint_gap * own_area;
      if (sums.all_ordinary) continue;
      for (std::size_t r = batch.first_region[k]; r < batch.first_region[k + 1]; ++r)
        ordinary = ordinary && sums.ordinary[r] != 0.0;
    }
    together_[k] = ordinary;
  }
  all_together_ =
      std::all_of(together_.begin(), together_.begin() + static_cast<std::ptrdiff_t>(count),
                  [](bool ordinary) { return ordinary; });
  const Group& g = groups_[0];
  solved_together_ = groups_.size() == 1 && g.components == 1 && target_.degree == 1;
  together_seconds_ = 0.0;
  if (!solved_together_) return count;
  std::array<double*, lanes> out{};
  std::array<double, static_cast<std::size_t>(bernstein::triangle_size(max_moment_degree))> nowhere;
  for (std::size_t k = 0; k < count; ++k)
    out[k] = together_[k] ? groups_[0].target_out(here[k]).data() : nowhere.data();
  const bool timed = batches_++ % timed_batches == 0;
  const auto start =
      timed ? std::chrono::steady_clock::now() : std::chrono::steady_clock::time_point();
  together_defect_ = solve_elements(g.target_space->uniform_degree(), batch, together_sums_[0],
                                    together_base_[0].data(), out);
  if (timed) {
    together_seconds_ =
        static_cast<double>(timed_batches) *
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return count;
}

void ElementTransfer::sum_together(std::size_t i, std::span<const std::int32_t> elements,
                                   std::span<const BoundaryPiece> pieces,
                                   std::span<const std::int32_t> donors) {
  const Group& g = groups_[i];
  ElementBatch& batch = ordinary_;
  const auto nc = static_cast<std::size_t>(g.components);
  const int degree = g.target_space->uniform_degree();
  for (std::size_t k = 0; k < elements.size(); ++k) {
    const auto corners = target_.corners(elements[k]);
    batch.places.set(k, target_place(g, elements[k]),
                     (corners[0] + corners[1] + corners[2]) * (1.0 / 3.0));
  }
  region_sums(piece_table(target_.degree, 2 * degree), 2 * degree, batch.places, pieces,
              batch.counts(), batch.pieces);
  if (target_.degree > 1) {
    const auto size = static_cast<std::size_t>(bernstein::triangle_size(2 * degree));
    std::vector<double>& whole = together_whole_[i];
    whole.assign(elements.size() * size, 0.0);
    for (std::size_t r = 0; r < donors.size(); ++r) {
      const double* const from = batch.pieces.region(r);
      double* const to = whole.data() + static_cast<std::size_t>(batch.owner[r]) * size;
      for (std::size_t n = 0; n < size; ++n) to[n] += from[n];
    }
  }
  const std::size_t stride = static_cast<std::size_t>(bernstein::triangle_size(degree)) * nc;
  for (std::size_t r = 0; r < padded_to_lanes(donors.size()); ++r) {
    const auto d = static_cast<std::size_t>(donors[std::min(r, donors.size() - 1)]);
    batch.frame[r] = &g.donor_frame[d];
    batch.donor[r] = g.powers.data() + d * stride;
  }
  // Constants come back whatever the rounding of the moments when they are not integrated at all.
  std::vector<double>& base = together_base_[i];
  base.resize(lanes * nc + batch_padding);
  for (std::size_t k = 0; k < elements.size(); ++k)
    std::copy_n(batch.donor[batch.first_region[k]], nc,
                base.begin() + static_cast<std::ptrdiff_t>(k * nc));
  add_elements(degree, batch, g.components, base.data(), together_sums_[i]);
}

ElementOutcome ElementTransfer::take(std::size_t k, std::int32_t t, const ElementPieces& own,
                                     GivenList& given) {
  ElementOutcome outcome;
  const std::size_t first = ordinary_.first_region[k], regions = own.donors.size();
  // All at once when all are ordinary.
  const std::size_t listed = all_together_ ? (k == 0 ? ordinary_.regions() : 0) : regions;
  const std::int32_t* const donors = own.donors.data();
  const double* const areas = together_sums_[0].region_area.data() + first;
  given.donor.insert(given.donor.end(), donors, donors + listed);
  given.area.insert(given.area.end(), areas, areas + listed);
  given.target.insert(given.target.end(), regions, t);
  const double own_area = ordinary_.area[k];
  outcome.pairs = static_cast<std::int32_t>(regions);
  outcome.covered_area = together_sums_[0].row(k)[together_sums_[0].area];
  outcome.partition_residual = std::abs(outcome.covered_area - own_area) / own_area;
  outcome.max_joint_gap = together_sums_[0].max_joint_gap;
  if (solved_together_) {
    outcome.max_mass_defect = together_defect_[k];
    outcome.solve_seconds = std::exchange(together_seconds_, 0.0);
    return outcome;
  }
  masses_.clear();
  loose_ = false;  // what process() left is another element's
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    const ElementSums& sums = together_sums_[i];
    const auto nc = static_cast<std::size_t>(g.components);
    const auto functions =
        static_cast<std::size_t>(bernstein::triangle_size(g.target_space->uniform_degree()));
    const double* const row = sums.row(k);
    Accumulators& moments = moment_sums_[i];
    const double* const product = nc == 1 ? row : sums.product.data() + k * sums.product_stride;
    const double* const mass =
        nc == 1 ? row + sums.mass : sums.masses.data() + k * sums.mass_stride;
    moments.product.assign(product, product + functions * nc);
    moments.product.resize(functions * nc + batch_padding);
    moments.basis.assign(row + sums.basis, row + sums.basis + functions);
    masses_.insert(masses_.end(), mass, mass + nc);
    const double* const base = together_base_[i].data() + k * nc;
    base_[i].assign(base, base + nc);
    base_[i].resize(nc + batch_padding);
    functions_[i] = functions;
    have_moments_[i] = 1;
    extended_[i] = 0;
    sums_[i].reset(functions, nc);
    if (target_.degree > 1) {
      const std::size_t size = together_whole_[i].size() / ordinary_.elements;
      const double* const whole = together_whole_[i].data() + k * size;
      whole_[i].assign(whole, whole + size);
    }
  }
  masses_.resize(masses_.size() + batch_padding);
  finish_groups(t, outcome.covered_area, true, nullptr, outcome);
  return outcome;
}

}  // namespace bezel::detail
