#pragma once
// Curved (Bezier) tetrahedra in space: map, inverse, validity, volume. Costs are of one core of a
// Xeon with two cores and a load of 3.5.

#include <span>
#include <vector>

#include "bezel/bernstein/tetrahedron.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

/// Barycentrics (l0, l1, l2, l3) on the tetrahedron.
using Lambda4 = bernstein::tetrahedron::Lambda;

/// Largest degree of the maps here: the determinant's, 3 (g-1), stays below
/// bernstein::max_tetrahedron_degree.
inline constexpr int max_tetrahedron_map_degree = 7;

/// Determinant of the Jacobian d(x,y,z)/d(u,v,w) as a Bernstein polynomial of degree 3(g-1) on the
/// reference tetrahedron.
///
/// @param g        degree of the map, 1..7
/// @param control  tetrahedron_size(g) control points, order bernstein/tetrahedron_index.hpp,
/// finite
/// @return   tetrahedron_size(3(g-1)) coefficients
/// @throws   InputError for a bad degree, size or value (as all functions here but `invert`)
/// @accuracy each within 6 (2 tetrahedron_size(g-1) + 13) u g^3 h^3, h the largest coordinate
/// difference of control points neighbouring along u, v or w
/// @cost     tetrahedron_size(g-1)^2 cross products and tetrahedron_size(g-1)
/// tetrahedron_size(2(g-1)) dot products
std::vector<double> jacobian_determinant(int g, std::span<const Vec3> control);

struct TetrahedronValidity {
  Validity status;
  Lambda4 where;  ///< a place where the determinant is smallest seen
  double det;     ///< its value there
};
/// Whether the map's Jacobian determinant is positive everywhere, by halving its Bernstein
/// polynomial with a bound on the rounding; places where rounding hides the sign are decided
/// exactly.
///
/// `valid`: all coefficients of all pieces are positive beyond rounding; `inverted`: a value is
/// negative beyond rounding, or zero or negative in exact arithmetic (g = 1: always decided so);
/// `undecided`: it touches zero to rounding: 60 halvings or 20000 pieces, with 32 exact values, did
/// not decide. A positive determinant makes the map locally one to one, not yet globally. Any
/// scale: differences are scaled by a power of two where products could over- or underflow (det may
/// then be 0 or infinite).
///
/// @cost     0.16, 0.5 and 1.8 us at g = 1, 2, 3 for tetrahedra far from degenerate
[[nodiscard]] TetrahedronValidity check_validity(int g, std::span<const Vec3> control);

struct TetrahedronLocation {
  Location status;
  Lambda4 lambda;   ///< best answer so far; may be slightly negative within tolerance
  double residual;  ///< |b(lambda) - p|
};
/// Finds lambda with b(lambda) = p.
///
/// Newton from the corner tetrahedron's barycentrics; when that leaves the tetrahedron, halving
/// with convex-hull tests (box, the direction of the centre, normals of the piece's faces) and
/// Newton from the pieces. `outside` is proven: the hulls of pieces that cover all lambda >=
/// -tolerance miss p by more than the rounding; `not_converged`: 90 halvings or 4000 pieces did not
/// decide, p lies within rounding of the boundary or in a place where the map is singular. For maps
/// that are not one to one any preimage may be found.
///
/// @param p          finite
/// @param tolerance  how far below 0 a barycentric may be, dimensionless, in [0, 1)
/// @accuracy residual within a few u of the control points' distance to p
/// @cost     inside: 0.14, 0.3 and 0.6 us at g = 1, 2, 3; outside but in the box: 0.4,
/// 1.8 and 3.5 us at a distance of 0.05 from a face, more when closer
[[nodiscard]] TetrahedronLocation locate(int g, std::span<const Vec3> control, const Vec3& p,
                                         double tolerance = 1e-12);

/// What `invert` found.
struct TetrahedronInverse {
  Lambda4 lambda;  ///< sums to 1, not clamped
  bool converged;  ///< the last step was below 4e-9 (the error is its square), or the residual is
                   ///< at rounding
};
/// Newton from a start, damped when the residual grows; also converges to points somewhat outside
/// the tetrahedron. For inner loops: arguments are NOT checked, and differences of control points
/// between 1e-100 and 1e100 are expected (locate takes any).
///
/// @param g, control  1 <= g <= 7, tetrahedron_size(g) finite points
/// @cost     70, 180 and 380 ns at g = 1, 2, 3; at most 60 evaluations; no allocation
[[nodiscard]] TetrahedronInverse invert(int g, std::span<const Vec3> control, const Vec3& p,
                                        const Lambda4& start);

/// Signed volume (positive for valid maps), exact up to rounding: the integral of the determinant,
/// from differences of control points only, so a tetrahedron far from the origin loses nothing.
/// @accuracy within 2 u |volume| + (2 tetrahedron_size(g-1) + 13) u g^3 h^3, h as in
/// jacobian_determinant
double volume(int g, std::span<const Vec3> control);

}  // namespace bezel
