// Which target elements each process works on, and which donor elements they may need.

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/base/parallel.hpp"
#include "bezel/transfer/extension.hpp"
#include "bezel/transfer/share.hpp"

namespace bezel::detail {
namespace {

/// Work of a target element besides its pairs, in candidates for pairs.
constexpr double work_of_target = 1.0;
/// Target elements for which the tree is asked together, unless they lie far apart: their box is
/// then this many times as large as their own boxes together.
constexpr std::size_t area_size = 32;
constexpr double far_apart = 1.5;
/// Those whose donors are sought among these together.
constexpr std::size_t group_size = 8;
/// Pieces of the list of chunks for threads, each with a mark per donor element.
constexpr std::size_t tasks = 16;

/// Collects element numbers, each once per list.
class Marks {
 public:
  explicit Marks(std::size_t elements) : mark_(elements, 0) {}
  void begin_list() { ++now_; }
  /// Whether e was not in the list so far.
  bool take(std::int32_t e) {
    std::uint32_t& mark = mark_[static_cast<std::size_t>(e)];
    if (mark == now_) return false;
    mark = now_;
    return true;
  }

 private:
  std::vector<std::uint32_t> mark_;
  std::uint32_t now_ = 0;
};

/// The donor elements that may matter to target elements, and the work to be expected.
class Needs {
 public:
  Needs(const OverlayMesh& donor, const OverlayMesh& target, const FrontSearch& search)
      : donor_(donor), target_(target), search_(search), marks_(donor.element_count()) {}

  void begin_list() { marks_.begin_list(); }
  /// Adds to the list those of some elements that are not in it; returns the work.
  double add(std::span<const std::int32_t> elements, std::vector<std::int32_t>& list) {
    const std::size_t n = elements.size();
    const Box2 box = box_of(elements);
    if (n > area_size || (n > 1 && are_far_apart(elements, box)))
      return add(elements.first(n / 2), list) + add(elements.subspan(n / 2), list);
    pool_box_ = widened(box, 0.5 * box.diameter());
    search_.query(pool_box_, {}, memory_, pool_);
    double work = 0.0;
    for (std::size_t i = 0; i < n; i += group_size)
      work += add_group(elements.subspan(i, std::min(group_size, n - i)), list);
    return work;
  }

 private:
  const Box2& box_of(std::int32_t t) const {
    return target_.element_box[static_cast<std::size_t>(t)];
  }
  Box2 box_of(std::span<const std::int32_t> elements) const {
    Box2 box;
    for (const std::int32_t t : elements) box.include(box_of(t));
    return box;
  }
  bool are_far_apart(std::span<const std::int32_t> elements, const Box2& box) const {
    const auto area = [](const Box2& b) { return (b.hi[0] - b.lo[0]) * (b.hi[1] - b.lo[1]); };
    double own = 0.0;
    for (const std::int32_t t : elements) own += area(box_of(t));
    return area(box) > far_apart * own;
  }
  /// Those of some donors whose boxes meet a box; without branches, which few could foresee.
  void select(std::span<const std::int32_t> donors, const Box2& box,
              std::vector<std::int32_t>& out) const {
    out.resize(donors.size());
    std::size_t count = 0;
    for (const std::int32_t d : donors) {
      const Box2& own = donor_.element_box[static_cast<std::size_t>(d)];
      out[count] = d;
      count += static_cast<std::size_t>(
          static_cast<int>(own.lo[0] <= box.hi[0]) & static_cast<int>(box.lo[0] <= own.hi[0]) &
          static_cast<int>(own.lo[1] <= box.hi[1]) & static_cast<int>(box.lo[1] <= own.hi[1]));
    }
    out.resize(count);
  }
  double add_group(std::span<const std::int32_t> elements, std::vector<std::int32_t>& list) {
    select(pool_, widened(box_of(elements), 0.0), near_);
    double work = 0.0;
    Box2 within;  // the donors that may matter meet this
    for (const std::int32_t t : elements) {
      const Box2& box = box_of(t);
      select(near_, widened(box, 0.0), met_);
      work += work_of_target + static_cast<double>(met_.size());
      if (met_.empty()) met_.push_back(search_.nearest(box.centre()));
      // No point of the box is farther than this from the nearest of them.
      const double reach = nearest_corner(donor_, met_, box.centre()) + 0.5 * box.diameter();
      within.include(widened(box, reach * (1.0 + widening)));
    }
    if (pool_box_.contains(within.lo) && pool_box_.contains(within.hi)) {
      select(pool_, within, found_);
    } else {
      search_.query(within, {}, memory_, found_);
    }
    for (const std::int32_t d : found_)
      if (marks_.take(d)) list.push_back(d);
    return work;
  }

