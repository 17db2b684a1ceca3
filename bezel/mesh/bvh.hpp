#pragma once
// Bounding volume hierarchy over boxes.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// A static tree over boxes in the plane. Deterministic; build O(n log n), memory about 80 bytes a
/// box. Empty boxes (lo > hi, or a NaN) are never found.
class Bvh {
 public:
  Bvh() = default;
  /// @throws InputError for more than 2^31 - 1 boxes
  /// @cost   boxes along a Morton curve, halved where it leaves a cell [lauterbach2009]; those in
  ///         one place of it by binned splits [wald2007]; leaves of up to four boxes; measured 12 ms
  ///         for 1e5 boxes of a mesh, and 350 ns for a query that finds two, far from the last
  /// @source [lauterbach2009], [wald2007]
  explicit Bvh(std::span<const Box2> boxes);

  /// Calls visit(i) once for every box i that overlaps `box` (touching counts), in an order that
  /// depends on the boxes alone.
  template <class Visit>
  void query(const Box2& box, Visit&& visit) const;
  /// Appends the numbers of the overlapping boxes.
  void query(const Box2& box, std::vector<std::int32_t>& out) const;
  /// The box nearest to p by exact distance.
  ///
  /// @param exact_distance  called with a box number i; returns a distance (not squared) that is at
  ///         least the one from p to box i; NaN counts as infinitely far
  /// @return the i with the smallest exact distance (ties: smallest i); -1 when there is no box
  template <class ExactDistance>
  std::int32_t nearest(const Vec2& p, ExactDistance&& exact_distance) const;

  struct Node {
    Box2 box;
    std::int32_t first = 0;  // leaf: first item; inner: left child (right = left + 1)
    std::int32_t count = 0;  // leaf: number of items; inner: 0
  };

 private:
  // Every level below max_depth / 2 halves its items, so no path is longer than max_depth.
  static constexpr int max_depth = 64;

  std::vector<Node> nodes_;
  std::vector<std::int32_t> items_;  // box numbers, leaf after leaf
  std::vector<Box2> boxes_;          // boxes_[k] is the box of items_[k]
};

}  // namespace bezel

#include "bezel/mesh/bvh_kernel.hpp"
