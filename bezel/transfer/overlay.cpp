#include "bezel/transfer/overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

#include "bezel/base/error.hpp"
#include "bezel/geometry/quick_crossing.hpp"
#include "bezel/geometry/quick_ends.hpp"
#include "bezel/numeric/box.hpp"
#include "bezel/transfer/thin_region.hpp"

namespace bezel::detail {

using geometry_kernel::EndMeeting;
using geometry_kernel::meet_at_ends;
using geometry_kernel::meet_quickly;
using geometry_kernel::Meeting;
using geometry_kernel::QuickCrossing;
using geometry_kernel::QuickEnds;

namespace {

/// sin(angle) below which a crossing's direction is not relied on.
constexpr double reliable_sine = 1e-5;

// Where a piece is looked at; the middle first, the others only when the middle is too close to an
// edge.
constexpr std::array<double, 5> looks = {0.5, 0.25, 0.75, 0.0625, 0.9375};
/// A barycentric margin that decides at once.
constexpr double clear_margin = 1e-7;

/// What may touch the box, whatever the rounding.
Box2 around(const Box2& box) {
  return grown(box, 1e-9 * box.diameter());
}

}  // namespace

ElementOverlay::ElementOverlay(const OverlayMesh& donor, const OverlayMesh& target,
                               const FrontSearch& search)
    : donor_(donor),
      target_(target),
      search_(search),
      record_numbers_(target.edge_count()),
      vertex_place_(target.mesh->node_count(), unlocated),
      parts_(donor.edge_count()),
      inside_stamp_(donor.mesh->node_count(), 0),
      edge_stamp_(donor.edge_count(), 0),
      regions_(donor.element_count()) {}

void ElementOverlay::begin_chunk(std::span<const std::int32_t> elements) {
  record_numbers_.begin();
  records_.clear();
  chunk_.clear();
  next_element_ = 0;
  details_.clear();
  steps_.clear();
  contacts_.clear();
  coincidences_.clear();
  pieces_.clear();
  candidates_.clear();
  candidates_of_ = -1;
  if (!is_straight()) return;
  ElementRecords* own = chunk_.room(elements.size());
  for (const std::int32_t t : elements) {
    own->element = t;
    find_records_of(t, own->record);
    ++own;
  }
  chunk_.resize(elements.size());
  walk_straight_edges(0);
}

void ElementOverlay::find_candidates(std::int32_t t) {
  if (candidates_of_ == t) return;
  candidates_of_ = t;
  const Box2& box = target_.element_box[static_cast<std::size_t>(t)];
  near_.swap(candidates_);
  search_.query(around(box), near_, search_memory_, candidates_);
  candidate_edges_.clear();
  if (++edge_now_ == 0) {
    std::fill(edge_stamp_.begin(), edge_stamp_.end(), 0U);
    edge_now_ = 1;
  }
  for (const std::int32_t d : candidates_) {
    for (const SideEdge& side : donor_.element_edges[static_cast<std::size_t>(d)]) {
      std::uint32_t& stamp = edge_stamp_[side.edge.index()];
      if (stamp == edge_now_) continue;
      stamp = edge_now_;
      candidate_edges_.push_back(side.edge.value);
    }
  }
}

std::int32_t ElementOverlay::best_donor(const Vec2& p, double& margin) const {
  std::int32_t best = exterior;
  margin = -std::numeric_limits<double>::infinity();
  for (const std::int32_t d : candidates_) {
    const double m = inside_margin(donor_, d, p);
    if (m > margin) {
      margin = m;
      best = d;
    }
    if (margin > clear_margin) break;
  }
  return margin >= 0.0 ? best : exterior;
}

std::int32_t ElementOverlay::locate_piece(std::span<const Vec2> curve, double r0, double r1) const {
  std::int32_t answer = exterior;
  double clearest = -1.0;
  for (const double look : looks) {
    double margin = 0.0;
    const std::int32_t d = best_donor(curve_point(curve, r0 + look * (r1 - r0)), margin);
    if (std::abs(margin) > clearest) {
      clearest = std::abs(margin);
      answer = d;
    }
    if (clearest > clear_margin) break;
  }
  return answer;
}

bool ElementOverlay::inside_target(std::int32_t t, std::span<const Vec2> curve, double s0,
                                   double s1) const {
  bool answer = false;
  double clearest = -1.0;
  for (const double look : looks) {
    const double margin = inside_margin(target_, t, curve_point(curve, s0 + look * (s1 - s0)));
    if (std::abs(margin) > clearest) {
      clearest = std::abs(margin);
      answer = margin > 0.0;
    }
    if (clearest > clear_margin) break;
  }
  return answer;
}

bool ElementOverlay::are_apart(std::int32_t donor_edge, double gap, double magnitude) const {
  if (gap > point_rounding * magnitude) return true;
  const auto& sides = donor_.edge_sides[static_cast<std::size_t>(donor_edge)];
  return std::any_of(sides.begin(), sides.end(),
                     [&](std::int32_t d) { return d != exterior && is_flat(donor_, d); });
}

bool ElementOverlay::meet_ordinarily(const CurveCache& curve, const CurveCache& other,
                                     double distance, std::int32_t donor_edge, Record& record) {
  QuickCrossing crossing{};
  switch (meet_quickly(curve, other, distance, crossing)) {
    case Meeting::none:
      return true;
    case Meeting::crossing:
      contacts_.push_back(
          {crossing.s, crossing.t, donor_edge, static_cast<std::int8_t>(crossing.sign)});
      record.gap = std::max(record.gap, crossing.gap);
      ++record.crossings;
      return true;
    case Meeting::unclear:
      break;
  }
  QuickEnds ends{};
  switch (meet_at_ends(curve, other, distance, ends)) {
    case EndMeeting::point:
      contacts_.push_back({ends.s, ends.t, donor_edge, 0});
      record.gap = std::max(record.gap, ends.gap);
      ++record.crossings;
      return true;
    case EndMeeting::part:
      coincidences_.push_back(
          {ends.s, ends.s_end, ends.t, ends.t_end, donor_edge,
           are_apart(donor_edge, ends.gap, std::max(curve.magnitude, other.magnitude))});
      ++details_of(record).overlaps;
      return true;
    case EndMeeting::unclear:
      break;
  }
  return false;
}

void ElementOverlay::overlay_edge(Record& record) {
  const std::int32_t edge = record.edge;
  const auto curve = target_.edge(edge);
  CurveCache own_room, facing_room;
  const CurveCache& own = target_.edge_cache(edge, own_room);
  const Box2& box = own.box;
  const double own_width = target_.edge_width(edge);
  begin_details(record);
  Details& details = details_of(record);

  const Box2 generous =
      grown(box, std::max(1e-9 * own.diameter, coordinate_rounding * own.magnitude));
  for (const std::int32_t e : candidate_edges_) {
    const Box2 other = donor_.edge_box(e);
    if (!generous.overlaps(other)) continue;
    const CurveCache& facing = donor_.edge_cache(e, facing_room);
    const double distance = coincidence_distance(std::min(own_width, donor_.edge_width(e)),
                                                 std::max(own.magnitude, facing.magnitude));
    if (!grown(box, distance).overlaps(other)) continue;
    if (meet_ordinarily(own, facing, distance, e, record)) continue;
    IntersectOptions options;
    options.coincidence_distance = distance;
    const auto donor_curve = donor_.edge(e);
    intersect(own, facing, options, found_);
    // Edges that are nearly parallel may be known to touch much better than where.
    const auto opposite = [&](double r, double s) {
      const Vec2 p = curve_point(curve, r);
      if (norm(p - curve_point(donor_curve, s)) <= 2.0 * distance) return s;
      return foot_point(donor_curve, p).s;
    };
    for (Crossing& c : found_.crossings) {
      c.t = opposite(c.s, c.t);
      const auto [pa, da] = edge_point(curve, c.s);
      const auto [pb, db] = edge_point(donor_curve, c.t);
      const double sine = cross(da, db);
      const double reliable = reliable_sine * norm(da) * norm(db);
      const std::int8_t sign = sine > reliable    ? std::int8_t{1}
                               : sine < -reliable ? std::int8_t{-1}
                                                  : std::int8_t{0};
      record.gap = std::max(record.gap, norm(pa - pb));
      contacts_.push_back({c.s, c.t, e, sign});
      ++record.crossings;
    }
    for (const Tangency& c : found_.tangencies) {
      contacts_.push_back({c.s, opposite(c.s, c.t), e, 0});
      ++details.tangencies;
    }
    for (const Overlap& c : found_.overlaps) {
      coincidences_.push_back({c.s0, c.s1, opposite(c.s0, c.t0), opposite(c.s1, c.t1), e,
                               are_apart(e, c.gap, std::max(own.magnitude, facing.magnitude))});
      ++details.overlaps;
    }
    for (const UnresolvedBox& c : found_.unresolved) {
      contacts_.push_back({0.5 * (c.s_lo + c.s_hi), 0.5 * (c.t_lo + c.t_hi), e, 0});
      ++details.unresolved;
    }
  }
  record.gap /= std::max(own.diameter, 1e-300);
  details.contact_end = static_cast<std::uint32_t>(contacts_.size());
  details.coincidence_end = static_cast<std::uint32_t>(coincidences_.size());
  const auto contacts = std::span(contacts_).subspan(details.contact_begin);
  const auto coincidences = std::span(coincidences_).subspan(details.coincidence_begin);
  std::sort(contacts.begin(), contacts.end(), [](const Contact& a, const Contact& b) {
    return std::tie(a.r, a.donor_edge, a.s) < std::tie(b.r, b.donor_edge, b.s);
  });
  std::sort(coincidences.begin(), coincidences.end(),
            [](const Coincidence& a, const Coincidence& b) {
              return std::tie(a.r0, a.r1, a.donor_edge) < std::tie(b.r0, b.r1, b.donor_edge);
            });

  breaks_.assign({0.0, 1.0});
  for (const Contact& c : contacts) breaks_.push_back(c.r);
  for (const Coincidence& c : coincidences) {
    breaks_.push_back(c.r0);
    breaks_.push_back(c.r1);
  }
  std::sort(breaks_.begin(), breaks_.end());
  breaks_.erase(std::unique(breaks_.begin(), breaks_.end()), breaks_.end());

  // The donor element before and after a contact, when a single plain crossing tells.
  const auto side_of = [&](double r, bool before) -> std::pair<bool, std::int32_t> {
    const auto first = std::lower_bound(contacts.begin(), contacts.end(), r,
                                        [](const Contact& c, double value) { return c.r < value; });
    if (first == contacts.end() || first->r != r || first->sign == 0) return {false, exterior};
    // Contacts at ends, or near each other, hold within the coincidence distance only, so their
    // order may be wrong: they cut, but tell no side.
    if (!is_inner(r) || !is_inner(first->s)) return {false, exterior};
    if (first != contacts.begin() && r - (first - 1)->r < contact_isolation)
      return {false, exterior};
    if (first + 1 != contacts.end() && (first + 1)->r - r < contact_isolation)
      return {false, exterior};
    // sign +1: the target edge comes from the donor edge's left side.
    const bool left = (first->sign > 0) == before;
    return {true, donor_.edge_sides[static_cast<std::size_t>(first->donor_edge)][left ? 0 : 1]};
  };
  for (std::size_t i = 0; i + 1 < breaks_.size(); ++i) {
    Piece piece{breaks_[i], breaks_[i + 1], exterior, -1};
    const double middle = 0.5 * (piece.r0 + piece.r1);
    for (std::size_t k = 0; k < coincidences.size(); ++k) {
      if (coincidences[k].r0 < middle && middle < coincidences[k].r1) {
        piece.coincidence = static_cast<std::int32_t>(details.coincidence_begin + k);
        break;
      }
    }
    if (piece.coincidence < 0) {
      const auto after = side_of(piece.r0, false);
      const auto before = side_of(piece.r1, true);
      if (after.first && (!before.first || before.second == after.second)) {
        piece.donor = after.second;
      } else if (!after.first && before.first) {
        piece.donor = before.second;
      } else {
        piece.donor = locate_piece(curve, piece.r0, piece.r1);
      }
    }
    pieces_.push_back(piece);
  }
  details.piece_end = static_cast<std::uint32_t>(pieces_.size());
}

void ElementOverlay::add_donor_part(std::int32_t edge, double s0, double s1) {
  const auto& sides = donor_.edge_sides[static_cast<std::size_t>(edge)];
  segments_.push_back({sides[0], one_curve, Part{}, Part{edge, s0, s1}});
  segments_.push_back({sides[1], one_curve, Part{}, Part{edge, s1, s0}});
}

void ElementOverlay::donor_edges_inside(std::int32_t t) {
  // Contacts of T's boundary with donor edges, ordered along the donor edges.
  marks_.clear();
  covered_.clear();
  for (std::size_t k = 0; k < 3; ++k) {
    const SideEdge& side = target_.element_edges[static_cast<std::size_t>(t)][k];
    const Details& record = details_of(records_[own_[k]]);
    for (std::uint32_t i = record.contact_begin; i < record.contact_end; ++i) {
      const Contact& c = contacts_[i];
      const bool inner = is_inner(c.r) && is_inner(c.s);
      std::int8_t direction = inner ? c.sign : std::int8_t{0};
      if (side.reversed) direction = static_cast<std::int8_t>(-direction);
      marks_.push_back({c.donor_edge, c.s, direction});
    }
    for (std::uint32_t i = record.coincidence_begin; i < record.coincidence_end; ++i) {
      const Coincidence& c = coincidences_[i];
      marks_.push_back({c.donor_edge, c.s0, 0});
      marks_.push_back({c.donor_edge, c.s1, 0});
      covered_.push_back({c.donor_edge, {std::min(c.s0, c.s1), std::max(c.s0, c.s1)}});
    }
  }
  std::sort(marks_.begin(), marks_.end(), [](const Mark& a, const Mark& b) {
    return std::tie(a.edge, a.s, a.direction) < std::tie(b.edge, b.s, b.direction);
  });

  for (std::size_t i = 0; i + 1 < marks_.size(); ++i) {
    if (marks_[i].edge == marks_[i + 1].edge && marks_[i + 1].s - marks_[i].s < contact_isolation) {
      marks_[i].direction = marks_[i + 1].direction = 0;
    }
  }

  // Edges without a contact are inside T or outside it as a whole.
  for (const Mark& mark : marks_) edge_stamp_[static_cast<std::size_t>(mark.edge)] = edge_now_ - 1;
  const Box2 box = around(target_.element_box[static_cast<std::size_t>(t)]);
  for (const std::int32_t e : candidate_edges_) {
    if (edge_stamp_[static_cast<std::size_t>(e)] != edge_now_) continue;
    const auto curve = donor_.edge(e);
    if (box.contains(curve.front()) && box.contains(curve.back()) &&
        inside_target(t, curve, 0.0, 1.0)) {
      add_donor_part(e, 0.0, 1.0);
    }
  }
  for (std::size_t next = 0; next < marks_.size();) {
    const std::size_t first = next;
    const std::int32_t e = marks_[first].edge;
    while (next < marks_.size() && marks_[next].edge == e) ++next;
    const auto curve = donor_.edge(e);
    double s = 0.0;
    std::int8_t direction = 0;
    for (std::size_t i = first; i <= next; ++i) {
      double end = 1.0;
      std::int8_t end_direction = 0;
      if (i < next) {
        end = marks_[i].s;
        end_direction = marks_[i].direction;
        for (; i + 1 < next && marks_[i + 1].s == end; ++i) end_direction = 0;
      }
      if (end > s) {
        const double middle = 0.5 * (s + end);
        bool on_boundary = false;
        for (const auto& [edge, interval] : covered_) {
          on_boundary =
              on_boundary || (edge == e && interval.first < middle && middle < interval.second);
        }
        if (!on_boundary) {
          bool inside = false;
          if (direction != 0 && (end_direction == 0 || end_direction == -direction)) {
            inside = direction > 0;
          } else if (direction == 0 && end_direction != 0) {
            inside = end_direction < 0;
          } else {
            inside = inside_target(t, curve, s, end);
          }
          if (inside) add_donor_part(e, s, end);
        }
        s = end;
        direction = end_direction;
      } else {
        direction = 0;  // several contacts in one place tell nothing
      }
    }
  }
}

// Which edges are new is as good as random: no branch depends on it.
void ElementOverlay::find_records_of(std::int32_t t, std::array<std::uint32_t, 3>& found) {
  const auto& sides = target_.element_edges[static_cast<std::size_t>(t)];
  Record* const records = records_.room(3) - records_.size();
  std::size_t count = records_.size();
  for (std::size_t k = 0; k < 3; ++k) {
    records[count] = Record{};
    records[count].edge = sides[k].edge.value;
    found[k] = record_numbers_.take(sides[k].edge.value);
    count = record_numbers_.count();
  }
  records_.resize(count);
}

void ElementOverlay::find_records(std::int32_t t) {
  if (next_element_ < chunk_.size() && chunk_[next_element_].element == t) {
    own_ = chunk_[next_element_++].record;
  } else {
    const std::size_t known = records_.size();
    find_records_of(t, own_);
    if (is_straight() && records_.size() > known) walk_straight_edges(known);
  }
  for (const std::uint32_t i : own_) {
    Record& record = records_[i];
    if (record.walked() || record.details >= 0 || walk_edge(record) || share_edge(record) ||
        join_edge(record))
      continue;
    find_candidates(t);
    overlay_edge(record);
  }
}

void ElementOverlay::add(std::int32_t t, OverlayList& list, OverlayCounts& counts) {
  find_records(t);
  bool walked = true;
  for (const std::uint32_t i : own_) {
    const Record& record = records_[i];
    const auto& owner = target_.edge_sides[static_cast<std::size_t>(record.edge)];
    const bool owned = (owner[0] != exterior ? owner[0] : owner[1]) == t;
    walked = walked && record.walked();
    counts.crossings += owned ? record.crossings : 0;
    counts.max_joint_gap = std::max(counts.max_joint_gap, record.gap);
    if (record.details < 0 || !owned) continue;
    const Details& details = details_of(record);
    counts.tangencies += details.tangencies;
    counts.overlaps += details.overlaps;
    counts.unresolved += details.unresolved;
  }
  if (!(walked && walk_inside(t, list))) {
    find_boundary_segments(t);
    if (!is_one_donor()) {
      find_candidates(t);
      donor_edges_inside(t);
    }
    group_segments(list);
  }
  list.close();
}

// Where a vertex hangs, a long donor edge with an element on one side only lies along short ones
// with elements on the other.
std::pair<std::size_t, std::int32_t> ElementOverlay::facing_coincidence(const Details& record,
                                                                        const Piece& piece,
                                                                        bool reversed) const {
  const auto donor_of = [&](const Coincidence& c) {
    const bool same_direction = c.s0 < c.s1;
    return donor_
        .edge_sides[static_cast<std::size_t>(c.donor_edge)][same_direction != reversed ? 0 : 1];
  };
  const auto first = static_cast<std::size_t>(piece.coincidence);
  const std::int32_t donor = donor_of(coincidences_[first]);
  if (donor != exterior) return {first, donor};
  const double middle = 0.5 * (piece.r0 + piece.r1);
  for (std::size_t k = first + 1; k < record.coincidence_end; ++k) {
    const Coincidence& c = coincidences_[k];
    if (c.r0 >= middle) break;
    if (c.r1 > middle && donor_of(c) != exterior) return {k, donor_of(c)};
  }
  return {first, exterior};
}

void ElementOverlay::find_boundary_segments(std::int32_t t) {
  segments_.clear();
  for (std::size_t k = 0; k < 3; ++k) {
    const SideEdge& side = target_.element_edges[static_cast<std::size_t>(t)][k];
    const Details& record = unfold(records_[own_[k]]);
    for (std::uint32_t i = record.piece_begin; i < record.piece_end; ++i) {
      const Piece& piece = pieces_[i];
      Segment segment;
      segment.target = {side.edge.value, piece.r0, piece.r1};
      segment.donor = piece.donor;
      if (piece.coincidence >= 0) {
        const auto [which, facing] = facing_coincidence(record, piece, side.reversed);
        const Coincidence& c = coincidences_[which];
        // Parameters of the piece on the donor edge: the piece may be cut finer than the
        // coincidence.
        const auto map = [&](double r) {
          if (r == c.r0) return c.s0;
          if (r == c.r1) return c.s1;
          return std::clamp(
              foot_point(donor_.edge(c.donor_edge), curve_point(target_.edge(side.edge.value), r))
                  .s,
              std::min(c.s0, c.s1), std::max(c.s0, c.s1));
        };
        segment.source = {c.donor_edge, map(piece.r0), map(piece.r1)};
        segment.donor = facing;
        if (c.apart) segment.across = facing_coincidence(record, piece, !side.reversed).second;
      }
      if (side.reversed) {
        std::swap(segment.target.from, segment.target.to);
        std::swap(segment.source.from, segment.source.to);
      }
      segments_.push_back(segment);
    }
  }
}

// T lies inside a donor element, or is one: its boundary does.
bool ElementOverlay::is_one_donor() const {
  return segments_[0].donor != exterior &&
         std::all_of(segments_.begin(), segments_.end(),
                     [&](const Segment& segment) { return segment.donor == segments_[0].donor; });
}

void collect_segments(const ElementPieces& own, std::vector<Segment>& out) {
  out.clear();
  if (!own.segments.empty()) {
    out.assign(own.segments.begin(), own.segments.end());
    return;
  }
  // Where each region's next segment goes.
  std::vector<std::size_t> place(own.donors.size() + 1, 0);
  const auto visit = [&](const auto& add) {
    for (const BoundaryPiece& piece : own.pieces) {
      add(piece.left, piece, false);
      if (piece.right >= 0 && piece.right != piece.left) add(piece.right, piece, true);
    }
  };
  visit([&](std::int32_t region, const BoundaryPiece&, bool) {
    ++place[static_cast<std::size_t>(region) + 1];
  });
  std::partial_sum(place.begin(), place.end(), place.begin());
  out.resize(place.back());
  visit([&](std::int32_t region, const BoundaryPiece& piece, bool reversed) {
    const auto r = static_cast<std::size_t>(region);
    Part part = piece.part;
    if (reversed) std::swap(part.from, part.to);
    Segment segment;
    segment.donor = own.donors[r];
    (piece.source ? segment.source : segment.target) = part;
    out[place[r]++] = segment;
  });
}

}  // namespace bezel::detail
