// Edges and elements in general position: found by walking through the donor mesh, each donor edge
// on the way met once. Whatever is not plainly so is left to overlay.cpp, which looks at all edges
// near the element.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <tuple>

#include "bezel/geometry/quick_crossing.hpp"
#include "bezel/numeric/box.hpp"
#include "bezel/transfer/overlay.hpp"

namespace bezel::detail {

using geometry_kernel::meet_quickly;
using geometry_kernel::Meeting;
using geometry_kernel::QuickCrossing;

namespace {

/// Parameters of a crossing known to within this are sure to be in order with others.
constexpr double reliable_condition = 0.01 * contact_isolation;

/// Of an edge's walk.
constexpr std::int32_t usual_steps = 4;

std::int8_t sign_of(const WalkStep& step) {
  return step.from_right != 0 ? std::int8_t{-1} : std::int8_t{1};
}

/// Sets `from` (0) or `to` (1) to a number with these bits, without a branch.
void set_end(Part& part, std::size_t end, std::uint64_t r) {
  static_assert(offsetof(Part, to) == offsetof(Part, from) + sizeof r);
  std::memcpy(reinterpret_cast<std::byte*>(&part) + offsetof(Part, from) + end * sizeof r, &r,
              sizeof r);
}

}  // namespace

std::int32_t ElementOverlay::donor_at_vertex(std::int32_t vertex, std::int32_t near) {
  std::int32_t& place = vertex_place_[static_cast<std::size_t>(vertex)];
  if (place == unlocated) {
    const Vec2& p = target_.mesh->control(NodeId(vertex));
    const std::int32_t start = vertex_place_[static_cast<std::size_t>(near)];
    // Where one vertex is no element's own the next seldom is. No vertex is found both ways.
    const bool on_edges = start <= first_node;
    place = on_edges ? place_on_edges(p) : exterior;
    if (place == exterior) {
      place = search_.containing(p, start >= 0 ? start : last_donor_, search_memory_);
      if (place != exterior) last_donor_ = place;
    }
    if (place == exterior && !on_edges) place = place_on_edges(p);
  }
  return std::max(place, exterior);
}

std::int32_t ElementOverlay::place_on_edges(const Vec2& p) {
  const std::int32_t node = donor_node(p);
  if (node >= 0) return first_node - node;
  const std::int32_t point = place_on_edge(p);
  return point >= 0 ? first_on_edge - point : exterior;
}

// Bit for bit; -1 when there is none.
std::int32_t ElementOverlay::donor_node(const Vec2& p) {
  Box2 point;
  point.include(p);
  point = grown(point, coordinate_rounding * geometry_kernel::largest_coordinate(point));
  search_.query(point, {}, search_memory_, walk_);
  for (const std::int32_t element : walk_) {
    for (const SideEdge& side : donor_.element_edges[static_cast<std::size_t>(element)]) {
      for (const std::int32_t node : donor_.edge_vertex[side.edge.index()])
        if (donor_.mesh->control(NodeId(node)) == p) return node;
    }
  }
  return -1;
}

// An edge of both meshes, bit for bit. Other donor edges meet it in its ends only, which cuts
// nothing.
bool ElementOverlay::share_edge(Record& record) {
  const auto& ends = target_.edge_vertex[static_cast<std::size_t>(record.edge)];
  const std::int32_t from = donor_node_at(ends[0]), to = donor_node_at(ends[1]);
  if (from < 0 || to < 0) return false;
  const auto curve = target_.edge(record.edge);
  for (const std::int32_t e : search_.edges_at(from)) {
    const auto& other_ends = donor_.edge_vertex[static_cast<std::size_t>(e)];
    const bool turned = other_ends[0] != from;
    if (other_ends[turned ? 0 : 1] != to) continue;
    // Beside an edge with an element on one side only others may lie, of a slit or of hanging
    // vertices.
    const auto& sides = donor_.edge_sides[static_cast<std::size_t>(e)];
    if (sides[0] == exterior || sides[1] == exterior) continue;
    const auto other = donor_.edge(e);
    if (turned ? !std::equal(curve.begin(), curve.end(), other.rbegin(), other.rend())
               : !std::equal(curve.begin(), curve.end(), other.begin(), other.end()))
      continue;
    begin_details(record);
    pieces_.push_back({0.0, 1.0, exterior, static_cast<std::int32_t>(coincidences_.size())});
    coincidences_.push_back({0.0, 1.0, turned ? 1.0 : 0.0, turned ? 0.0 : 1.0, e, false});
    details_of(record).overlaps = 1;
    end_details(record);
    return true;
  }
  return false;
}

bool ElementOverlay::cross_on_the_way(const CurveCache& curve, double& gap) {
  CurveCache other_room;
  QuickCrossing crossing{};
  for (std::size_t i = 0; i < walk_.size(); ++i) {
    for (const SideEdge& side : donor_.element_edges[static_cast<std::size_t>(walk_[i])]) {
      if (parts_.knows(side.edge.value)) continue;
      parts_.mark(side.edge.value, 0);
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
          if (!plain_crossings(curve, other, distance, side.edge.value, gap)) return false;
      }
      if (contacts_.size() == count) continue;
      if (next == exterior) return false;
      walk_.push_back(next);
    }
  }
  return true;
}

