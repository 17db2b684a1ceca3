#pragma once
// A Bernstein polynomial in exact arithmetic: signs and values without any rounding.

#include <span>
#include <vector>

#include "bezel/numeric/dyadic.hpp"

namespace bezel::bernstein {

/// The polynomial with the given coefficients, taken as exact, in the power basis: conversion once,
/// values many times.
class ExactPolynomial {
 public:
  /// @throws InputError when b is empty, of too large a degree, or not finite
  explicit ExactPolynomial(std::span<const double> b);
  /// The coefficients may be any dyadic numbers; at least one.
  explicit ExactPolynomial(std::span<const Dyadic> b);

  int degree() const { return static_cast<int>(b_.size()) - 1; }
  /// Coefficients of 1, s, s^2, ...
  std::span<const Dyadic> monomial() const { return a_; }
  bool is_zero() const;

  /// p(s) exactly. @cost d products by one or two limbs: 1 to 20 us for d = 8 to 60
  Dyadic operator()(const Dyadic& s) const;
  /// The sign of p(s).
  int sign(const Dyadic& s) const { return (*this)(s).sign(); }
  ExactPolynomial derivative() const;
  /// Bernstein coefficients on [0, 1], as given.
  std::span<const Dyadic> coefficients() const { return b_; }
  /// Bernstein coefficients on [lo, hi], exactly. @cost O(d^3) products
  std::vector<Dyadic> specialize(const Dyadic& lo, const Dyadic& hi) const;

 private:
  std::vector<Dyadic> b_, a_;
};

/// Halves a polynomial without dividing: c becomes its Bernstein coefficients on the right half of
/// the interval, the result those on the left one, both times 2^degree.
///
/// @param c  coefficients, at least one
std::vector<Dyadic> bisect_exactly(std::vector<Dyadic>& c);

}  // namespace bezel::bernstein
