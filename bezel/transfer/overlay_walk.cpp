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
  CurveCache room, other_room;
  const CurveCache& curve = target_.edge_cache(edge, room);
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
      const CurveCache& other = donor_.edge_cache(side.edge.value, other_room);
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

  keep_walk(record, begin, piece_begin, gap / std::max(curve.diameter, 1e-300));
  return true;
}

void ElementOverlay::keep_walk(Record& record, std::size_t contact_begin, std::size_t piece_begin,
                               double gap) {
  record = Record{};
  record.walked = true;
  record.contact_begin = static_cast<std::uint32_t>(contact_begin);
  record.contact_end = static_cast<std::uint32_t>(contacts_.size());
  record.coincidence_begin = record.coincidence_end =
      static_cast<std::uint32_t>(coincidences_.size());
  record.piece_begin = static_cast<std::uint32_t>(piece_begin);
  record.piece_end = static_cast<std::uint32_t>(pieces_.size());
  record.gap = gap;
  record.crossings = static_cast<std::int32_t>(contacts_.size() - contact_begin);
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

void ElementOverlay::mark_contacts(std::int32_t t) {
  marks_.clear();
  crossed_.clear();
  next_walk();
  for (const SideEdge& side : target_.element_edges[static_cast<std::size_t>(t)]) {
    const Record& record = known_record(side.edge);
    for (std::uint32_t i = record.contact_begin; i < record.contact_end; ++i) {
      const Contact& c = contacts_[i];
      const auto e = static_cast<std::size_t>(c.donor_edge);
      std::int32_t& first = first_mark_[e];
      if (walk_stamp_[e] != walk_now_) {
        walk_stamp_[e] = walk_now_;
        first = -1;
        crossed_.push_back(c.donor_edge);
      }
      const auto here = static_cast<std::int32_t>(marks_.size());
      marks_.push_back(
          {c.donor_edge, c.s, static_cast<std::int8_t>(side.reversed ? -c.sign : c.sign), -1});
      std::int32_t* place = &first;  // in ascending order of s
      while (*place >= 0 && marks_[static_cast<std::size_t>(*place)].s < c.s)
        place = &marks_[static_cast<std::size_t>(*place)].next;
      marks_.back().next = *place;
      *place = here;
    }
  }
}

void ElementOverlay::next_group() {
  group_count_ = 0;
  if (++group_now_ == 0) {
    std::fill(group_.begin(), group_.end(), Group{});
    group_now_ = 1;
  }
}

void ElementOverlay::add_target_pieces(std::int32_t t, OverlayList& list) {
  for (const SideEdge& side : target_.element_edges[static_cast<std::size_t>(t)]) {
    const Record& record = known_record(side.edge);
    const Piece* const end = pieces_.data() + record.piece_end;
    for (const Piece* piece = pieces_.data() + record.piece_begin; piece < end; ++piece) {
      const Part part = side.reversed ? Part{side.edge.value, piece->r1, piece->r0}
                                      : Part{side.edge.value, piece->r0, piece->r1};
      list.pieces.push_back({part, false, region_of(piece->donor, list), -1});
    }
  }
}

// Along a donor edge the crossings with T's boundary enter and leave T in turn. Edges without a
// crossing are inside T when they end in a vertex inside T; in a connected donor mesh that is
// reached from a crossing, for T's boundary is all inside the donor.
bool ElementOverlay::walk_inside(std::int32_t t, OverlayList& list) {
  if (!search_.connected()) return false;
  const std::size_t donors_before = list.donors.size(), pieces_before = list.pieces.size();
  const auto give_up = [&] {
    list.donors.resize(donors_before);
    list.pieces.resize(pieces_before);
    return false;
  };
  next_group();
  add_target_pieces(t, list);
  mark_contacts(t);
  walk_.clear();
  const auto inside = [&](std::int32_t vertex) {
    std::uint32_t& stamp = inside_stamp_[static_cast<std::size_t>(vertex)];
    if (stamp == walk_now_) return;
    stamp = walk_now_;
    walk_.push_back(vertex);
  };
  const auto add_part = [&](std::int32_t edge, double from, double to) {
    const auto& sides = donor_.edge_sides[static_cast<std::size_t>(edge)];
    const std::int32_t left = region_of(sides[0], list), right = region_of(sides[1], list);
    list.pieces.push_back({{edge, from, to}, true, left, right});
  };
  for (const std::int32_t e : crossed_) {
    const auto& ends = donor_.edge_vertex[static_cast<std::size_t>(e)];
    std::int32_t i = first_mark_[static_cast<std::size_t>(e)];
    double last = -1.0;
    if (marks_[static_cast<std::size_t>(i)].direction < 0) {
      const Mark& mark = marks_[static_cast<std::size_t>(i)];
      inside(ends[0]);
      add_part(e, 0.0, mark.s);
      last = mark.s;
      i = mark.next;
    }
    while (i >= 0) {
      const Mark& enter = marks_[static_cast<std::size_t>(i)];
      if (enter.direction < 0 || enter.s - last < contact_isolation) return give_up();
      if (enter.next < 0) {
        inside(ends[1]);
        add_part(e, enter.s, 1.0);
        break;
      }
      const Mark& leave = marks_[static_cast<std::size_t>(enter.next)];
      if (leave.direction > 0 || leave.s - enter.s < contact_isolation) return give_up();
      add_part(e, enter.s, leave.s);
      last = leave.s;
      i = leave.next;
    }
  }
  for (std::size_t k = 0; k < walk_.size(); ++k) {
    for (const std::int32_t e : search_.edges_at(walk_[k])) {
      std::uint32_t& stamp = walk_stamp_[static_cast<std::size_t>(e)];
      if (stamp == walk_now_) continue;
      stamp = walk_now_;
      add_part(e, 0.0, 1.0);
      for (const std::int32_t v : donor_.edge_vertex[static_cast<std::size_t>(e)]) inside(v);
    }
  }
  return true;
}

// In the order in which the donors appear, the part that no donor covers first.
void ElementOverlay::group_segments(OverlayList& list) {
  next_group();
  group_end_.clear();
  slots_.clear();
  const std::size_t first_segment = list.segments.size();
  if (std::any_of(segments_.begin(), segments_.end(),
                  [](const Segment& s) { return s.donor == exterior; }))
    region_of(exterior, list);
  for (const Segment& segment : segments_) {
    const auto slot = static_cast<std::uint32_t>(region_of(segment.donor, list));
    slots_.push_back(slot);
    if (group_end_.size() < group_count_) group_end_.resize(group_count_, 0);
    ++group_end_[slot];
  }
  std::uint32_t begin = 0;
  for (std::uint32_t& end : group_end_) {
    const std::uint32_t size = end;
    end = begin;
    begin += size;
  }
  list.segments.resize(first_segment + segments_.size());
  list.pieces.resize(list.pieces.size() + segments_.size());
  Segment* const segments = list.segments.data() + first_segment;
  BoundaryPiece* const pieces = list.pieces.data() + list.pieces.size() - segments_.size();
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& segment = segments_[i];
    const std::uint32_t at = group_end_[slots_[i]]++;
    const bool source = segment.target.edge < 0;
    segments[at] = segment;
    pieces[at] = {source ? segment.source : segment.target, source,
                  static_cast<std::int32_t>(slots_[i]), -1};
  }
}

}  // namespace bezel::detail
