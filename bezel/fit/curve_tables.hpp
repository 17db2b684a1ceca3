#pragma once
// What curve interpolation knows of each degree before it sees a curve.

#include <cstddef>
#include <mutex>
#include <vector>

#include "bezel/fit/curve_interpolation.hpp"
#include "bezel/fit/lobatto.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel {

/// Tables of one degree n.
struct CurveRung {
  explicit CurveRung(int degree);

  int n;
  LobattoBasis basis;
  std::vector<double> from_last;    ///< [j][k] = l_k^(n-1)(xi_j^(n)); n >= 2
  std::vector<double> from_second;  ///< [j][k] = l_k^(n-2)(xi_j^(n)); n >= 3
  /// Points where distances are measured while searching: xi = -cos((a + 1/2) pi / m), a < m = 4n,
  /// with weight pi / m sqrt(1 - xi^2), the midpoint rule in the angle. Distances vanish at both
  /// ends, so d^2 sqrt(1 - xi^2) is smooth enough there for the rule to converge fast.
  int m;
  std::vector<double> xi, weight;
  /// [a][k] = l_k(xi_a); the loops of small_kernels.hpp may read a little beyond the last row.
  std::vector<double> value;
  std::vector<double> value_columns;  ///< [k][a] = l_k(xi_a)
  std::vector<double> slope_columns;  ///< [k][a] = l_k'(xi_a)
  const double* value_row(int a) const {
    return value.data() + std::size_t(a) * std::size_t(n + 1);
  }

  /// The differentiation matrix, [i][k] = l_k'(xi_i), with room behind it as above; and by columns,
  /// [k][i], each padded.
  std::vector<double> d, d_columns;
  const double* d_row(int i) const { return d.data() + std::size_t(i) * std::size_t(n + 1); }
};

struct CurveInterpolator::Tables {
  explicit Tables(int max_degree);

  /// @param n  1..max_degree
  const CurveRung& rung(int n) const { return rungs[std::size_t(n - 1)]; }
  /// The rule of error (4): 3n + 1 GLL points. Made when first asked for, once: its points in
  /// double-double cost more than all other tables.
  const IntervalRule& l2_rule(int n) const;

  std::vector<CurveRung> rungs;

 private:
  struct Lazy {
    std::once_flag once;
    IntervalRule rule;
  };
  mutable std::vector<Lazy> l2_rules_;
};

}  // namespace bezel
