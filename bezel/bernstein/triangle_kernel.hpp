#pragma once
// Kernels on the reference triangle, templates on the value and the parameter's scalar, without any
// check of their arguments; see interval_kernel.hpp.

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "bezel/bernstein/interval_kernel.hpp"

namespace bezel::bernstein {

/// Value and the two derivatives d/du, d/dv where lambda = (1-u-v, u, v).
template <class Value>
struct ValueAndGradient {
  Value value, du, dv;
};

namespace kernel {

using bezel::kernel::trinomial;

inline constexpr int max_triangle_size = triangle_size(max_triangle_degree);

/// Runs body on uninitialised work space for `size` values: on the stack when small.
template <class Value, class Body>
auto with_work(int size, const Body& body) {
  if (size <= 28) {
    std::array<Value, 28> w;
    return body(w.data());
  }
  std::vector<Value> w(at(size));
  return body(w.data());
}

/// One de Casteljau step in place: degree m becomes m-1. Reads run ahead of writes.
template <class Value, class Scalar>
void triangle_step(Value* w, int m, const std::array<Scalar, 3>& lambda) {
  const Value* lower = w;
  for (int k = 0; k < m; ++k) {
    const Value* upper = lower + (m - k + 1);
    for (int j = 0; j < m - k; ++j)
      *w++ = Value(Value(Value(lambda[0] * lower[j]) + Value(lambda[1] * lower[j + 1])) +
                   Value(lambda[2] * upper[j]));
    lower = upper;
  }
}

/// p(lambda), without checks: b holds triangle_size(d) values, 0 <= d <= max_triangle_degree.
template <class Value, class Scalar>
Value evaluate_unchecked(int d, const Value* b, const std::array<Scalar, 3>& lambda) {
  const int size = triangle_size(d);
  return with_work<Value>(size, [&](Value* w) -> Value {
    std::copy(b, b + size, w);
    for (int m = d; m > 0; --m) triangle_step(w, m, lambda);
    return w[0];
  });
}

/// p(lambda) from the scaled coefficients d!/(i!j!k!) b_ijk, without checks: Horner's scheme in l2,
/// with rows of equal k by Horner's scheme in l0 with growing powers of l1.
template <class Value, class Scalar>
Value evaluate_scaled_triangle(int d, const Value* c, const std::array<Scalar, 3>& lambda) {
  c += triangle_size(d) - 1;
  Value p = *c;
  for (int n = 1; n <= d; ++n) {
    c -= n + 1;
    p = Value(Value(lambda[2] * p) + evaluate_scaled(n, c, lambda[0], lambda[1]));
  }
  return p;
}

/// p(lambda) and its derivatives from one de Casteljau sweep, without checks.
template <class Value, class Scalar>
ValueAndGradient<Value> evaluate_gradient_unchecked(int d, const Value* b,
                                                    const std::array<Scalar, 3>& lambda) {
  if (d == 0) return {b[0], Value(b[0] - b[0]), Value(b[0] - b[0])};
  const int size = triangle_size(d);
  return with_work<Value>(size, [&](Value* w) -> ValueAndGradient<Value> {
    std::copy(b, b + size, w);
    for (int m = d; m > 1; --m) triangle_step(w, m, lambda);
    return {
        Value(Value(Value(lambda[0] * w[0]) + Value(lambda[1] * w[1])) + Value(lambda[2] * w[2])),
        Value(Scalar(d) * Value(w[1] - w[0])), Value(Scalar(d) * Value(w[2] - w[0]))};
  });
}

/// Coefficients of d/du and d/dv: triangle_size(d-1) values each (d = 0: one zero).
template <class Value, class Scalar>
void differentiate_triangle(int d, const Value* b, Value* du, Value* dv) {
  if (d == 0) {
    du[0] = dv[0] = Value(b[0] - b[0]);
    return;
  }
  for (int k = 0, n = 0; k < d; ++k)
    for (int j = 0; j < d - k; ++j, ++n) {
      const Value& corner = b[triangle_index(d, j, k)];
      du[n] = Value(Scalar(d) * Value(b[triangle_index(d, j + 1, k)] - corner));
      dv[n] = Value(Scalar(d) * Value(b[triangle_index(d, j, k + 1)] - corner));
    }
}

/// out_ijk = blossom of i times x[0], j times x[1], k times x[2]. The arguments are applied in the
/// order given by `order`; children of one subdivision use one order for their shared points, so
/// that their shared sides agree bit for bit.
template <class Value, class Scalar>
void specialize_triangle(int d, const Value* b, const std::array<std::array<Scalar, 3>, 3>& x,
                         const std::array<int, 3>& order, Value* out) {
  std::vector<Value> first(b, b + triangle_size(d)), second, third;
  for (int p = 0; p <= d; ++p) {  // p steps of x[order[0]] have been applied
    const int m = d - p;
    second.assign(first.begin(), first.begin() + triangle_size(m));
    for (int q = 0; q <= m; ++q) {
      third.assign(second.begin(), second.begin() + triangle_size(m - q));
      for (int n = m - q; n > 0; --n) triangle_step(third.data(), n, x[at(order[2])]);
      std::array<int, 3> index{};
      index[at(order[0])] = p;
      index[at(order[1])] = q;
      index[at(order[2])] = m - q;
      out[triangle_index(d, index[1], index[2])] = third[0];
      if (q < m) triangle_step(second.data(), m - q, x[at(order[1])]);
    }
    if (p < d) triangle_step(first.data(), m, x[at(order[0])]);
  }
}

/// Four children of the midpoint split, each triangle_size(d) values.
template <class Value, class Scalar>
void subdivide_triangle(int d, const Value* b, const std::array<Value*, 4>& out) {
  const Scalar zero(0), one(1), half(0.5);
  using Point = std::array<Scalar, 3>;
  const Point c0{one, zero, zero}, c1{zero, one, zero}, c2{zero, zero, one};
  const Point m0{half, half, zero}, m1{zero, half, half}, m2{half, zero, half};  // of sides 0, 1, 2
  // Always the corner first, then the midpoints m0, m1, m2 in this order.
  specialize_triangle<Value, Scalar>(d, b, {c0, m0, m2}, {0, 1, 2}, out[0]);
  specialize_triangle<Value, Scalar>(d, b, {m0, c1, m1}, {1, 0, 2}, out[1]);
  specialize_triangle<Value, Scalar>(d, b, {m2, m1, c2}, {2, 1, 0}, out[2]);
  specialize_triangle<Value, Scalar>(d, b, {m1, m2, m0}, {2, 0, 1}, out[3]);
}

/// Degree d to d+1: out_ijk = (i b_{i-1,j,k} + j b_{i,j-1,k} + k b_{i,j,k-1}) / (d+1).
template <class Value, class Scalar>
void elevate_triangle(int d, const Value* b, Value* out) {
  const int n = d + 1;
  for (int k = 0; k <= n; ++k)
    for (int j = 0; j <= n - k; ++j) {
      const int i = n - j - k;
      Value& c = *out++;
      if (i == n || j == n || k == n) {
        c = b[triangle_corner(d, i == n ? 0 : j == n ? 1 : 2)];
        continue;
      }
      bool empty = true;
      const auto add = [&](int weight, int index) {
        const Value term = Value(Scalar(weight) * b[index]);
        c = empty ? term : Value(c + term);
        empty = false;
      };
      if (i > 0) add(i, triangle_index(d, j, k));
      if (j > 0) add(j, triangle_index(d, j - 1, k));
      if (k > 0) add(k, triangle_index(d, j, k - 1));
      c = Value(c * Scalar(Scalar(1) / Scalar(n)));
    }
}

/// Best L2 approximation of degree d-1 (d >= 1): the Euclidean least-squares solution of
/// elevate(out) = b [peters2000]; a band system of width d+1 with condition number (d+2)/2 or so.
template <class Value, class Scalar>
void reduce_triangle(int d, const Value* b, Value* out) {
  const int n = triangle_size(d - 1);
  BandMatrix<Scalar> a(n, d);
  for (int m = 0; m < n; ++m) out[m] = Value(b[0] - b[0]);
  for (int k = 0; k <= d; ++k)
    for (int j = 0; j <= d - k; ++j) {
      const std::array<int, 3> weight{d - j - k, j, k};  // row (i, j, k) of the elevation, times d
      const std::array<int, 3> column{triangle_index(d - 1, j, k), triangle_index(d - 1, j - 1, k),
                                      triangle_index(d - 1, j, k - 1)};
      const Value& c = b[triangle_index(d, j, k)];
      for (std::size_t e = 0; e < 3; ++e) {
        if (weight[e] == 0) continue;
        out[column[e]] = Value(out[column[e]] + Value(Scalar(d * weight[e]) * c));
        for (std::size_t f = 0; f < 3; ++f)
          if (weight[f] != 0 && column[f] <= column[e]) {
            Scalar& entry = a(column[e], column[f]);
            entry = Scalar(entry + Scalar(weight[e] * weight[f]));
          }
      }
    }
  a.solve(out);
}

/// Product: c_g = sum over a + b = g of M(a) M(b) / M(g) x_a y_b, M the trinomial coefficient.
template <class Scalar>
void multiply_triangle(int da, const Scalar* x, int db, const Scalar* y, Scalar* out) {
  const int d = da + db;
  std::vector<Scalar> scaled(at(triangle_size(db)));
  for (int k = 0, n = 0; k <= db; ++k)
    for (int j = 0; j <= db - k; ++j, ++n)
      scaled[at(n)] = Scalar(trinomial<Scalar>(db, j, k) * y[n]);
  for (int n = 0; n < triangle_size(d); ++n) out[n] = Scalar(0);
  for (int k = 0; k <= da; ++k)
    for (int j = 0; j <= da - k; ++j) {
      const Scalar f = Scalar(trinomial<Scalar>(da, j, k) * *x++);
      const Scalar* s = scaled.data();
      for (int l = 0; l <= db; ++l) {
        Scalar* row = out + triangle_index(d, j, k + l);
        for (int m = 0; m <= db - l; ++m) row[m] = Scalar(row[m] + Scalar(f * *s++));
      }
    }
  for (int k = 0; k <= d; ++k)
    for (int j = 0; j <= d - k; ++j, ++out) *out = Scalar(*out / trinomial<Scalar>(d, j, k));
}

/// Values at (i, j, k)/d: sum of M(a) i^a0 j^a1 k^a2 b_a, divided by d^d at the end.
template <class Scalar>
void to_lagrange_triangle(int d, const Scalar* b, Scalar* values) {
  if (d == 0) {
    values[0] = b[0];
    return;
  }
  std::vector<std::vector<Scalar>> power;
  for (int i = 0; i <= d; ++i) power.push_back(powers(Scalar(i), d));
  std::vector<Scalar> scaled(at(triangle_size(d)));
  for (int k = 0, n = 0; k <= d; ++k)
    for (int j = 0; j <= d - k; ++j, ++n) scaled[at(n)] = Scalar(trinomial<Scalar>(d, j, k) * b[n]);
  for (int k = 0; k <= d; ++k)
    for (int j = 0; j <= d - k; ++j) {
      const int i = d - j - k;
      Scalar sum(0);
      for (int c = 0, n = 0; c <= d; ++c) {
        Scalar row(0);
        for (int a = 0; a <= d - c; ++a, ++n) {
          const Scalar w = Scalar(power[at(i)][at(d - c - a)] * power[at(j)][at(a)]);
          row = Scalar(row + Scalar(w * scaled[at(n)]));
        }
        sum = Scalar(sum + Scalar(row * power[at(k)][at(c)]));
      }
      *values++ = Scalar(sum / power[at(d)][at(d)]);
    }
}

/// Coefficients from values at (i, j, k)/d: the Newton form on the lattice in x = d u, y = d v,
/// sum D_ab C(x, a) C(y, b), nested in y over polynomials in x; both multiplied out in Bernstein
/// form.
template <class Scalar>
void from_lagrange_triangle(int d, const Scalar* values, Scalar* b) {
  std::vector<Scalar> difference(values, values + triangle_size(d));
  const auto entry = [&](int j, int k) -> Scalar& {
    return difference[at(triangle_index(d, j, k))];
  };
  for (int k = 0; k <= d; ++k)
    for (int a = 1; a <= d - k; ++a)
      for (int j = d - k; j >= a; --j) entry(j, k) = Scalar(entry(j, k) - entry(j - 1, k));
  for (int j = 0; j <= d; ++j)
    for (int a = 1; a <= d - j; ++a)
      for (int k = d - j; k >= a; --k) entry(j, k) = Scalar(entry(j, k) - entry(j, k - 1));

  std::vector<Scalar> p(at(triangle_size(d)), Scalar(0)), next(at(triangle_size(d)));
  std::vector<Scalar> q(at(d + 1)), q_next(at(d + 1));
  for (int l = d; l >= 0; --l) {
    // q: sum_a D_al C(x, a), degree n = d - l in u.
    const int n = d - l;
    q[0] = entry(n, l);
    for (int a = n - 1; a >= 0; --a) {
      const int m = n - 1 - a;
      for (int i = 0; i <= m + 1; ++i) {
        Scalar sum(0);
        if (i <= m) sum = Scalar(sum + Scalar(Scalar(-a * (m + 1 - i)) * q[at(i)]));
        if (i >= 1) sum = Scalar(sum + Scalar(Scalar((d - a) * i) * q[at(i - 1)]));
        q_next[at(i)] = Scalar(Scalar(sum / Scalar((m + 1) * (a + 1))) + entry(a, l));
      }
      q.swap(q_next);
    }
    // p <- p (y - l) / (l+1) + q, of degree n: y - l has the coefficients -l, -l, d - l.
    for (int k = 0, at_next = 0; k <= n; ++k)
      for (int j = 0; j <= n - k; ++j, ++at_next) {
        const int i = n - j - k;
        Scalar sum(0);
        if (i > 0) sum = Scalar(sum + Scalar(Scalar(-l * i) * p[at(triangle_index(n - 1, j, k))]));
        if (j > 0)
          sum = Scalar(sum + Scalar(Scalar(-l * j) * p[at(triangle_index(n - 1, j - 1, k))]));
        if (k > 0)
          sum = Scalar(sum + Scalar(Scalar((d - l) * k) * p[at(triangle_index(n - 1, j, k - 1))]));
        if (n > 0) sum = Scalar(sum / Scalar(n * (l + 1)));
        next[at(at_next)] = Scalar(sum + q[at(j)]);  // a polynomial in u alone: its coefficient j
      }
    p.swap(next);
  }
  std::copy(p.begin(), p.end(), b);
}

/// M(i,j,k) l0^i l1^j l2^k, each from powers: small relative error in each value.
template <class Scalar>
void basis_triangle(int d, const std::array<Scalar, 3>& lambda, Scalar* out) {
  const std::vector<Scalar> p0 = powers(lambda[0], d), p1 = powers(lambda[1], d),
                            p2 = powers(lambda[2], d);
  for (int k = 0; k <= d; ++k)
    for (int j = 0; j <= d - k; ++j)
      *out++ = Scalar(Scalar(Scalar(trinomial<Scalar>(d, j, k) * p0[at(d - j - k)]) * p1[at(j)]) *
                      p2[at(k)]);
}

/// Integrals of B_m B_n over the reference triangle, row major:
/// C(i+i', i) C(j+j', j) C(k+k', k) / C(2d, d) / ((2d+1)(2d+2)).
template <class Scalar>
void mass_matrix(int d, Scalar* out) {
  const Scalar scale = Scalar(Binomial<Scalar>::get(2 * d, d) * Scalar((2 * d + 1) * (2 * d + 2)));
  const int size = triangle_size(d);
  std::vector<std::array<int, 3>> index;
  for (int n = 0; n < size; ++n) index.push_back(triangle_multi_index(d, n));
  for (const auto& a : index)
    for (const auto& b : index) {
      Scalar product = Binomial<Scalar>::get(a[0] + b[0], a[0]);
      product = Scalar(product * Binomial<Scalar>::get(a[1] + b[1], a[1]));
      product = Scalar(product * Binomial<Scalar>::get(a[2] + b[2], a[2]));
      *out++ = Scalar(product / scale);
    }
}

}  // namespace kernel
}  // namespace bezel::bernstein
