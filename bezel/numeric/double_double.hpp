#pragma once
// A number as the unevaluated sum of two doubles: about 106 bits. For tables and small conversions,
// not for hot loops.

#include <cmath>

#include "bezel/numeric/eft.hpp"

namespace bezel {

/// hi + lo with hi == fl(hi + lo). Overflow and underflow are those of double.
///
/// @accuracy  relative error of one operation, u = 2^-53: + and - at most 3 u^2 + O(u^3), * at most
/// 5 u^2,
///            / at most 15 u^2 + O(u^3), away from underflow
/// @source    [joldes2017, algorithms 6, 12, 18]
struct DoubleDouble {
  double hi = 0.0, lo = 0.0;

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double a) : hi(a) {}  // NOLINT: a double is a DoubleDouble exactly
  constexpr DoubleDouble(double a, double b) : hi(a), lo(b) {}
  constexpr explicit operator double() const { return hi; }

  friend constexpr DoubleDouble operator-(const DoubleDouble& a) { return {-a.hi, -a.lo}; }
  friend constexpr DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const WithError s = two_sum(a.hi, b.hi);
    const WithError t = two_sum(a.lo, b.lo);
    const WithError v = fast_two_sum(s.value, s.error + t.value);
    const WithError z = fast_two_sum(v.value, t.error + v.error);
    return {z.value, z.error};
  }
  friend constexpr DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
    return a + (-b);
  }
  friend DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const WithError c = two_prod(a.hi, b.hi);
    const double t0 = a.lo * b.lo;
    const double t1 = std::fma(a.hi, b.lo, t0);
    const double c2 = std::fma(a.lo, b.hi, t1);
    const WithError z = fast_two_sum(c.value, c.error + c2);
    return {z.value, z.error};
  }
  friend DoubleDouble operator/(const DoubleDouble& a, const DoubleDouble& b) {
    const double th = 1.0 / b.hi;
    const double rh = std::fma(-b.hi, th, 1.0);
    const double rl = -(b.lo * th);
    const WithError e = fast_two_sum(rh, rl);
    const DoubleDouble m = DoubleDouble(th) + DoubleDouble(e.value, e.error) * DoubleDouble(th);
    return a * m;
  }
  DoubleDouble& operator+=(const DoubleDouble& b) { return *this = *this + b; }
  DoubleDouble& operator-=(const DoubleDouble& b) { return *this = *this - b; }
  DoubleDouble& operator*=(const DoubleDouble& b) { return *this = *this * b; }
  DoubleDouble& operator/=(const DoubleDouble& b) { return *this = *this / b; }
  friend constexpr bool operator==(const DoubleDouble&, const DoubleDouble&) = default;
};

constexpr DoubleDouble abs(const DoubleDouble& a) {
  return a.hi < 0.0 ? -a : a;
}

}  // namespace bezel
