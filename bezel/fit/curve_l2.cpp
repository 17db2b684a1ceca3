#include "bezel/fit/curve_l2.hpp"

namespace bezel::curve_search {

template <int dim>
GraphError<dim>::GraphError(const Problem<dim>& problem, int n)
    : problem_(problem),
      rung_(problem.tables.rung(n)),
      projection_(Projection<dim>::onto_x(problem.curve)) {
  if (!is_graph()) return;
  const IntervalRule& rule = problem.tables.l2_rule(n);
  const double width = projection_.span();
  for (std::size_t a = 0; a < rule.node.size(); ++a) {
    x_.push_back(width * rule.node[a]);
    weight_.push_back(width * rule.weight[a]);
    point_.push_back(problem.curve(projection_.parameter(x_.back())).x);
  }
}

template <int dim>
typename GraphError<dim>::Value GraphError<dim>::evaluate(std::span<const Vec<dim>> nodal) const {
  const int pieces = 40 * rung_.n;
  Value value{0.0, true, {}};
  const auto x_of = [&](double xi) {
    return projection_.coordinate(rung_.basis.evaluate(nodal, xi));
  };
  std::vector<double> xi, x;
  for (int i = 0; i <= pieces; ++i) {
    xi.push_back(i == pieces ? 1.0 : -1.0 + 2.0 * i / pieces);
    x.push_back(x_of(xi.back()));
    if (i > 0 && !(x[std::size_t(i)] > x[std::size_t(i) - 1])) value.monotone = false;
  }
  const IntervalRule& rule = problem_.tables.l2_rule(rung_.n);
  for (std::size_t a = 0; a < x_.size(); ++a) {
    const double target = x_[a], near = 2.0 * rule.node[a] - 1.0;
    // The interval with a sign change that is nearest to xi_a; with x_N monotone there is one.
    double best = HUGE_VAL, lo = -1.0, hi = -1.0;
    for (std::size_t i = 0; i + 1 < xi.size(); ++i) {
      if ((x[i] - target) * (x[i + 1] - target) > 0.0) continue;
      const double away = std::max({xi[i] - near, near - xi[i + 1], 0.0});
      if (away < best) {
        best = away;
        lo = xi[i];
        hi = xi[i + 1];
      }
      if (value.monotone) break;
    }
    double eta = near;
    if (a == 0 || a + 1 == x_.size()) {
      eta = a == 0 ? -1.0 : 1.0;
    } else if (best < HUGE_VAL) {
      // Regula falsi with the Illinois change of weights, then the bracket's end.
      double f_lo = x_of(lo) - target, f_hi = x_of(hi) - target;
      eta = f_lo == 0.0 ? lo : hi;
      int side = 0;
      for (int i = 0; i < 60 && f_lo != 0.0 && f_hi != 0.0; ++i) {
        const double next = (lo * f_hi - hi * f_lo) / (f_hi - f_lo);
        if (!(next > lo && next < hi)) break;
        const bool settled = std::fabs(next - eta) <= 2e-16;
        eta = next;
        if (settled) break;
        const double f = x_of(eta) - target;
        if (f == 0.0) break;
        if ((f > 0.0) == (f_hi > 0.0)) {
          hi = eta;
          f_hi = f;
          if (side == 1) f_lo *= 0.5;
          side = 1;
        } else {
          lo = eta;
          f_lo = f;
          if (side == -1) f_hi *= 0.5;
          side = -1;
        }
      }
    }
    value.eta.push_back(eta);
    const Vec<dim> e = point_[a] - rung_.basis.evaluate(nodal, eta);
    for (int c = 1; c < dim; ++c) value.l2 += weight_[a] * e[c] * e[c];
  }
  value.l2 = std::sqrt(value.l2);
  return value;
}

template <int dim>
int GraphError<dim>::minimise(Nodes<dim>& nodes, int iterations) const {
  const int n = rung_.n;
  const auto nodal_of = [n](const Nodes<dim>& at) {
    std::array<Vec<dim>, max_nodes> nodal;
    for (int k = 0; k <= n; ++k) nodal[std::size_t(k)] = Nodes<dim>::at(at.x, k);
    return nodal;
  };
  const auto value_of = [&](const Nodes<dim>& at) {
    const auto nodal = nodal_of(at);
    return evaluate(std::span(nodal).first(std::size_t(n) + 1));
  };
  Value value = value_of(nodes);
  // x_N(eta) = x_a stays true as node k moves, so that y_N(eta) changes by l_k (y'_k - sigma x'_k)
  // with sigma = y_N' / x_N' at eta.
  const auto build = [&](small::LeastSquares& squares, const small::Vector& unit) {
    const auto nodal = nodal_of(nodes);
    std::array<double, max_nodes> l, slope_row;
    for (std::size_t a = 0; a < x_.size(); ++a) {
      rung_.basis.values(value.eta[a], l);
      std::fill(slope_row.begin(), slope_row.end(), 0.0);
      for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k)
          slope_row[std::size_t(k)] += l[std::size_t(i)] * rung_.d_row(i)[k];
      Vec<dim> p, slope;
      for (std::size_t k = 0; k <= std::size_t(n); ++k) {
        p += l[k] * nodal[k];
        slope += slope_row[k] * nodal[k];
      }
      if (!(std::fabs(slope[0]) > 1e-12 * projection_.span())) continue;
      for (int c = 1; c < dim; ++c) {
        small::Vector row;
        const double sigma = slope[c] / slope[0];
        for (std::size_t k = 1; k < std::size_t(n); ++k)
          row[k - 1] = -l[k] * unit[k - 1] * (nodes.d1[std::size_t(c)][k] - sigma * nodes.d1[0][k]);
        squares.add(std::sqrt(weight_[a]), row.data(), p[c] - point_[a][c]);
      }
    }
  };
  const auto accept = [&](const Nodes<dim>& next) {
    Value trial = value_of(next);
    if (!(trial.l2 < value.l2) || (value.monotone && !trial.monotone)) return 0.0;
    const double gain = (value.l2 - trial.l2) / value.l2;
    value = std::move(trial);
    return gain;
  };
  return levenberg_marquardt(problem_, nodes, iterations, 1e-4, build, accept,
                             [](const Nodes<dim>&, int) { return false; });
}

template class GraphError<2>;
template class GraphError<3>;

}  // namespace bezel::curve_search
