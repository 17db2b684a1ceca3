#pragma once
// Curved (tensor-product Bezier) quadrilaterals in the plane: map, Jacobian, validity, area.
//
// A quadrilateral of degree g is p(s, t) = sum b_ij B_i(s) B_j(t), (s, t) in the unit square, with
// (g+1)^2 control points in rows of constant j, i running fastest. Corners 0 to 3 are (0, 0), (1,
// 0), (1, 1), (0, 1); side k runs from corner k to corner k+1: counter-clockwise.

#include <cstddef>
#include <span>
#include <vector>

#include "bezel/geometry/triangle.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

/// Largest degree of a quadrilateral: its Jacobian has degree 2g-1 <= max_interval_degree.
inline constexpr int max_quad_degree = 30;

/// Number of control points of degree g.
constexpr int quad_size(int g) {
  return (g + 1) * (g + 1);
}
/// Position of b_ij in the flat array.
constexpr int quad_index(int g, int i, int j) {
  return j * (g + 1) + i;
}
/// Flat position of the m-th control point (0..g) along a side, in the side's own direction.
constexpr int quad_side_index(int g, int side, int m) {
  return side == 0   ? quad_index(g, m, 0)
         : side == 1 ? quad_index(g, g, m)
         : side == 2 ? quad_index(g, g - m, g)
                     : quad_index(g, 0, g - m);
}

/// The map and its first derivatives at a place.
struct QuadValue {
  Vec2 point, ds, dt;
};
/// Value and first derivatives of the map, by de Casteljau's algorithm along both directions.
///
/// @param g        degree, 1..max_quad_degree
/// @param control  quad_size(g) control points, finite
/// @param s, t     dimensionless, finite; outside [0, 1] it extrapolates
/// @return   the corner control points at the corners, exactly
/// @throws   InputError for a bad degree, size or value (as all functions here)
/// @accuracy within 6 g u max|b| for the point, 12 g^2 u max|b| for the derivatives, in the square;
///           largest seen 0.1 of that
/// @cost     g (g+1) (g+2) combinations of points
QuadValue evaluate_quad(int g, std::span<const Vec2> control, double s, double t);

/// Determinant of the Jacobian d(x,y)/d(s,t) as a tensor-product Bernstein polynomial of degree
/// 2g-1 in each direction.
///
/// @return   quad_size(2g-1) coefficients, ordered as control points
/// @cost     g^2 (g+1)^2 cross products
std::vector<double> quad_jacobian_determinant(int g, std::span<const Vec2> control);

struct QuadValidity {
  Validity status;
  Vec2 where;  ///< (s, t) of the smallest determinant seen
  double det;  ///< its value there
};
/// Whether the Jacobian determinant is positive on the whole square, by halving its Bernstein
/// polynomial along both directions in turn, with a bound on the rounding.
///
/// `valid`: all coefficients of all pieces are positive beyond rounding; `inverted`: a value is
/// negative beyond rounding; `undecided`: it touches zero to rounding, or the bounded subdivision
/// did not decide. A positive determinant makes the map locally one to one, not yet globally.
///
/// @cost     far from degenerate 0.2 us at g = 2, 5 us at g = 8, 0.2 ms at g = 24; at most 80
/// halvings
///           deep and 500 to 20000 pieces, the fewer the higher the degree (below a second)
[[nodiscard]] QuadValidity check_quad_validity(int g, std::span<const Vec2> control);

/// Signed area (positive for counter-clockwise sides) by Green's theorem along the sides, relative
/// to corner 0.
///
/// @accuracy as area_and_centroid (curve_shape.hpp): within 160 g (g+1) u r^2, r the largest
///           coordinate relative to corner 0
double quad_area(int g, std::span<const Vec2> control);

/// The control points of one side, in its own direction.
std::vector<Vec2> quad_side(int g, std::span<const Vec2> control, int side);

}  // namespace bezel
