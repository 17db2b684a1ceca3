#pragma once
// The parts of the search for good nodes on a curve: foot points, Newton on the equal-tangent
// equations, least squares for distances and for error (4).

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "bezel/fit/curve_tables.hpp"
#include "bezel/fit/small_solve.hpp"

namespace bezel::curve_search {

constexpr std::size_t max_nodes = std::size_t(max_curve_degree) + 1;

/// to[0 .. padded(n)) = from.
template <std::size_t capacity>
void copy_padded(int n, const std::array<double, capacity>& from,
                 std::array<double, capacity>& to) {
  std::copy(from.data(), from.data() + small::padded(n), to.data());
}

/// Nodes on the curve: parameters and what the curve is there, coordinate by coordinate. Entries
/// behind the last node are padding; copies are of what is used, since there are many.
template <int dim>
struct Nodes {
  using Row = std::array<double, std::size_t(small::padded(max_curve_degree + 1)) + small::padding>;
  using Rows = std::array<Row, std::size_t(dim)>;
  int n = 0;
  Row t;
  Rows x, d1, d2;

  Nodes() = default;
  Nodes(const Nodes& other) { *this = other; }
  Nodes& operator=(const Nodes& other) {
    n = other.n;
    copy_padded(n + 1, other.t, t);
    for (std::size_t c = 0; c < dim; ++c) {
      copy_padded(n + 1, other.x[c], x[c]);
      copy_padded(n + 1, other.d1[c], d1[c]);
      copy_padded(n + 1, other.d2[c], d2[c]);
    }
    return *this;
  }

  void place(const SmoothCurve<dim>& curve, int i, double parameter) {
    set(i, parameter, curve(parameter));
  }
  void set(int i, double parameter, const CurveJet<dim>& jet) {
    t[std::size_t(i)] = parameter;
    for (std::size_t c = 0; c < dim; ++c) {
      x[c][std::size_t(i)] = jet.x.c[c];
      d1[c][std::size_t(i)] = jet.d1.c[c];
      d2[c][std::size_t(i)] = jet.d2.c[c];
    }
  }
  static Vec<dim> at(const Rows& values, int i) {
    Vec<dim> v;
    for (std::size_t c = 0; c < dim; ++c) v.c[c] = values[c][std::size_t(i)];
    return v;
  }
  bool ordered() const {
    for (int i = 0; i < n; ++i)
      if (!(t[std::size_t(i)] < t[std::size_t(i) + 1])) return false;
    return true;
  }
};

/// What every step needs; `ends` are the jets at -1 and 1.
template <int dim>
struct Problem {
  const SmoothCurve<dim>& curve;
  const CurveInterpolator::Tables& tables;
  double length;
  CurveJet<dim> first, last;

