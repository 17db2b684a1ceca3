#pragma once
// Lagrange polynomials at the Gauss-Lobatto-Legendre (GLL) points of [-1, 1].

#include <cstddef>
#include <span>
#include <vector>

#include "bezel/numeric/vec.hpp"

namespace bezel {

/// The GLL points xi_0 = -1 < ... < xi_d = 1 of one degree d, and what one does with values there.
class LobattoBasis {
 public:
  /// @throws   InputError unless 1 <= degree <= 100
  explicit LobattoBasis(int degree);

  int degree() const { return degree_; }
  std::span<const double> nodes() const { return node_; }
  std::span<const double> weights() const { return weight_; }  ///< GLL quadrature on [-1, 1]
  /// w_j = 1 / P_d(xi_j), up to a common factor the barycentric weights.
  std::span<const double> barycentric_weights() const { return barycentric_; }
  /// l_k'(xi_i). Row sums are zero to rounding: the diagonal is minus the sum of the rest.
  double derivative(int i, int k) const { return matrix_[row(i) + static_cast<std::size_t>(k)]; }
  /// The same row by row, (d+1)^2 numbers.
  std::span<const double> derivative_matrix() const { return matrix_; }

  /// l_k(xi) for k = 0..d. @param xi dimensionless; outside [-1, 1] it extrapolates
  /// @param out  d + 1 numbers
  /// @accuracy each within 4 d u of the largest, for xi in [-1, 1]
  void values(double xi, std::span<double> out) const;
  /// l_k'(xi) for k = 0..d. @param out d + 1 numbers
  void derivatives(double xi, std::span<double> out) const;

  /// The interpolant of nodal values at xi. @param nodal d + 1 points
  template <int dim>
  Vec<dim> evaluate(std::span<const Vec<dim>> nodal, double xi) const;
  /// Its derivative with respect to xi.
  template <int dim>
  Vec<dim> derivative(std::span<const Vec<dim>> nodal, double xi) const;

  /// Bernstein coefficients on [0, 1], s = (1 + xi) / 2, of the interpolant of nodal values.
  ///
  /// @param nodal  d + 1 points, finite
  /// @throws   InputError when their number is not d + 1
  /// @accuracy computed in double-double: rounded correctly but for 1e-20 of the largest value
  ///           (degree 30). The map itself magnifies an error of the values by up to 0.4 2^d;
  ///           the curve evaluated from the coefficients does not
  /// @cost     5 us at degree 10, 35 us at degree 30, per coordinate
  /// @source   docs/methods/curves.md
  template <int dim>
  std::vector<Vec<dim>> to_bernstein(std::span<const Vec<dim>> nodal) const;

 private:
  std::size_t row(int i) const {
    return static_cast<std::size_t>(i) * static_cast<std::size_t>(degree_ + 1);
  }
  int degree_;
  std::vector<double> node_, weight_, barycentric_, matrix_;
};

}  // namespace bezel
