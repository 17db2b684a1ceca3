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

std::int32_t ElementOverlay::donor_at_vertex(std::int32_t vertex, std::int32_t near) {
  std::int32_t& place = vertex_place_[static_cast<std::size_t>(vertex)];
  if (place == unlocated) {
    const std::int32_t start = vertex_place_[static_cast<std::size_t>(near)];
    place = search_.containing(target_.mesh->control(NodeId(vertex)),
                               start >= 0 ? start : last_donor_, search_memory_);
    if (place != exterior) {
      last_donor_ = place;
    } else {
      const std::int32_t node = donor_node(target_.mesh->control(NodeId(vertex)));
      if (node >= 0) place = first_node - node;
    }
  }
  return std::max(place, exterior);
}

// Bit for bit; -1 when there is none.
std::int32_t ElementOverlay::donor_node(const Vec2& p) {
  Box2 point;
  point.include(p);
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
  const std::int32_t from = first_node - vertex_place_[static_cast<std::size_t>(ends[0])],
                     to = first_node - vertex_place_[static_cast<std::size_t>(ends[1])];
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
    record.details = static_cast<std::int32_t>(details_.size());
    Details& details = details_.emplace_back();
    details.contact_begin = details.contact_end = static_cast<std::uint32_t>(contacts_.size());
    details.coincidence_begin = static_cast<std::uint32_t>(coincidences_.size());
    details.piece_begin = static_cast<std::uint32_t>(pieces_.size());
    pieces_.push_back({0.0, 1.0, exterior, static_cast<std::int32_t>(coincidences_.size())});
    coincidences_.push_back({0.0, 1.0, turned ? 1.0 : 0.0, turned ? 0.0 : 1.0, e, false});
    details.coincidence_end = details.coincidence_begin + 1;
    details.piece_end = details.piece_begin + 1;
    details.overlaps = 1;
    return true;
  }
  return false;
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
  const CurveCache& curve = target_.edge_cache[static_cast<std::size_t>(edge)];
  const auto begin = contacts_.size();
  const auto give_up = [&] {
    contacts_.resize(begin);
    return false;
  };
  next_stamp();
  walk_.assign(1, first);
  QuickCrossing crossing{};
  double gap = 0.0;
  for (std::size_t i = 0; i < walk_.size(); ++i) {
    for (const SideEdge& side : donor_.element_edges[static_cast<std::size_t>(walk_[i])]) {
      std::uint32_t& stamp = inner_place_[side.edge.index()].stamp;
      if (stamp == now_) continue;
      stamp = now_;
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

  const std::size_t first_step = step_count_;
  double r = 0.0;
  std::int32_t donor = first;
  for (const Contact& c : contacts) {
    const auto& sides = donor_.edge_sides[static_cast<std::size_t>(c.donor_edge)];
    const bool from_left = c.sign > 0;
    if (c.r - r < contact_isolation || sides[from_left ? 0 : 1] != donor) {
      step_count_ = first_step;
      return give_up();
    }
    add_step({c.r, c.s, donor, c.donor_edge, static_cast<std::int32_t>(step_count_ + 1), c.sign});
    r = c.r;
    donor = sides[from_left ? 1 : 0];
  }
  if (donor != last) {
    step_count_ = first_step;
    return give_up();
  }
  add_step({1.0, 0.0, donor, -1, -1, 0});
  record.first_step = static_cast<std::int32_t>(first_step);
  record.gap = gap / std::max(curve.diameter, 1e-300);
  record.crossings = static_cast<std::int32_t>(contacts.size());
  contacts_.resize(begin);
  return true;
}

void ElementOverlay::add_step(const Step& step) {
  if (step_count_ == steps_.size()) steps_.resize(2 * step_count_ + 64);
  steps_[step_count_++] = step;
}

const ElementOverlay::Details& ElementOverlay::unfold(Record& record) {
  if (record.details >= 0) return details_of(record);
  record.details = static_cast<std::int32_t>(details_.size());
  Details& details = details_.emplace_back();
  details.contact_begin = static_cast<std::uint32_t>(contacts_.size());
  details.piece_begin = static_cast<std::uint32_t>(pieces_.size());
  double r = 0.0;
  for (std::int32_t i = record.first_step; i >= 0;) {
    const Step& step = steps_[static_cast<std::size_t>(i)];
    pieces_.push_back({r, step.r, step.donor, -1});
    if (step.donor_edge >= 0)
      contacts_.push_back({step.r, step.s, step.donor_edge, static_cast<std::int8_t>(step.sign)});
    r = step.r;
    i = step.next;
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
  group_count_ = 0;
  if (++now_ == 0) {
    std::fill(inner_place_.begin(), inner_place_.end(), Place{});
    std::fill(inside_stamp_.begin(), inside_stamp_.end(), 0U);
    std::fill(group_.begin(), group_.end(), Place{});
    now_ = 1;
  }
}

// The pieces of T's edges, and the donor edges that they cross. A donor edge crosses T's boundary
// once or, where it enters and leaves, twice; false when one does more or an order is not plain.
// What is new and what was met before is as good as random: no branch depends on it.
bool ElementOverlay::cross_boundary(std::int32_t t, OverlayList& list) {
  const auto& sides = target_.element_edges[static_cast<std::size_t>(t)];
  std::size_t most = 4;
  for (const std::size_t i : own_) most += static_cast<std::size_t>(records_[i].crossings);
  if (inner_.size() < most) inner_.resize(2 * most);
  const std::size_t donors_before = list.donors.size();
  list.donors.resize(donors_before + most);
  std::int32_t* const donors = list.donors.data() + donors_before;
  const Step* const steps = steps_.data();
  Place* const group = group_.data() + 1;
  Place* const places = inner_place_.data();
  InnerPart* const inner = inner_.data();
  const std::uint32_t now = now_;
  std::int32_t regions = 0, parts = 0;
  std::uint32_t twice = 0;
  // What is remembered at a place, or the next number; counts that when it is new.
  const auto number_at = [now](Place& place, std::int32_t& count) {
    const Place before = place;
    const auto known = -static_cast<std::int32_t>(before.stamp == now);  // all bits or none
    const std::int32_t number = (before.at & known) | (count & ~known);
    place = {now, number};
    count += 1 + known;
    return number;
  };
  const auto region_at = [&](std::int32_t donor) {
    const std::int32_t number = number_at(group[donor], regions);
    donors[number] = donor;
    return number;
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int32_t edge = sides[k].edge.value;
    const std::size_t turned = sides[k].reversed ? 1 : 0;
    const Step* step = steps + records_[own_[k]].first_step;
    double r = 0.0;
    std::int32_t region = region_at(step->donor);
    for (;;) {
      BoundaryPiece& piece = list.pieces.emplace_back();
      piece.part.edge = edge;
      piece.part.from = turned != 0 ? step->r : r;
      piece.part.to = turned != 0 ? r : step->r;
      piece.source = false;
      piece.left = region;
      piece.right = -1;
      if (step->donor_edge < 0) break;
      const Step* const beyond = steps + step->next;
      const std::int32_t next_region = region_at(beyond->donor);
      inner[parts] = InnerPart{};
      InnerPart& part = inner[number_at(places[step->donor_edge], parts)];
      const std::size_t from_right = static_cast<std::uint32_t>(step->sign) >> 31;
      const std::size_t end = from_right ^ turned;  // 0: it enters T
      const std::uint32_t cut = 1U << end;
      twice |= part.cut & cut;
      part.cut |= cut;
      part.end[end] = step->s;
      part.edge = step->donor_edge;
      part.region[from_right] = region;
      part.region[1 - from_right] = next_region;
      region = next_region;
      r = step->r;
      step = beyond;
    }
  }
  group_count_ = static_cast<std::size_t>(regions);
  list.donors.resize(donors_before + group_count_);
  inner_count_ = static_cast<std::size_t>(parts);
  bool in_order = twice == 0;
  for (std::size_t i = 0; i < inner_count_; ++i)
    in_order &= inner[i].end[1] - inner[i].end[0] >= contact_isolation;
  return in_order;
}

// Along a donor edge the crossings with T's boundary enter and leave T in turn; false when they do
// not, or are too near each other to tell.
bool ElementOverlay::order_crossings(std::int32_t t) {
  marks_.clear();
  for (const SideEdge& side : target_.element_edges[static_cast<std::size_t>(t)]) {
    const auto first = records_[record_of(side.edge.value)].first_step;
    const Step* step = &steps_[static_cast<std::size_t>(first)];
    while (step->donor_edge >= 0) {
      const auto part = inner_place_[static_cast<std::size_t>(step->donor_edge)].at;
      marks_.push_back({step->donor_edge, step->s,
                        static_cast<std::int8_t>(side.reversed ? -step->sign : step->sign),
                        inner_[static_cast<std::size_t>(part)].region});
      step = &steps_[static_cast<std::size_t>(step->next)];
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
      inner_[inner_count_] = InnerPart{};
      inner_[inner_count_].edge = mark.edge;
      inner_[inner_count_].region = mark.region;
      ++inner_count_;
    }
    inner_[inner_count_ - 1].end[end] = mark.s;
    inner_[inner_count_ - 1].cut |= 1U << end;
  }
  return true;
}

// Edges without a crossing are inside T when they end in a vertex inside T; in a connected donor
// mesh that is reached from a crossing, for T's boundary is all inside the donor.
void ElementOverlay::add_inner_parts(OverlayList& list) {
  walk_.resize(2 * inner_count_);
  std::size_t count = 0;
  const auto enter = [&](std::int32_t vertex, bool inside) {
    std::uint32_t& stamp = inside_stamp_[static_cast<std::size_t>(vertex)];
    walk_[count] = vertex;
    count += static_cast<std::size_t>(int{inside} & int{stamp != now_});
    stamp = inside ? now_ : stamp;
  };
  for (std::size_t i = 0; i < inner_count_; ++i) {
    const InnerPart& part = inner_[i];
    list.pieces.push_back(
        {{part.edge, part.end[0], part.end[1]}, true, part.region[0], part.region[1]});
    const auto& ends = donor_.edge_vertex[static_cast<std::size_t>(part.edge)];
    enter(ends[0], (part.cut & 1U) == 0);
    enter(ends[1], (part.cut & 2U) == 0);
  }
  walk_.resize(count);
  for (std::size_t k = 0; k < walk_.size(); ++k) {
    for (const std::int32_t e : search_.edges_at(walk_[k])) {
      Place& place = inner_place_[static_cast<std::size_t>(e)];
      if (place.stamp == now_) continue;
      place.stamp = now_;
      const auto& sides = donor_.edge_sides[static_cast<std::size_t>(e)];
      const std::int32_t left = region_of(sides[0], list), right = region_of(sides[1], list);
      list.pieces.push_back({{e, 0.0, 1.0}, true, left, right});
      for (const std::int32_t v : donor_.edge_vertex[static_cast<std::size_t>(e)]) {
        std::uint32_t& stamp = inside_stamp_[static_cast<std::size_t>(v)];
        if (stamp != now_) walk_.push_back(v);
        stamp = now_;
      }
    }
  }
}

bool ElementOverlay::walk_inside(std::int32_t t, OverlayList& list) {
  if (!search_.connected()) return false;
  const std::size_t donors_before = list.donors.size(), pieces_before = list.pieces.size();
  next_stamp();
  if (!cross_boundary(t, list) && !order_crossings(t)) {
    list.donors.resize(donors_before);
    list.pieces.resize(pieces_before);
    return false;
  }
  add_inner_parts(list);
  return true;
}

// In the order in which the donors appear, the part that no donor covers first.
void ElementOverlay::group_segments(OverlayList& list) {
  next_stamp();
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
