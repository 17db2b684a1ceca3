#pragma once
// Exact values of Bernstein polynomials in integers of GMP, sharing nothing with bezel's own exact
// arithmetic, and the exact checks of rounded values against them.

#include <gmpxx.h>

#include <cfloat>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "bezel/bernstein/index.hpp"

namespace support {

/// m 2^e.
struct Number {
  mpz_class m;
  long e = 0;
  Number() = default;
  Number(mpz_class mantissa, long exponent) : m(std::move(mantissa)), e(exponent) {}
  explicit Number(double x) {  // finite
    int exponent = 0;
    m = std::ldexp(std::frexp(x, &exponent), 53);
    e = exponent - 53;
  }
  int sign() const { return sgn(m); }
};

inline mpz_class shifted(const mpz_class& m, long bits) {
  mpz_class out;
  mpz_mul_2exp(out.get_mpz_t(), m.get_mpz_t(), static_cast<mp_bitcnt_t>(bits));
  return out;
}
inline Number operator+(const Number& a, const Number& b) {
  if (a.e >= b.e) return {shifted(a.m, a.e - b.e) + b.m, b.e};
  return {a.m + shifted(b.m, b.e - a.e), a.e};
}
inline Number operator-(const Number& a) {
  return {-a.m, a.e};
}
inline Number operator-(const Number& a, const Number& b) {
  return a + -b;
}
inline Number operator*(const Number& a, const Number& b) {
  return {a.m * b.m, a.e + b.e};
}
inline Number abs(const Number& a) {
  return {::abs(a.m), a.e};
}
inline Number power(const Number& a, int n) {
  mpz_class out;
  mpz_pow_ui(out.get_mpz_t(), a.m.get_mpz_t(), static_cast<unsigned long>(n));
  return {out, a.e * n};
}
/// The sign of a - b.
inline int compare(const Number& a, const Number& b) {
  if (a.sign() != b.sign()) return a.sign() < b.sign() ? -1 : 1;
  return (a - b).sign();
}
/// Truncated to 53 bits; the wide exponents of long double hold every number of these tests.
inline long double approximate(const Number& a) {
  long exponent = 0;
  const double m = mpz_get_d_2exp(&exponent, a.m.get_mpz_t());
  return std::ldexp(static_cast<long double>(m), static_cast<int>(exponent + a.e));
}

inline mpz_class binomial(int n, int k) {
  mpz_class out;
  mpz_bin_uiui(out.get_mpz_t(), static_cast<unsigned long>(n), static_cast<unsigned long>(k));
  return out;
}

/// The coefficients as integers over one power of two.
inline std::pair<std::vector<mpz_class>, long> integers(std::span<const Number> b) {
  long lowest = 0;
  bool found = false;
  for (const Number& x : b)
    if (x.sign() != 0 && (!found || x.e < lowest)) lowest = x.e, found = true;
  std::vector<mpz_class> m(b.size());
  for (std::size_t j = 0; j < b.size(); ++j)
    if (b[j].sign() != 0) m[j] = shifted(b[j].m, b[j].e - lowest);
  return {std::move(m), lowest};
}
inline std::vector<Number> numbers(std::span<const double> b) {
  std::vector<Number> out;
  for (const double x : b) out.emplace_back(x);
  return out;
}

/// A Bernstein polynomial in the power basis, with integer coefficients: converted once, values for
/// many s by Horner's rule.
class ExactValues {
 public:
  explicit ExactValues(std::span<const double> b) : ExactValues(numbers(b)) {}
  explicit ExactValues(const std::vector<Number>& b) {
    std::tie(a_, exponent_) = integers(b);
    // a_i = C(n, i) times the i-th difference at 0.
    const std::size_t n = a_.size() - 1;
    for (std::size_t i = 1; i <= n; ++i)
      for (std::size_t j = n; j >= i; --j) a_[j] -= a_[j - 1];
    for (std::size_t i = 0; i <= n; ++i)
      a_[i] *= binomial(static_cast<int>(n), static_cast<int>(i));
  }
  Number operator()(double s) const {
    Number x(s);
    if (x.sign() == 0) return {a_[0], exponent_};
    const auto zeros = static_cast<long>(mpz_scan1(x.m.get_mpz_t(), 0));
    mpz_fdiv_q_2exp(x.m.get_mpz_t(), x.m.get_mpz_t(), static_cast<mp_bitcnt_t>(zeros));
    x.e += zeros;
    if (x.e > 0) x = {shifted(x.m, x.e), 0};
    // With s = m 2^-k: the sum of a_i m^i 2^(k (n-i)).
    const long k = -x.e;
    long shift = 0;
    mpz_class h = a_.back(), term;
    for (std::size_t i = a_.size() - 1; i-- > 0;) {
      shift += k;
      h *= x.m;
      mpz_mul_2exp(term.get_mpz_t(), a_[i].get_mpz_t(), static_cast<mp_bitcnt_t>(shift));
      h += term;
    }
    return {h, exponent_ - shift};
  }
  ExactValues derivative() const {
    ExactValues out = *this;
    for (std::size_t i = 1; i < a_.size(); ++i) out.a_[i - 1] = a_[i] * static_cast<int>(i);
    if (a_.size() == 1)
      out.a_[0] = 0;
    else
      out.a_.pop_back();
    return out;
  }

