#pragma once
// The K-fold compensated de Casteljau algorithm in plain doubles, without any check: the reference
// for the vector kernels of compensated_batch.cpp, which give the same bits.
//
// Work space: level F of coefficient n at w[n K + F]; level 0 the coefficients, the others 0.

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/eft.hpp"
#include "bezel/numeric/local_error_kernel.hpp"

namespace bezel::bernstein {

/// Largest K served by the compensated evaluations: u^20 is below every double's last place.
inline constexpr int max_precision = 20;

namespace kernel {

/// Places for the local errors: 5 F - 2 on the interval, 5 F + 1 (one more term each) elsewhere.
inline constexpr int max_local_errors = 5 * max_precision + 8;

/// The last level: plain operations, errors dropped.
inline double add_plain(const double* e, int count, double rho, double b) {
  double l = e[0];
  for (int i = 1; i < count; ++i) l += e[i];
  return l + rho * b;
}

/// One update of coefficient `low` with its neighbour `high`, all K >= 1 levels, in place;
/// 1 - s = r + rho.
inline void compensated_update(double* low, const double* high, double r, double rho, double s,
                               int K) {
  const WithError p = two_prod(r, low[0]), q = two_prod(s, high[0]);
  const WithError sum = two_sum(p.value, q.value);
  double b = low[0];  // the value below, before its update
  low[0] = sum.value;
  if (K == 1) return;
  double e[max_local_errors] = {p.error, q.error, sum.error};
  int count = 3;
  for (int f = 1; f < K - 1; ++f) {
    double l = bezel::kernel::sum_with_errors(e, count--);
    l = bezel::kernel::add_product_with_errors(l, rho, b, e, count);
    l = bezel::kernel::add_product_with_errors(l, s, high[f], e, count);
    b = low[f];
    low[f] = bezel::kernel::add_product_with_errors(l, r, b, e, count);
  }
  const int f = K - 1;
  low[f] = (add_plain(e, count, rho, b) + s * high[f]) + r * low[f];
}

/// Reduces the d + 1 coefficients in w to one; its levels are w[0..K-1].
inline void compensated_sweep(int d, double* w, double s, int K) {
  const WithError r = two_sum(1.0, -s);
  for (int m = d; m > 0; --m)
    for (int j = 0; j < m; ++j)
      compensated_update(w + j * K, w + (j + 1) * K, r.value, r.error, s, K);
}

/// The levels of p(s): `levels` gets K values; w has (d+1) K places.
inline void compensated_levels(int d, const double* b, double s, int K, double* w, double* levels) {
  for (int j = 0; j <= d; ++j) {
    w[j * K] = b[j];
    for (int f = 1; f < K; ++f) w[j * K + f] = 0.0;
  }
  compensated_sweep(d, w, s, K);
  for (int f = 0; f < K; ++f) levels[f] = w[f];
}

/// The levels of p'(s) / d, d >= 1: differences of coefficients, exact in two levels (K = 1:
/// rounded).
inline void compensated_derivative_levels(int d, const double* b, double s, int K, double* w,
                                          double* levels) {
  for (int j = 0; j < d; ++j) {
    const WithError difference = two_sum(b[j + 1], -b[j]);
    w[j * K] = difference.value;
    for (int f = 1; f < K; ++f) w[j * K + f] = f == 1 ? difference.error : 0.0;
  }
  compensated_sweep(d - 1, w, s, K);
  for (int f = 0; f < K; ++f) levels[f] = w[f];
}

/// Barycentrics (l0, l1, l2) = (r + rho + rho2, l1, l2): rho and rho2 are what l0 loses as a
/// double.
struct SplitLambda {
  double r, l1, l2, rho, rho2;
};

/// One update on the triangle, in place: `low` from itself, its neighbour `right` in the row and
/// the one `up` in the row above.
inline void compensated_triangle_update(double* out, const double* low, const double* right,
                                        const double* up, const SplitLambda& l, int K) {
  const WithError p = two_prod(l.r, low[0]), q = two_prod(l.l1, right[0]),
                  v = two_prod(l.l2, up[0]);
  const WithError s1 = two_sum(p.value, q.value), s2 = two_sum(s1.value, v.value);
  double b = low[0];
  out[0] = s2.value;
  if (K == 1) return;
  double e[max_local_errors + 5 * max_precision] = {p.error, q.error, v.error, s1.error, s2.error};
  int count = 5;
  for (int f = 1; f < K - 1; ++f) {
    double sum = bezel::kernel::sum_with_errors(e, count--);
    sum = bezel::kernel::add_product_with_errors(sum, l.rho, b, e, count);
    sum = bezel::kernel::add_product_with_errors(sum, l.rho2, b, e, count);
    sum = bezel::kernel::add_product_with_errors(sum, l.l2, up[f], e, count);
    sum = bezel::kernel::add_product_with_errors(sum, l.l1, right[f], e, count);
    b = low[f];
    out[f] = bezel::kernel::add_product_with_errors(sum, l.r, b, e, count);
  }
  const int f = K - 1;
  const double local = add_plain(e, count, l.rho, b) + l.rho2 * b;
  out[f] = ((local + l.l2 * up[f]) + l.l1 * right[f]) + l.r * low[f];
}

/// Levels on the triangle; w has triangle_size(d) K places.
inline void compensated_triangle_levels(int d, const double* b, const SplitLambda& lambda, int K,
                                        double* w, double* levels) {
  for (int n = 0; n < triangle_size(d); ++n) {
    w[n * K] = b[n];
    for (int f = 1; f < K; ++f) w[n * K + f] = 0.0;
  }
  for (int m = d; m > 0; --m) {
    double* write = w;
    const double* lower = w;
    for (int k = 0; k < m; ++k) {
      const double* upper = lower + (m - k + 1) * K;
      for (int j = 0; j < m - k; ++j, write += K) {
        // Reads run ahead of writes: low is copied, since out may be low itself.
        double low[max_precision];
        for (int f = 0; f < K; ++f) low[f] = lower[j * K + f];
        compensated_triangle_update(write, low, lower + (j + 1) * K, upper + j * K, lambda, K);
      }
      lower = upper;
    }
  }
  for (int f = 0; f < K; ++f) levels[f] = w[f];
}

}  // namespace kernel
}  // namespace bezel::bernstein
