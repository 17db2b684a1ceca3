#pragma once
// Kernels on [0, 1], templates on the value (scalar or point) and the parameter's scalar, without
// any check of their arguments. Instantiated with double by interval.cpp and with exact rationals
// by the tests. Every intermediate is converted to Value explicitly, so that expression-template
// numbers work.

#include <array>
#include <cstddef>
#include <vector>

#include "bezel/bernstein/band_kernel.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/binomial_kernel.hpp"

namespace bezel::bernstein::kernel {

using bezel::kernel::Binomial;

/// One de Casteljau step in place: m+1 coefficients become m. r = 1 - s.
template <class Value, class Scalar>
void step(Value* w, int m, const Scalar& r, const Scalar& s) {
  for (int j = 0; j < m; ++j) w[j] = Value(Value(r * w[j]) + Value(s * w[j + 1]));
}

/// p(s) by de Casteljau; w holds the d+1 coefficients and is overwritten.
template <class Value, class Scalar>
Value evaluate_in_place(int d, Value* w, const Scalar& s) {
  const Scalar r(1 - s);
  for (int m = d; m > 0; --m) step(w, m, r, s);
  return w[0];
}

/// p(s), without checks: b holds d+1 values, 0 <= d <= max_interval_degree.
template <class Value, class Scalar>
Value evaluate_unchecked(int d, const Value* b, const Scalar& s) {
  const auto run = [&](Value* w) {
    for (int i = 0; i <= d; ++i) w[i] = b[i];
    return evaluate_in_place(d, w, s);
  };
  if (d <= 7) {
    std::array<Value, 8> w;
    return run(w.data());
  }
  std::array<Value, max_interval_degree + 1> w;
  return run(w.data());
}

/// Scaled coefficients up to this size cannot make the sums below overflow at parameters in [0, 1].
inline constexpr double largest_scaled = 0x1p1000;

/// sum_i c_i r^(d-i) s^i, d >= 1, c_i `stride` apart: Horner's scheme in r with growing powers of
/// s, without checks.
template <int stride = 1, class Value, class Scalar>
Value evaluate_scaled(int d, const Value* c, const Scalar& r, const Scalar& s) {
  Scalar power = s;
  Value a(r * c[0]);
  for (int i = 1; i < d; ++i) {
    c += stride;
    a = Value(r * Value(a + Value(power * c[0])));
    power = Scalar(power * s);
  }
  return Value(a + Value(power * c[stride]));
}

template <class Value>
struct ValueAndDerivative {
  Value value, derivative;
};

/// p(s) and p'(s) from one de Casteljau sweep, without checks.
template <class Value, class Scalar>
ValueAndDerivative<Value> evaluate_derivative_unchecked(int d, const Value* b, const Scalar& s) {
  if (d == 0) return {b[0], Value(b[0] - b[0])};
  const Scalar r(1 - s);
  const auto run = [&](Value* w) -> ValueAndDerivative<Value> {
    for (int i = 0; i <= d; ++i) w[i] = b[i];
    for (int m = d; m > 1; --m) step(w, m, r, s);
    return {Value(Value(r * w[0]) + Value(s * w[1])), Value(Scalar(d) * Value(w[1] - w[0]))};
  };
  if (d <= 7) {
    std::array<Value, 8> w;
    return run(w.data());
  }
  std::array<Value, max_interval_degree + 1> w;
  return run(w.data());
}

template <class Value, class Scalar>
void differentiate(int d, const Value* b, Value* out) {
  if (d == 0) {
    out[0] = Value(b[0] - b[0]);
    return;
  }
  for (int i = 0; i < d; ++i) out[i] = Value(Scalar(d) * Value(b[i + 1] - b[i]));
}

/// left and right hold d+1 values each.
template <class Value, class Scalar>
void subdivide(int d, const Value* b, const Scalar& t, Value* left, Value* right) {
  const Scalar r(1 - t);
  for (int i = 0; i <= d; ++i) right[i] = b[i];
  for (int m = d; m >= 0; --m) {
    left[d - m] = right[0];
    if (m > 0) step(right, m, r, t);
    // After the step right[m - 1] is the last of its level and right[m] keeps the last of the level
    // above: exactly the right child's coefficients.
  }
}

/// out_i = blossom of d-i times t0 and i times t1: stages of t0 steps, each finished with t1 steps.
template <class Value, class Scalar>
void specialize(int d, const Value* b, const Scalar& t0, const Scalar& t1, Value* out) {
  const Scalar r0(1 - t0);
  std::vector<Value> stage(b, b + d + 1), w;
  for (int i = d; i >= 0; --i) {
    w.assign(stage.begin(), stage.begin() + i + 1);
    out[i] = evaluate_in_place(i, w.data(), t1);
    if (i > 0) step(stage.data(), i, r0, t0);
  }
}

/// Degree d to d+1: out_i = (i b_{i-1} + (d+1-i) b_i) / (d+1). out may not overlap b.
template <class Value, class Scalar>
void elevate(int d, const Value* b, Value* out) {
  const int n = d + 1;
  out[0] = b[0];
  for (int i = 1; i <= d; ++i)
    out[i] = Value(Value(Value(Scalar(i) * b[i - 1]) + Value(Scalar(n - i) * b[i])) *
                   Scalar(Scalar(1) / Scalar(n)));
  out[n] = b[d];
}

/// Best L2 approximation of degree d-1 (d >= 1). It is also the least-squares solution of
/// elevate(out) = b in the plain Euclidean norm of the coefficients [lutterkort1999]: a tridiagonal
/// system with condition number (d+1)/2.
template <class Value, class Scalar>
void reduce(int d, const Value* b, Value* out) {
  BandMatrix<Scalar> a(d, 1);
  for (int i = 0; i < d; ++i) {
    // Both sides times d^2: column i of the elevation is (d-i)/d in row i and (i+1)/d in row i+1.
    a(i, i) = Scalar((d - i) * (d - i) + (i + 1) * (i + 1));
    if (i > 0) a(i, i - 1) = Scalar(i * (d - i));
    out[i] = Value(Value(Scalar(d * (d - i)) * b[i]) + Value(Scalar(d * (i + 1)) * b[i + 1]));
  }
  a.solve(out);
}

/// Antiderivative vanishing at 0: d+2 values.
template <class Value, class Scalar>
void antiderivative(int d, const Value* b, Value* out) {
  const Scalar n(d + 1);
  Value sum(b[0] - b[0]);
  out[0] = sum;
  for (int i = 0; i <= d; ++i) {
    sum = Value(sum + b[i]);
    out[i + 1] = Value(sum / n);
  }
}

/// c_k = sum C(da, i) C(db, k-i) a_i b_{k-i} / C(da+db, k).
template <class Scalar>
void multiply(int da, const Scalar* a, int db, const Scalar* b, Scalar* out) {
  std::vector<Scalar> scaled(at(db + 1));
  for (int j = 0; j <= db; ++j) scaled[at(j)] = Scalar(Binomial<Scalar>::get(db, j) * b[j]);
  for (int k = 0; k <= da + db; ++k) out[k] = Scalar(0);
  for (int i = 0; i <= da; ++i) {
    const Scalar f = Scalar(Binomial<Scalar>::get(da, i) * a[i]);
    for (int j = 0; j <= db; ++j) out[i + j] = Scalar(out[i + j] + Scalar(f * scaled[at(j)]));
  }
  for (int k = 0; k <= da + db; ++k) out[k] = Scalar(out[k] / Binomial<Scalar>::get(da + db, k));
}

/// a_k = C(d, k) (k-th forward difference of b at 0).
template <class Scalar>
void to_monomial(int d, const Scalar* b, Scalar* a) {
  for (int i = 0; i <= d; ++i) a[i] = b[i];
  for (int k = 1; k <= d; ++k)
    for (int i = d; i >= k; --i) a[i] = Scalar(a[i] - a[i - 1]);
  for (int k = 0; k <= d; ++k) a[k] = Scalar(a[k] * Binomial<Scalar>::get(d, k));
}

/// The inverse of to_monomial: b_i = sum_k C(i, k) a_k / C(d, k).
template <class Scalar>
void from_monomial(int d, const Scalar* a, Scalar* b) {
  for (int k = 0; k <= d; ++k) b[k] = Scalar(a[k] / Binomial<Scalar>::get(d, k));
  for (int k = d; k >= 1; --k)
    for (int i = k; i <= d; ++i) b[i] = Scalar(b[i] + b[i - 1]);
}

/// Powers 0..n of x, each one product from the one before.
template <class Scalar>
std::vector<Scalar> powers(const Scalar& x, int n) {
  std::vector<Scalar> p(at(n + 1), Scalar(1));
  for (int i = 1; i <= n; ++i) p[at(i)] = Scalar(p[at(i - 1)] * x);
  return p;
}

/// Values at i/d from coefficients: sum of C(d,j) i^j (d-i)^(d-j) b_j, divided by d^d at the end.
template <class Scalar>
void to_lagrange(int d, const Scalar* b, Scalar* values) {
  if (d == 0) {
    values[0] = b[0];
    return;
  }
  std::vector<std::vector<Scalar>> power;
  for (int i = 0; i <= d; ++i) power.push_back(powers(Scalar(i), d));
  for (int i = 0; i <= d; ++i) {
    Scalar sum(0);
    for (int j = 0; j <= d; ++j) {
      const Scalar w = Scalar(power[at(i)][at(j)] * power[at(d - i)][at(d - j)]);
      sum = Scalar(sum + Scalar(Scalar(w * Binomial<Scalar>::get(d, j)) * b[j]));
    }
    values[i] = Scalar(sum / power[at(d)][at(d)]);
  }
}

/// Coefficients from values at i/d: the Newton form on the lattice, sum_a D_a C(x, a) with x = d s
/// and D_a the forward differences, nested and multiplied out in Bernstein form.
template <class Scalar>
void from_lagrange(int d, const Scalar* values, Scalar* b) {
  std::vector<Scalar> difference(values, values + d + 1), c(at(d + 1), Scalar(0)), next(at(d + 1));
  for (int a = 1; a <= d; ++a)
    for (int i = d; i >= a; --i)
      difference[at(i)] = Scalar(difference[at(i)] - difference[at(i - 1)]);
  c[0] = difference[at(d)];
  for (int a = d - 1; a >= 0; --a) {
    const int m = d - 1 - a;  // degree of c; now c <- c (x - a) / (a+1) + D_a, of degree m+1
    // x - a = d s - a has the coefficients -a and d - a; the product rule with a linear factor.
    for (int i = 0; i <= m + 1; ++i) {
      Scalar sum(0);
      if (i <= m) sum = Scalar(sum + Scalar(Scalar(-a * (m + 1 - i)) * c[at(i)]));
      if (i >= 1) sum = Scalar(sum + Scalar(Scalar((d - a) * i) * c[at(i - 1)]));
      next[at(i)] = Scalar(Scalar(sum / Scalar((m + 1) * (a + 1))) + difference[at(a)]);
    }
    c.swap(next);
  }
  for (int i = 0; i <= d; ++i) b[i] = c[at(i)];
}

/// C(d,i) s^i (1-s)^(d-i), each from powers: small relative error in each value.
template <class Scalar>
void basis(int d, const Scalar& s, Scalar* out) {
  const Scalar r(1 - s);
  Scalar p(1);
  for (int i = 0; i <= d; ++i) {
    out[i] = Scalar(p * Binomial<Scalar>::get(d, i));
    p = Scalar(p * s);
  }
  p = Scalar(1);
  for (int i = d; i >= 0; --i) {
    out[i] = Scalar(out[i] * p);
    p = Scalar(p * r);
  }
}

}  // namespace bezel::bernstein::kernel
