// Newton's method on the equal-tangent equations.

#include "bezel/fit/curve_search.hpp"

namespace bezel::curve_search {
namespace {

using small::Matrix;
using small::Vector;

// p' at the nodes.
template <int dim>
void slopes(const CurveRung& rung, const Nodes<dim>& nodes, typename Nodes<dim>::Rows& p1) {
  for (std::size_t c = 0; c < dim; ++c)
    small::combine(nodes.n + 1, small::padded(nodes.n + 1), rung.d_columns.data(),
                   nodes.x[c].data(), p1[c].data());
}

// The equations at one iterate, and what their derivative needs of it.
struct Equations {
  Vector f;              // F_i of node i + 1
  double residual;       // largest |F_i|
  Nodes<2>::Rows p1;     // p'
  Vector inverse_speed;  // 1 / |g'| of node i + 1

  Equations() = default;
  Equations(const Problem<2>& problem, const CurveRung& rung, const Nodes<2>& nodes) {
    slopes(rung, nodes, p1);
    const double scale = 2.0 / problem.length;
    residual = 0.0;
    for (std::size_t i = 1; i < std::size_t(nodes.n); ++i) {
      const double x1 = nodes.d1[0][i], y1 = nodes.d1[1][i];
      inverse_speed[i - 1] = 1.0 / std::sqrt(x1 * x1 + y1 * y1);
      f[i - 1] = scale * inverse_speed[i - 1] * (p1[0][i] * y1 - p1[1][i] * x1);
      residual = std::max(residual, std::fabs(f[i - 1]));
      if (!std::isfinite(f[i - 1])) residual = HUGE_VAL;
    }
  }

