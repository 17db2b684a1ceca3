// Least squares for the normal distance of an interpolant to its curve.

#include "bezel/fit/curve_search.hpp"

namespace bezel::curve_search {
using small::Vector;

template <int dim>
Score measure(const Problem<dim>& problem, const Nodes<dim>& nodes, const Score* guess) {
  const CurveRung& rung = problem.tables.rung(nodes.n);
  const auto xi = rung.basis.nodes();
  Score score;
  double sum = 0.0, slowest = HUGE_VAL;
  for (int a = 0, k = 0; a < rung.m; ++a) {
    const double x = rung.xi[std::size_t(a)];
    const Vec<dim> p = combine(rung.value_row(a), nodes);
    const Vec<dim> slope = combine(rung.slope_row(a), nodes);
    double start;
    if (guess) {
      start = guess->foot[std::size_t(a)];
    } else {
      while (x > xi[std::size_t(k) + 1]) ++k;
      const double part = (x - xi[std::size_t(k)]) / (xi[std::size_t(k) + 1] - xi[std::size_t(k)]);
      start =
          nodes.t[std::size_t(k)] + part * (nodes.t[std::size_t(k) + 1] - nodes.t[std::size_t(k)]);
    }
    const Foot<dim> f = foot(problem.curve, p, start);
    const double speed = norm(slope);
    slowest = std::min(slowest, speed);
    score.foot[std::size_t(a)] = f.s;
    sum += rung.weight[std::size_t(a)] * speed * dot(f.e, f.e);
  }
  score.d2 = std::isfinite(sum) ? std::sqrt(sum) : HUGE_VAL;
  score.min_speed = slowest / (0.5 * problem.length);
  score.valid = nodes.ordered() && score.min_speed >= 1e-3 && std::isfinite(sum);
  return score;
}

template <int dim>
int minimise_distance(const Problem<dim>& problem, Nodes<dim>& nodes, Score& score,
                      int iterations) {
  const CurveRung& rung = problem.tables.rung(nodes.n);
  const int size = nodes.n - 1;
  // |p'| is frozen in each step, and the derivative of a distance is exact: the foot moves along
  // the curve. In the plane the distance has a sign and gives one residual; in space the residual
  // is the vector normal to the curve.
  const auto build = [&](small::LeastSquares& squares, const Vector& unit) {
    for (int a = 0; a < rung.m; ++a) {
      const Vec<dim> p = combine(rung.value_row(a), nodes);
      const Vec<dim> slope = combine(rung.slope_row(a), nodes);
      const CurveJet<dim> at = problem.curve(score.foot[std::size_t(a)]);
      const Vec<dim> e = p - at.x;
      const Vec<dim> tau = (1.0 / norm(at.d1)) * at.d1;
      const double weight = std::sqrt(rung.weight[std::size_t(a)] * norm(slope));
      const double* l = rung.value_row(a) + 1;
      Vector row;
      if constexpr (dim == 2) {
        for (int k = 0; k < size; ++k)
          row[std::size_t(k)] =
              l[k] * unit[std::size_t(k)] * cross(tau, nodes.g[std::size_t(k) + 1].d1);
        squares.add(weight, row.data(), -cross(tau, e));
      } else {
        const Vec<dim> across = e - dot(e, tau) * tau;
        for (int c = 0; c < dim; ++c) {
          for (int k = 0; k < size; ++k) {
            const Vec<dim>& d1 = nodes.g[std::size_t(k) + 1].d1;
            row[std::size_t(k)] = l[k] * unit[std::size_t(k)] * (d1[c] - dot(d1, tau) * tau[c]);
          }
          squares.add(weight, row.data(), -across[c]);
        }
      }
    }
  };
  const auto accept = [&](const Nodes<dim>& next) {
    const Score trial = measure(problem, next, &score);
    if (!trial.valid || (score.valid && !(trial.d2 < score.d2))) return 0.0;
    const double gain = score.valid ? (score.d2 - trial.d2) / score.d2 : 1.0;
    score = trial;
    return gain;
  };
  return levenberg_marquardt(problem, nodes, iterations, 1e-3, build, accept);
}

template Score measure(const Problem<2>&, const Nodes<2>&, const Score*);
template Score measure(const Problem<3>&, const Nodes<3>&, const Score*);
template int minimise_distance(const Problem<2>&, Nodes<2>&, Score&, int);
template int minimise_distance(const Problem<3>&, Nodes<3>&, Score&, int);

}  // namespace bezel::curve_search
