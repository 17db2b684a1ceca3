#pragma once
// Internal: integrals of f m over regions, m the monomials, where f is no polynomial in the
// coordinates of the region, or one of another degree: f is interpolated in a box around the
// region, and the moments of the region do the rest.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "bezel/numeric/lanes.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::detail {

inline constexpr int max_fit_degree = 12;
inline constexpr int max_fit_moments = 23;
inline constexpr int max_fit_map = 10;  ///< degree of a map

/// Rows of monomials: x^a y^b at [b * fit_stride(degree) + a].
inline constexpr std::size_t fit_stride(int degree) {
  return padded_to_lanes(static_cast<std::size_t>(degree) + 1);
}
inline constexpr std::size_t fit_rows(int degree) {
  return static_cast<std::size_t>(degree + 1) * fit_stride(degree);
}

/// Interpolation by polynomials of a total degree at the Padua points of the square [-1, 1]^2.
struct FitTable {
  explicit FitTable(int with_degree);
  int degree;
  std::size_t count, padded;      ///< points
  std::size_t terms;              ///< coefficients, padded
  std::vector<double> x, y;       ///< the padding repeats the last point
  std::vector<double> chebyshev;  ///< [point][term]: coefficients of T_a(x) T_b(y), in the order of
                                  ///< triangle_index(degree, a, b), of the function that is 1 at
                                  ///< the point
  std::size_t high = 0;
  std::vector<double> tails;  ///< [point][high]: of those the two highest degrees' and degree 1's
};
/// @param degree 0 .. max_fit_degree
const FitTable& fit_table(int degree);

/// A map of the reference triangle (or of any plane) to the plane as monomials about a centre:
/// base + sum of (x, y)[a, b] (u - centre)^a (v - centre)^b, in the order of triangle_index(degree,
/// a, b).
struct MapPolynomial {
  int degree = 1;
  double centre = 0.0;
  Vec2 base;
  std::vector<double> x, y;
  MapPolynomial() = default;
  MapPolynomial(int with_degree, std::span<const Vec2> control) { set(with_degree, control); }
  /// The map of a triangle with these control points, about its centroid.
  void set(int with_degree, std::span<const Vec2> control);
  /// base + first u + second v.
  void set_affine(const Vec2& at, const Vec2& first, const Vec2& second);
};

/// Points of curves and derivatives times weights.
struct CurvePoints {
  std::vector<double> x, y, dx, dy;
  std::size_t count = 0;
  void clear() { count = 0; }
  /// Appends n points, with room for a block more; returns the place of the first.
  std::size_t append(std::size_t n);
};

/// A box with the region in it: x = centre + half * (number in [-1, 1]).
struct FitFrame {
  std::array<double, 2> centre, half;
};

/// x, y of the map at blocks of points; det, unless null, becomes its Jacobian determinant.
void fit_map(const MapPolynomial& map, std::size_t blocks, const double* u, const double* v,
             double* x, double* y, double* det);

/// The points' places under a map, by Newton's method from the affine map at its centre.
/// @param u, v    out
/// @param dx, dy  in: derivatives in the plane, out: the same in the map's coordinates; or null
/// @return false when it does not converge
bool fit_invert(const MapPolynomial& map, std::size_t blocks, const double* x, const double* y,
                double* u, double* v, double* dx, double* dy);

/// Gauss points of a part of a Bezier curve, from - origin, whole blocks: curve parameters from +
/// step * node, derivatives times step * weight.
void fit_curve(std::span<const Vec2> control, const Vec2& origin, double from, double step,
               std::size_t blocks, const double* node, const double* weight, double* x, double* y,
               double* dx, double* dy);

/// The box of the points.
FitFrame fit_frame(const CurvePoints& boundary);

/// Moments up to a degree of the region with this boundary in the coordinates of a frame, in rows;
/// boundary.count points, padded to a whole block by points with dx = dy = 0.
void fit_moments(int degree, const CurvePoints& boundary, const FitFrame& frame, double* moments);

/// values[c * padded + q] = f_c at point q less mean[c], f_c = sum_n scaled[c * size + n] times the
/// powers of the barycentrics (1-u-v, u, v).
void fit_values(int degree, int components, const double* scaled, const double* mean,
                std::size_t padded, const double* u, const double* v, double* values);

/// terms[c * table.terms + n]: coefficients of the interpolants, of monomials in the order of
/// triangle_index(degree, a, b). By way of Chebyshev polynomials, whose coefficients lose nothing
/// and are small where the powers' factors are large.
void fit_interpolate(const FitTable& table, int components, const double* values, double* terms);

/// How much of two functions is in their highest degrees, beside their linear parts: the sizes of
/// the Chebyshev coefficients of the highest degree and of the one below over those of degree 1.
/// @param u, v  [point] of a table of degree 2 or more
std::array<double, 2> fit_tails(const FitTable& table, const double* u, const double* v);

/// sums[c * fit_rows(degree) ...] (rows) += integral of f_c m for the monomials m up to `degree` in
/// coordinates about a centre, over a region whose moments in a frame (up to table.degree + degree)
/// and interpolants there are given. The last component is the constant 1, without terms.
void fit_add(const FitTable& table, int degree, int components, const double* terms,
             const double* moments, const FitFrame& frame, const std::array<double, 2>& centre,
             double* sums);

/// products[i, j <= i, row by row] = sum of w psi_i psi_j over the points, integrals[i] = sum of
/// w psi_i, psi the powers of the barycentrics (1-u-v, u, v) of a degree.
/// @param degree 0 .. 10
void fit_products(int degree, std::size_t padded, const double* weight, const double* u,
                  const double* v, double* products, double* integrals);

/// sum over the rows of a . b; both of the same degree.
double fit_dot(int degree, const double* a, const double* b);

}  // namespace bezel::detail