  Problem(const SmoothCurve<dim>& c, const CurveInterpolator::Tables& made)
      : curve(c), tables(made), length(c.length()), first(c(-1.0)), last(c(1.0)) {}
  Nodes<dim> chord() const {
    Nodes<dim> nodes;
    nodes.n = 1;
    set_ends(nodes);
    return nodes;
  }
  void set_ends(Nodes<dim>& nodes) const {
    nodes.set(0, -1.0, first);
    nodes.set(nodes.n, 1.0, last);
  }
};

/// sum_k row[k] g(t_k).
template <int dim>
Vec<dim> combine(const double* row, const Nodes<dim>& nodes) {
  Vec<dim> sum;
  for (std::size_t c = 0; c < dim; ++c)
    sum.c[c] = small::product(row, nodes.x[c].data(), nodes.n + 1);
  return sum;
}

template <int dim>
struct Foot {
  double s;
  Vec<dim> e, tangent;  ///< point asked for minus foot; unit tangent there
};

/// The step of Newton's method from s, where the curve is `jet`, towards the foot of q.
template <int dim>
double foot_step(const CurveJet<dim>& jet, const Vec<dim>& e, double s) {
  const double speed_squared = dot(jet.d1, jet.d1);
  // The second derivative of half the squared distance; where it is small or negative the nearest
  // point is elsewhere, and the step for a straight line is taken instead.
  double h = speed_squared - dot(e, jet.d2);
  if (h < 0.25 * speed_squared) h = speed_squared;
  const double step = std::clamp(dot(e, jet.d1) / h, -0.25, 0.25);
  return std::clamp(s + step, -1.0, 1.0) - s;
}

/// A nearby point of the curve where q - g(s) is normal to it (or an end point), by at most 12
/// steps of Newton from s.
template <int dim>
Foot<dim> foot(const SmoothCurve<dim>& curve, const Vec<dim>& q, double s) {
  // What a cubic Taylor term of a step leaves is below rounding.
  constexpr double settled = 1e-6;
  s = std::clamp(s, -1.0, 1.0);
  for (int i = 0;; ++i) {
    const CurveJet<dim> jet = curve(s);
    Vec<dim> e = q - jet.x;
    const double step = foot_step(jet, e, s);
    Vec<dim> d1 = jet.d1;
    if (std::fabs(step) <= settled) {
      // What is left of the step is followed on the Taylor polynomial: no further evaluation.
      e -= step * (jet.d1 + (0.5 * step) * jet.d2);
      d1 += step * jet.d2;
    } else if (i < 12) {
      s += step;
      continue;
    }
    const double at = s + (std::fabs(step) <= settled ? step : 0.0);
    const Vec<dim> tau = (1.0 / norm(d1)) * d1;
    // Inside, what is left along the curve is the step's error and no distance.
    if (at > -1.0 && at < 1.0) e -= dot(e, tau) * tau;
    return {at, e, tau};
  }
}

/// Largest step <= 1 along dt (of the inner nodes 1..n-1) that leaves every gap a tenth.
template <int dim>
double longest_step(const Nodes<dim>& nodes, const small::Vector& dt) {
  double lambda = 1.0;
  for (int k = 0; k < nodes.n; ++k) {
    const double gap = nodes.t[std::size_t(k) + 1] - nodes.t[std::size_t(k)];
    const double before = k == 0 ? 0.0 : dt[std::size_t(k) - 1];
    const double after = k + 1 == nodes.n ? 0.0 : dt[std::size_t(k)];
    const double shrink = before - after;
    if (shrink * lambda > 0.9 * gap) lambda = 0.9 * gap / shrink;
  }
  return lambda;
}
/// to = from + lambda dt, evaluated; both may be the same. dt[i - 1] belongs to node i.
template <int dim>
void move(const Problem<dim>& problem, const Nodes<dim>& from, const small::Vector& dt,
          double lambda, Nodes<dim>& to) {
  if (&to != &from) {
    to.n = from.n;
    problem.set_ends(to);
  }
  for (int i = 1; i < from.n; ++i)
    to.place(problem.curve, i, from.t[std::size_t(i)] + lambda * dt[std::size_t(i) - 1]);
}

/// Levenberg-Marquardt in the inner nodes; the unknown of node i is dt_i / unit_i, unit_i the
/// smaller gap beside it.
///
/// @param build  (squares, unit): adds the rows unit_k dr / dt_k, with right-hand side -r, at the
///               nodes accepted last
/// @param accept (next) -> relative gain in cost, when that is positive `next` becomes the state
/// @param pointless (nodes, done) -> stop here; asked after each step accepted
/// @return  steps tried. Stops when two gains in a row are below `least_gain` at little damping
template <int dim, class Build, class Accept, class Pointless>
int levenberg_marquardt(const Problem<dim>& problem, Nodes<dim>& nodes, int iterations,
                        double least_gain, const Build& build, const Accept& accept,
                        const Pointless& pointless) {
  const int size = nodes.n - 1;
  constexpr double least_damping = 1e-30, little_damping = 1e-12, most_damping = 1e4;
  double mu = 1e-6;
  int done = 0, small_gains = 0;
  small::LeastSquares squares;
  small::Vector unit;
  Nodes<dim> next;
  while (done < iterations && size > 0) {
    for (int r = 0; r < size; ++r) {
      const double* t = nodes.t.data() + r;
      unit[std::size_t(r)] = std::min(t[1] - t[0], t[2] - t[1]);
    }
    squares.start(size);
    build(squares, unit);
    squares.factor();
    double gain = 0.0;
    while (mu < most_damping && !(gain > 0.0) && done < iterations) {
      ++done;
      small::Vector step;
      if (squares.solve(mu * squares.largest(), step)) {
        for (int r = 0; r < size; ++r) step[std::size_t(r)] *= unit[std::size_t(r)];
        move(problem, nodes, step, longest_step(nodes, step), next);
        if (next.ordered()) gain = accept(next);
        if (gain > 0.0) nodes = next;
      }
      mu = gain > 0.0 ? std::max(0.02 * mu, least_damping) : 20.0 * mu;
    }
    if (!(gain > 0.0) || pointless(nodes, done)) break;
    small_gains = gain >= least_gain || mu > little_damping ? 0 : small_gains + 1;
    if (small_gains == 2) break;
  }
  return done;
}

/// Largest |F_i| of the equal-tangent equations F_i = 2 / L p'(xi_i) x tau(t_i).
template <int dim>
double tangent_residual(const Problem<dim>& problem, const Nodes<dim>& nodes);
template <>
double tangent_residual(const Problem<2>& problem, const Nodes<2>& nodes);
template <>
double tangent_residual(const Problem<3>& problem, const Nodes<3>& nodes);

struct NewtonResult {
  double residual;
  bool converged;
  int iterations;
};
/// Newton on the equal-tangent equations (in space: damped Gauss-Newton on their squares), then
/// with a line search, then Levenberg-Marquardt. `nodes` becomes the best iterate.
///
/// @param patient    false: stop after the plain Newton steps
/// @param converged  the residual of a root
template <int dim>
NewtonResult solve_tangents(const Problem<dim>& problem, Nodes<dim>& nodes, bool patient,
                            double converged = 1e-12);
template <>
NewtonResult solve_tangents(const Problem<2>& problem, Nodes<2>& nodes, bool patient,
                            double converged);
template <>
NewtonResult solve_tangents(const Problem<3>& problem, Nodes<3>& nodes, bool patient,
                            double converged);

/// Mean square distance of an interpolant to the curve, measured while searching.
template <int dim>
struct Score {
  double d2 = HUGE_VAL;                ///< sqrt(int d^2 |p'|)
  double min_speed = 0.0;              ///< smallest |p'| / (L / 2)
  double length = 0.0;                 ///< of p, over L
  bool valid = false;                  ///< nodes ordered, min_speed >= 1e-3, length >= 1 / 4
  bool turns = false;                  ///< p runs backwards somewhere
  bool slow = false;                   ///< so it does, or |p'| < 1e-3 L / 2 between the points
  double slow_xi = 0.0, far_xi = 0.0;  ///< where |p'| is smallest, and d largest
  using Row = std::array<double, std::size_t(4) * max_curve_degree>;
  int points = 0;                   ///< entries of the rows below
  Row s, speed;                     ///< parameter of the foot of each point; |p'|
  std::array<Row, dim> e, tangent;  ///< of Foot, coordinate by coordinate

