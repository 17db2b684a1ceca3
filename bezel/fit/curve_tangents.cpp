// Newton's method on the equal-tangent equations.

#include "bezel/fit/curve_search.hpp"

namespace bezel::curve_search {
namespace {

using small::Matrix;
using small::Vector;

// One inner node: its tangent, the tangent's derivative, and p' there.
template <int dim>
struct Tangent {
  Vec<dim> tau, dtau, slope;
};
template <int dim>
Tangent<dim> tangent(const CurveRung& rung, const Nodes<dim>& nodes, int i) {
  const CurveJet<dim>& g = nodes.g[std::size_t(i)];
  Tangent<dim> r;
  const double inverse = 1.0 / norm(g.d1);
  r.tau = inverse * g.d1;
  r.dtau = inverse * (g.d2 - dot(r.tau, g.d2) * r.tau);
  r.slope = combine(rung.d_row(i), nodes);
  return r;
}

double residual_of(const Problem<2>& problem, const CurveRung& rung, const Nodes<2>& nodes,
                   Vector& f) {
  const double scale = 2.0 / problem.length;
  double largest = 0.0;
  for (int i = 1; i < nodes.n; ++i) {
    const Vec2& d1 = nodes.g[std::size_t(i)].d1;
    const double value = scale / norm(d1) * cross(combine(rung.d_row(i), nodes), d1);
    f[std::size_t(i) - 1] = value;
    largest = std::max(largest, std::fabs(value));
  }
  return std::isfinite(largest) ? largest : HUGE_VAL;
}

double sum_of_squares(int size, const Vector& f) {
  double sum = 0.0;
  for (int i = 0; i < size; ++i) sum += f[std::size_t(i)] * f[std::size_t(i)];
  return sum;
}

// dF/dt.
void linearise(const Problem<2>& problem, const CurveRung& rung, const Nodes<2>& nodes,
               Matrix& jacobian) {
  const double scale = 2.0 / problem.length;
  for (int i = 1; i < nodes.n; ++i) {
    const Tangent<2> r = tangent(rung, nodes, i);
    const Vec2 tau = scale * r.tau;
    const double* d = rung.d_row(i);
    double* row = jacobian[i - 1];
    for (int k = 1; k < nodes.n; ++k)
      row[k - 1] =
          d[k] * (nodes.d1[0][std::size_t(k)] * tau[1] - nodes.d1[1][std::size_t(k)] * tau[0]);
    row[i - 1] = scale * cross(r.slope, r.dtau);
  }
}

}  // namespace

template <>
double tangent_residual(const Problem<2>& problem, const Nodes<2>& nodes) {
  Vector f;
  return residual_of(problem, problem.tables.rung(nodes.n), nodes, f);
}

template <>
double tangent_residual(const Problem<3>& problem, const Nodes<3>& nodes) {
  const CurveRung& rung = problem.tables.rung(nodes.n);
  double largest = 0.0;
  for (int i = 1; i < nodes.n; ++i) {
    const Tangent<3> r = tangent(rung, nodes, i);
    const Vec3 f = (2.0 / problem.length) * (r.slope - dot(r.slope, r.tau) * r.tau);
    largest = std::max(largest, norm(f));
  }
  return std::isfinite(largest) ? largest : HUGE_VAL;
}

// Below noise a residual that no longer falls by a factor of three is a root too: once p is exact
// to rounding, sigma_min of the Jacobian falls with the error, and Newton would walk at random
// along polynomial reparametrisations.
constexpr double noise = 1e-10;
constexpr int plain_steps = 30, search_steps = 30, damped_steps = 30;

template <>
NewtonResult solve_tangents(const Problem<2>& problem, Nodes<2>& nodes, bool patient,
                            double converged) {
  const CurveRung& rung = problem.tables.rung(nodes.n);
  const int size = nodes.n - 1;
  Matrix jacobian;
  Vector f, step;
  Nodes<2> now = nodes;
  NewtonResult result{HUGE_VAL, false, 0};
  double last = HUGE_VAL;
  int without_gain = 0;
  // Plain Newton, steps limited by the gaps only.
  for (int i = 0;; ++i) {
    const double residual = residual_of(problem, rung, now, f);
    if (residual < result.residual) {
      result.residual = residual;
      nodes = now;
      without_gain = 0;
    } else if (++without_gain > 8) {
      break;
    }
    if (residual <= converged || (residual <= noise && residual > last / 3.0)) {
      result.converged = true;
      return result;
    }
    if (i == plain_steps) break;
    last = residual;
    linearise(problem, rung, now, jacobian);
    for (int k = 0; k < size; ++k) step[std::size_t(k)] = -f[std::size_t(k)];
    if (!small::solve(size, jacobian, step)) break;
    ++result.iterations;
    now = moved(problem, now, step, longest_step(now, step));
    if (!now.ordered()) break;
  }
  result.converged = result.residual <= noise;
  if (result.converged || !patient) return result;

  // From the best iterate, with a line search; when that stalls, damped normal equations.
  now = nodes;
  bool damped = false;
  for (int i = 0; i < search_steps + damped_steps; ++i) {
    if (residual_of(problem, rung, now, f) <= converged) break;
    linearise(problem, rung, now, jacobian);
    const double cost = sum_of_squares(size, f);
    if (damped) {
      Matrix normal;
      for (int r = 0; r < size; ++r) {
        for (int c = 0; c <= r; ++c) {
          double sum = 0.0;
          for (int k = 0; k < size; ++k) sum += jacobian[k][r] * jacobian[k][c];
          normal[r][c] = sum;
        }
        normal[r][r] += cost;
        double sum = 0.0;
        for (int k = 0; k < size; ++k) sum -= jacobian[k][r] * f[std::size_t(k)];
        step[std::size_t(r)] = sum;
      }
      if (!small::solve_spd(size, normal, step)) break;
    } else {
      for (int k = 0; k < size; ++k) step[std::size_t(k)] = -f[std::size_t(k)];
      if (!small::solve(size, jacobian, step)) {
        damped = true;
        continue;
      }
    }
    ++result.iterations;
    double lambda = longest_step(now, step);
    bool moving = false;
    for (int halving = 0; halving < 10 && !moving; ++halving, lambda *= 0.5) {
      const Nodes<2> next = moved(problem, now, step, lambda);
      Vector trial;
      const double value = residual_of(problem, rung, next, trial);
      if (next.ordered() && sum_of_squares(size, trial) < (1.0 - 1e-4 * lambda) * cost) {
        moving = true;
        now = next;
        if (value < result.residual) {
          result.residual = value;
          nodes = next;
        }
      }
    }
    if (moving) continue;
    if (damped || i >= search_steps) break;
    damped = true;
  }
  result.converged = result.residual <= noise;
  return result;
}

template <>
NewtonResult solve_tangents(const Problem<3>& problem, Nodes<3>& nodes, bool patient, double) {
  // Two equations per node for one unknown: their squares are minimised.
  const CurveRung& rung = problem.tables.rung(nodes.n);
  const int size = nodes.n - 1;
  const double scale = 2.0 / problem.length;
  const auto cost_of = [&](const Nodes<3>& at) {
    double sum = 0.0;
    for (int i = 1; i < at.n; ++i) {
      const Tangent<3> r = tangent(rung, at, i);
      const Vec3 f = scale * (r.slope - dot(r.slope, r.tau) * r.tau);
      sum += dot(f, f);
    }
    return std::isfinite(sum) ? sum : HUGE_VAL;
  };
  double cost = cost_of(nodes);
  const auto build = [&](small::LeastSquares& squares, const Vector& unit) {
    for (int node = 1; node < nodes.n; ++node) {
      const Tangent<3> r = tangent(rung, nodes, node);
      const double along = dot(r.slope, r.tau);
      const Vec3 f = scale * (r.slope - along * r.tau);
      const Vec3 own = (-scale) * (along * r.dtau + dot(r.slope, r.dtau) * r.tau);
      for (int c = 0; c < 3; ++c) {
        Vector row;
        for (int k = 0; k < size; ++k) {
          const Vec3& d1 = nodes.g[std::size_t(k) + 1].d1;
          row[std::size_t(k)] =
              scale * rung.d_row(node)[k + 1] * (d1[c] - dot(d1, r.tau) * r.tau[c]);
        }
        row[std::size_t(node) - 1] = own[c];
        for (int k = 0; k < size; ++k) row[std::size_t(k)] *= unit[std::size_t(k)];
        squares.add(1.0, row.data(), -f[c]);
      }
    }
  };
  const auto accept = [&](const Nodes<3>& next) {
    const double value = cost_of(next);
    if (!(value < cost)) return 0.0;
    const double gain = (cost - value) / cost;
    cost = value;
    return gain;
  };
  NewtonResult result{HUGE_VAL, false, 0};
  result.iterations = levenberg_marquardt(problem, nodes, patient ? 60 : 15, 1e-8, build, accept);
  result.residual = tangent_residual(problem, nodes);
  result.converged = std::isfinite(cost);
  return result;
}

}  // namespace bezel::curve_search
