// Internal: included once per SIMD target, inside a file of several targets. V: a number or a
// vector of them; S: the same or a number.

#if defined(BEZEL_TRANSFER_POLYNOMIAL_MOVES_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BEZEL_TRANSFER_POLYNOMIAL_MOVES_HPP
#undef BEZEL_TRANSFER_POLYNOMIAL_MOVES_HPP
#else
#define BEZEL_TRANSFER_POLYNOMIAL_MOVES_HPP
#endif

#include <algorithm>

#include "bezel/bernstein/index.hpp"
#include "bezel/transfer/vector_lanes.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

constexpr int at(int degree, int a, int b) {
  return bernstein::triangle_index(degree, a, b);
}

/// f(x + s, y + t) for the monomials' coefficients.
template <int P, class V, class S>
HWY_INLINE void move_polynomial(V* f, const S& s, const S& t) {
#pragma GCC unroll 4
  for (int b = 0; b < P; ++b) {
#pragma GCC unroll 4
    for (int r = 0; r < P - b; ++r) {
#pragma GCC unroll 4
      for (int a = P - b - 1; a >= r; --a)
        f[at(P, a, b)] = mul_add(s, f[at(P, a + 1, b)], f[at(P, a, b)]);
    }
  }
#pragma GCC unroll 4
  for (int a = 0; a < P; ++a) {
#pragma GCC unroll 4
    for (int r = 0; r < P - a; ++r) {
#pragma GCC unroll 4
      for (int b = P - a - 1; b >= r; --b)
        f[at(P, a, b)] = mul_add(t, f[at(P, a, b + 1)], f[at(P, a, b)]);
    }
  }
}

/// Integrals with the monomials in (x + s, y + t) from those in (x, y).
template <int P, class V, class S>
HWY_INLINE void move_integrals(V* g, const S& s, const S& t) {
  for (int b = 0; b < P; ++b) {
    for (int r = 1; r <= P - b; ++r)
      for (int a = P - b; a >= r; --a)
        g[at(P, a, b)] = mul_add(s, g[at(P, a - 1, b)], g[at(P, a, b)]);
  }
  for (int a = 0; a < P; ++a) {
    for (int r = 1; r <= P - a; ++r)
      for (int b = P - a; b >= r; --b)
        g[at(P, a, b)] = mul_add(t, g[at(P, a, b - 1)], g[at(P, a, b)]);
  }
}

/// Puts m0 x + m1 y and m2 x + m3 y for x and y into polynomials of degree P.
template <int P, class S>
class Substitution {
 public:
  Substitution() = default;
  HWY_INLINE explicit Substitution(const S* m) { set(m); }

  HWY_INLINE void set(const S* m) {
    S powers[P + 1][P + 1];
    powers[0][0] = S{} + 1.0;
#pragma GCC unroll 4
    for (int e = 1; e <= P; ++e) {
      powers[e][e] = m[3] * powers[e - 1][e - 1];
#pragma GCC unroll 4
      for (int i = e - 1; i > 0; --i)
        powers[e][i] = mul_add(m[2], powers[e - 1][i], m[3] * powers[e - 1][i - 1]);
      powers[e][0] = m[2] * powers[e - 1][0];
#pragma GCC unroll 4
      for (int j = 0; j < e; ++j) {
        powers[j][e] = m[1] * powers[j][e - 1];
#pragma GCC unroll 4
        for (int i = e - 1; i > 0; --i)
          powers[j][i] = mul_add(m[0], powers[j][i], m[1] * powers[j][i - 1]);
        powers[j][0] = m[0] * powers[j][0];
      }
#pragma GCC unroll 4
      for (int j = 0; j <= e; ++j) {
#pragma GCC unroll 4
        for (int i = 0; i <= e; ++i) rows_[e - 1][j][i] = powers[j][i];
      }
    }
  }

  /// The coefficients of f(m0 x + m1 y, m2 x + m3 y).
  template <class V>
  HWY_INLINE void apply(V* f) const {
#pragma GCC unroll 4
    for (int e = 1; e <= P; ++e) {
      const auto& rows = rows_[e - 1];
      V old[P + 1];
#pragma GCC unroll 4
      for (int j = 0; j <= e; ++j) old[j] = f[at(P, e - j, j)];
#pragma GCC unroll 4
      for (int i = 0; i <= e; ++i) {
        V sum = rows[0][i] * old[0];
#pragma GCC unroll 4
        for (int j = 1; j <= e; ++j) sum = mul_add(rows[j][i], old[j], sum);
        f[at(P, e - i, i)] = sum;
      }
    }
  }

 private:
  /// Of degree e, row j: (m0 x + m1 y)^(e-j) (m2 x + m3 y)^j, its coefficient of x^(e-i) y^i at i.
  S rows_[std::max(P, 1)][P + 1][P + 1];
};

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
