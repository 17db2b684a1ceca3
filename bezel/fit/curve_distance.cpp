// Least squares for the normal distance of an interpolant to its curve.

#include <numbers>

#include "bezel/fit/curve_search.hpp"

namespace bezel::curve_search {
using small::Vector;

namespace {

// Where to look for the foot of the a-th point: the interpolant of the parameters there, if it is
// between the parameters of the nodes beside it. Calls in ascending order of a.
template <int dim>
class Start {
 public:
  Start(const CurveRung& rung, const Nodes<dim>& nodes) : rung_(rung), nodes_(nodes) {}
  double operator()(int a) {
    const auto xi = rung_.basis.nodes();
    const double x = rung_.xi[std::size_t(a)];
    while (x > xi[k_ + 1]) ++k_;
    const double t0 = nodes_.t[k_], t1 = nodes_.t[k_ + 1];
    double guess = 0.0;
    for (int k = 0; k <= nodes_.n; ++k) guess += rung_.value_row(a)[k] * nodes_.t[std::size_t(k)];
    if (guess >= t0 && guess <= t1) return guess;
    return t0 + (t1 - t0) * ((x - xi[k_]) / (xi[k_ + 1] - xi[k_]));
  }

 private:
  const CurveRung& rung_;
  const Nodes<dim>& nodes_;
  std::size_t k_ = 0;
};

}  // namespace

template <int dim>
Score<dim> measure(const Problem<dim>& problem, const Nodes<dim>& nodes, const Score<dim>* guess) {
  const CurveRung& rung = problem.tables.rung(nodes.n);
  Start<dim> start(rung, nodes);
  Score<dim> score;
  double sum = 0.0, furthest = -1.0;
  int slowest = 0;
  for (int a = 0; a < rung.m; ++a) {
    const double x = rung.xi[std::size_t(a)];
    const Vec<dim> p = combine(rung.value_row(a), nodes);
    const double speed = norm(combine(rung.slope_row(a), nodes));
    const Foot<dim> f = foot(problem.curve, p, guess ? guess->foot[std::size_t(a)].s : start(a));
    score.foot[std::size_t(a)] = f;
    const double distance_squared = dot(f.e, f.e);
    sum += rung.weight[std::size_t(a)] * speed * distance_squared;
    score.speed[std::size_t(a)] = speed;
    if (speed < score.speed[std::size_t(slowest)]) slowest = a;
    if (distance_squared > furthest) {
      furthest = distance_squared;
      score.far_xi = x;
    }
  }
  // The least speed lies between points: the vertex of the parabola in the angle through three.
  double vertex = slowest + 0.5;
  if (slowest > 0 && slowest + 1 < rung.m) {
    const double* v = score.speed.data() + slowest;
    const double bend = v[-1] - 2.0 * v[0] + v[1];
    if (bend > 0.0) vertex += 0.5 * (v[-1] - v[1]) / bend;
  }
  score.slow_xi = -std::cos(vertex * std::numbers::pi / rung.m);
  score.d2 = std::isfinite(sum) ? std::sqrt(sum) : HUGE_VAL;
  score.min_speed = score.speed[std::size_t(slowest)] / (0.5 * problem.length);
  score.valid = nodes.ordered() && score.min_speed >= 1e-3 && std::isfinite(sum);
  return score;
}

template <int dim>
double rough_distance(const Problem<dim>& problem, const Nodes<dim>& nodes) {
  const CurveRung& rung = problem.tables.rung(nodes.n);
  Start<dim> start(rung, nodes);
  double sum = 0.0;
  for (int a = 1; a < rung.m; a += 4) {
    const Foot<dim> f = foot(problem.curve, combine(rung.value_row(a), nodes), start(a));
    sum += rung.weight[std::size_t(a)] * dot(f.e, f.e);
  }
  return std::sqrt(4.0 * 0.5 * problem.length * sum);
}

template <int dim>
int minimise_distance(const Problem<dim>& problem, Nodes<dim>& nodes, Score<dim>& score,
                      int iterations) {
  const CurveRung& rung = problem.tables.rung(nodes.n);
  const int size = nodes.n - 1;
  // |p'| is frozen in each step, and the derivative of a distance is exact: the foot moves along
  // the curve. In the plane the distance has a sign and gives one residual; in space the residual
  // is the vector normal to the curve.
  const auto build = [&](small::LeastSquares& squares, const Vector& unit) {
    for (int a = 0; a < rung.m; ++a) {
      const Vec<dim>& e = score.foot[std::size_t(a)].e;
      const Vec<dim>& tau = score.foot[std::size_t(a)].tangent;
      const double weight = std::sqrt(rung.weight[std::size_t(a)] * score.speed[std::size_t(a)]);
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
    const Score<dim> trial = measure(problem, next, &score);
    if (!trial.valid || (score.valid && !(trial.d2 < score.d2))) return 0.0;
    const double gain = score.valid ? (score.d2 - trial.d2) / score.d2 : 1.0;
    score = trial;
    return gain;
  };
  return levenberg_marquardt(problem, nodes, iterations, 1e-3, build, accept);
}

template Score<2> measure(const Problem<2>&, const Nodes<2>&, const Score<2>*);
template Score<3> measure(const Problem<3>&, const Nodes<3>&, const Score<3>*);
template double rough_distance(const Problem<2>&, const Nodes<2>&);
template double rough_distance(const Problem<3>&, const Nodes<3>&);
template int minimise_distance(const Problem<2>&, Nodes<2>&, Score<2>&, int);
template int minimise_distance(const Problem<3>&, Nodes<3>&, Score<3>&, int);

}  // namespace bezel::curve_search