// The donor elements that the edge meets are connected by the edges it crosses; and the crossings
// in their order lead from the element around the first vertex to that around the last. So nothing
// depends on where a walk began, and a crossing that was missed would show.
bool ElementOverlay::walk_edge(Record& record) {
  const std::int32_t edge = record.edge;
  const auto& ends = target_.edge_vertex[static_cast<std::size_t>(edge)];
  const std::int32_t first = donor_at_vertex(ends[0], ends[1]),
                     last = donor_at_vertex(ends[1], ends[0]);
  if (first == exterior || last == exterior) return false;
  CurveCache room;
  const CurveCache& curve = target_.edge_cache(edge, room);
  const auto begin = contacts_.size();
  const auto give_up = [&] {
    contacts_.resize(begin);
    return false;
  };
  next_stamp();
  walk_.assign(1, first);
  double gap = 0.0;
  if (!cross_on_the_way(curve, gap)) return give_up();
  const auto contacts = std::span(contacts_).subspan(begin);
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& a, const Contact& b) { return a.r < b.r; });

  const std::size_t first_step = steps_.size();
  double r = 0.0;
  std::int32_t donor = first;
  for (const Contact& c : contacts) {
    const auto& sides = donor_.edge_sides[static_cast<std::size_t>(c.donor_edge)];
    const bool from_left = c.sign > 0;
    if (c.r - r < contact_isolation || sides[from_left ? 0 : 1] != donor) {
      steps_.resize(first_step);
      return give_up();
    }
    steps_.push_back({c.r, c.s, donor, c.donor_edge, from_left ? 0 : 1});
    r = c.r;
    donor = sides[from_left ? 1 : 0];
  }
  if (donor != last) {
    steps_.resize(first_step);
    return give_up();
  }
  steps_.push_back({1.0, 0.0, donor, -1, 0});
  record.first_step = static_cast<std::int32_t>(first_step);
  record.gap = gap / std::max(curve.diameter, 1e-300);
  record.crossings = static_cast<std::int32_t>(contacts.size());
  contacts_.resize(begin);
  return true;
}

