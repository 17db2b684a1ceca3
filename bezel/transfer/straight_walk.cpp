// Straight edges through straight donor elements: where they begin, and what their walks make of
// them.

#include <algorithm>
#include <cmath>

#include "bezel/transfer/overlay.hpp"
#include "bezel/transfer/straight_elements.hpp"
#include "bezel/transfer/straight_walk.hpp"

namespace bezel::detail {
namespace {

constexpr std::array<std::size_t, 3> after = {1, 2, 0};

/// By which corners lie right of a line (bit k: corner k), the side through which it leaves: from
/// a corner on the right to one on the left.
constexpr std::array<std::int32_t, 8> leaving = {3, 0, 1, 1, 2, 0, 2, 3};
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

bool ElementOverlay::start_walk(std::size_t record, StraightWalk& walk) {
  const auto edge = static_cast<std::size_t>(records_[record].edge);
  const auto& ends = target_.edge_vertex[edge];
  const std::int32_t donor = donor_at_vertex(ends[0], ends[1]);
  if (donor == exterior || donor_at_vertex(ends[1], ends[0]) == exterior) return false;
  const Vec2 a = target_.edge_control[2 * edge], d = target_.edge_control[2 * edge + 1] - a;
  const StraightElement& element = search_.straight()[static_cast<std::size_t>(donor)];
  std::array<double, 3> left{};  // of the line
  for (std::size_t k = 0; k < 3; ++k) left[k] = cross(d, element.corner[k] - a);
  const std::int32_t leaves =
      leaving[(left[0] < 0.0 ? 1U : 0U) + (left[1] < 0.0 ? 2U : 0U) + (left[2] < 0.0 ? 4U : 0U)];
  if (leaves == 3) return false;
  const auto side = static_cast<std::size_t>(leaves);
  walk.a = a;
  walk.d = d;
  walk.record = static_cast<std::int32_t>(record);
  walk.place = 4 * donor + leaves;
  walk.right = element.corner[side];
  walk.left = element.corner[after[side]];
  walk.beside_right = left[side];
  walk.beside_left = left[after[side]];
  return true;
}

void ElementOverlay::finish_walk(const StraightWalk& walk) {
  Record& record = records_[static_cast<std::size_t>(walk.record)];
  WalkStep& last =
      steps_[static_cast<std::size_t>(walk.first_step + (walk.steps - 1) * straight_stride)];
  const auto& ends = target_.edge_vertex[static_cast<std::size_t>(record.edge)];
  // The walk ends in the element around the edge's last vertex.
  if (!walk.ended || vertex_place_[static_cast<std::size_t>(ends[1])] != last.donor) return;
  last.r = 1.0;
  last.donor_edge = -1;
  record.first_step = walk.first_step;
  record.stride = straight_stride;
  record.gap = std::sqrt(walk.gap_squared / dot(walk.d, walk.d));
  record.crossings = walk.steps - 1;
}

// Of the ends of edges, as far as that is plain; the others are left for when they are needed.
void ElementOverlay::locate_vertices(std::size_t first_record) {
  sought_.clear();
  SoughtPoint* point = sought_.room(2 * (records_.size() - first_record));
  for (std::size_t i = first_record; i < records_.size(); ++i) {
    for (const std::int32_t v : target_.edge_vertex[static_cast<std::size_t>(records_[i].edge)]) {
      std::int32_t& place = vertex_place_[static_cast<std::size_t>(v)];
      point->p = target_.mesh->control(NodeId(v));
      point->vertex = v;
      point += place == unlocated ? 1 : 0;
      place = place == unlocated ? sought : place;
    }
  }
  sought_.resize(static_cast<std::size_t>(point - sought_.data()));
  const std::span<SoughtPoint> points(sought_.room(0) - sought_.size(), sought_.size());
  last_donor_ = locate_straight(search_.straight(), points, last_donor_);
  for (const SoughtPoint& found : points)
    vertex_place_[static_cast<std::size_t>(found.vertex)] =
        found.element < 0 ? unlocated : static_cast<std::int32_t>(found.element);
}

void ElementOverlay::walk_straight_edges(std::size_t first_record) {
  locate_vertices(first_record);
  walks_.clear();
  StraightWalk* walk = walks_.room(records_.size() - first_record);
  for (std::size_t i = first_record; i < records_.size(); ++i) walk += start_walk(i, *walk) ? 1 : 0;
  walks_.resize(static_cast<std::size_t>(walk - walks_.data()));
  const std::span<StraightWalk> walks(walks_.room(0) - walks_.size(), walks_.size());
  walk_straight(search_.straight(), donor_.element_edges, walks, steps_);
  for (const StraightWalk& done : walks) finish_walk(done);
}

}  // namespace bezel::detail
