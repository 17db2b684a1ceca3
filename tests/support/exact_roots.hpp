#pragma once
// Integer polynomials: gcd, squarefree parts, real roots in [0, 1] as dyadic intervals, signs of
// polynomials at such roots. Everything is exact.

#include <gmpxx.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

namespace support {

/// Coefficients of 1, t, t^2, ...; the last one is not zero; empty: the zero polynomial.
using Polynomial = std::vector<mpz_class>;

inline void trim(Polynomial& p) {
  while (!p.empty() && p.back() == 0) p.pop_back();
}
/// Divided by its content; signs stay.
inline Polynomial primitive(Polynomial p) {
  trim(p);
  mpz_class g = 0;
  for (const mpz_class& x : p) g = gcd(g, x);
  if (g > 1)
    for (mpz_class& x : p) mpz_divexact(x.get_mpz_t(), x.get_mpz_t(), g.get_mpz_t());
  return p;
}
inline Polynomial derivative(const Polynomial& p) {
  Polynomial out;
  for (std::size_t i = 1; i < p.size(); ++i) out.push_back(p[i] * static_cast<unsigned long>(i));
  return out;
}
inline Polynomial difference(const Polynomial& p, const Polynomial& q) {
  Polynomial out(std::max(p.size(), q.size()));
  for (std::size_t i = 0; i < p.size(); ++i) out[i] += p[i];
  for (std::size_t i = 0; i < q.size(); ++i) out[i] -= q[i];
  trim(out);
  return out;
}
/// {quotient, remainder} of a multiple of p by q, each up to a constant.
inline std::pair<Polynomial, Polynomial> divide(Polynomial p, const Polynomial& q) {
  Polynomial quotient(p.size() < q.size() ? 0 : p.size() - q.size() + 1);
  while (p.size() >= q.size()) {
    const mpz_class common = gcd(p.back(), q.back());
    const mpz_class scale = q.back() / common, factor = p.back() / common;
    const std::size_t shift = p.size() - q.size();
    for (mpz_class& x : p) x *= scale;
    for (mpz_class& x : quotient) x *= scale;
    for (std::size_t i = 0; i < q.size(); ++i) p[i + shift] -= factor * q[i];
    quotient[shift] += factor;
    trim(p);
  }
  return {primitive(std::move(quotient)), primitive(std::move(p))};
}

/// Proves two polynomials coprime by Euclid modulo 2^61 - 1; false: not proven.
inline bool coprime_modulo_prime(const Polynomial& p, const Polynomial& q) {
  constexpr std::uint64_t prime = (std::uint64_t{1} << 61) - 1;
  __extension__ using Wide = unsigned __int128;
  const auto times = [](std::uint64_t x, std::uint64_t y) {
    return static_cast<std::uint64_t>(Wide{x} * y % prime);
  };
  const auto reduced = [](const Polynomial& a) {
    std::vector<std::uint64_t> out;
    for (const mpz_class& x : a) out.push_back(mpz_fdiv_ui(x.get_mpz_t(), prime));
    return out;
  };
  std::vector<std::uint64_t> a = reduced(p), b = reduced(q);
  if (a.empty() || b.empty() || (a.back() == 0 && b.back() == 0)) return false;
  const auto cut = [](std::vector<std::uint64_t>& x) {
    while (!x.empty() && x.back() == 0) x.pop_back();
  };
  cut(a);
  cut(b);
  while (!b.empty()) {
    std::uint64_t inverse = 1, base = b.back();
    for (std::uint64_t e = prime - 2; e > 0; e >>= 1, base = times(base, base))
      if (e & 1U) inverse = times(inverse, base);
    while (a.size() >= b.size()) {
      const std::uint64_t factor = times(a.back(), inverse);
      const std::size_t shift = a.size() - b.size();
      for (std::size_t i = 0; i < b.size(); ++i)
        a[i + shift] = (a[i + shift] + (prime - times(factor, b[i]))) % prime;
      cut(a);
    }
    std::swap(a, b);
  }
  return a.size() == 1;
}

/// Up to a constant.
inline Polynomial common_divisor(Polynomial p, Polynomial q) {
  p = primitive(std::move(p));
  q = primitive(std::move(q));
  if (p.empty()) return q;
  if (q.empty()) return p;
  if (p.size() == 1 || q.size() == 1 || coprime_modulo_prime(p, q)) return {1};
  while (!q.empty()) {
    Polynomial rest = p.size() < q.size() ? p : divide(p, q).second;
    p = std::move(q);
    q = std::move(rest);
  }
  return p;
}

/// p = constant * product of result[i]^(i+1), the factors squarefree and coprime. @pre p not zero
inline std::vector<Polynomial> squarefree_factors(const Polynomial& p) {
  std::vector<Polynomial> factors;
  Polynomial rest = common_divisor(p, derivative(p)), distinct = divide(p, rest).first;
  while (distinct.size() > 1) {
    Polynomial again = common_divisor(distinct, rest);
    factors.push_back(divide(distinct, again).first);
    rest = divide(rest, again).first;
    distinct = std::move(again);
  }
  return factors;
}

/// p(a / 2^k) times 2^(k degree).
inline mpz_class scaled_value(const Polynomial& p, const mpz_class& a, unsigned long k) {
  if (p.empty()) return 0;
  mpz_class h = p.back();
  for (std::size_t i = p.size() - 1, j = 1; i-- > 0; ++j) h = h * a + (p[i] << (k * j));
  return h;
}
inline int sign_at(const Polynomial& p, const mpz_class& a, unsigned long k) {
  return sgn(scaled_value(p, a, k));
}

/// A real root of a squarefree polynomial p: a / 2^k exactly, or alone in (a / 2^k, (a + 1) / 2^k).
class RealRoot {
 public:
  RealRoot(const Polynomial& p, mpz_class a, unsigned long k, bool exact)
      : p_(p), a_(std::move(a)), k_(k), exact_(exact), left_(exact ? 0 : sign_after(p, a_)) {}