 private:
  std::vector<mpz_class> a_;
  long exponent_ = 0;
};

/// The polynomial of degree d on the triangle at exact homogeneous barycentrics.
inline Number exact_triangle_value(int d, std::span<const Number> b,
                                   const std::vector<Number>& lambda) {
  auto [w, w_exponent] = integers(b);
  const auto [l, l_exponent] = integers(lambda);
  using bezel::bernstein::triangle_index;
  for (int m = d; m > 0; --m) {
    std::vector<mpz_class> next(static_cast<std::size_t>(bezel::bernstein::triangle_size(m - 1)));
    for (int k = 0; k < m; ++k)
      for (int j = 0; j < m - k; ++j) {
        mpz_class& out = next[static_cast<std::size_t>(triangle_index(m - 1, j, k))];
        out = l[0] * w[static_cast<std::size_t>(triangle_index(m, j, k))];
        out += l[1] * w[static_cast<std::size_t>(triangle_index(m, j + 1, k))];
        out += l[2] * w[static_cast<std::size_t>(triangle_index(m, j, k + 1))];
      }
    w = std::move(next);
  }
  return {w[0], w_exponent + d * l_exponent};
}

/// p~: the sum of |b_j| |B_j(s)|, within 2^-45 of itself.
inline long double absolute_sum(std::span<const double> b, double s) {
  std::vector<long double> w(b.begin(), b.end());
  for (long double& x : w) x = std::fabs(x);
  const long double r = std::fabs(1.0L - s), t = std::fabs(static_cast<long double>(s));
  for (std::size_t m = w.size() - 1; m > 0; --m)
    for (std::size_t j = 0; j < m; ++j) w[j] = r * w[j] + t * w[j + 1];
  return w[0];
}

/// Whether value is p or one of the two doubles around it; infinite only beyond the largest double,
/// and always where p rounds to infinity.
inline bool is_faithful(double value, const Number& p) {
  if (std::isnan(value)) return false;
  if (std::isinf(value))
    return (value > 0 ? 1 : -1) == p.sign() && compare(abs(p), Number(DBL_MAX)) > 0;
  const int side = compare(Number(value), p);
  if (side == 0) return true;
  const double other = std::nextafter(value, side < 0 ? HUGE_VAL : -HUGE_VAL);
  if (std::isinf(other)) return compare(abs(p), Number(DBL_MAX) + Number(0x1p970)) < 0;
  return compare(Number(other), p) == -side;
}

/// Whether value is the double nearest to p, ties to even.
inline bool is_nearest(double value, const Number& p) {
  if (!is_faithful(value, p)) return false;
  if (std::isinf(value)) return compare(abs(p), Number(DBL_MAX) + Number(0x1p970)) >= 0;
  const int side = compare(Number(value), p);
  if (side == 0) return true;
  const double other = std::nextafter(value, side < 0 ? HUGE_VAL : -HUGE_VAL);
  if (std::isinf(other)) return true;
  const int nearer = compare(abs(Number(value) - p), abs(Number(other) - p));
  const auto odd = [](double x) {
    int exponent = 0;
    const double m = std::frexp(x, &exponent);
    return std::fmod(std::ldexp(m, exponent < -1021 ? exponent + 1074 : 53), 2.0) != 0.0;
  };
  return nearer < 0 || (nearer == 0 && !odd(value));
}

/// Whether |value - p| <= bound; an infinite value has only an infinite bound.
inline bool is_bound(double value, double bound, const Number& p) {
  if (std::isnan(value) || !(bound >= 0.0)) return false;
  if (std::isinf(bound)) return true;
  if (std::isinf(value)) return false;
  return compare(abs(Number(value) - p), Number(bound)) <= 0;
}

}  // namespace support