  // [dF/dt | -F].
  void linearise(const Problem<2>& problem, const CurveRung& rung, const Nodes<2>& nodes,
                 Matrix& jacobian) const {
    const double scale = 2.0 / problem.length;
    const int size = nodes.n - 1;
    for (int at = 1; at < nodes.n; ++at) {
      const std::size_t i = std::size_t(at);
      const double inverse = inverse_speed[i - 1];
      const double tx = inverse * nodes.d1[0][i], ty = inverse * nodes.d1[1][i];
      const double along = tx * nodes.d2[0][i] + ty * nodes.d2[1][i];
      double* row = jacobian[at - 1];
      small::scaled_sum(size, rung.d_row(at) + 1, scale * ty, nodes.d1[0].data() + 1, -scale * tx,
                        nodes.d1[1].data() + 1, row);
      // tau' = (g'' - (tau . g'') tau) / |g'|.
      row[at - 1] =
          scale * inverse *
          (p1[0][i] * (nodes.d2[1][i] - along * ty) - p1[1][i] * (nodes.d2[0][i] - along * tx));
      row[size] = -f[i - 1];
    }
  }
};

// In space: one inner node's tangent, the tangent's derivative, and p' there.
struct Tangent {
  Vec3 tau, dtau, slope;
};
Tangent tangent(const Nodes<3>& nodes, const Nodes<3>::Rows& p1, int i) {
  const Vec3 d1 = Nodes<3>::at(nodes.d1, i), d2 = Nodes<3>::at(nodes.d2, i);
  Tangent r;
  const double inverse = 1.0 / norm(d1);
  r.tau = inverse * d1;
  r.dtau = inverse * (d2 - dot(r.tau, d2) * r.tau);
  r.slope = Nodes<3>::at(p1, i);
  return r;
}

double sum_of_squares(int size, const Vector& f) {
  double sum = 0.0;
  for (int i = 0; i < size; ++i) sum += f[std::size_t(i)] * f[std::size_t(i)];
  return sum;
}

}  // namespace

template <>
double tangent_residual(const Problem<2>& problem, const Nodes<2>& nodes) {
  return Equations(problem, problem.tables.rung(nodes.n), nodes).residual;
}

template <>
double tangent_residual(const Problem<3>& problem, const Nodes<3>& nodes) {
  const CurveRung& rung = problem.tables.rung(nodes.n);
  Nodes<3>::Rows p1;
  slopes(rung, nodes, p1);
  double largest = 0.0;
  for (int i = 1; i < nodes.n; ++i) {
    const Tangent r = tangent(nodes, p1, i);
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
  Vector step;
  NewtonResult result{HUGE_VAL, false, 0};
  double last = HUGE_VAL;
  int without_gain = 0;
  // Plain Newton, steps limited by the gaps only. The best iterate and the last one, if that is
  // another, in two places, so that nothing is copied.
  Nodes<2> second;
  Nodes<2>*best = nullptr, *now = &nodes;
  for (int i = 0;; ++i) {
    const Equations equations(problem, rung, *now);
    const double residual = equations.residual;
    if (residual < result.residual || !best) {
      result.residual = residual;
      best = now;
      without_gain = 0;
    } else if (++without_gain > 8) {
      break;
    }
    if (residual <= converged || (residual <= noise && residual > last / 3.0)) {
      result.converged = true;
      break;
    }
    if (i == plain_steps) break;
    last = residual;
    equations.linearise(problem, rung, *now, jacobian);
    if (!small::solve(size, jacobian, step)) break;
    ++result.iterations;
    const double lambda = longest_step(*now, step);
    Nodes<2>* next = best == &nodes ? &second : &nodes;
    move(problem, *now, step, lambda, *next);
    now = next;
    if (!now->ordered()) break;
  }
  if (best == &second) nodes = second;
  if (result.converged) return result;
  result.converged = result.residual <= noise;
  if (result.converged || !patient) return result;

  // From the best iterate, with a line search; when that stalls, damped least squares.
  Nodes<2> at = nodes, trial;
  Equations equations(problem, rung, at);
  bool damped = false;
  for (int i = 0; i < search_steps + damped_steps; ++i) {
    if (equations.residual <= converged) break;
    equations.linearise(problem, rung, at, jacobian);
    const double cost = sum_of_squares(size, equations.f);
    if (damped) {
      small::LeastSquares squares;
      squares.start(size);
      for (int r = 0; r < size; ++r) squares.add(1.0, jacobian[r], jacobian[r][size]);
      squares.factor();
      if (!squares.solve(cost, step)) break;
    } else if (!small::solve(size, jacobian, step)) {
      damped = true;
      continue;
    }
    ++result.iterations;
    double lambda = longest_step(at, step);
    bool moving = false;
    for (int halving = 0; halving < 10 && !moving; ++halving, lambda *= 0.5) {
      move(problem, at, step, lambda, trial);
      const Equations there(problem, rung, trial);
      if (trial.ordered() && sum_of_squares(size, there.f) < (1.0 - 1e-4 * lambda) * cost) {
        moving = true;
        at = trial;
        equations = there;
        if (there.residual < result.residual) {
          result.residual = there.residual;
          nodes = at;
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
    Nodes<3>::Rows p1;
    slopes(rung, at, p1);
    double sum = 0.0;
    for (int i = 1; i < at.n; ++i) {
      const Tangent r = tangent(at, p1, i);
      const Vec3 f = scale * (r.slope - dot(r.slope, r.tau) * r.tau);
      sum += dot(f, f);
    }
    return std::isfinite(sum) ? sum : HUGE_VAL;
  };
  double cost = cost_of(nodes);
  const auto build = [&](small::LeastSquares& squares, const Vector& unit) {
    Nodes<3>::Rows p1;
    slopes(rung, nodes, p1);
    for (int node = 1; node < nodes.n; ++node) {
      const Tangent r = tangent(nodes, p1, node);
      const double along = dot(r.slope, r.tau);
      const Vec3 f = scale * (r.slope - along * r.tau);
      const Vec3 own = (-scale) * (along * r.dtau + dot(r.slope, r.dtau) * r.tau);
      for (int c = 0; c < 3; ++c) {
        Vector row;
        for (int k = 0; k < size; ++k) {
          const Vec3 d1 = Nodes<3>::at(nodes.d1, k + 1);
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
  result.iterations = levenberg_marquardt(problem, nodes, patient ? 60 : 15, 1e-8, build, accept,
                                          [](const Nodes<3>&, int) { return false; });
  result.residual = tangent_residual(problem, nodes);
  result.converged = std::isfinite(cost);
  return result;
}

}  // namespace bezel::curve_search