  bool exact() const { return exact_; }
  mpq_class lo() const { return dyadic(a_); }
  mpq_class hi() const { return exact_ ? lo() : dyadic(a_ + 1); }
  mpq_class middle() const { return (lo() + hi()) / 2; }
  /// Until the interval is at most 2^-bits wide.
  void refine(unsigned long bits) {
    while (!exact_ && k_ < bits) {
      const mpz_class middle = 2 * a_ + 1;
      const int sign = sign_at(p_, middle, k_ + 1);
      a_ = sign == 0 || sign == left_ ? middle : mpz_class(2 * a_);
      ++k_;
      exact_ = sign == 0;
    }
  }
  /// {lowest, highest} of q on the interval, or bounds of them.
  std::pair<mpq_class, mpq_class> range(const Polynomial& q) const {
    if (q.empty()) return {0, 0};
    const mpz_class middle = exact_ ? a_ : mpz_class(2 * a_ + 1);
    const unsigned long k = exact_ ? k_ : k_ + 1, degree = q.size() - 1;
    mpq_class value(scaled_value(q, middle, k)), error = 0;
    mpq_div_2exp(value.get_mpq_t(), value.get_mpq_t(), k * degree);
    if (!exact_) {
      mpz_class slope = 0;  // of |q'| on [0, 1]
      for (std::size_t i = 1; i < q.size(); ++i) slope += abs(q[i]) * static_cast<unsigned long>(i);
      error = slope;
      mpq_div_2exp(error.get_mpq_t(), error.get_mpq_t(), k);
    }
    return {value - error, value + error};
  }
  /// The sign of q at the root.
  int sign(const Polynomial& q) {
    for (unsigned long bits = 32;; bits *= 2) {
      refine(bits);
      const auto [low, high] = range(q);
      if (low > 0) return 1;
      if (high < 0) return -1;
      if (low == 0 && high == 0) return 0;
      if (bits == 256 && vanishes(q)) return 0;
    }
  }

 private:
  mpq_class dyadic(const mpz_class& a) const {
    mpq_class x(a);
    mpq_div_2exp(x.get_mpq_t(), x.get_mpq_t(), k_);
    return x;
  }
  int sign_after(const Polynomial& p, const mpz_class& a) const {
    const int sign = sign_at(p, a, k_);
    return sign != 0 ? sign : sign_at(derivative(p), a, k_);
  }
  int sign_before(const Polynomial& p, const mpz_class& a) const {
    const int sign = sign_at(p, a, k_);
    return sign != 0 ? sign : -sign_at(derivative(p), a, k_);
  }
  bool vanishes(const Polynomial& q) const {
    if (exact_) return sign_at(q, a_, k_) == 0;
    const Polynomial g = common_divisor(p_, q);  // squarefree, at most one root in the interval
    return g.size() > 1 && sign_after(g, a_) != sign_before(g, a_ + 1);
  }

  Polynomial p_;
  mpz_class a_;
  unsigned long k_;
  bool exact_;
  int left_;  // sign of p right of a / 2^k
};

namespace exact_roots_detail {

inline void shift_by_one(Polynomial& p) {
  for (std::size_t i = 0; i + 1 < p.size(); ++i)
    for (std::size_t j = p.size() - 1; j-- > i;) p[j] += p[j + 1];
}
/// Descartes' bound of the number of roots in (0, 1).
inline int sign_changes(const Polynomial& p) {
  Polynomial q(p.rbegin(), p.rend());
  shift_by_one(q);
  int changes = 0, last = 0;
  for (const mpz_class& x : q) {
    if (sgn(x) * last < 0) ++changes;
    if (sgn(x) != 0) last = sgn(x);
  }
  return changes;
}
/// q has the roots of p in (a, a + 1) / 2^k moved to (0, 1).
inline void isolate(const Polynomial& p, Polynomial q, const mpz_class& a, unsigned long k,
                    std::vector<RealRoot>& roots) {
  const int changes = sign_changes(q);
  if (changes == 0) return;
  if (changes == 1) {
    roots.emplace_back(p, a, k, false);
    return;
  }
  for (std::size_t i = 0, d = q.size() - 1; i < q.size(); ++i) q[i] <<= d - i;
  Polynomial right = q;
  shift_by_one(right);
  const mpz_class middle = 2 * a + 1;
  isolate(p, std::move(q), 2 * a, k + 1, roots);
  if (right.front() == 0) {
    roots.emplace_back(p, middle, k + 1, true);
    right.erase(right.begin());
  }
  isolate(p, std::move(right), middle, k + 1, roots);
}

}  // namespace exact_roots_detail

/// The roots of a squarefree polynomial in [0, 1], ascending.
///
/// @source  Vincent, Collins and Akritas: bisection with Descartes' rule of signs
inline std::vector<RealRoot> roots_in_unit_interval(const Polynomial& p) {
  if (p.empty()) throw std::invalid_argument("the zero polynomial");
  std::vector<RealRoot> roots;
  Polynomial q = p;
  if (q.front() == 0) {
    roots.emplace_back(p, 0, 0, true);
    q.erase(q.begin());
  }
  mpz_class sum = 0;
  for (const mpz_class& x : q) sum += x;
  // Descartes' rule counts (0, 1): a root at 1 does no harm, but is not found.
  if (q.size() > 1) exact_roots_detail::isolate(p, q, 0, 0, roots);
  if (sum == 0 && q.size() > 1) roots.emplace_back(p, 1, 0, true);
  return roots;
}

}  // namespace support