const ElementOverlay::Details& ElementOverlay::unfold(Record& record) {
  if (record.details >= 0) return details_of(record);
  record.details = static_cast<std::int32_t>(details_.size());
  Details& details = details_.emplace_back();
  details.contact_begin = static_cast<std::uint32_t>(contacts_.size());
  details.piece_begin = static_cast<std::uint32_t>(pieces_.size());
  double r = 0.0;
  for (const WalkStep* step = first_step(record);; step += record.stride) {
    pieces_.push_back({r, step->r, step->donor, -1});
    if (step->donor_edge < 0) break;
    contacts_.push_back({step->r, step->s, step->donor_edge, sign_of(*step)});
    r = step->r;
  }
  details.contact_end = static_cast<std::uint32_t>(contacts_.size());
  details.piece_end = static_cast<std::uint32_t>(pieces_.size());
  return details;
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

void ElementOverlay::next_stamp() {
  parts_.begin();
  regions_.begin();
  if (++now_ == 0) {
    std::fill(inside_stamp_.begin(), inside_stamp_.end(), 0U);
    now_ = 1;
  }
}

// The pieces of T's edges, and the donor edges that they cross: a donor edge crosses T's boundary
// once or, where it enters and leaves, twice; what is found of one that does more is wrong. What is
// new and what was met before is as good as random, and so is where an edge ends: no branch depends
// on it, and no step waits for another.
void ElementOverlay::cross_boundary(std::int32_t t, OverlayList& list) {
  struct Side {
    std::int32_t edge;
    std::uint32_t turned;
  };
  std::array<Side, 3> sides{};
  std::array<std::size_t, 3> lengths{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const SideEdge& side = target_.element_edges[static_cast<std::size_t>(t)][k];
    sides[k] = {side.edge.value, side.reversed ? 1U : 0U};
    lengths[k] = static_cast<std::size_t>(records_[own_[k]].crossings) + 1;
    count += lengths[k];
  }
  // All steps in a row; of most edges more are noted than there are, which the next then hides.
  BoundaryStep* place = boundary_steps_.room(count + usual_steps);
  const BoundaryStep* const boundary = place;
  for (std::size_t k = 0; k < 3; ++k) {
    const Record& record = records_[own_[k]];
    const auto side = static_cast<std::int32_t>(k);
    for (std::int32_t i = 0; i < usual_steps; ++i)
      place[i] = {record.first_step + i * record.stride, side};
    for (auto i = usual_steps; i <= record.crossings; ++i)
      place[i] = {record.first_step + i * record.stride, side};
    place += lengths[k];
  }
  crossing_count_ = count - 3;
  if (inner_.size() < count + 2) inner_.resize(2 * count + 2);
  std::int32_t* const donors = list.donors.room(count);
  BoundaryPiece* const pieces = list.pieces.room(count);
  const WalkStep* const steps = steps_.data();
  InnerPart* const inner = inner_.data();
  // Where edges end no donor edge is crossed: what is noted of "its" part goes where none is.
  parts_.mark(-1, static_cast<std::uint32_t>(count));
  {
    Numbering::Taker regions(regions_), parts(parts_);
    std::uint64_t r = 0;                                 // the bits
    std::int32_t* beyond = &inner[count].end[0].region;  // of the part before
    for (std::size_t i = 0; i < count; ++i) {
      const Side& side = sides[static_cast<std::size_t>(boundary[i].side)];
      const WalkStep& step = steps[boundary[i].step];
      const std::uint32_t number = regions.take(step.donor);
      donors[number] = step.donor;
      const auto region = static_cast<std::int32_t>(number);
      *beyond = region;
      const auto step_r = std::bit_cast<std::uint64_t>(step.r);
      BoundaryPiece& piece = pieces[i];
      piece.part.edge = side.edge;
      set_end(piece.part, side.turned, r);
      set_end(piece.part, 1 - side.turned, step_r);
      piece.source = false;
      piece.left = region;
      piece.right = -1;
      r = step.donor_edge < 0 ? 0U : step_r;
      InnerPart& fresh = inner[parts.count()];
      fresh.end[0].s = 0.0;
      fresh.end[1].s = 1.0;
      InnerPart& part = inner[parts.take(step.donor_edge)];
      const auto from_right = static_cast<std::size_t>(step.from_right);
      part.end[from_right ^ side.turned].s = step.s;  // 0: the donor edge enters T
      part.end[from_right].region = region;
      beyond = &part.end[from_right ^ 1].region;
      part.end[0].edge = step.donor_edge;
    }
  }
  list.donors.resize(list.donors.size() + regions_.count());
  list.pieces.resize(list.pieces.size() + count);
  inner_count_ = parts_.count();
}

// Along a donor edge the crossings with T's boundary enter and leave T in turn; false when they do
// not, or are too near each other to tell.
bool ElementOverlay::order_crossings(std::int32_t t) {
  marks_.clear();
  for (std::size_t k = 0; k < 3; ++k) {
    const SideEdge& side = target_.element_edges[static_cast<std::size_t>(t)][k];
    const Record& record = records_[own_[k]];
    for (const WalkStep* step = first_step(record); step->donor_edge >= 0; step += record.stride) {
      const auto& part = inner_[parts_.number(step->donor_edge)];
      const std::int8_t sign = sign_of(*step);
      marks_.push_back({step->donor_edge,
                        step->s,
                        side.reversed ? static_cast<std::int8_t>(-sign) : sign,
                        {part.end[0].region, part.end[1].region}});
    }
  }
  std::sort(marks_.begin(), marks_.end(), [](const Mark& a, const Mark& b) {
    return std::tie(a.edge, a.s) < std::tie(b.edge, b.s);
  });
  inner_count_ = 0;
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    const Mark& mark = marks_[i];
    const bool first = i == 0 || marks_[i - 1].edge != mark.edge;
    if (!first &&
        (marks_[i - 1].direction == mark.direction || mark.s - marks_[i - 1].s < contact_isolation))
      return false;
    const std::size_t end = mark.direction > 0 ? 0 : 1;
    if (end == 0 || first) {
      inner_[inner_count_++] = {{InnerPart::End{0.0, mark.region[0], mark.edge},
                                 InnerPart::End{1.0, mark.region[1], mark.edge}}};
    }
    inner_[inner_count_ - 1].end[end].s = mark.s;
  }
  return true;
}

