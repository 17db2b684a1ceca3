#pragma once
// Internal: a curved element in double-double arithmetic, from its control points as they were
// given. Where an element is bent by more than its width, points rounded in any plane are off by a
// part of the width, while the same points kept in two doubles have digits to spare.

#include <array>
#include <span>
#include <vector>

#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/geometry/area_map.hpp"
#include "bezel/geometry/bent.hpp"

namespace bezel::detail {

class BentElement {
 public:
  /// Barycentrics 1 and 2. Along the element they are needed to more than their rounding: over that
  /// much an element turns by more than its width over its length.
  using Place = std::array<DoubleDouble, 2>;
  struct Point {
    ExactVec2 value, du, dv;
  };

  /// @param control  of the element, as given
  /// @param centre   what points are taken from
  void set(int degree, std::span<const Vec2> control, const Vec2& centre);
  /// A point and the derivatives of the map there.
  Point at(const Place& q) const;
  /// The Jacobian's determinant.
  /// @accuracy  a few u of the largest coefficient's size
  double det(const std::array<double, 2>& q) const;
  /// Where x lies, by Newton's method from what invert_map() finds in a plane.
  /// @param q  in: a start when `warm`
  /// @return   false when it does not converge
  bool invert(const ExactVec2& x, Place& q, bool warm) const;

 private:
  bool improve(const ExactVec2& x, Place& q) const;
  /// From a point in the plane.
  Place nearest_on_sides(const Vec2& x) const;

  int degree_ = 0;
  std::vector<ExactVec2> control_;
  std::vector<double> det_;
  AreaMap map_;
  std::vector<Vec2> in_plane_;  // control points there, from the centre
};

/// Point of a curve and its derivative, unchecked.
inline bernstein::kernel::ValueAndDerivative<ExactVec2> exact_edge_point(
    std::span<const ExactVec2> control, double s) {
  return bernstein::kernel::evaluate_derivative_unchecked<ExactVec2, DoubleDouble>(
      static_cast<int>(control.size()) - 1, control.data(), s);
}

inline std::array<double, 2> rounded(const BentElement::Place& q) {
  return {static_cast<double>(q[0]), static_cast<double>(q[1])};
}

}  // namespace bezel::detail
