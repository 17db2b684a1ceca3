#include "bezel/transfer/flat_sweep.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/transfer/extension.hpp"
#include "bezel/transfer/thin_region.hpp"

namespace bezel::detail {
namespace {

/// Elements share a plane in cells of this many of their lengths and widths.
constexpr double cell = 4.0;

/// A plane in which an element is round. It depends on the element alone, and elements near each
/// other, of about the same direction and shape, have the same: slopes are rounded as far as
/// roundness allows, and the centre is that of a cell.
AreaMap shared_map(std::span<const Vec2> control) {
  AreaMap map = round_map(control);
  if (map.identity) return map;
  const double step = 0.5 / (map.stretch * map.stretch);
  map.slope = std::clamp(std::round(map.slope / step) * step, -1.0, 1.0);
  Box2 box;
  for (const Vec2& p : control) box.include(p);
  const double length = std::ldexp(cell, std::ilogb(box.diameter()));
  const double width = length / (map.stretch * map.stretch);
  const Vec2& p = control[0];
  const double u = map.turned ? p.y() : p.x(), v = map.turned ? -p.x() : p.y();
  const double centre_u = std::round(u / length) * length;
  const double centre_v = map.slope * centre_u + std::round((v - map.slope * u) / width) * width;
  map.centre = map.turned ? Vec2{{-centre_v, centre_u}} : Vec2{{centre_u, centre_v}};
  return map;
}

bool same(const AreaMap& a, const AreaMap& b) {
  return a.centre == b.centre && a.slope == b.slope && a.stretch == b.stretch &&
         a.turned == b.turned;
}

Box2 box_in(const AreaMap& map, std::span<const Vec2> control) {
  Box2 box;
  for (const Vec2& p : control) box.include(map(p));
  return box;
}

/// Whether an element has a side that no other one has.
bool is_outer(const OverlayMesh& mesh, std::int32_t e) {
  const auto& sides = mesh.element_edges[static_cast<std::size_t>(e)];
  return std::any_of(sides.begin(), sides.end(), [&](const SideEdge& side) {
    const auto& beside = mesh.edge_sides[side.edge.index()];
    return beside[0] == exterior || beside[1] == exterior;
  });
}

Box2 grown(Box2 box, double by) {
  box.lo -= Vec2{{by, by}};
  box.hi += Vec2{{by, by}};
  return box;
}

template <class T>
void append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

void merge(const ChunkResult& from, ChunkResult& to) {
  for (const std::int32_t entry : from.given.massed)
    to.given.massed.push_back(entry + static_cast<std::int32_t>(to.given.donor.size()));
  append(from.given.donor, to.given.donor);
  append(from.given.target, to.given.target);
  append(from.given.area, to.given.area);
  append(from.given.mass, to.given.mass);
  to.counts.pairs += from.counts.pairs;
  to.counts.crossings += from.counts.crossings;
  to.counts.tangencies += from.counts.tangencies;
  to.counts.overlaps += from.counts.overlaps;
  to.counts.unresolved += from.counts.unresolved;
  to.counts.max_joint_gap = std::max(to.counts.max_joint_gap, from.counts.max_joint_gap);
  for (std::size_t c = 0; c < to.made.size(); ++c) to.made[c] += from.made[c];
  append(from.element_made.element, to.element_made.element);
  append(from.element_made.mass, to.element_made.mass);
  append(from.uncovered, to.uncovered);
  to.uncovered_area += from.uncovered_area;
  to.max_partition_residual = std::max(to.max_partition_residual, from.max_partition_residual);
  to.max_joint_gap = std::max(to.max_joint_gap, from.max_joint_gap);
  to.max_mass_defect = std::max(to.max_mass_defect, from.max_mass_defect);
  to.extension.add(from.extension);
  to.overlay += from.overlay;
  to.integrate += from.integrate;
  to.solve += from.solve;
  if (to.inconsistent < 0) to.inconsistent = from.inconsistent;
  to.inconsistent_count += from.inconsistent_count;
}

void make_unique(std::vector<std::int32_t>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}  // namespace

FlatSweep::FlatSweep(const OverlayMesh& donor, const OverlayMesh& target, const FrontSearch& search,
                     std::span<Group> groups, const TransferOptions& options,
                     std::span<const std::uint8_t> rim, bool with_blocks)
    : donor_(donor),
      target_(target),
      search_(search),
      groups_(groups),
      options_(options),
      rim_(rim),
      with_blocks_(with_blocks) {}

std::vector<FlatSweep::Cluster> FlatSweep::clusters(std::span<const std::int32_t> elements) const {
  std::vector<Cluster> all;
  if (target_.rounding > 0.0) return all;  // round as it can be
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!is_flat(target_, elements[i])) continue;
    const AreaMap map = shared_map(target_.element(elements[i]));
    if (map.identity) continue;
    auto at = all.begin();
    while (at != all.end() && !same(at->map, map)) ++at;
    if (at == all.end()) at = all.insert(at, Cluster{map, {}, {}});
    at->share.own.push_back(elements[i]);
    at->place.push_back(i);
  }
  return all;
}

