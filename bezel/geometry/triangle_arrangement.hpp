#pragma once
// The boundaries of two curved triangles cut at their common points, each part with its place
// relative to the other triangle. Internal; the pieces of `intersect` and `difference`.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "bezel/geometry/curved_polygon.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

/// The three sides of a triangle as curves, counter-clockwise.
class TriangleSides {
 public:
  TriangleSides() = default;
  TriangleSides(const TriangleSides&) = delete;
  TriangleSides& operator=(const TriangleSides&) = delete;
  /// @param control         checked by the caller
  /// @param with_distance   the sides will be met within a coincidence distance
  void assign(int g, std::span<const Vec2> control, bool with_distance = false);
  std::span<const Vec2> control(int side) const { return cache_[at(side)].control; }
  const CurveCache& cache(int side) const { return cache_[at(side)]; }
  const Vec2& corner(int k) const { return control(k).front(); }
  const Box2& box() const { return box_; }  ///< of the sides' control points

 private:
  static std::size_t at(int side) { return static_cast<std::size_t>(side); }
  std::vector<Vec2> points_;
  std::array<CurveCache, 3> cache_;
  Box2 box_;
};

/// A common point of both boundaries.
struct BoundaryJoint {
  std::array<BoundaryPlace, 2> place;
  std::array<double, 2> lo, hi;  ///< the true parameters are between these; corners: equal
  int sign;    ///< of cross(a', b') where a side simply crosses a side, proven; 0: nothing known
  Vec2 point;  ///< for corners the corner
  // While the joints are gathered:
  std::array<std::uint8_t, 2> seen;  ///< corners: from its side's start (1), its side's end (2)
  std::array<double, 2> error;       ///< of the computed parameters
  int seen_sign;                     ///< of the crossing at a corner
  std::int32_t first_contact;        ///< of the contacts that it joins, those that may be apart
};

enum class PartClass : std::uint8_t { inside, outside, along, against };

/// The part of a boundary from one joint to the next; `along` and `against`: both boundaries, run
/// in the same or in opposite directions.
struct BoundaryPart {
  std::int32_t from, to;  ///< joints
  PartClass place;
};

/// Sides coincide: s0 < s1 on side `edge[0]` of the first, t0 to t1 on side `edge[1]` of the
/// second.
struct SideOverlap {
  std::array<int, 2> edge;
  double s0, s1, t0, t1;
};

class Arrangement {
 public:
  /// False: unresolved, with reason() and where(). Storage is reused from call to call.
  bool build(const TriangleSides& a, const TriangleSides& b, double coincidence_distance);

  std::span<const BoundaryJoint> joints() const { return joints_; }
  /// Of triangle k, in order around it; part i begins at its joint of rank i. Empty without joints.
  std::span<const BoundaryPart> parts(int k) const { return parts_[static_cast<std::size_t>(k)]; }
  /// Without joints: is corner 0 of triangle k inside the other?
  bool corner_inside(int k) const { return corner_inside_[static_cast<std::size_t>(k)]; }
  const TriangleSides& sides(int k) const { return *sides_[static_cast<std::size_t>(k)]; }
  const std::string& reason() const { return reason_; }
  const Box2& where() const { return where_; }

 private:
  bool fail(const char* reason, const Box2& where);
  bool meet(int i, int j, double coincidence_distance);
  bool add_contact(const BoundaryJoint& contact);
  bool join(BoundaryJoint& joint, const BoundaryJoint& contact);
  const BoundaryJoint& joint(std::int32_t i) const { return joints_[static_cast<std::size_t>(i)]; }
  void separate_contacts();
  void settle_corners();
  bool sort_joints();
  void tighten(std::int32_t i);
  bool apart(int k, std::int32_t i, std::int32_t j) const;
  bool order_pair(int k, std::size_t i);
  bool classify(int k);
  bool classify_part(int k, BoundaryPart& part);
  bool classify_exactly(int k, BoundaryPart& part);
  /// Of what lies strictly between two places of boundary k, after parameter `after` of the first's
  /// side and before `before_end` of the second's: +1 inside the other triangle, -1 outside, 0
  /// undecided. The same place twice: once around.
  int class_between(int k, const BoundaryPlace& start, double after, const BoundaryPlace& end,
                    double before_end) const;
  /// Is the point at s of a side of triangle k inside the other? on_boundary or undecided: nothing.
  enum class Place : std::uint8_t { inside, outside, unknown };
  Place place_of(int k, int side, double s) const;

  std::array<const TriangleSides*, 2> sides_{};
  std::vector<BoundaryJoint> joints_;
  std::vector<BoundaryJoint> contacts_;   ///< at corners, as they were found
  std::vector<std::int32_t> same_joint_;  ///< per contact the next one of its joint, or -1
  std::vector<SideOverlap> overlaps_;
  std::array<std::vector<std::int32_t>, 2> order_;  ///< joints along each boundary
  std::array<std::vector<BoundaryPart>, 2> parts_;
  std::array<bool, 2> corner_inside_{};
  CurveIntersections found_;
  std::string reason_;
  Box2 where_;
};

}  // namespace bezel::geometry_kernel
