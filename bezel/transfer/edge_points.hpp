#pragma once
// Internal: Gauss points on pieces of edges, in the plane or in an element's reference triangle.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/transfer/overlay.hpp"
#include "bezel/transfer/region_fit.hpp"

namespace bezel::detail {

/// Makes the points, and keeps the rules that it makes them from.
class EdgePoints {
 public:
  struct Rule {
    std::size_t count = 0, blocks = 0;
    std::vector<double> node, weight;  ///< padded to whole blocks; weights by 0
  };
  /// @param points  at least 1
  const Rule& rule(int points);
  /// Appends points on a part of an element's own side: straight in its reference triangle.
  void append_side(const OverlayMesh& mesh, std::int32_t element, const Part& part, int points,
                   CurvePoints& to);
  /// Appends points on a part of a curve, from - origin.
  /// @return  the place of the first
  std::size_t append_curve(std::span<const Vec2> control, const Part& part, const Vec2& origin,
                           int points, CurvePoints& to);

 private:
  std::vector<Rule> rules_;
};

/// Fills the last block up with points that count nothing.
/// @param points  at least one
void pad(CurvePoints& points);

/// Whether all points lie in the reference triangle, to 1e-6 in barycentrics.
bool in_reference_triangle(const CurvePoints& points);

}  // namespace bezel::detail
