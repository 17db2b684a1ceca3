#pragma once
// Internal: weighted mass matrices and right-hand sides of single elements, in the basis that the
// space stores.

#include <memory>
#include <span>
#include <vector>

#include "bezel/field/field.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel::detail {

/// Integrals of products of a space's basis functions, a weight and another polynomial.
class ElementMass {
 public:
  /// @param other_degree   degree of the other polynomial in the space's own coordinates
  /// @param weight_degree  of the weight in reference coordinates
  explicit ElementMass(std::shared_ptr<const Space> space, int other_degree = 0,
                       int weight_degree = 0);

  /// One element with its quadrature; made anew for each element.
  struct Element {
    std::span<const Lambda> points;  ///< reference points of the rule
    std::vector<double> measure;     ///< weights of the rule in the plane, per point
    std::vector<double> basis;       ///< [point][n]
    std::vector<double> mass;        ///< [n][n]: integrals of w phi_n phi_m
    std::vector<double> integrals;   ///< integrals of w phi_n
  };
  void prepare(ElementId e, Element& out) const;
  /// @param weight  values at the points; empty: 1
  static void weigh(std::span<const double> weight, Element& out);
  /// Integrals of f phi_n, [n][column], f given at the points, [point][column].
  static void load(const Element& element, std::span<const double> f, std::span<double> out);
  /// Replaces columns of right-hand sides, [n][column], by the solutions with element.mass.
  /// @return false when the matrix is not positive definite
  static bool solve(const Element& element, std::span<double> rhs);

 private:
  std::shared_ptr<const Space> space_;
  std::vector<TriangleRule> rule_;  // per degree of the space
};

}  // namespace bezel::detail
