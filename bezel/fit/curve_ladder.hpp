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

/// Equal-tangent nodes by Newton from degree to degree, unscored on the way. False when a degree
/// fails or the last one's distance did not fall as it should: then climb() has to look closer.
template <int dim>
bool quick_climb(const Problem<dim>& problem, int degree, Found<dim>& found, Effort& effort);

/// The best nodes of a degree, and the best equal-tangent root seen (its score invalid when none).
template <int dim>
void climb(const Problem<dim>& problem, int degree, Found<dim>& best, Found<dim>& root,
           Effort& effort);

/// xi_j -> s = L (xi_j + 1) / 2.
template <int dim>
Nodes<dim> arc_length_nodes(const Problem<dim>& problem, int degree);
/// Coordinate along a direction affine in xi_j.
template <int dim>
CurveStatus projected_nodes(const Problem<dim>& problem, int degree, CurveMethod method,
                            Nodes<dim>& nodes);

}  // namespace bezel::curve_search