  const OverlayMesh& donor_;
  const OverlayMesh& target_;
  const FrontSearch& search_;
  Marks marks_;
  FrontSearch::Memory memory_;
  Box2 pool_box_;
  std::vector<std::int32_t> pool_, near_, met_, found_;  // pool_: those that meet pool_box_
};

/// The elements and those beyond their edges, ascending.
std::vector<std::int32_t> with_neighbours(const OverlayMesh& mesh,
                                          std::span<const std::int32_t> own, Marks& marks) {
  marks.begin_list();
  std::vector<std::int32_t> all;
  for (const std::int32_t e : own) {
    if (marks.take(e)) all.push_back(e);
    for (const SideEdge& side : mesh.element_edges[static_cast<std::size_t>(e)]) {
      const std::int32_t other = mesh.across(e, side.edge.value);
      if (other != exterior && marks.take(other)) all.push_back(other);
    }
  }
  std::ranges::sort(all);
  return all;
}

}  // namespace

std::vector<Share> split_work(const OverlayMesh& donor, const OverlayMesh& target,
                              const FrontSearch& search, std::size_t count, int threads) {
  const std::vector<std::int32_t> order = target.spatial_order();
  const std::size_t chunks = (order.size() + chunk_size - 1) / chunk_size;
  const auto range = [&](std::size_t first, std::size_t end) {
    const std::size_t from = std::min(order.size(), first * chunk_size);
    return std::span(order).subspan(from, std::min(order.size(), end * chunk_size) - from);
  };
  std::vector<std::vector<std::int32_t>> needed(chunks);
  std::vector<double> work(chunks, 0.0);
  parallel_for(
      tasks,
      [&](std::size_t task) {
        const std::size_t end = chunks * (task + 1) / tasks;
        std::size_t chunk = chunks * task / tasks;
        if (chunk == end) return;
        Needs needs(donor, target, search);
        for (; chunk < end; ++chunk) {
          needs.begin_list();
          work[chunk] = needs.add(range(chunk, chunk + 1), needed[chunk]);
        }
      },
      threads);

  double total = 0.0;
  for (const double w : work) total += w;
  std::vector<Share> shares(count);
  Marks donor_marks(donor.element_count());
  Marks target_marks(target.element_count());
  double done = 0.0;
  std::size_t next = 0;
  for (std::size_t s = 0; s < count; ++s) {
    Share& share = shares[s];
    share.first_chunk = next;
    const double until = total * static_cast<double>(s + 1) / static_cast<double>(count);
    // A chunk belongs to the share in which its middle lies.
    while (next < chunks && (s + 1 == count || done + 0.5 * work[next] <= until))
      done += work[next++];
    share.chunk_count = next - share.first_chunk;
    const auto own = range(share.first_chunk, next);
    share.own.assign(own.begin(), own.end());
    share.targets = with_neighbours(target, share.own, target_marks);
    donor_marks.begin_list();
    for (std::size_t c = share.first_chunk; c < next; ++c) {
      for (const std::int32_t d : needed[c])
        if (donor_marks.take(d)) share.donors.push_back(d);
    }
    std::ranges::sort(share.donors);
  }
  return shares;
}

}  // namespace bezel::detail
