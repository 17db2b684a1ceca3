// Straight edges through straight donor elements: each step looks at one vertex and one edge.

#include <algorithm>
#include <cmath>

#include "bezel/transfer/overlay.hpp"
#include "bezel/transfer/straight_elements.hpp"

namespace bezel::detail {
namespace {

constexpr std::array<std::size_t, 3> after = {1, 2, 0};

/// Two edges cross plainly when the cross product of their directions is at least this fraction of
/// what their lengths allow: parameters are then good to 1e-11, a hundredth of contact_isolation.
constexpr double least_sine = 1e-4;

double size_of(const Vec2& d) {
  return std::abs(d.x()) + std::abs(d.y());
}

}  // namespace

std::vector<StraightElement> straight_elements(const OverlayMesh& mesh) {
  std::vector<StraightElement> elements(mesh.element_count());
  // By edge: 4 times the element plus its side, left and right.
  std::vector<std::array<std::int32_t, 2>> place(mesh.edge_sides.size(), {-1, -1});
  for (std::size_t e = 0; e < elements.size(); ++e) {
    for (std::size_t k = 0; k < 3; ++k) {
      const SideEdge& side = mesh.element_edges[e][k];
      place[side.edge.index()][side.reversed ? 1 : 0] = static_cast<std::int32_t>(4 * e + k);
    }
  }
  for (std::size_t e = 0; e < elements.size(); ++e) {
    elements[e].corner = mesh.corners(static_cast<std::int32_t>(e));
    for (std::size_t k = 0; k < 3; ++k) {
      const SideEdge& side = mesh.element_edges[e][k];
      elements[e].beyond[k] = place[side.edge.index()][side.reversed ? 0 : 1];
      if (side.reversed) elements[e].reversed |= 1U << k;
    }
  }
  return elements;
}

// Which vertices lie left and right of the edge's line tells where it leaves each element; the walk
// ends in the element around the edge's last vertex. Everything is decided far above rounding
// (crossings near the ends of edges, or nearly along them, end the walk), so that the crossings
// found are all there are.
bool ElementOverlay::walk_straight_edge(std::int32_t edge, Record& record) {
  const std::vector<StraightElement>& elements = search_.straight();
  if (elements.empty() || target_.degree != 1) return false;
  const auto& ends = target_.edge_vertex[static_cast<std::size_t>(edge)];
  std::int32_t donor = donor_at_vertex(ends[0]);
  if (donor == exterior) return false;
  const Vec2 a = target_.edge_control[2 * static_cast<std::size_t>(edge)];
  const Vec2 b = target_.edge_control[2 * static_cast<std::size_t>(edge) + 1];
  const Vec2 d = b - a;
  const double size = size_of(d);

  const StraightElement* at = &elements[static_cast<std::size_t>(donor)];
  std::array<double, 3> left{};  // of the line: cross(d, corner - a)
  for (std::size_t k = 0; k < 3; ++k) left[k] = cross(d, at->corner[k] - a);
  std::size_t side = 0;
  while (side < 3 && !(left[side] < 0.0 && left[after[side]] >= 0.0)) ++side;
  if (side == 3) return false;
  double from = left[side], to = left[after[side]];  // at the side's ends

  const std::size_t contact_begin = contacts_.size(), piece_begin = pieces_.size();
  double r = 0.0, gap_squared = 0.0;
  for (;;) {
    const Vec2& u = at->corner[side];
    const Vec2& v = at->corner[after[side]];
    const Vec2 e = v - u;
    const double start = cross(e, a - u), end = cross(e, b - u);
    if (end > 0.0) break;
    const double determinant = start - end;
    const double r_next = start / determinant;
    const double length = size_of(e);
    const bool reversed = (at->reversed >> side & 1U) != 0;
    const double s = (reversed ? to : -from) / (to - from);
    const std::int32_t beyond = at->beyond[side];
    if (!(determinant > least_sine * length * (length + size)) || !is_inner(r_next) ||
        !is_inner(s) || r_next - r < contact_isolation || beyond < 0) {
      contacts_.resize(contact_begin);
      pieces_.resize(piece_begin);
      return false;
    }
    const double along = reversed ? 1.0 - s : s;
    const Vec2 apart = (a - u) + r_next * d - along * e;
    gap_squared = std::max(gap_squared, dot(apart, apart));
    contacts_.push_back({r_next, s,
                         donor_.element_edges[static_cast<std::size_t>(donor)][side].edge.value,
                         reversed ? std::int8_t{-1} : std::int8_t{1}});
    pieces_.push_back({r, r_next, donor, -1});
    r = r_next;
    donor = beyond >> 2;
    at = &elements[static_cast<std::size_t>(donor)];
    // The side just crossed runs the other way here: from `to` to `from`.
    const std::size_t entered = static_cast<std::size_t>(beyond & 3);
    const std::size_t opposite = after[after[entered]];
    const double third = cross(d, at->corner[opposite] - a);
    // Without a branch: half of the vertices lie left.
    const bool is_left = third >= 0.0;
    side = is_left ? after[entered] : opposite;
    to = is_left ? third : to;
    from = is_left ? from : third;
  }
  last_donor_ = donor;
  if (donor_at_vertex(ends[1]) != donor) {
    contacts_.resize(contact_begin);
    pieces_.resize(piece_begin);
    return false;
  }
  pieces_.push_back({r, 1.0, donor, -1});
  keep_walk(record, contact_begin, piece_begin, std::sqrt(gap_squared / dot(d, d)));
  return true;
}

}  // namespace bezel::detail
