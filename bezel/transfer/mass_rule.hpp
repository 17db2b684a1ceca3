#pragma once
// Internal: mass matrices of curved elements by quadrature, and their Cholesky factors.

#include <array>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel::detail {

/// Quadrature on the reference triangle with the basis functions of a map at the points.
struct MassRule {
  int degree;                                ///< exact for polynomials up to this
  std::vector<std::array<double, 2>> place;  ///< barycentrics 1 and 2 of the points
  std::vector<double> weight;
  std::vector<std::array<double, 3>>
      map;  ///< value, d/du, d/dv of each geometry basis function, point by point
};

/// @param geometric_degree  of the elements, 1..10
MassRule make_mass_rule(int geometric_degree, int degree);

/// A point of an element's map and its Jacobian.
struct MassPoint {
  Vec2 x;
  double det;
};
/// The map of the element with these control points at point q of the rule.
inline MassPoint mass_point(const MassRule& rule, std::span<const Vec2> control, std::size_t q) {
  const std::array<double, 3>* map = rule.map.data() + q * control.size();
  Vec2 x;
  Vec2 du;
  Vec2 dv;
  for (std::size_t i = 0; i < control.size(); ++i) {
    x += control[i] * map[i][0];
    du += control[i] * map[i][1];
    dv += control[i] * map[i][2];
  }
  return {x, cross(du, dv)};
}

/// Mass matrices of mapped polynomials, exactly: the Jacobian determinant is a polynomial too.
struct MappedMass {
  MappedMass(int with_geometric_degree, int with_degree);
  int geometric_degree, degree;
  std::size_t size;               ///< basis functions
  std::vector<double> integrals;  ///< [function of the determinant][function]
  std::vector<double> products;   ///< [function of the determinant][i, j <= i, row by row]
  /// @param control   of the element
  /// @param mass      out, lower triangle of (size x size)
  /// @param integral  out, of each basis function
  void compute(std::span<const Vec2> control, std::span<double> mass,
               std::span<double> integral) const;
  /// The same from jacobian_determinant().
  void compute_from(std::span<const double> jacobian, std::span<double> mass,
                    std::span<double> integral) const;
  /// The same from the determinant's coefficients times their multinomials.
  void add_up(std::span<const double> det, std::span<double> mass,
              std::span<double> integral) const;
};

/// Replaces the lower triangle of a matrix (n x n, row major) by its Cholesky factor; false when
/// the matrix is not positive definite in double precision.
bool cholesky(std::size_t n, std::span<double> lower);

}  // namespace bezel::detail
