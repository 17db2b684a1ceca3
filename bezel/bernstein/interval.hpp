#pragma once
// Polynomials on [0, 1] in Bernstein form: p(s) = sum b_i C(d,i) s^i (1-s)^(d-i), d = b.size()-1.
// Value is double (a scalar polynomial) or Vec2/Vec3 (a Bezier curve's control points).

#include <span>
#include <utility>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::bernstein {

template <class Value>
Value evaluate(std::span<const Value> b, double s);
/// Many points: out[q] = p(s[q]); vectorised across points, same bits on every SIMD target.
void evaluate(std::span<const double> b, std::span<const double> s, std::span<double> out);
template <class Value>
Value evaluate_derivative(std::span<const Value> b, double s);
/// Coefficients of the derivative, degree d-1 (degree 0: one zero).
template <class Value>
std::vector<Value> differentiate(std::span<const Value> b);
/// {left, right} at t; left.back() == right.front() bit for bit.
template <class Value>
std::pair<std::vector<Value>, std::vector<Value>> subdivide(std::span<const Value> b, double t);
/// The same polynomial on [t0, t1] (t0 > t1 reverses), by blossoming; end values exact for 0 and 1.
template <class Value>
std::vector<Value> specialize(std::span<const Value> b, double t0, double t1);
template <class Value>
std::vector<Value> elevate(std::span<const Value> b, int by = 1);
/// Best approximation of degree d-by in L2([0,1]).
template <class Value>
std::vector<Value> reduce(std::span<const Value> b, int by = 1);
/// Antiderivative with value 0 at s = 0, degree d+1.
std::vector<double> antiderivative(std::span<const double> b);
double integral(std::span<const double> b);
std::vector<double> multiply(std::span<const double> a, std::span<const double> b);
/// Composition-free conversions.
std::vector<double> to_monomial(std::span<const double> b);
std::vector<double> from_monomial(std::span<const double> a);
/// Values at the d+1 equally spaced points i/d <-> Bernstein coefficients.
template <class Value>
std::vector<Value> to_lagrange(std::span<const Value> b);
template <class Value>
std::vector<Value> from_lagrange(std::span<const Value> values);
/// out[i] = C(d,i) s^i (1-s)^(d-i), size d+1.
void basis(int d, double s, std::span<double> out);

/// Certified enclosure of the range on [0, 1], sharpened by subdivision to within tol of the true range
/// (tol 0: the coefficient range).
struct Range {
  double lo, hi;
};
Range range(std::span<const double> b, double tol = 0.0);

/// Simple real roots in [0, 1] by subdivision and sign variations; `multiple` marks a cluster that double
/// precision cannot separate. A polynomial that is zero everywhere is an InputError.
struct Root {
  double s;
  double lo, hi;  ///< interval known to hold the root(s)
  bool multiple;
};
std::vector<Root> roots(std::span<const double> b);

}  // namespace bezel::bernstein
