#pragma once
// Internal: weighted mass matrices of single elements, in the basis the space stores.

#include <memory>
#include <span>
#include <vector>

#include "bezel/field/space.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel::detail {

/// Mass matrices of the elements of a space; the weight, if any, is a polynomial of one degree in
/// the element's reference coordinates.
class ElementMass {
 public:
  explicit ElementMass(std::shared_ptr<const Space> space, int weight_degree = 0);

  struct Matrices {
    std::vector<double> mass;       ///< [n][n]: integrals of w phi_n phi_m
    std::vector<double> integrals;  ///< integrals of w phi_n
  };
  /// @param weight  Bernstein coefficients in reference coordinates; empty: 1
  void compute(ElementId e, std::span<const double> weight, Matrices& out) const;

  /// Replaces columns of right-hand sides, [n][column], by the solutions.
  /// @return false when the matrix is not positive definite
  static bool solve(const Matrices& system, std::size_t columns, std::span<double> rhs);

 private:
  std::shared_ptr<const Space> space_;
  int weight_degree_;
  std::vector<TriangleRule> rule_;  // per degree of the space
};

}  // namespace bezel::detail
