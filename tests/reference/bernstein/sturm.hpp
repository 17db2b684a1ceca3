#pragma once
// An independent count of real roots: Sturm's theorem in exact integers.

#include <gmpxx.h>

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "exact.hpp"

namespace exact {

using Integers = std::vector<mpz_class>;

/// Removes leading zeros and the common factor; signs stay.
inline void make_primitive(Integers& a) {
  while (!a.empty() && a.back() == 0) a.pop_back();
  mpz_class g = 0;
  for (const mpz_class& x : a) g = gcd(g, x);
  if (g > 1)
    for (mpz_class& x : a) x /= g;
}

/// Coefficients of 1, s, s^2, ... of a positive multiple of the polynomial with the Bernstein
/// coefficients b.
inline Integers power_form(std::span<const double> b) {
  std::vector<Rational> a(b.begin(), b.end());
  const std::size_t d = b.size() - 1;
  for (std::size_t k = 1; k <= d; ++k)
    for (std::size_t i = d; i >= k; --i) a[i] -= a[i - 1];
  mpz_class binomial = 1, common = 1;
  for (std::size_t k = 0; k <= d; ++k) {
    a[k] *= binomial;
    binomial = binomial * static_cast<unsigned long>(d - k) / static_cast<unsigned long>(k + 1);
    common = lcm(common, a[k].get_den());
  }
  Integers out;
  for (const Rational& x : a) out.push_back(x.get_num() * (common / x.get_den()));
  make_primitive(out);
  return out;
}

inline Integers derivative(const Integers& a) {
  Integers out;
  for (std::size_t k = 1; k < a.size(); ++k) out.push_back(a[k] * static_cast<unsigned long>(k));
  make_primitive(out);
  return out;
}

inline int sign_at(const Integers& a, const Rational& s) {
  if (a.empty()) return 0;
  // The numerator of sum a_k x^k / y^k, y > 0.
  mpz_class h = a.back(), power = 1;
  for (std::size_t k = a.size() - 1; k-- > 0;) {
    power *= s.get_den();
    h = h * s.get_num() + a[k] * power;
  }
  return sgn(h);
}

/// Divides a positive multiple of r by q: the quotient; r becomes the remainder (up to a positive
/// factor each).
inline Integers divide(Integers& r, const Integers& q) {
  const mpz_class lead = q.back(), scale = abs(lead);
  Integers quotient(r.size() < q.size() ? 0 : r.size() - q.size() + 1);
  while (r.size() >= q.size()) {
    const mpz_class factor = lead > 0 ? r.back() : mpz_class(-r.back());
    const std::size_t shift = r.size() - q.size();
    for (mpz_class& x : r) x *= scale;
    for (mpz_class& x : quotient) x *= scale;
    for (std::size_t k = 0; k < q.size(); ++k) r[k + shift] -= factor * q[k];
    quotient[shift] += factor;
    while (!r.empty() && r.back() == 0) r.pop_back();
  }
  make_primitive(r);
  make_primitive(quotient);
  return quotient;
}

class Sturm {
 public:
  explicit Sturm(std::span<const double> b) : p_(power_form(b)) {
    build(p_);
    // Without multiple roots, which as an end of an interval would spoil the count.
    if (chain_.back().size() > 1) {
      Integers r = p_;
      const Integers gcd = chain_.back();
      build(divide(r, gcd));
    }
  }
  /// Distinct roots in (lo, hi].
  int count(const Rational& lo, const Rational& hi) const { return changes(lo) - changes(hi); }
  const Integers& polynomial() const { return p_; }

 private:
  void build(const Integers& p) {
    chain_ = {p};
    for (Integers next = derivative(p); !next.empty();) {
      Integers r = chain_.back();
      chain_.push_back(next);
      divide(r, next);
      for (mpz_class& x : r) x = -x;
      next = std::move(r);
    }
  }
  int changes(const Rational& s) const {
    int last = 0, out = 0;
    for (const Integers& p : chain_) {
      const int sign = sign_at(p, s);
      if (sign * last < 0) ++out;
      if (sign != 0) last = sign;
    }
    return out;
  }
  Integers p_;
  std::vector<Integers> chain_;
};

}  // namespace exact