// The donors that may meet an element, or continue a field to it: those whose boxes meet its own in
// both planes. In the files' plane alone the boxes of thin turned elements meet many others. Where
// the donor mesh may end in an element, the field is continued by the donors at hand: they must not
// depend on the elements that it shares a plane with.
std::vector<std::size_t> FlatSweep::add_neighbourhood(Cluster& cluster) {
  Box2 all, all_there;
  std::vector<Box2> own, around;
  for (const std::int32_t t : cluster.share.own) {
    all.include(widened(target_.element_box[static_cast<std::size_t>(t)], 0.0));
    const Box2 there = box_in(cluster.map, target_.element(t));
    own.push_back(widened(there, 0.0));
    around.push_back(grown(there, there.diameter()));
    all_there.include(around.back());
  }
  search_.query(all, {}, memory_, found_);
  std::vector<std::int32_t> near;
  std::vector<Box2> boxes;
  for (const std::int32_t d : found_) {
    const Box2 there = box_in(cluster.map, donor_.element(d));
    if (!there.overlaps(all_there)) continue;
    near.push_back(d);
    boxes.push_back(there);
  }
  const Bvh tree(boxes);
  Cluster kept{cluster.map, {}, {}};
  std::vector<std::size_t> apart;
  std::vector<std::int32_t> met;
  for (std::size_t i = 0; i < own.size(); ++i) {
    const std::int32_t t = cluster.share.own[i];
    const Box2& box = target_.element_box[static_cast<std::size_t>(t)];
    const Box2 wide = widened(box, 0.0);
    met.clear();
    bool reached = false, outer = false;
    tree.query(around[i], [&](std::int32_t k) {
      const auto at = static_cast<std::size_t>(k);
      if (!donor_.element_box[static_cast<std::size_t>(near[at])].overlaps(wide)) return;
      met.push_back(near[at]);
      if (!boxes[at].overlaps(own[i])) return;
      reached = true;
      outer = outer || is_outer(donor_, near[at]);
    });
    const bool covered = reached && !outer;
    if (!covered && own.size() > 1) {
      apart.push_back(cluster.place[i]);
      continue;
    }
    if (met.empty()) donors_in_reach(donor_, search_, box, met);
    append(met, kept.share.donors);
    kept.share.own.push_back(t);
    kept.place.push_back(cluster.place[i]);
    kept.share.targets.push_back(t);
    for (const SideEdge& side : target_.element_edges[static_cast<std::size_t>(t)]) {
      const std::int32_t beyond = target_.across(t, side.edge.value);
      if (beyond != exterior) kept.share.targets.push_back(beyond);
    }
  }
  kept.share.chunk_count = 1;
  make_unique(kept.share.targets);
  make_unique(kept.share.donors);
  cluster = std::move(kept);
  return apart;
}

bool FlatSweep::work_on(const Cluster& cluster, ChunkResult& result) {
  MessageWriter to, from;
  writer_->write(cluster.share, to, cluster.map);
  const std::vector<std::byte> work = to.take();
  MessageReader reader(work);
  detail::work_on(reader, 1, from);
  const std::vector<std::byte> answer = from.take();
  MessageReader results(answer);
  VisitBlocks visit;
  if (with_blocks_) {
    visit = [&](std::size_t index, std::int32_t, const ElementBlocks& blocks) {
      blocks_[cluster.place[index]] = blocks;
    };
  }
  ChunkResult own;
  read_results(cluster.share, results, groups_, {&own, 1}, visit);
  if (own.inconsistent >= 0) return false;
  merge(own, result);
  return true;
}

// Where thin donors cross a thin target element, no plane makes both round, and regions may fail to
// close in one where one of them is. Such elements are left to the plane of the files, alone.
void FlatSweep::work_on(std::span<const std::int32_t> elements, std::vector<std::uint8_t>& done,
                        ChunkResult& result) {
  done.assign(elements.size(), 0);
  std::vector<Cluster> all = clusters(elements);
  if (all.empty()) return;
  if (!writer_) {
    writer_ = std::make_unique<ShareWriter>(donor_, target_, search_, groups_, options_,
                                            with_blocks_, rim_);
  }
  if (with_blocks_) blocks_.resize(elements.size());
  for (Cluster& cluster : all) {
    std::vector<std::size_t> apart = add_neighbourhood(cluster);
    if (!cluster.place.empty()) {
      if (work_on(cluster, result)) {
        for (const std::size_t i : cluster.place) done[i] = 1;
      } else {
        append(cluster.place, apart);
      }
    }
    for (const std::size_t i : apart) {
      Cluster alone{cluster.map, {}, {i}};
      alone.share.own.push_back(elements[i]);
      add_neighbourhood(alone);
      done[i] = work_on(alone, result) ? 1 : 0;
    }
  }
}

}  // namespace bezel::detail
