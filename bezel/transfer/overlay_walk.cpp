// Edges and elements in general position: found by walking through the donor mesh, each donor edge
// on the way met once. Whatever is not plainly so is left to overlay.cpp, which looks at all edges
// near the element.

#include <algorithm>
#include <tuple>

#include "bezel/geometry/quick_crossing.hpp"
#include "bezel/transfer/overlay.hpp"

namespace bezel::detail {

using geometry_kernel::meet_quickly;
using geometry_kernel::Meeting;
using geometry_kernel::QuickCrossing;

namespace {

/// Parameters of a crossing known to within this are sure to be in order with others.
constexpr double reliable_condition = 0.01 * contact_isolation;

}  // namespace

std::int32_t ElementOverlay::donor_at_vertex(std::int32_t vertex) {
  Place& place = vertex_place_[static_cast<std::size_t>(vertex)];
  if (place.chunk != chunk_) {
    const Vec2& p = target_.mesh->control(NodeId(vertex));
    place = {chunk_, search_.containing(p, last_donor_, search_memory_)};
    if (place.at != exterior) last_donor_ = place.at;
  }
  return place.at;
}

// The donor elements that the edge meets are connected by the edges it crosses; and the crossings
// in their order lead from the element around the first vertex to that around the last. So nothing
// depends on where a walk began, and a crossing that was missed would show.
bool ElementOverlay::walk_edge(std::int32_t edge, Record& record) {
  const auto& ends = target_.edge_vertex[static_cast<std::size_t>(edge)];
  const std::int32_t first = donor_at_vertex(ends[0]), last = donor_at_vertex(ends[1]);
  if (first == exterior || last == exterior) return false;
  const CurveCache& curve = target_.edge_cache[static_cast<std::size_t>(edge)];
  const auto begin = contacts_.size();
  const auto give_up = [&] {
    contacts_.resize(begin);
    return false;
  };
  next_walk();
  walk_.assign(1, first);
  QuickCrossing crossing{};
  double gap = 0.0;
  for (std::size_t i = 0; i < walk_.size(); ++i) {
    for (const SideEdge& side : donor_.element_edges[static_cast<std::size_t>(walk_[i])]) {
      std::uint32_t& stamp = walk_stamp_[side.edge.index()];
      if (stamp == walk_now_) continue;
      stamp = walk_now_;
      const CurveCache& other = donor_.edge_cache[side.edge.index()];
      const double distance = coincidence_distance(curve, other);
      if (curve.box.lo[0] > other.box.hi[0] + distance ||
          other.box.lo[0] > curve.box.hi[0] + distance ||
          curve.box.lo[1] > other.box.hi[1] + distance ||
          other.box.lo[1] > curve.box.hi[1] + distance)
        continue;
      const std::int32_t next = donor_.across(walk_[i], side.edge.value);
      const auto count = contacts_.size();
      switch (meet_quickly(curve, other, distance, crossing)) {
        case Meeting::none:
          break;
        case Meeting::crossing:
          contacts_.push_back(
              {crossing.s, crossing.t, side.edge.value, static_cast<std::int8_t>(crossing.sign)});
          gap = std::max(gap, crossing.gap);
          break;
        case Meeting::unclear:
          if (!plain_crossings(curve, other, distance, side.edge.value, gap)) return give_up();
      }
      if (contacts_.size() == count) continue;
      if (next == exterior) return give_up();
      walk_.push_back(next);
    }
  }
  const auto contacts = std::span(contacts_).subspan(begin);
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& a, const Contact& b) { return a.r < b.r; });

  const auto piece_begin = pieces_.size();
  double r = 0.0;
  std::int32_t donor = first;
  for (const Contact& c : contacts) {
    const auto& sides = donor_.edge_sides[static_cast<std::size_t>(c.donor_edge)];
    const bool from_left = c.sign > 0;
    if (c.r - r < contact_isolation || sides[from_left ? 0 : 1] != donor) {
      pieces_.resize(piece_begin);
      return give_up();
    }
    pieces_.push_back({r, c.r, donor, -1});
    r = c.r;
    donor = sides[from_left ? 1 : 0];
  }
  if (donor != last) {
    pieces_.resize(piece_begin);
    return give_up();
  }
  pieces_.push_back({r, 1.0, donor, -1});

  record = Record{};
  record.walked = true;
  record.contact_begin = static_cast<std::uint32_t>(begin);
  record.contact_end = static_cast<std::uint32_t>(contacts_.size());
  record.coincidence_begin = record.coincidence_end =
      static_cast<std::uint32_t>(coincidences_.size());
  record.piece_begin = static_cast<std::uint32_t>(piece_begin);
  record.piece_end = static_cast<std::uint32_t>(pieces_.size());
  record.gap = gap;
  record.crossings = static_cast<std::int32_t>(contacts.size());
  return true;
}

