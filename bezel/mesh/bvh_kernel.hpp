#pragma once
// Queries of Bvh: included by bvh.hpp.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "bezel/mesh/bvh.hpp"

namespace bezel {
namespace bvh_detail {

/// Distance from p to the box, 0 inside.
inline double distance(const Vec2& p, const Box2& box) {
  const double dx = std::max({box.lo[0] - p[0], p[0] - box.hi[0], 0.0});
  const double dy = std::max({box.lo[1] - p[1], p[1] - box.hi[1], 0.0});
  return std::sqrt(dx * dx + dy * dy);
}

}  // namespace bvh_detail

template <class Visit>
void Bvh::query(const Box2& box, Visit&& visit) const {
  if (nodes_.empty() || !nodes_[0].box.overlaps(box)) return;
  std::array<std::int32_t, max_depth + 1> stack;
  std::size_t top = 0;
  std::int32_t at = 0;
  while (true) {
    const Node& node = nodes_[static_cast<std::size_t>(at)];
    if (node.count > 0) {
      for (auto k = static_cast<std::size_t>(node.first),
                end = k + static_cast<std::size_t>(node.count);
           k < end; ++k)
        if (boxes_[k].overlaps(box)) visit(items_[k]);
    } else {
      const bool left = nodes_[static_cast<std::size_t>(node.first)].box.overlaps(box);
      const bool right = nodes_[static_cast<std::size_t>(node.first) + 1].box.overlaps(box);
      if (left) {
        if (right) stack[top++] = node.first + 1;
        at = node.first;
        continue;
      }
      if (right) {
        at = node.first + 1;
        continue;
      }
    }
    if (top == 0) return;
    at = stack[--top];
  }
}

template <class ExactDistance>
std::int32_t Bvh::nearest(const Vec2& p, ExactDistance&& exact_distance) const {
  // The caller's distances carry rounding errors of their own; a box is skipped only when it is
  // farther by more.
  constexpr double slack = 1.0 - 1e-14;
  double best_distance = std::numeric_limits<double>::infinity();
  std::int32_t best = -1;
  if (nodes_.empty()) return best;
  struct Entry {
    double distance;
    std::int32_t node;
  };
  std::array<Entry, max_depth + 1> stack;
  std::size_t top = 0;
  stack[top++] = {bvh_detail::distance(p, nodes_[0].box), 0};
  while (top > 0) {
    const Entry entry = stack[--top];
    if (entry.distance * slack > best_distance) continue;
    const Node& node = nodes_[static_cast<std::size_t>(entry.node)];
    if (node.count > 0) {
      for (auto k = static_cast<std::size_t>(node.first),
                end = k + static_cast<std::size_t>(node.count);
           k < end; ++k) {
        if (bvh_detail::distance(p, boxes_[k]) * slack > best_distance) continue;
        double d = exact_distance(items_[k]);
        if (std::isnan(d)) d = std::numeric_limits<double>::infinity();
        if (d < best_distance || (d == best_distance && (best < 0 || items_[k] < best))) {
          best_distance = d;
          best = items_[k];
        }
      }
    } else {
      Entry near{bvh_detail::distance(p, nodes_[static_cast<std::size_t>(node.first)].box),
                 node.first};
      Entry far{bvh_detail::distance(p, nodes_[static_cast<std::size_t>(node.first) + 1].box),
                node.first + 1};
      if (far.distance < near.distance) std::swap(near, far);
      stack[top++] = far;
      stack[top++] = near;
    }
  }
  return best;
}

}  // namespace bezel
