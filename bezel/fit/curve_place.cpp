// Nodes by formula: standard, chord, arc length.

#include "bezel/fit/curve_ladder.hpp"
#include "bezel/fit/curve_projection.hpp"

namespace bezel::curve_search {

template <int dim>
Nodes<dim> arc_length_nodes(const Problem<dim>& problem, int degree) {
  const auto xi = problem.tables.rung(degree).basis.nodes();
  Nodes<dim> nodes;
  nodes.n = degree;
  problem.set_ends(nodes);
  for (int i = 1; i < degree; ++i)
    nodes.place(problem.curve, i,
                problem.curve.at_length(0.5 * problem.length * (1.0 + xi[std::size_t(i)])));
  return nodes;
}

template <int dim>
CurveStatus projected_nodes(const Problem<dim>& problem, int degree, CurveMethod method,
                            Nodes<dim>& nodes) {
  Vec<dim> direction = problem.last.x - problem.first.x;
  const bool chord = method == CurveMethod::chord;
  if (chord) {
    const double size = norm(direction);
    if (!(size > 1e-12 * problem.length)) return CurveStatus::closed;
    direction *= 1.0 / size;
  }
  const Projection<dim> projection =
      chord ? Projection<dim>(problem.curve, direction) : Projection<dim>::onto_x(problem.curve);
  const CurveStatus refusal = chord ? CurveStatus::not_a_chord_map : CurveStatus::not_a_graph;
  if (!projection.monotone()) return refusal;
  const auto xi = problem.tables.rung(degree).basis.nodes();
  nodes.n = degree;
  problem.set_ends(nodes);
  for (int i = 1; i < degree; ++i)
    nodes.place(problem.curve, i,
                projection.parameter(0.5 * projection.span() * (1.0 + xi[std::size_t(i)])));
  return nodes.ordered() ? CurveStatus::ok : refusal;
}

template Nodes<2> arc_length_nodes(const Problem<2>&, int);
template Nodes<3> arc_length_nodes(const Problem<3>&, int);
template CurveStatus projected_nodes(const Problem<2>&, int, CurveMethod, Nodes<2>&);
template CurveStatus projected_nodes(const Problem<3>&, int, CurveMethod, Nodes<3>&);

}  // namespace bezel::curve_search