  Score() = default;
  Score(const Score& other) { *this = other; }
  Score& operator=(const Score& other) {
    d2 = other.d2;
    min_speed = other.min_speed;
    length = other.length;
    valid = other.valid;
    turns = other.turns;
    slow = other.slow;
    slow_xi = other.slow_xi;
    far_xi = other.far_xi;
    points = other.points;
    copy_padded(points, other.s, s);
    copy_padded(points, other.speed, speed);
    for (std::size_t c = 0; c < dim; ++c) {
      copy_padded(points, other.e[c], e[c]);
      copy_padded(points, other.tangent[c], tangent[c]);
    }
    return *this;
  }
};
/// @param guess  feet to start from; null: between the nodes
template <int dim>
Score<dim> measure(const Problem<dim>& problem, const Nodes<dim>& nodes,
                   const Score<dim>* guess = nullptr);

/// When least distance ends.
template <int dim>
struct DistanceSteps {
  int most;                           ///< steps
  double least_gain = 1e-3;           ///< relative, per step
  const Nodes<dim>* rival = nullptr;  ///< others found before: steps end when they run into these,
  double rival_d2 = 0.0;              ///< or fall too slowly to get below their distance
};
/// Levenberg-Marquardt on the mean square distance; `nodes` and `score` become the best.
///
/// @return  iterations done
template <int dim>
int minimise_distance(const Problem<dim>& problem, Nodes<dim>& nodes, Score<dim>& score,
                      const DistanceSteps<dim>& steps);

}  // namespace bezel::curve_search
