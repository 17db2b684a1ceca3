#pragma once
// Curved (Bezier) triangles in the plane: map, inverse, validity, moments.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bezel/bernstein/triangle.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

using bernstein::Lambda;

/// Determinant of the Jacobian d(x,y)/d(u,v) as a Bernstein polynomial of degree 2(g-1) on the
/// reference triangle.
///
/// @param g        degree of the map, 1..40
/// @param control  triangle_size(g) control points, order bernstein/index.hpp, finite
/// @return   triangle_size(2(g-1)) coefficients
/// @throws   InputError for a bad degree, size or value (as all functions here but `invert`)
/// @cost     triangle_size(g-1)^2 cross products
std::vector<double> jacobian_determinant(int g, std::span<const Vec2> control);

enum class Validity {
  valid,      ///< the Jacobian determinant is proven positive everywhere (check_validity)
  inverted,   ///< it is proven zero or negative somewhere (check_validity)
  undecided,  ///< neither could be proven within the bounded subdivision (check_validity)
};
struct ValidityResult {
  Validity status;
  Lambda where;  ///< a place where the determinant is smallest seen
  double det;    ///< its value there
};
/// Whether the map's Jacobian determinant is positive everywhere, by halving its Bernstein
/// polynomial with a bound on the rounding.
///
/// `valid`: all coefficients of all pieces are positive beyond rounding; `inverted`: a value is
/// negative beyond rounding (g = 1: the determinant is not positive); `undecided`: it touches zero
/// to rounding, or 40 halvings or 20000 pieces did not decide. A positive determinant makes the
/// map locally one to one, not yet globally.
///
/// @cost     0.15 us at g = 2, 0.3 us at g = 3 for triangles far from degenerate
/// @source   [hermes2018, sec. 2.2] for the notion
[[nodiscard]] ValidityResult check_validity(int g, std::span<const Vec2> control);

enum class Location {
  inside,        ///< lambda found, all >= -tolerance (locate)
  outside,       ///< proven outside (locate)
  not_converged  ///< neither (locate)
};
struct LocateResult {
  Location status;
  Lambda lambda;    ///< best answer so far; may be slightly negative within tolerance
  double residual;  ///< |b(lambda) - p|
};
/// Finds lambda with b(lambda) = p.
///
/// Newton from the corner triangle's barycentrics; when that leaves the triangle, halving with
/// convex-hull tests (box and three directions) and Newton from the pieces. `outside` is proven by
/// the hulls of all pieces; `not_converged`: 90 halvings or 4000 pieces did not decide. For maps
/// that are not one to one any preimage may be found.
///
/// @param p          finite
/// @param tolerance  how far below 0 a barycentric may be, dimensionless, in [0, 1)
/// @accuracy residual within a few u of the control points' distance to p
/// @cost     inside: 0.12 us at g = 2; outside but in the hull: microseconds
[[nodiscard]] LocateResult locate(int g, std::span<const Vec2> control, const Vec2& p,
                                  double tolerance = 1e-12);

/// Many points in one triangle: out[q] = locate(g, control, p[q], tolerance), bit for bit, on every
/// SIMD target.
///
/// @param out    one place per point
/// @throws   InputError also when `out` has another size than `p`
/// @cost     per point inside: 8 ns at g = 1, 16 ns at g = 2, 22 ns at g = 3, 45 ns at g = 4 with
///           AVX-512; 1.4 times that with AVX2, 2.4 times with SSE4
/// @limits   above degree 10, and for points that are outside but in the hull, as one by one
void locate(int g, std::span<const Vec2> control, std::span<const Vec2> p,
            std::span<LocateResult> out, double tolerance = 1e-12);

/// What `invert` found.
struct InverseResult {
  Lambda lambda;   ///< sums to 1, not clamped
  bool converged;  ///< the last step was below 4e-9 (the error is its square), or the residual is
                   ///< at rounding
};
/// Newton from a start, damped when the residual grows; also converges to points somewhat outside
/// the triangle. An inner loop of transfer: arguments are NOT checked.
///
/// @param g, control  1 <= g <= 40, triangle_size(g) finite points
/// @cost     60 ns at g = 2, 70 ns at g = 3; at most 60 evaluations; no allocation
[[nodiscard]] InverseResult invert(int g, std::span<const Vec2> control, const Vec2& p,
                                   const Lambda& start);

/// Many points in one triangle: out[q] = invert(g, control, p[q], start[q]), bit for bit, on every
/// SIMD target.
///
/// @param p, start, out  of one size; a point or start that is not finite gives `converged` false
/// @throws   InputError for a bad degree, a bad control point, or spans of different sizes
/// @accuracy |b(lambda) - p| within 8 (g + 1) u of the control points' largest distance from p,
/// where
///           the map is far from singular
/// @cost     per point: 6 ns at g = 1, 13 ns at g = 2, 21 ns at g = 3, 44 ns at g = 4 with AVX-512
/// @limits   above degree 10 as one by one
void invert(int g, std::span<const Vec2> control, std::span<const Vec2> p,
            std::span<const Lambda> start, std::span<InverseResult> out);

/// Signed area (positive for counter-clockwise sides), exact up to rounding, by Green's theorem
/// along the sides; relative to corner 0, so a triangle far from the origin loses nothing, and
/// where the triangle is round (AreaMap), so a thin one loses nothing either.
double area(int g, std::span<const Vec2> control);
/// Integral of x^a y^b over the triangle, exact up to rounding, by Green's theorem with a Gauss
/// rule per side.
///
/// @param g 1..18
/// @param a, b >= 0, a + b <= 20
double moment(int g, std::span<const Vec2> control, int a, int b);

}  // namespace bezel
