// Least squares for the normal distance of an interpolant to its curve.

#include <numbers>

#include "bezel/fit/curve_search.hpp"

namespace bezel::curve_search {
using small::Vector;

namespace {

// Where to look for the foot of each point: the interpolant of the parameters there, if it is
// between the parameters of the nodes beside it.
template <int dim>
void guess_feet(const CurveRung& rung, const Nodes<dim>& nodes, double* s) {
  small::combine(nodes.n + 1, rung.m, rung.value_columns.data(), nodes.t.data(), s);
  const auto xi = rung.basis.nodes();
  std::size_t k = 0;
  for (int a = 0; a < rung.m; ++a) {
    const double x = rung.xi[std::size_t(a)];
    while (x > xi[k + 1]) ++k;
    const double t0 = nodes.t[k], t1 = nodes.t[k + 1];
    if (!(s[a] >= t0 && s[a] <= t1)) s[a] = t0 + (t1 - t0) * ((x - xi[k]) / (xi[k + 1] - xi[k]));
  }
}

// Whether all nodes are within a small part of the gaps beside them.
template <int dim>
bool close(const Nodes<dim>& a, const Nodes<dim>& b) {
  for (std::size_t i = 1; i < std::size_t(a.n); ++i) {
    const double gap = std::min(a.t[i] - a.t[i - 1], a.t[i + 1] - a.t[i]);
    if (std::fabs(a.t[i] - b.t[i]) > 0.01 * gap) return false;
  }
  return true;
}

}  // namespace

template <int dim>
Score<dim> measure(const Problem<dim>& problem, const Nodes<dim>& nodes, const Score<dim>* guess) {
  using Row = typename Score<dim>::Row;
  const CurveRung& rung = problem.tables.rung(nodes.n);
  std::array<Row, dim> p, slope;
  for (std::size_t c = 0; c < dim; ++c) {
    const double* x = nodes.x[c].data();
    small::combine(nodes.n + 1, rung.m, rung.value_columns.data(), x, p[c].data());
    small::combine(nodes.n + 1, rung.m, rung.slope_columns.data(), x, slope[c].data());
  }
  Score<dim> score;
  score.points = rung.m;
  if (guess)
    std::copy(guess->s.begin(), guess->s.begin() + rung.m, score.s.begin());
  else
    guess_feet(rung, nodes, score.s.data());
  double sum = 0.0, length = 0.0, furthest = -1.0;
  std::size_t slowest = 0;
  for (std::size_t a = 0; a < std::size_t(rung.m); ++a) {
    Vec<dim> q;
    double speed_squared = 0.0;
    for (std::size_t c = 0; c < dim; ++c) {
      q.c[c] = p[c][a];
      speed_squared += slope[c][a] * slope[c][a];
    }
    const double speed = std::sqrt(speed_squared);
    const Foot<dim> f = foot(problem.curve, q, score.s[a]);
    score.s[a] = f.s;
    for (std::size_t c = 0; c < dim; ++c) {
      score.e[c][a] = f.e.c[c];
      score.tangent[c][a] = f.tangent.c[c];
    }
    double forwards = 0.0;
    for (std::size_t c = 0; c < dim; ++c) forwards += slope[c][a] * f.tangent.c[c];
    if (!(forwards > 0.0)) score.turns = true;
    const double distance_squared = dot(f.e, f.e);
    sum += rung.weight[a] * speed * distance_squared;
    length += rung.weight[a] * speed;
    score.speed[a] = speed;
    if (speed < score.speed[slowest]) slowest = a;
    if (distance_squared > furthest) {
      furthest = distance_squared;
      score.far_xi = rung.xi[a];
    }
  }
  constexpr double least_speed = 1e-3, least_length = 0.25;
  // The least speed lies between points: the vertex of the parabola in the angle through three, and
  // its value by that through their squares, since |p'|^2 is smooth.
  double vertex = double(slowest) + 0.5, least_squared = score.speed[slowest];
  least_squared *= least_squared;
  if (slowest > 0 && slowest + 1 < std::size_t(rung.m)) {
    const double* v = score.speed.data() + slowest;
    const double bend = v[-1] - 2.0 * v[0] + v[1];
    if (bend > 0.0) vertex += 0.5 * (v[-1] - v[1]) / bend;
    const double rise = v[1] * v[1] - v[-1] * v[-1];
    const double curvature = v[-1] * v[-1] - 2.0 * least_squared + v[1] * v[1];
    if (curvature > 0.0) least_squared -= rise * rise / (8.0 * curvature);
  }
  score.slow_xi = -std::cos(vertex * std::numbers::pi / rung.m);
  score.d2 = std::isfinite(sum) ? std::sqrt(sum) : HUGE_VAL;
  score.min_speed = score.speed[slowest] / (0.5 * problem.length);
  score.slow = score.turns ||
               !(std::sqrt(std::max(least_squared, 0.0)) >= least_speed * 0.5 * problem.length);
  // An interpolant shrunk to where a closed curve starts would be nearest to it.
  score.length = length / problem.length;
  score.valid = nodes.ordered() && score.min_speed >= least_speed && score.length >= least_length &&
                std::isfinite(sum);
  return score;
}

template <int dim>
int minimise_distance(const Problem<dim>& problem, Nodes<dim>& nodes, Score<dim>& score,
                      const DistanceSteps<dim>& steps) {
  const CurveRung& rung = problem.tables.rung(nodes.n);
  const int size = nodes.n - 1;
  // |p'| is frozen in each step, and the derivative of a distance is exact: the foot moves along
  // the curve. In the plane the distance has a sign and gives one residual; in space the residual
  // is the vector normal to the curve.
  const auto build = [&](small::LeastSquares& squares, const Vector& unit) {
    std::array<Vector, dim> d1;
    for (std::size_t c = 0; c < dim; ++c)
      for (std::size_t k = 0; k < std::size_t(size); ++k) d1[c][k] = unit[k] * nodes.d1[c][k + 1];
    for (int at = 0; at < rung.m; ++at) {
      const std::size_t a = std::size_t(at);
      const double weight = std::sqrt(rung.weight[a] * score.speed[a]);
      const double* l = rung.value_row(at) + 1;
      if constexpr (dim == 2) {
        const double tx = weight * score.tangent[0][a], ty = weight * score.tangent[1][a];
        double* row = squares.next_row();
        small::scaled_sum(size, l, tx, d1[1].data(), -ty, d1[0].data(), row);
        row[size] = ty * score.e[0][a] - tx * score.e[1][a];
      } else {
        Vec<dim> tau, e;
        for (std::size_t c = 0; c < dim; ++c) {
          tau.c[c] = score.tangent[c][a];
          e.c[c] = score.e[c][a];
        }
        const Vec<dim> across = e - dot(e, tau) * tau;
        for (int c = 0; c < dim; ++c) {
          Vector row;
          for (int k = 0; k < size; ++k) {
            Vec<dim> g;
            for (std::size_t i = 0; i < dim; ++i) g.c[i] = d1[i][std::size_t(k)];
            row[std::size_t(k)] = l[k] * (g[c] - dot(g, tau) * tau[c]);
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
  double before = score.d2;
  int done_before = 0;
  const auto pointless = [&](const Nodes<dim>& now, int done) {
    if (!steps.rival || !score.valid) return false;
    if (score.d2 < 1.5 * steps.rival_d2 && close(now, *steps.rival)) return true;
    constexpr int some = 4;
    if (done < done_before + some) return false;
    // What the steps left bring if they bring as much as the last ones.
    const double rate = std::pow(score.d2 / before, 1.0 / (done - done_before));
    before = score.d2;
    done_before = done;
    return score.d2 * std::pow(rate, 2.0 * (steps.most - done)) > steps.rival_d2;
  };
  return levenberg_marquardt(problem, nodes, steps.most, steps.least_gain, build, accept,
                             pointless);
}

template Score<2> measure(const Problem<2>&, const Nodes<2>&, const Score<2>*);
template Score<3> measure(const Problem<3>&, const Nodes<3>&, const Score<3>*);
template int minimise_distance(const Problem<2>&, Nodes<2>&, Score<2>&, const DistanceSteps<2>&);
template int minimise_distance(const Problem<3>&, Nodes<3>&, Score<3>&, const DistanceSteps<3>&);

}  // namespace bezel::curve_search
