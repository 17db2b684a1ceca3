#pragma once
// Internal: integrals over a region from its boundary, by Green's theorem.
//
// About a centre c the monomials m of degree k are homogeneous, so that the integral of m over a
// region is 1 / (k + 2) times the integral of m (x - c) x dx along its boundary: a polynomial in
// the parameter of each piece, exact with enough Gauss points. About the region's own middle
// nothing cancels, however small it is beside the elements.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bezel/field/space.hpp"
#include "bezel/numeric/vec.hpp"
#include "bezel/transfer/lanes.hpp"

namespace bezel::detail {

/// Highest field degree that is integrated by moments.
inline constexpr int max_moment_degree = 3;

/// Highest degree of power_matrix and powers_from_moments.
inline constexpr int max_power_degree = 10;

/// Gauss points on a Bezier piece, for all monomials up to a degree.
struct PieceTable {
  /// @param degree   of the piece, 1..10
  /// @param moments  highest degree of the monomials
  PieceTable(int degree, int moments);
  int degree, points;
  std::size_t stride;             ///< points, padded
  std::vector<double> parameter;  ///< [point]
  std::vector<double> weight;     ///< [point]
  std::vector<double> value;      ///< Bernstein polynomials, [function][point]
  std::vector<double> slope;      ///< their derivatives times the weights
};

struct MomentPiece {
  const Vec2* control;  ///< table->degree + 1 points, run counter-clockwise
  const PieceTable* table;
};

/// moments[triangle_index(degree, a, b)] = integral of x^a y^b over the region, a + b <= degree.
/// The same bits on every SIMD target.
/// @param degree  0 .. 2 max_moment_degree
void region_moments(int degree, std::span<const MomentPiece> pieces, double* moments);

/// How a region lies in the donor's and the target's coordinates (both measured from the centroid
/// of their triangles, in barycentrics 1 and 2).
struct RegionPlace {
  std::array<double, 2> in_donor;   ///< the region's centre
  std::array<double, 4> to_donor;   ///< donor coordinates = in_donor + to_donor * (x, y)
  std::array<double, 2> in_target;  ///< target coordinates = in_target + (x, y)
};

/// Adds the integrals of f m and m over a region, m the monomials in target coordinates:
///   product[n * components + c] += integral of f_c m_n, basis[n] += integral of m_n,
///   mass[c] = integral of f_c + base[c]; n in the order of triangle_index(degree, a, b),
/// where f is the donor's polynomial less the constant base[c].
/// @param moments  about the region's centre, up to degree 2 degree
/// @param donor    coefficients of the donor's monomials, [n][component]
void add_region(int degree, const RegionPlace& place, const double* moments, int components,
                const double* donor, const double* base, double* product, double* basis,
                double* mass);

/// weight[i, j] = integral of B_i B_j' - B_j B_i' over [0, 1], i < j in lexicographic order: the
/// sum of weight[i, j] cross(p_i, p_j) is twice the area between a curve and the rays to its ends.
const std::vector<double>& area_weights(int degree);

/// Row n: coefficients of l0^i l1^j l2^k (in index order) as a polynomial in x = l1 - 1/3, y = l2 -
/// 1/3.
const std::vector<double>& power_matrix(int degree);

}  // namespace bezel::detail
