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
/// Finds lambda with b(lambda) = p. tolerance: how far below 0 a barycentric may be
/// (dimensionless).
[[nodiscard]] LocateResult locate(int g, std::span<const Vec2> control, const Vec2& p,
                                  double tolerance = 1e-12);

/// Newton from a start; also converges to points somewhat outside the triangle (lambda not
/// clamped).
struct InverseResult {
  Lambda lambda;
  bool converged;
};
[[nodiscard]] InverseResult invert(int g, std::span<const Vec2> control, const Vec2& p,
                                   const Lambda& start);

double area(int g, std::span<const Vec2> control);
/// Integral of x^a y^b over the triangle, a + b <= 20, exact up to rounding.
double moment(int g, std::span<const Vec2> control, int a, int b);

}  // namespace bezel
