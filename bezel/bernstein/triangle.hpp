#pragma once
// Polynomials on the reference triangle in Bernstein form; coefficient order: index.hpp.
// p(lambda) = sum b_ijk d!/(i!j!k!) l0^i l1^j l2^k. The degree d is always given (size = triangle_size(d)).

#include <array>
#include <span>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::bernstein {

using Lambda = std::array<double, 3>;

template <class Value>
Value evaluate(int d, std::span<const Value> b, const Lambda& lambda);
/// Value and the two derivatives d/du, d/dv where lambda = (1-u-v, u, v).
template <class Value>
ValueAndGradient<Value> evaluate_gradient(int d, std::span<const Value> b, const Lambda& lambda);
/// Many points, structure of arrays; vectorised across points, same bits on every SIMD target.
void evaluate(int d, std::span<const double> b, std::span<const double> u, std::span<const double> v,
              std::span<double> out);
/// Coefficients (degree d-1) of d/du and d/dv.
template <class Value>
std::array<std::vector<Value>, 2> differentiate(int d, std::span<const Value> b);
/// The polynomial on the triangle whose corners have barycentrics corner[0..2] (blossom; any affine triangle).
template <class Value>
std::vector<Value> specialize(int d, std::span<const Value> b, const std::array<Lambda, 3>& corner);
/// The four children of the midpoint split: three at the corners 0, 1, 2 (same orientation), then the middle
/// one, with corners at the midpoints of sides 1, 2, 0.
template <class Value>
std::array<std::vector<Value>, 4> subdivide(int d, std::span<const Value> b);
template <class Value>
std::vector<Value> elevate(int d, std::span<const Value> b, int by = 1);
/// Best approximation of degree d-by in L2 of the reference triangle.
template <class Value>
std::vector<Value> reduce(int d, std::span<const Value> b, int by = 1);
/// Product of degrees da and db: degree da + db.
std::vector<double> multiply(int da, std::span<const double> a, int db, std::span<const double> b);
/// Integral over the reference triangle (area 1/2).
double integral(int d, std::span<const double> b);
/// Coefficients along a side, in the side's direction: d+1 values.
template <class Value>
std::vector<Value> side(int d, std::span<const Value> b, int side);
/// Values at the equally spaced nodes (i,j,k)/d, in index order <-> Bernstein coefficients. d = 0 is a copy.
template <class Value>
std::vector<Value> to_lagrange(int d, std::span<const Value> b);
template <class Value>
std::vector<Value> from_lagrange(int d, std::span<const Value> values);
/// out[n] = Bernstein basis function n at lambda.
void basis(int d, const Lambda& lambda, std::span<double> out);
/// Certified enclosure of the range on the triangle, sharpened by subdivision to within tol of the true one.
Range range(int d, std::span<const double> b, double tol = 0.0);
/// Exact mass matrix of the reference triangle: entry (m, n) = integral of B_m B_n, row major.
std::vector<double> mass_matrix(int d);

}  // namespace bezel::bernstein
