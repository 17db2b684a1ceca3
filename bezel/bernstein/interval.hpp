#pragma once
// Polynomials on [0, 1] in Bernstein form: p(s) = sum b_i C(d,i) s^i (1-s)^(d-i), d = b.size()-1.
// Value is double (a scalar polynomial) or Vec2/Vec3 (a Bezier curve's control points).
//
// Every function here takes 0 <= d <= max_interval_degree (the degree of the result included) and
// finite values, checks both, and throws InputError otherwise. u = 2^-53; accuracies leave out
// underflow and terms of order u^2, and say the largest fraction of the bound that the tests have
// seen. Parameters may be any finite number; accuracies hold in [0, 1]. The kernels without checks,
// for hot loops and other scalars, are in interval_kernel.hpp.

#include <span>
#include <utility>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::bernstein {

/// p(s), by de Casteljau's algorithm.
///
/// @return    b[0] at s = 0 and b[d] at s = 1, exactly
/// @accuracy  within 3 d u sum |b_i| B_i(s), 0.26 of that seen
/// @cost      d (d+1) / 2 combinations; no allocation
/// @source    [farin2002, sec. 4.2]
template <class Value>
Value evaluate(std::span<const Value> b, double s);

/// Many points: out[q] = p(s[q]), by Horner's scheme with scaled coefficients and growing powers of
/// s. The last bits may differ from those of evaluate(b, s[q]); they do not depend on the SIMD
/// target, nor on the other points.
///
/// @return    b[0] at s = 0 and b[d] at s = 1, exactly
/// @throws    also InputError when the sizes of s and out differ
/// @accuracy  within 3 d u sum |b_i| B_i(s), as evaluate; 0.35 of that seen
/// @cost      4 d vector operations for 2 to 8 points, no allocation: 0.3, 0.7 and 0.9 ns a point
/// at
///            d = 3, 8 and 10 (AVX-512). With |b_i| C(d,i) above 2^1000, one by one
/// @source    docs/methods/bernstein.md
void evaluate(std::span<const double> b, std::span<const double> s, std::span<double> out);
/// The points of a plane curve, coordinate by coordinate, with the bits of the former; the powers
/// of s serve both: 0.5, 1.2 and 1.5 ns a point at d = 3, 8 and 10 (AVX-512).
/// @throws    also InputError when the sizes of s, x and y differ
void evaluate(std::span<const Vec2> b, std::span<const double> s, std::span<double> x,
              std::span<double> y);

/// p'(s), from the last but one level of de Casteljau's algorithm.
/// @accuracy  within 6 d^2 u max|b|, 0.04 of that seen
template <class Value>
Value evaluate_derivative(std::span<const Value> b, double s);

/// Coefficients of the derivative, d (b_{i+1} - b_i), degree d-1 (degree 0: one zero); two
/// roundings each.
template <class Value>
std::vector<Value> differentiate(std::span<const Value> b);

/// Splits p at t into its parts on [0, t] and [t, 1].
///
/// @return    {left, right}; left.back() == right.front() == evaluate(b, t) bit for bit
/// @accuracy  each coefficient within 3 d u max|b|, 0.10 of that seen
template <class Value>
std::pair<std::vector<Value>, std::vector<Value>> subdivide(std::span<const Value> b, double t);

/// The same polynomial on [t0, t1] (t0 > t1 reverses), by its blossom.
///
/// @return    first and last coefficients equal to evaluate(b, t0) and evaluate(b, t1) bit for bit
/// @accuracy  as subdivide, for t0 and t1 in [0, 1]
/// @cost      (d+1)(d+2)(d+3) / 6 combinations or so
/// @source    [farin2002, sec. 4.4]
template <class Value>
std::vector<Value> specialize(std::span<const Value> b, double t0, double t1);

/// Coefficients at degree d + by of the same polynomial; by >= 0.
/// @accuracy  within 4 by u max|b|, 0.24 of that seen
template <class Value>
std::vector<Value> elevate(std::span<const Value> b, int by = 1);

/// Best approximation of degree d - by in L2([0,1]); 0 <= by <= d.
///
/// @accuracy  within 4 by (d+1) u max|b|, 0.24 of that seen
/// @cost      a tridiagonal solve per degree
/// @source    [lutterkort1999]: the Euclidean least-squares solution of elevate(c) = b is the L2
/// projection
template <class Value>
std::vector<Value> reduce(std::span<const Value> b, int by = 1);

/// Antiderivative with value 0 at s = 0, degree d+1; sums in twice the precision, rounded once.
std::vector<double> antiderivative(std::span<const double> b);

/// Integral over [0, 1]: the mean of the coefficients, summed in twice the precision.
double integral(std::span<const double> b);

/// Product of two polynomials, of degree da + db <= max_interval_degree.
/// @accuracy  coefficient k within (min(da, db) + 7) u times that of the product of |a| and |b|
std::vector<double> multiply(std::span<const double> a, std::span<const double> b);

/// Coefficients of 1, s, s^2, ... and back, computed in twice the precision. The monomial form is
/// ill-conditioned (to_monomial amplifies by up to 3^d): for exchange with others, not for
/// computing.
/// @accuracy  u |result| + 8 (d+1) u^2 times the size of the terms, C(d,k) 2^k max|b|
std::vector<double> to_monomial(std::span<const double> b);
std::vector<double> from_monomial(std::span<const double> a);

/// Values at the d+1 equally spaced points i/d from Bernstein coefficients (d = 0: a copy).
/// @accuracy  u |result| + 32 (d+1) u^2 max|b|
template <class Value>
std::vector<Value> to_lagrange(std::span<const Value> b);

/// Bernstein coefficients from the values at i/d: the inverse of to_lagrange, computed in twice the
/// precision for the values as given.
///
/// @accuracy  u |result| + 64 u^2 8^d max|values|; within u max|result| of the exact inverse in all
/// tests,
///            d <= 60. The inverse itself amplifies the rounding of the values: by 2e2 at d = 10,
///            2e7 at d = 20, 1e24 at d = 60
/// @cost      O(d^2) double-double operations
/// @source    Newton's form on the lattice, multiplied out in Bernstein form;
/// docs/methods/bernstein.md
template <class Value>
std::vector<Value> from_lagrange(std::span<const Value> values);

/// out[i] = C(d,i) s^i (1-s)^(d-i), i = 0..d; out has size d+1.
/// @accuracy  each within (2d + 3) u of itself
void basis(int d, double s, std::span<double> out);

/// An interval [lo, hi].
struct Range {
  double lo, hi;
};

/// Certified enclosure of the range of p on [0, 1], sharpened by subdivision.
///
/// @param tol  absolute, >= 0; 0 gives the range of the coefficients, which is an enclosure too
/// @return    lo <= p(s) <= hi for the exact polynomial with these coefficients, rounding included;
///            within tol + 64 d u max|b| of the true range
/// @throws    also InputError when tol is negative or NaN
/// @cost      O(log(1/tol)) splits for isolated extrema; after 20000 splits the enclosure so far is
/// returned
Range range(std::span<const double> b, double tol = 0.0);

}  // namespace bezel::bernstein