// The parts of donor edges that T's boundary cuts, and the vertices inside T that they end in;
// false when one is cut more than once at an end, or its order is not plain.
bool ElementOverlay::add_inner_parts(OverlayList& list) {
  BoundaryPiece* const pieces = list.pieces.room(inner_count_);
  if (walk_.size() < 2 * inner_count_) walk_.resize(4 * inner_count_);
  std::int32_t* const inside = walk_.data();
  std::size_t ends_inside = 0;
  bool in_order = true;
  for (std::size_t i = 0; i < inner_count_; ++i) {
    const InnerPart::End &first = inner_[i].end[0], &last = inner_[i].end[1];
    const double from = first.s, to = last.s;
    pieces[i] = {{first.edge, from, to}, true, first.region, last.region};
    in_order &= to - from >= contact_isolation;
    const auto& ends = donor_.edge_vertex[static_cast<std::size_t>(first.edge)];
    inside[ends_inside] = ends[0];
    ends_inside += from > 0.0 ? 0U : 1U;
    inside[ends_inside] = ends[1];
    ends_inside += to < 1.0 ? 0U : 1U;
  }
  walk_.resize(ends_inside);
  list.pieces.resize(list.pieces.size() + inner_count_);
  return in_order && 2 * inner_count_ - ends_inside == crossing_count_;
}

// Edges without a crossing are inside T when they end in a vertex inside T; in a connected donor
// mesh that is reached from a crossing, for T's boundary is all inside the donor.
void ElementOverlay::add_inner_edges(OverlayList& list) {
  for (std::size_t k = 0; k < walk_.size(); ++k) {
    std::uint32_t& seen = inside_stamp_[static_cast<std::size_t>(walk_[k])];
    if (seen == now_) continue;
    seen = now_;
    for (const std::int32_t e : search_.edges_at(walk_[k])) {
      if (parts_.knows(e)) continue;
      parts_.mark(e, 0);
      const auto& sides = donor_.edge_sides[static_cast<std::size_t>(e)];
      const std::int32_t left = region_of(sides[0], list), right = region_of(sides[1], list);
      list.pieces.push_back({{e, 0.0, 1.0}, true, left, right});
      const auto& ends = donor_.edge_vertex[static_cast<std::size_t>(e)];
      walk_.push_back(ends[0]);
      walk_.push_back(ends[1]);
    }
  }
}

bool ElementOverlay::walk_inside(std::int32_t t, OverlayList& list) {
  if (!search_.connected()) return false;
  const std::size_t donors_before = list.donors.size(), pieces_before = list.pieces.size();
  next_stamp();
  cross_boundary(t, list);
  const std::size_t own_pieces = list.pieces.size();
  if (!add_inner_parts(list)) {
    list.pieces.resize(own_pieces);
    if (!order_crossings(t)) {
      list.donors.resize(donors_before);
      list.pieces.resize(pieces_before);
      return false;
    }
    add_inner_parts(list);
  }
  add_inner_edges(list);
  return true;
}

// In the order in which the donors appear, the part that no donor covers first.
void ElementOverlay::group_segments(OverlayList& list) {
  next_stamp();
  group_end_.clear();
  slots_.clear();
  if (std::any_of(segments_.begin(), segments_.end(),
                  [](const Segment& s) { return s.donor == exterior; }))
    region_of(exterior, list);
  for (const Segment& segment : segments_) {
    const auto slot = static_cast<std::uint32_t>(region_of(segment.donor, list));
    slots_.push_back(slot);
    if (group_end_.size() < regions_.count()) group_end_.resize(regions_.count(), 0);
    ++group_end_[slot];
  }
  std::uint32_t begin = 0;
  for (std::uint32_t& end : group_end_) {
    const std::uint32_t size = end;
    end = begin;
    begin += size;
  }
  Segment* const segments = list.segments.room(segments_.size());
  BoundaryPiece* const pieces = list.pieces.room(segments_.size());
  for (std::size_t i = 0; i < segments_.size(); ++i) {
    const Segment& segment = segments_[i];
    const std::uint32_t at = group_end_[slots_[i]]++;
    const bool source = segment.target.edge < 0;
    segments[at] = segment;
    pieces[at] = {source ? segment.source : segment.target, source,
                  static_cast<std::int32_t>(slots_[i]), -1};
  }
  list.segments.resize(list.segments.size() + segments_.size());
  list.pieces.resize(list.pieces.size() + segments_.size());
}

}  // namespace bezel::detail
