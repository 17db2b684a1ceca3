#pragma once
// Affine maps of the plane that keep areas and make thin shapes round.

#include <cmath>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// (x, y) to (u / stretch, stretch (v - slope u)), where (u, v) is (x, y) from a centre, turned by
/// a right angle or not. Its determinant is 1 exactly: areas, integrals and polynomials on
/// triangles are the same in both planes. What is lost when differences of the rounded coordinates
/// of a thin turned shape are multiplied is not lost in the plane where that shape is round.
struct AreaMap {
  Vec2 centre;
  double slope = 0.0;    ///< at most 1 in size
  double stretch = 1.0;  ///< a power of two
  bool turned = false;   ///< (u, v) = (y, -x)
  bool identity = true;  ///< points stay what they are

  /// @accuracy each coordinate within 2 u of itself, and stretch u^2 times the distance from the
  ///           centre
  Vec2 operator()(const Vec2& p) const;
  /// The gradient of a linear function there from the one here.
  /// @accuracy each coordinate within 2 u of itself for the gradient as given
  Vec2 gradient(const Vec2& g) const;
  /// A step between two points there from the one here, and back: the linear part of the map, which
  /// a double-double carries out to its own rounding.
  template <class Scalar>
  Vec<2, Scalar> step(const Vec<2, Scalar>& d) const {
    if (identity) return d;
    const Scalar u = turned ? d.y() : d.x(), v = turned ? -d.x() : d.y();
    return {{u * Scalar(1.0 / stretch), (v - Scalar(slope) * u) * Scalar(stretch)}};
  }
  template <class Scalar>
  Vec<2, Scalar> step_back(const Vec<2, Scalar>& d) const {
    if (identity) return d;
    const Scalar u = d.x() * Scalar(stretch);
    const Scalar v = d.y() * Scalar(1.0 / stretch) + Scalar(slope) * u;
    return turned ? Vec<2, Scalar>{{-v, u}} : Vec<2, Scalar>{{u, v}};
  }
  /// As gradient() above, in the arithmetic of the scalar.
  template <class Scalar>
  Vec<2, Scalar> gradient(const Vec<2, Scalar>& g) const {
    if (identity) return g;
    const Scalar u = turned ? g.y() : g.x(), v = turned ? -g.x() : g.y();
    return {{(u + Scalar(slope) * v) * Scalar(stretch), v * Scalar(1.0 / stretch)}};
  }
  /// By how much the rounding of coordinates of this size here moves points there.
  double rounding(double largest_coordinate) const;
};

/// The map that makes a thin shape about as wide as long, or the identity when the shape is not
/// thin or has no width at all.
/// @param points  at least 1, finite: control points of the shape
/// @cost  one pass when the shape is not thin
AreaMap round_map(std::span<const Vec2> points);

/// The control points of a triangle where it is round.
class RoundControl {
 public:
  explicit RoundControl(std::span<const Vec2> control);
  RoundControl(const RoundControl&) = delete;
  RoundControl& operator=(const RoundControl&) = delete;
  const AreaMap& map() const { return map_; }
  std::span<const Vec2> points() const { return points_; }

 private:
  AreaMap map_;
  std::span<const Vec2> points_;  // those given, when they need no map
  std::vector<Vec2> room_;
};

/// Width over length below which a shape is thin: above, 16 roundings are lost at most.
inline constexpr double thin = 1.0 / 16.0;

/// Whether cross(a, b) is small beside its products.
inline bool is_thin(const Vec2& a, const Vec2& b) {
  const double first = a.x() * b.y(), second = a.y() * b.x();
  return !(std::abs(first - second) > thin * (std::abs(first) + std::abs(second)));
}

/// cross(b - a, c - a): twice the area of a triangle.
/// @accuracy within 50 u of itself, thin or not, where nothing underflows
/// @cost  10 flops when the triangle is not thin
double triangle_cross(const Vec2& a, const Vec2& b, const Vec2& c);

}  // namespace bezel
