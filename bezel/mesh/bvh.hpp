#pragma once
// Bounding volume hierarchy over boxes.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// A static tree over boxes in the plane. Deterministic; build O(n log n), memory about 40 bytes a box.
class Bvh {
 public:
  Bvh() = default;
  explicit Bvh(std::span<const Box2> boxes);

  /// Calls visit(i) for every box i that overlaps `box`, in an order that does not depend on threads.
  template <class Visit>
  void query(const Box2& box, Visit&& visit) const;
  /// Appends the numbers of the overlapping boxes.
  void query(const Box2& box, std::vector<std::int32_t>& out) const;
  /// The box nearest to p by box distance, refined by exact_distance(i) >= box distance: the i with the
  /// smallest exact distance (ties: smallest i); -1 when empty.
  template <class ExactDistance>
  std::int32_t nearest(const Vec2& p, ExactDistance&& exact_distance) const;

  struct Node {
    Box2 box;
    std::int32_t first = 0;  // leaf: first item; inner: left child (right = left + 1)
    std::int32_t count = 0;  // leaf: number of items; inner: 0
  };

 private:
  std::vector<Node> nodes_;
  std::vector<std::int32_t> items_;
  std::vector<Box2> boxes_;
};

}  // namespace bezel

#include "bezel/mesh/bvh_kernel.hpp"
