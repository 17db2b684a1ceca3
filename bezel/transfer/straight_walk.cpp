// Straight edges through straight donor elements: each step looks at one vertex and one edge. Many
// walks take their steps in turn, so that none waits for another's memory or divisions, and hardly
// a branch depends on where an edge leads.

#include <algorithm>
#include <cmath>

#include "bezel/transfer/overlay.hpp"
#include "bezel/transfer/straight_elements.hpp"

namespace bezel::detail {
namespace {

constexpr std::array<std::size_t, 3> after = {1, 2, 0};

/// At a time: their states fit the nearest memory.
constexpr std::size_t walks_together = 64;

/// By which corners lie right of a line (bit k: corner k), the side through which it leaves: from
/// a corner on the right to one on the left.
constexpr std::array<std::int32_t, 8> leaving = {3, 0, 1, 1, 2, 0, 2, 3};
/// ... when it came in by side k and the corner opposite of it lies right or left.
constexpr std::array<std::int32_t, 6> next_side = {2, 1, 0, 2, 1, 0};

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

bool ElementOverlay::start_walk(std::size_t record, Walk& walk) {
  const auto edge = static_cast<std::size_t>(records_[record].edge);
  const auto& ends = target_.edge_vertex[edge];
  walk.record = static_cast<std::int32_t>(record);
  walk.donor = donor_at_vertex(ends[0], ends[1]);
  if (walk.donor == exterior || donor_at_vertex(ends[1], ends[0]) == exterior) return false;
  walk.a = target_.edge_control[2 * edge];
  walk.d = target_.edge_control[2 * edge + 1] - walk.a;
  const StraightElement& element = search_.straight()[static_cast<std::size_t>(walk.donor)];
  std::array<double, 3> left{};  // of the line
  for (std::size_t k = 0; k < 3; ++k) left[k] = cross(walk.d, element.corner[k] - walk.a);
  walk.side =
      leaving[(left[0] < 0.0 ? 1U : 0U) + (left[1] < 0.0 ? 2U : 0U) + (left[2] < 0.0 ? 4U : 0U)];
  if (walk.side == 3) return false;
  const auto side = static_cast<std::size_t>(walk.side);
  walk.size = size_of(walk.d);
  walk.beside = {left[side], left[after[side]]};
  walk.r = walk.gap_squared = walk.last_gap_squared = 0.0;
  walk.steps = 0;
  return true;
}

// Which vertices lie left and right of the edge's line tells where it leaves each element; the walk
// ends in the element around the edge's last vertex. Everything is decided far above rounding
// (crossings near the ends of edges, or nearly along them, end the walk), so that the crossings
// found are all there are.
void ElementOverlay::advance_walks() {
  const std::vector<StraightElement>& elements = search_.straight();
  std::size_t left = walks_.size();
  going_.resize(left);
  for (std::size_t i = 0; i < left; ++i) {
    going_[i] = static_cast<std::uint32_t>(i);
    // Each begins with a step of the first round.
    walks_[i].first_step = walks_[i].last_step = static_cast<std::int32_t>(step_count_ + i);
  }
  while (left > 0) {
    if (steps_.size() < step_count_ + left) steps_.resize(2 * (step_count_ + left));
    std::size_t next = 0;
    for (std::size_t i = 0; i < left; ++i) {
      const std::uint32_t which = going_[i];
      Walk& walk = walks_[which];
      const StraightElement& at = elements[static_cast<std::size_t>(walk.donor)];
      const auto side = static_cast<std::size_t>(walk.side);
      const std::size_t reversed = at.reversed >> side & 1U;
      const std::int32_t beyond = at.beyond[side];
      const Vec2 &u = at.corner[side], &v = at.corner[after[side]];
      const Vec2 e = v - u, from_u = walk.a - u;
      const double start = cross(e, from_u);
      const double determinant = walk.beside[1] - walk.beside[0];  // cross(d, e)
      const double inverse = 1.0 / determinant;
      const double r = start * inverse;
      const double along = -walk.beside[0] * inverse;
      const double s = std::abs(walk.beside[reversed]) * inverse;
      const double length = size_of(e);
      const Vec2 apart = from_u + r * walk.d - along * e;

      const auto here = static_cast<std::int32_t>(step_count_++);
      steps_[static_cast<std::size_t>(walk.last_step)].next = here;
      steps_[static_cast<std::size_t>(here)] = {
          r,          s,
          walk.donor, donor_.element_edges[static_cast<std::size_t>(walk.donor)][side].edge.value,
          -1,         1 - 2 * static_cast<std::int32_t>(reversed)};
      walk.last_step = here;
      ++walk.steps;
      walk.gap_squared = std::max(walk.gap_squared, walk.last_gap_squared);
      walk.last_gap_squared = dot(apart, apart);
      walk.ended = start > determinant;
      const int plain = int{determinant > least_sine * length * (length + walk.size)} &
                        int{r > contact_isolation} & int{r < 1.0 - contact_isolation} &
                        int{s > contact_isolation} & int{s < 1.0 - contact_isolation} &
                        int{r - walk.r >= contact_isolation} & int{beyond >= 0} & int{!walk.ended};
      walk.r = r;

      // The side just crossed runs the other way beyond: from the left of the line to the right.
      const std::int32_t place = beyond >= 0 ? beyond : 4 * walk.donor;
      walk.donor = place >> 2;
      const auto behind = static_cast<std::size_t>(place & 3);
      const std::size_t opposite = after[after[behind]];
      const StraightElement& to = elements[static_cast<std::size_t>(walk.donor)];
      const double third = cross(walk.d, to.corner[opposite] - walk.a);
      const auto is_left = static_cast<std::size_t>(third >= 0.0);
      walk.side = next_side[2 * behind + is_left];
      walk.beside[is_left] = third;
      going_[next] = which;
      next += static_cast<std::size_t>(plain);
    }
    left = next;
  }
}

void ElementOverlay::finish_walk(const Walk& walk) {
  Record& record = records_[static_cast<std::size_t>(walk.record)];
  Step& last = steps_[static_cast<std::size_t>(walk.last_step)];
  const auto& ends = target_.edge_vertex[static_cast<std::size_t>(record.edge)];
  if (!walk.ended || vertex_place_[static_cast<std::size_t>(ends[1])] != last.donor) return;
  last.r = 1.0;
  last.donor_edge = -1;
  record.first_step = walk.first_step;
  record.gap = std::sqrt(walk.gap_squared / dot(walk.d, walk.d));
  record.crossings = walk.steps - 1;
}

void ElementOverlay::walk_straight_edges(std::size_t first_record) {
  for (std::size_t begin = first_record; begin < records_.size(); begin += walks_together) {
    const std::size_t end = std::min(records_.size(), begin + walks_together);
    walks_.clear();
    Walk walk{};
    for (std::size_t i = begin; i < end; ++i) {
      if (start_walk(i, walk)) walks_.push_back(walk);
    }
    advance_walks();
    for (const Walk& done : walks_) finish_walk(done);
  }
}

}  // namespace bezel::detail
