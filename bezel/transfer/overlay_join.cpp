// Edges that end on donor edges or in donor vertices, as those of refinements do: known from where
// their ends lie, each found once.

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/geometry/intersect_search.hpp"
#include "bezel/geometry/quick_ends.hpp"
#include "bezel/numeric/box.hpp"
#include "bezel/transfer/overlay.hpp"

namespace bezel::detail {
namespace {

/// Parts of two curves, from end to end within tau of each other; the largest distance seen.
bool run_together(std::span<const Vec2> a, double a0, double a1, std::span<const Vec2> b, double b0,
                  double b1, double tau, double& gap) {
  if (a.size() != b.size()) return false;
  const int degree = static_cast<int>(a.size()) - 1;
  if (degree == 1) {
    gap = std::max(norm(curve_point(a, a0) - curve_point(b, b0)),
                   norm(curve_point(a, a1) - curve_point(b, b1)));
    return gap <= tau;
  }
  std::array<Vec2, 2 * geometry_kernel::max_curve_points> room{};
  const std::size_t size = a.size();
  geometry_kernel::restrict_curve(degree, a.data(), a0, a1, room.data());
  geometry_kernel::restrict_curve(degree, b.data(), std::min(b0, b1), std::max(b0, b1),
                                  room.data() + size);
  gap = 0.0;
  for (std::size_t i = 0; i < size; ++i)
    gap = std::max(gap, norm(room[i] - room[size + (b0 < b1 ? i : size - 1 - i)]));
  return gap <= tau;
}

double rounding_of(const CurveCache& a, const CurveCache& b) {
  return coordinate_rounding * std::max(a.magnitude, b.magnitude);
}

}  // namespace

// Of a vertex in no donor element's interior: `walk_` are the elements whose boxes hold it.
std::int32_t ElementOverlay::place_on_edge(const Vec2& p) {
  EdgePoint found;
  CurveCache room;
  std::array<double, 4> feet{};
  for (const std::int32_t element : walk_) {
    for (const SideEdge& side : donor_.element_edges[static_cast<std::size_t>(element)]) {
      if (side.edge.value == found.edge) continue;
      const Box2 box = donor_.edge_box(side.edge.value);
      const double nearness = coordinate_rounding * geometry_kernel::largest_coordinate(box);
      if (!grown(box, nearness).contains(p)) continue;
      const CurveCache& curve = donor_.edge_cache(side.edge.value, room);
      const int count = geometry_kernel::inner_feet(p, curve, nearness, feet);
      if (count == 0) continue;
      if (count > 1 || found.edge >= 0 || !is_inner(feet[0])) return -1;
      found = {side.edge.value, feet[0],
               norm(p - curve_point(donor_.edge(side.edge.value), feet[0]))};
    }
  }
  if (found.edge < 0) return -1;
  const auto& sides = donor_.edge_sides[static_cast<std::size_t>(found.edge)];
  if (sides[0] == exterior || sides[1] == exterior) return -1;
  // Nothing else may be near.
  for (const std::int32_t element : walk_) {
    std::array<double, 3> lambda{};
    if (!invert_map(donor_.degree, donor_.element(element), p, lambda, false)) continue;
    std::sort(lambda.begin(), lambda.end());
    const bool beside = element == sides[0] || element == sides[1];
    if (beside ? lambda[1] <= clear_of_edges || lambda[0] > clear_of_edges
               : lambda[0] >= -clear_of_edges)
      return -1;
  }
  on_edges_.push_back(found);
  return static_cast<std::int32_t>(on_edges_.size()) - 1;
}

// What lies around a vertex; false where that is not plain, or the donor mesh ends there.
bool ElementOverlay::find_end(std::int32_t vertex, EdgeEnd& end) const {
  const std::int32_t place = vertex_place_[static_cast<std::size_t>(vertex)];
  end.elements.clear();
  end.edges = {};
  end.edge = end.node = -1;
  if (place >= 0) {
    end.elements.push_back(place);
    return true;
  }
  if (place <= first_on_edge) {
    const EdgePoint& on = on_edges_[static_cast<std::size_t>(first_on_edge - place)];
    end.edge = on.edge;
    end.s = on.s;
    end.gap = on.gap;
    end.edges = {&on.edge, 1};
    for (const std::int32_t e : donor_.edge_sides[static_cast<std::size_t>(on.edge)])
      end.elements.push_back(e);
    return true;
  }
  end.node = donor_node_at(vertex);
  if (end.node < 0) return false;
  end.edges = search_.edges_at(end.node);
  for (const std::int32_t e : end.edges) {
    for (const std::int32_t side : donor_.edge_sides[static_cast<std::size_t>(e)]) {
      if (side == exterior) return false;
      if (std::find(end.elements.begin(), end.elements.end(), side) == end.elements.end())
        end.elements.push_back(side);
    }
  }
  return true;
}

void ElementOverlay::begin_details(Record& record) {
  record.details = static_cast<std::int32_t>(details_.size());
  Details& details = details_.emplace_back();
  details.contact_begin = static_cast<std::uint32_t>(contacts_.size());
  details.coincidence_begin = static_cast<std::uint32_t>(coincidences_.size());
  details.piece_begin = static_cast<std::uint32_t>(pieces_.size());
}

void ElementOverlay::end_details(const Record& record) {
  Details& details = details_of(record);
  details.contact_end = static_cast<std::uint32_t>(contacts_.size());
  details.coincidence_end = static_cast<std::uint32_t>(coincidences_.size());
  details.piece_end = static_cast<std::uint32_t>(pieces_.size());
}

// The edge lies along donor edges, from vertex to vertex. Other donor edges meet it in vertices
// only, which cuts nothing.
bool ElementOverlay::follow_edges(Record& record) {
  const CurveCache& curve = target_.edge_cache(record.edge, own_room_);
  const auto own = target_.edge(record.edge);
  const std::size_t first = coincidences_.size();
  const auto give_up = [&] {
    coincidences_.resize(first);
    return false;
  };
  CurveCache room;
  std::array<double, 4> feet{};
  const double nearness = coordinate_rounding * curve.magnitude;
  const Box2 near_by = grown(curve.box, nearness);
  // A part of donor edge e from s to its end `to`, or to the edge's end before that.
  const auto follow = [&](std::int32_t e, double s, std::size_t to, double r, double& end) {
    const auto& sides = donor_.edge_sides[static_cast<std::size_t>(e)];
    if (sides[0] == exterior || sides[1] == exterior) return false;
    const auto other = donor_.edge(e);
    const std::int32_t node = donor_.edge_vertex[static_cast<std::size_t>(e)][to];
    double s_end = static_cast<double>(to);
    if (ends_[1].edge == e) {
      s_end = ends_[1].s;
      end = 1.0;
      if ((s_end > s) != (to == 1)) return false;
    } else if (ends_[1].node == node) {
      end = 1.0;
    } else {
      const Vec2& p = to == 0 ? other.front() : other.back();
      if (!near_by.contains(p) || geometry_kernel::inner_feet(p, curve, nearness, feet) != 1)
        return false;
      end = feet[0];
    }
    const CurveCache& other_cache = donor_.edge_cache(e, room);
    const double tau = rounding_of(curve, other_cache);
    double gap = 0.0;
    if (end - r < contact_isolation || !run_together(own, r, end, other, s, s_end, tau, gap))
      return false;
    coincidences_.push_back(
        {r, end, s, s_end, e, are_apart(e, gap, std::max(curve.magnitude, other_cache.magnitude))});
    return true;
  };
  double r = 0.0, end = 0.0;
  std::int32_t node = ends_[0].node;
  if (node < 0) {
    if (ends_[0].edge < 0) return false;
    const double s = ends_[0].s;
    if (!follow(ends_[0].edge, s, 0, r, end) && !follow(ends_[0].edge, s, 1, r, end)) return false;
    r = end;
  }
  while (r < 1.0) {
    if (node < 0) {
      const Coincidence& last = coincidences_.back();
      node = donor_.edge_vertex[static_cast<std::size_t>(last.donor_edge)][last.s1 == 0.0 ? 0 : 1];
    }
    bool found = false;
    for (const std::int32_t e : search_.edges_at(node)) {
      if (coincidences_.size() > first && coincidences_.back().donor_edge == e) continue;
      const std::size_t from = donor_.edge_vertex[static_cast<std::size_t>(e)][0] == node ? 0U : 1U;
      if (!follow(e, static_cast<double>(from), 1 - from, r, end)) continue;
      found = true;
      break;
    }
    if (!found) return give_up();
    r = end;
    node = -1;
  }
  begin_details(record);
  Details& details = details_of(record);
  details.coincidence_begin = static_cast<std::uint32_t>(first);
  details.overlaps = static_cast<std::int32_t>(coincidences_.size() - first);
  for (std::size_t i = first; i < coincidences_.size(); ++i)
    pieces_.push_back(
        {coincidences_[i].r0, coincidences_[i].r1, exterior, static_cast<std::int32_t>(i)});
  end_details(record);
  return true;
}

// The edge crosses donor elements between its ends, which lie on donor edges or vertices.
bool ElementOverlay::reach_across(Record& record) {
  const CurveCache& curve = target_.edge_cache(record.edge, own_room_);
  const std::size_t begin = contacts_.size();
  const auto give_up = [&] {
    contacts_.resize(begin);
    return false;
  };
  next_stamp();
  walk_ = ends_[0].elements;
  CurveCache room;
  double gap = 0.0;
  std::int32_t touches = 0;
  // The donor edges that it ends on it meets there only.
  for (std::size_t k = 0; k < 2; ++k) {
    const EdgeEnd& end = ends_[k];
    for (const std::int32_t e : end.edges) {
      if (parts_.knows(e)) return give_up();
      parts_.mark(e, static_cast<std::uint32_t>(k));
      const CurveCache& other = donor_.edge_cache(e, room);
      if (!geometry_kernel::nowhere_parallel(curve, other)) {
        geometry_kernel::QuickEnds met{};
        if (geometry_kernel::meet_at_ends(curve, other, rounding_of(curve, other), met) !=
            geometry_kernel::EndMeeting::point)
          return give_up();
      }
      ++touches;
    }
    if (end.edge < 0) continue;
    contacts_.push_back({static_cast<double>(k), end.s, end.edge, 0});
    gap = std::max(gap, end.gap);
  }
  const std::size_t first = contacts_.size();
  if (!cross_on_the_way(curve, gap)) return give_up();
  const auto crossings = std::span(contacts_).subspan(first);
  std::sort(crossings.begin(), crossings.end(),
            [](const Contact& a, const Contact& b) { return a.r < b.r; });
  const auto among = [](const std::vector<std::int32_t>& elements, std::int32_t e) {
    return std::find(elements.begin(), elements.end(), e) != elements.end();
  };
  std::int32_t donor = exterior;
  if (crossings.empty()) {
    for (const std::int32_t e : ends_[0].elements) {
      if (!among(ends_[1].elements, e)) continue;
      if (donor != exterior) return give_up();
      donor = e;
    }
  } else {
    donor = donor_.edge_sides[static_cast<std::size_t>(crossings[0].donor_edge)]
                             [crossings[0].sign > 0 ? 0 : 1];
    if (!among(ends_[0].elements, donor)) return give_up();
  }
  if (donor == exterior) return give_up();
  const std::size_t first_piece = pieces_.size();
  double r = 0.0;
  for (const Contact& c : crossings) {
    const auto& sides = donor_.edge_sides[static_cast<std::size_t>(c.donor_edge)];
    if (c.r - r < contact_isolation || sides[c.sign > 0 ? 0 : 1] != donor) {
      pieces_.resize(first_piece);
      return give_up();
    }
    pieces_.push_back({r, c.r, donor, -1});
    r = c.r;
    donor = sides[c.sign > 0 ? 1 : 0];
  }
  if (!among(ends_[1].elements, donor)) {
    pieces_.resize(first_piece);
    return give_up();
  }
  pieces_.push_back({r, 1.0, donor, -1});
  record.gap = gap / std::max(curve.diameter, 1e-300);
  record.crossings = static_cast<std::int32_t>(crossings.size()) + touches;
  std::sort(contacts_.begin() + static_cast<std::ptrdiff_t>(begin), contacts_.end(),
            [](const Contact& a, const Contact& b) { return a.r < b.r; });
  begin_details(record);
  Details& details = details_of(record);
  details.contact_begin = static_cast<std::uint32_t>(begin);
  details.piece_begin = static_cast<std::uint32_t>(first_piece);
  end_details(record);
  return true;
}

bool ElementOverlay::join_edge(Record& record) {
  const auto& ends = target_.edge_vertex[static_cast<std::size_t>(record.edge)];
  for (std::size_t k = 0; k < 2; ++k)
    if (!find_end(ends[k], ends_[k])) return false;
  if (ends_[0].edges.empty() && ends_[1].edges.empty()) return false;
  return follow_edges(record) || reach_across(record);
}

}  // namespace bezel::detail
