#pragma once
// Errors of interpolated curves as an independent prototype found them, for `study curves`.

#include <array>
#include <cstddef>

namespace bezel::cli {

/// One of the cases 1 to 5 of [bjontegaard2009, sec. 2.6]; entry i belongs to degree i + 2.
struct CurveReference {
  static constexpr std::size_t degrees = 29;
  using Row = std::array<double, degrees>;
  /// Error (4) of the methods standard, chord, arc length, L2, equal tangent, and the prototype's
  /// search that ends with least distances.
  std::array<Row, 6> l2;
  Row distance;  ///< smallest L2 norm of the distance that any of its interpolants has
  std::array<int, degrees> iterations;  ///< Newton iterations of equal tangent at this degree
};

/// @param case_number  0 to 4
const CurveReference& curve_reference(std::size_t case_number);

}  // namespace bezel::cli
