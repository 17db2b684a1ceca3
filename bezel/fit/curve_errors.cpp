// Errors of an interpolant, as reported.

#include <fmt/format.h>

#include <numbers>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/fit/curve_l2.hpp"

namespace bezel {
namespace {

// p and p' at one point, from the values of both at the nodes.
template <int dim>
struct Interpolant {
  const LobattoBasis& basis;
  std::span<const Vec<dim>> nodal;
  std::vector<Vec<dim>> slope;

  Interpolant(const CurveRung& rung, std::span<const Vec<dim>> values)
      : basis(rung.basis), nodal(values), slope(values.size()) {
    for (int i = 0; i <= rung.n; ++i)
      for (int k = 0; k <= rung.n; ++k)
        slope[std::size_t(i)] += rung.d_row(i)[k] * nodal[std::size_t(k)];
  }
  Vec<dim> point(double xi) const { return basis.evaluate(nodal, xi); }
  Vec<dim> derivative(double xi) const {
    return basis.evaluate(std::span<const Vec<dim>>(slope), xi);
  }
};

template <int dim>
int checked_degree(std::span<const Vec<dim>> nodal, int max_degree) {
  const int n = static_cast<int>(nodal.size()) - 1;
  if (n < 1 || n > max_degree)
    throw InputError(fmt::format("found {} nodal values of a curve, expected 2 to {}", nodal.size(),
                                 max_degree + 1));
  for (const Vec<dim>& v : nodal)
    for (int c = 0; c < dim; ++c)
      if (!std::isfinite(v[c])) throw InputError("a nodal value of a curve is not finite");
  return n;
}

// Distance of q to the curve: the nearer of the foot that continues from the last one and the foot
// near the nearest sample.
template <int dim>
double distance(const SmoothCurve<dim>& curve, const Vec<dim>& q, double& s) {
  const curve_search::Foot<dim> next = curve_search::foot(curve, q, s);
  s = next.s;
  double best = norm(next.e), nearest = HUGE_VAL, t = 0.0;
  for (const auto& sample : curve.samples()) {
    const Vec<dim> e = sample.x - q;
    if (const double d = dot(e, e); d < nearest) {
      nearest = d;
      t = sample.t;
    }
  }
  // A sample further away than the foot can still lie beside a nearer one, but not beside one that
  // is nearer by more than half the samples' spacing.
  if (best > 1e-6 * curve.length()) {
    const curve_search::Foot<dim> other = curve_search::foot(curve, q, t);
    if (norm(other.e) < best) {
      best = norm(other.e);
      s = other.s;
    }
  }
  return best;
}

}  // namespace

template <int dim>
CurveErrors CurveInterpolator::errors(const SmoothCurve<dim>& curve,
                                      std::span<const Vec<dim>> nodal) const {
  const int n = checked_degree(nodal, max_degree());
  const curve_search::Problem<dim> problem(curve, *tables_);
  const Interpolant<dim> p(tables_->rung(n), nodal);
  CurveErrors errors;
  double sum = 0.0, s = -1.0, slowest = HUGE_VAL;
  static const IntervalRule rule = gauss_lobatto(200);
  for (std::size_t a = 0; a < rule.node.size(); ++a) {
    const double xi = 2.0 * rule.node[a] - 1.0;
    const double speed = norm(p.derivative(xi));
    const double d = distance(curve, p.point(xi), s);
    sum += 2.0 * rule.weight[a] * speed * d * d;
    errors.distance_max = std::max(errors.distance_max, d);
    slowest = std::min(slowest, speed);
  }
  errors.distance_l2 = std::sqrt(sum);
  errors.min_speed = slowest / (0.5 * problem.length);

  constexpr int panels = 8;
  double length = 0.0;
  static const IntervalRule gauss = gauss_legendre(60);
  for (int i = 0; i < panels; ++i)
    for (std::size_t q = 0; q < gauss.node.size(); ++q)
      length += 2.0 / panels * gauss.weight[q] *
                norm(p.derivative(-1.0 + 2.0 * (i + gauss.node[q]) / panels));
  errors.arc_length = std::fabs(length - problem.length);

  const curve_search::GraphError<dim> graph(problem, n);
  if (graph.is_graph()) {
    const auto value = graph.evaluate(nodal);
    errors.l2 = value.l2;
    errors.monotone = value.monotone;
  } else {
    errors.l2 = -1.0;
  }
  return errors;
}

template <int dim>
double CurveInterpolator::largest_distance(const SmoothCurve<dim>& curve,
                                           std::span<const Vec<dim>> nodal) const {
  const CurveRung& rung = tables_->rung(checked_degree(nodal, max_degree()));
  // Distances of good interpolants have about 2 n humps: their tops are met within 2 percent.
  const int points = 8 * rung.n + 24;
  double largest = 0.0, s = -1.0;
  for (int a = 0; a < points; ++a) {
    const double xi = -std::cos((a + 0.5) * std::numbers::pi / points);
    largest = std::max(largest, distance(curve, rung.basis.evaluate(nodal, xi), s));
  }
  return largest;
}

template CurveErrors CurveInterpolator::errors(const SmoothCurve<2>&, std::span<const Vec2>) const;
template CurveErrors CurveInterpolator::errors(const SmoothCurve<3>&, std::span<const Vec3>) const;
template double CurveInterpolator::largest_distance(const SmoothCurve<2>&,
                                                    std::span<const Vec2>) const;
template double CurveInterpolator::largest_distance(const SmoothCurve<3>&,
                                                    std::span<const Vec3>) const;

}  // namespace bezel
