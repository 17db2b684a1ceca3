#pragma once
// The Jacobian determinant of a curved triangle from tables of its degree, for meshes of many.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::geometry_kernel {

/// What the coefficients of det(db/du, db/dv) need of a degree.
struct JacobianTable {
  explicit JacobianTable(int g);

  /// A coefficient of a derivative: weight times the difference of two control points.
  struct Step {
    std::int32_t base, along_u, along_v;
    double weight;
  };
  std::vector<Step> steps;
  std::vector<std::int32_t> place;  ///< [m][n]: where the product of steps m and n goes
  std::vector<double> scale;        ///< of each coefficient

  /// Largest degree of the tables kept, and what they have at most.
  static constexpr int max_kept = 10;
  static constexpr auto max_room =
      static_cast<std::size_t>(4 * bernstein::triangle_size(max_kept - 1));
  static constexpr auto max_size =
      static_cast<std::size_t>(bernstein::triangle_size(2 * (max_kept - 1)));
  /// Made once. @param g  1..max_kept
  static const JacobianTable& of(int g);

  /// Sets scale.size() coefficients of degree 2 (g - 1).
  /// @param room  for 4 steps.size() numbers
  void operator()(const Vec2* control, double* room, double* det) const;
};

}  // namespace bezel::geometry_kernel
