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
  together_ = {};
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
  const std::size_t looked_at = std::min(count + 1, most);  // the last may not be ordinary
  batch.elements = count;
  batch.first_region[count] = regions;
  if (count == 0) return looked_at;
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
    for (const GroupBatch& group : group_batches_) {
      const ElementSums& sums = group.sums;
      const double own_area = batch.area[k], covered = sums.row(k)[sums.area];
      ordinary = ordinary && std::abs(covered - own_area) <= largest_joint_gap * own_area;
      if (sums.all_ordinary) continue;
      for (std::size_t r = batch.first_region[k]; r < batch.first_region[k + 1]; ++r)
        ordinary = ordinary && sums.ordinary[r] != 0.0;
    }
    together_.ready[k] = ordinary;
  }
  together_.all_ready = std::all_of(together_.ready.begin(),
                                    together_.ready.begin() + static_cast<std::ptrdiff_t>(count),
                                    [](bool ready) { return ready; });
  const Group& g = groups_[0];
  together_.solved = groups_.size() == 1 && g.components == 1 && target_.degree == 1;
  if (!together_.solved) return looked_at;
  std::array<double*, lanes> out{};
  std::array<double, static_cast<std::size_t>(bernstein::triangle_size(max_moment_degree))> nowhere;
  for (std::size_t k = 0; k < count; ++k)
    out[k] = together_.ready[k] ? groups_[0].target_out(here[k]).data() : nowhere.data();
  const bool timed = batches_++ % timed_batches == 0;
  const auto start =
      timed ? std::chrono::steady_clock::now() : std::chrono::steady_clock::time_point();
  together_.defect = solve_elements(g.target_space->uniform_degree(), batch, group_batches_[0].sums,
                                    group_batches_[0].base.data(), out);
  if (timed) {
    together_.seconds =
        static_cast<double>(timed_batches) *
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  return looked_at;
}

void ElementTransfer::sum_together(std::size_t i, std::span<const std::int32_t> elements,
                                   std::span<const BoundaryPiece> pieces,
                                   std::span<const std::int32_t> donors) {
  const Group& g = groups_[i];
  GroupBatch& group = group_batches_[i];
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
    std::vector<double>& whole = group.whole;
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
  std::vector<double>& base = group.base;
  base.resize(lanes * nc + batch_padding);
  for (std::size_t k = 0; k < elements.size(); ++k) {
    SmallestConstants constants({base.data() + k * nc, nc});
    for (std::size_t r = batch.first_region[k]; r < batch.first_region[k + 1]; ++r)
      constants.take(batch.donor[r]);
  }
  add_elements(degree, batch, g.components, base.data(), group.sums);
}

ElementOutcome ElementTransfer::take(std::size_t k, std::int32_t t, const ElementPieces& own,
                                     GivenList& given) {
  ElementOutcome outcome;
  const std::size_t first = ordinary_.first_region[k], regions = own.donors.size();
  // All at once when all are ordinary.
  const std::size_t listed = together_.all_ready ? (k == 0 ? ordinary_.regions() : 0) : regions;
  const std::int32_t* const donors = own.donors.data();
  const ElementSums& some = group_batches_[0].sums;
  const double* const areas = some.region_area.data() + first;
  given.donor.insert(given.donor.end(), donors, donors + listed);
  given.area.insert(given.area.end(), areas, areas + listed);
  given.target.insert(given.target.end(), regions, t);
  const double own_area = ordinary_.area[k];
  outcome.pairs = static_cast<std::int32_t>(regions);
  outcome.covered_area = some.row(k)[some.area];
  outcome.partition_residual = std::abs(outcome.covered_area - own_area) / own_area;
  outcome.max_joint_gap = some.max_joint_gap;
  if (together_.solved) {
    outcome.max_mass_defect = together_.defect[k];
    outcome.solve_seconds = std::exchange(together_.seconds, 0.0);
    return outcome;
  }
  begin_element(t, false);
  double* masses = element_.masses.data();
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const GroupBatch& group = group_batches_[i];
    const ElementSums& sums = group.sums;
    GroupState& state = element_.groups[i];
    const auto nc = static_cast<std::size_t>(groups_[i].components);
    const double* const row = sums.row(k);
    const double* const product = nc == 1 ? row : sums.product.data() + k * sums.product_stride;
    const double* const mass =
        nc == 1 ? row + sums.mass : sums.masses.data() + k * sums.mass_stride;
    state.has_moments = true;
    state.moments.product.assign(product, product + state.functions * nc);
    state.moments.product.resize(state.functions * nc + batch_padding);
    state.moments.basis.assign(row + sums.basis, row + sums.basis + state.functions);
    masses = std::copy_n(mass, nc, masses);
    std::copy_n(group.base.data() + k * nc, nc, state.base.data());
    if (target_.degree > 1) {
      const std::size_t size = group.whole.size() / ordinary_.elements;
      const double* const whole = group.whole.data() + k * size;
      state.whole.assign(whole, whole + size);
    }
  }
  finish_groups(t, outcome.covered_area, true, nullptr, outcome);
  return outcome;
}

}  // namespace bezel::detail