bool ElementOverlay::plain_crossings(const CurveCache& curve, const CurveCache& other,
                                     double distance, std::int32_t donor_edge, double& gap) {
  IntersectOptions options;
  options.coincidence_distance = distance;
  intersect(curve, other, options, found_);
  if (!found_.tangencies.empty() || !found_.overlaps.empty() || !found_.unresolved.empty())
    return false;
  for (const Crossing& c : found_.crossings) {
    if (!c.certified || c.sign == 0 || !is_inner(c.s) || !is_inner(c.t) ||
        c.condition * coordinate_rounding > reliable_condition)
      return false;
    contacts_.push_back({c.s, c.t, donor_edge, static_cast<std::int8_t>(c.sign)});
    gap = std::max(gap, norm(c.point_a - c.point_b));
  }
  return true;
}

void ElementOverlay::next_walk() {
  if (++walk_now_ == 0) {
    std::fill(walk_stamp_.begin(), walk_stamp_.end(), 0U);
    std::fill(inside_stamp_.begin(), inside_stamp_.end(), 0U);
    walk_now_ = 1;
  }
}

// Along a donor edge the crossings with T's boundary enter and leave T in turn. Edges without a
// crossing are inside T when they end in a vertex inside T; in a connected donor mesh that is
// reached from a crossing, for T's boundary is all inside the donor.
bool ElementOverlay::walk_inside(std::int32_t t) {
  if (!search_.connected()) return false;
  const std::size_t before = segments_.size();
  const auto give_up = [&] {
    segments_.resize(before);
    return false;
  };
  marks_.clear();
  for (const SideEdge& side : target_.element_edges[static_cast<std::size_t>(t)]) {
    const Record& record = known_record(side.edge);
    for (std::uint32_t i = record.contact_begin; i < record.contact_end; ++i) {
      const Contact& c = contacts_[i];
      marks_.push_back(
          {c.donor_edge, c.s, static_cast<std::int8_t>(side.reversed ? -c.sign : c.sign)});
    }
  }
  std::sort(marks_.begin(), marks_.end(), [](const Mark& a, const Mark& b) {
    return std::tie(a.edge, a.s) < std::tie(b.edge, b.s);
  });
  next_walk();
  walk_.clear();
  const auto inside = [&](std::int32_t vertex) {
    std::uint32_t& stamp = inside_stamp_[static_cast<std::size_t>(vertex)];
    if (stamp == walk_now_) return;
    stamp = walk_now_;
    walk_.push_back(vertex);
  };
  for (std::size_t i = 0; i < marks_.size();) {
    const std::int32_t e = marks_[i].edge;
    walk_stamp_[static_cast<std::size_t>(e)] = walk_now_;
    const auto& ends = donor_.edge_vertex[static_cast<std::size_t>(e)];
    if (marks_[i].direction < 0) {
      inside(ends[0]);
      add_donor_part(e, 0.0, marks_[i].s);
      ++i;
    }
    for (; i < marks_.size() && marks_[i].edge == e; i += 2) {
      if (marks_[i].direction < 0) return give_up();
      if (i > 0 && marks_[i - 1].edge == e && marks_[i].s - marks_[i - 1].s < contact_isolation)
        return give_up();
      if (i + 1 == marks_.size() || marks_[i + 1].edge != e) {
        inside(ends[1]);
        add_donor_part(e, marks_[i].s, 1.0);
        ++i;
        break;
      }
      if (marks_[i + 1].direction > 0 || marks_[i + 1].s - marks_[i].s < contact_isolation)
        return give_up();
      add_donor_part(e, marks_[i].s, marks_[i + 1].s);
    }
  }
  for (std::size_t k = 0; k < walk_.size(); ++k) {
    for (const std::int32_t e : search_.edges_at(walk_[k])) {
      std::uint32_t& stamp = walk_stamp_[static_cast<std::size_t>(e)];
      if (stamp == walk_now_) continue;
      stamp = walk_now_;
      add_donor_part(e, 0.0, 1.0);
      for (const std::int32_t v : donor_.edge_vertex[static_cast<std::size_t>(e)]) inside(v);
    }
  }
  return true;
}

// In the order in which the donors appear, the part that no donor covers first.
void ElementOverlay::group_segments() {
  if (++group_now_ == 0) {
    std::fill(group_.begin(), group_.end(), Group{});
    group_now_ = 1;
  }
  group_end_.clear();
  slots_.clear();
  if (std::any_of(segments_.begin(), segments_.end(),
                  [](const Segment& s) { return s.donor == exterior; })) {
    group_[0] = {group_now_, 0};
    group_end_.push_back(0);
  }
  for (const Segment& segment : segments_) {
    Group& group = group_[static_cast<std::size_t>(segment.donor + 1)];
    if (group.stamp != group_now_) {
      group = {group_now_, static_cast<std::uint32_t>(group_end_.size())};
      group_end_.push_back(0);
    }
    slots_.push_back(group.slot);
    ++group_end_[group.slot];
  }
  std::uint32_t begin = 0;
  for (std::uint32_t& end : group_end_) {
    const std::uint32_t size = end;
    end = begin;
    begin += size;
  }
  grouped_.resize(segments_.size());
  for (std::size_t i = 0; i < segments_.size(); ++i)
    grouped_[group_end_[slots_[i]]++] = segments_[i];
}

}  // namespace bezel::detail
