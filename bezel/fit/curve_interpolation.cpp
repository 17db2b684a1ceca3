#include "bezel/fit/curve_interpolation.hpp"

#include <fmt/format.h>

#include "bezel/base/error.hpp"
#include "bezel/fit/curve_l2.hpp"
#include "bezel/fit/curve_ladder.hpp"

namespace bezel {
namespace {

using curve_search::arc_length_nodes;
using curve_search::climb;
using curve_search::Effort;
using curve_search::Found;
using curve_search::GraphError;
using curve_search::minimise_distance;
using curve_search::Nodes;
using curve_search::Problem;
using curve_search::projected_nodes;
using curve_search::Projection;
using curve_search::Quick;
using curve_search::quick_climb;
using curve_search::tangent_residual;

void check_degree(int degree, int largest) {
  if (degree < 1 || degree > largest)
    throw InputError(fmt::format("curve degree {}, expected 1 to {}", degree, largest));
}

template <int dim>
CurveNodes searched(const Problem<dim>& problem, int degree, CurveMethod method,
                    Nodes<dim>& nodes) {
  constexpr double rounding = 1e-14, far_behind = 50.0;
  constexpr int l2_iterations = 60, distance_iterations = 100;
  CurveNodes out;
  Effort effort;
  Found<dim> best, root;
  const Quick<dim> quick = quick_climb(problem, degree, effort);
  if (method == CurveMethod::equal_tangent ? quick.good : converges(problem, quick)) {
    best = root = quick.found;
    if (method != CurveMethod::equal_tangent) polish(problem, best, effort);
  } else {
    climb(problem, degree, quick, best, root, effort);
  }
  switch (method) {
    case CurveMethod::equal_tangent:
      // Nodes exact to rounding solve the equations to rounding. Roots far behind the best nodes
      // are no answer: at an inflection all roots of an even degree may be bad.
      if (!(best.score.valid && best.score.d2 < rounding * problem.length)) {
        if (root.score.valid && root.score.d2 <= far_behind * best.score.d2)
          best = root;
        else
          out.status = CurveStatus::not_converged;
      }
      break;
    case CurveMethod::orthogonal_distance:
      effort.distance +=
          minimise_distance(problem, best.nodes, best.score, {.most = distance_iterations});
      best.kind = CurveKind::orthogonal_distance;
      break;
    case CurveMethod::l2:
      effort.distance += GraphError<dim>(problem, degree).minimise(best.nodes, l2_iterations);
      best.kind = CurveKind::placed;
      break;
    default:
      break;
  }
  nodes = best.nodes;
  out.kind = degree == 1 ? CurveKind::placed : best.kind;
  out.newton_iterations = effort.newton;
  out.distance_iterations = effort.distance;
  return out;
}

}  // namespace

std::string_view name(CurveMethod method) {
  switch (method) {
    case CurveMethod::standard:
      return "standard";
    case CurveMethod::chord:
      return "chord";
    case CurveMethod::arc_length:
      return "arc-length";
    case CurveMethod::l2:
      return "l2";
    case CurveMethod::equal_tangent:
      return "equal-tangent";
    case CurveMethod::orthogonal_distance:
      return "orthogonal-distance";
    case CurveMethod::best:
      return "best";
  }
  return "unknown";
}

std::string_view name(CurveStatus status) {
  switch (status) {
    case CurveStatus::ok:
      return "ok";
    case CurveStatus::not_a_graph:
      return "not a graph over x";
    case CurveStatus::not_a_chord_map:
      return "not monotone along its chord";
    case CurveStatus::closed:
      return "closed";
    case CurveStatus::not_converged:
      return "not converged";
  }
  return "unknown";
}

std::string_view name(CurveKind kind) {
  switch (kind) {
    case CurveKind::placed:
      return "placed";
    case CurveKind::equal_tangent:
      return "equal tangent";
    case CurveKind::orthogonal_distance:
      return "orthogonal distance";
  }
  return "unknown";
}

CurveInterpolator::CurveInterpolator(int max_degree) {
  check_degree(max_degree, max_curve_degree);
  tables_ = std::make_unique<const Tables>(max_degree);
}
CurveInterpolator::~CurveInterpolator() = default;
CurveInterpolator::CurveInterpolator(CurveInterpolator&&) noexcept = default;
CurveInterpolator& CurveInterpolator::operator=(CurveInterpolator&&) noexcept = default;
int CurveInterpolator::max_degree() const {
  return static_cast<int>(tables_->rungs.size());
}

template <int dim>
CurveNodes CurveInterpolator::place(const SmoothCurve<dim>& curve, int degree,
                                    CurveMethod method) const {
  check_degree(degree, max_degree());
  const Problem<dim> problem(curve, *tables_);
  CurveNodes out;
  Nodes<dim> nodes;
  switch (method) {
    case CurveMethod::standard:
    case CurveMethod::chord:
      out.status = projected_nodes(problem, degree, method, nodes);
      if (out.status != CurveStatus::ok) return out;
      break;
    case CurveMethod::arc_length:
      nodes = arc_length_nodes(problem, degree);
      break;
    case CurveMethod::l2:
      if (!Projection<dim>::onto_x(curve).monotone()) {
        out.status = CurveStatus::not_a_graph;
        return out;
      }
      [[fallthrough]];
    default:
      out = searched(problem, degree, method, nodes);
  }
  out.residual = degree == 1 ? 0.0 : tangent_residual(problem, nodes);
  out.t.assign(nodes.t.begin(), nodes.t.begin() + degree + 1);
  return out;
}

template <int dim>
CurveInterpolant<dim> CurveInterpolator::interpolate(const SmoothCurve<dim>& curve, int degree,
                                                     CurveMethod method) const {
  CurveInterpolant<dim> out;
  out.nodes = place(curve, degree, method);
  if (out.nodes.t.empty()) return out;
  for (const double t : out.nodes.t) out.nodal.push_back(curve(t).x);
  const std::span<const Vec<dim>> nodal(out.nodal);
  out.control = tables_->rung(degree).basis.to_bernstein(nodal);
  out.errors = errors(curve, nodal);
  return out;
}

template <int dim>
CurveInterpolant<dim> interpolate_curve(const SmoothCurve<dim>& curve, int degree,
                                        CurveMethod method) {
  check_degree(degree, max_curve_degree);
  return CurveInterpolator(degree).interpolate(curve, degree, method);
}

template CurveNodes CurveInterpolator::place(const SmoothCurve<2>&, int, CurveMethod) const;
template CurveNodes CurveInterpolator::place(const SmoothCurve<3>&, int, CurveMethod) const;
template CurveInterpolant<2> CurveInterpolator::interpolate(const SmoothCurve<2>&, int,
                                                            CurveMethod) const;
template CurveInterpolant<3> CurveInterpolator::interpolate(const SmoothCurve<3>&, int,
                                                            CurveMethod) const;
template CurveInterpolant<2> interpolate_curve(const SmoothCurve<2>&, int, CurveMethod);
template CurveInterpolant<3> interpolate_curve(const SmoothCurve<3>&, int, CurveMethod);

}  // namespace bezel
