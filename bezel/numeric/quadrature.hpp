#pragma once
// Quadrature rules on [0, 1] and on the reference triangle.

#include <array>
#include <vector>

namespace bezel {

/// A rule on [0, 1]: sum of weight[q] f(node[q]) approximates the integral; weights sum to 1.
struct IntervalRule {
  std::vector<double> node, weight;
  int size() const { return static_cast<int>(node.size()); }
};

/// Gauss-Legendre with n >= 1 points (n <= 200), exact to degree 2n-1; nodes ascending.
IntervalRule gauss_legendre(int n);
/// Gauss-Lobatto with n >= 2 points (n <= 200), exact to degree 2n-3; nodes ascending, end points
/// included.
IntervalRule gauss_lobatto(int n);

/// A rule on the reference triangle {u, v >= 0, u + v <= 1}; weights sum to 1/2 (its area).
struct TriangleRule {
  std::vector<std::array<double, 3>> lambda;  ///< barycentric nodes (1-u-v, u, v), all > 0
  std::vector<double> weight;                 ///< all > 0
  int size() const { return static_cast<int>(weight.size()); }
};

/// A rule exact for all polynomials of total degree <= degree, 0 <= degree <= 80, with positive
/// weights and interior points.
TriangleRule triangle_rule(int degree);

}  // namespace bezel
