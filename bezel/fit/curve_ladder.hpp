#pragma once
// The search for the best nodes, degree by degree.

#include "bezel/fit/curve_search.hpp"

namespace bezel::curve_search {

/// Nodes found for one degree.
template <int dim>
struct Found {
  Nodes<dim> nodes;
  Score<dim> score;
  CurveKind kind = CurveKind::orthogonal_distance;
};
struct Effort {
  int newton = 0, distance = 0;
};

/// Equal-tangent nodes by Newton from degree to degree, unscored on the way.
template <int dim>
struct Quick {
  bool good = false;        ///< found, and nearer than the degrees before promise
  Found<dim> found;         ///< of the degree asked for
  Nodes<dim> last, before;  ///< of the two degrees before; n < 1 when there are none
};
template <int dim>
Quick<dim> quick_climb(const Problem<dim>& problem, int degree, Effort& effort);
/// The curve is resolved and the distances fall steadily: no other nodes will be much better.
template <int dim>
bool converges(const Problem<dim>& problem, const Quick<dim>& quick);
/// Least distance from nodes found.
template <int dim>
void polish(const Problem<dim>& problem, Found<dim>& found, Effort& effort);

/// The best nodes of a degree, and the best equal-tangent root seen (its score invalid when none).
template <int dim>
void climb(const Problem<dim>& problem, int degree, const Quick<dim>& quick, Found<dim>& best,
           Found<dim>& root, Effort& effort);

/// xi_j -> s = L (xi_j + 1) / 2.
template <int dim>
Nodes<dim> arc_length_nodes(const Problem<dim>& problem, int degree);
/// Coordinate along a direction affine in xi_j.
template <int dim>
CurveStatus projected_nodes(const Problem<dim>& problem, int degree, CurveMethod method,
                            Nodes<dim>& nodes);

}  // namespace bezel::curve_search
