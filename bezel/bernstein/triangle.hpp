#pragma once
// Polynomials on the reference triangle in Bernstein form; coefficient order: index.hpp.
// p(lambda) = sum b_ijk d!/(i!j!k!) l0^i l1^j l2^k. The degree d is always given (size =
// triangle_size(d)). Value is double, Vec2 or Vec3.
//
// Every function here takes 0 <= d <= max_triangle_degree (the degree of the result included),
// triangle_size(d) finite values and finite barycentrics that sum to 1, checks all but the sum, and
// throws InputError otherwise. u = 2^-53; accuracies leave out underflow and terms of order u^2,
// hold inside the triangle, and say the largest fraction of the bound that the tests have seen. The
// kernels without checks, for hot loops (kernel::evaluate_gradient_unchecked ...) and other
// scalars, are in triangle_kernel.hpp.

#include <array>
#include <span>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::bernstein {

using Lambda = std::array<double, 3>;

/// p(lambda), by de Casteljau's algorithm; the corner coefficients at the corners, exactly.
///
/// @accuracy  within 3 d u sum |b_n| B_n(lambda), 0.12 of that seen
/// @cost      d (d+1)(d+2) / 6 combinations of three; allocates above degree 6
/// @source    [farin2002, sec. 17.3]
template <class Value>
Value evaluate(int d, std::span<const Value> b, const Lambda& lambda);

/// Value and the two derivatives d/du, d/dv where lambda = (1-u-v, u, v), from one sweep.
/// @accuracy  value as evaluate; derivatives within 6 d^2 u max|b|, 0.07 of that seen
template <class Value>
ValueAndGradient<Value> evaluate_gradient(int d, std::span<const Value> b, const Lambda& lambda);

/// Many points, structure of arrays: out[q] = p at lambda = ((1-u)-v, u, v), by Horner's scheme as
/// on the interval. The last bits may differ from those of the scalar evaluate; they do not depend
/// on the SIMD target, nor on the other points.
///
/// @throws    also InputError when the sizes of u, v and out differ
/// @accuracy  as evaluate; 0.25 of the bound seen
/// @cost      1.5 (d+1)(d+2) vector operations for 2 to 8 points, no allocation: 0.7, 0.9 and
///            4.5 ns a point at d = 2, 3 and 10 (AVX-512). With |b| d!/(i!j!k!) above 2^1000, one
///            by one
/// @source    docs/methods/bernstein.md
void evaluate(int d, std::span<const double> b, std::span<const double> u,
              std::span<const double> v, std::span<double> out);

/// Coefficients (degree d-1; d = 0: one zero) of d/du and d/dv; two roundings each.
template <class Value>
std::array<std::vector<Value>, 2> differentiate(int d, std::span<const Value> b);

/// The polynomial on the triangle whose corners have barycentrics corner[0..2] (blossom; any affine
/// triangle).
///
/// @accuracy  each coefficient within 3 d u max|b| for corners in the triangle, 0.11 of that seen
/// @cost      about d^5 / 120 combinations
template <class Value>
std::vector<Value> specialize(int d, std::span<const Value> b, const std::array<Lambda, 3>& corner);

/// The four children of the midpoint split: three at the corners 0, 1, 2 (same orientation), then
/// the middle one, with corners at the midpoints of sides 1, 2, 0.
///
/// @return    children whose shared sides agree bit for bit, with each other and, along the sides
/// of the
///            triangle, with those of a neighbour that has the same side coefficients
/// @accuracy  each coefficient within d u max|b|, 0.55 of that seen
template <class Value>
std::array<std::vector<Value>, 4> subdivide(int d, std::span<const Value> b);

/// Coefficients at degree d + by of the same polynomial; by >= 0.
/// @accuracy  within 5 by u max|b|, 0.36 of that seen
template <class Value>
std::vector<Value> elevate(int d, std::span<const Value> b, int by = 1);

/// Best approximation of degree d - by in L2 of the reference triangle; 0 <= by <= d.
///
/// @accuracy  Euclidean norm of the error within 4 by d u times that of max|b| everywhere, 0.18
/// seen
/// @cost      a band solve per degree, d^4 / 4 products
/// @source    [peters2000]: the Euclidean least-squares solution of elevate(c) = b is the L2
/// projection
template <class Value>
std::vector<Value> reduce(int d, std::span<const Value> b, int by = 1);

/// Product of degrees da and db: degree da + db <= max_triangle_degree.
/// @accuracy  each coefficient within (triangle_size(min(da, db)) + 10) u times that of |a| |b|
std::vector<double> multiply(int da, std::span<const double> a, int db, std::span<const double> b);

/// Integral over the reference triangle (area 1/2): half the mean of the coefficients, summed in
/// twice the precision.
double integral(int d, std::span<const double> b);

/// Coefficients along a side (0, 1, 2), in the side's direction: d+1 values.
template <class Value>
std::vector<Value> side(int d, std::span<const Value> b, int side);

/// Values at the equally spaced nodes (i,j,k)/d, in index order (d = 0: a copy).
/// @accuracy  u |result| + 32 (d+1) u^2 max|b|
template <class Value>
std::vector<Value> to_lagrange(int d, std::span<const Value> b);

/// Bernstein coefficients from the values at (i,j,k)/d: the inverse of to_lagrange, computed in
/// twice the precision for the values as given.
/// @accuracy  u |result| + 64 u^2 8^d max|values|; within u max|result| of the exact inverse in all
/// tests
/// @cost      O(d^3) double-double operations
template <class Value>
std::vector<Value> from_lagrange(int d, std::span<const Value> values);

/// out[n] = Bernstein basis function n at lambda; out has size triangle_size(d).
/// @accuracy  each within (d + 6) u of itself
void basis(int d, const Lambda& lambda, std::span<double> out);

/// Certified enclosure of the range on the triangle, sharpened by subdivision to within
/// tol + 64 d u max|b| of the true one; as range() on the interval.
/// @limits    maxima along whole curves need many triangles: after 20000 splits the enclosure so
/// far is
///            returned, still certified, wider than tol
Range range(int d, std::span<const double> b, double tol = 0.0);

/// Exact mass matrix of the reference triangle: entry (m, n) = integral of B_m B_n, row major,
/// triangle_size(d)^2 entries, each within 8 u of itself.
std::vector<double> mass_matrix(int d);

}  // namespace bezel::bernstein
