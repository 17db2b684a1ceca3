#pragma once
// Error (4) of an interpolant over x, and the nodes that minimise it.

#include <span>
#include <vector>

#include "bezel/fit/curve_projection.hpp"
#include "bezel/fit/curve_search.hpp"

namespace bezel::curve_search {

/// The curve as a graph over x, sampled for one degree n: points x_a of the GLL rule with 3n + 1
/// points on its x range, and what the curve is there.
template <int dim>
class GraphError {
 public:
  /// @param n  degree of the interpolants
  GraphError(const Problem<dim>& problem, int n);
  /// x is monotone; otherwise nothing else may be called.
  bool is_graph() const { return projection_.monotone(); }

  struct Value {
    double l2;
    bool monotone;            ///< x_N grows strictly
    std::vector<double> eta;  ///< x_N(eta_a) = x_a
  };
  /// @param nodal  n + 1 points whose ends have the x of the curve's ends
  Value evaluate(std::span<const Vec<dim>> nodal) const;
  /// Nodes with least error (4), from `nodes`, never losing a monotone x_N. @return iterations
  int minimise(Nodes<dim>& nodes, int iterations) const;

 private:
  const Problem<dim>& problem_;
  const CurveRung& rung_;
  Projection<dim> projection_;
  std::vector<double> x_, weight_;  // weight includes half the width
  std::vector<Vec<dim>> point_;
};

}  // namespace bezel::curve_search
