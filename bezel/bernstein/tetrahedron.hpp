#pragma once
// Polynomials on the reference tetrahedron in Bernstein form; coefficient order and numbering of
// corners and faces: index.hpp, tetrahedron_index.hpp. The functions are in a namespace of their
// own: `tetrahedron::elevate(d, b)`.
// p(lambda) = sum b_ijkl d!/(i!j!k!l!) l0^i l1^j l2^k l3^l. The degree d is always given (size =
// tetrahedron_size(d)). Value is double, Vec2 or Vec3.
//
// Every function here takes 0 <= d <= max_tetrahedron_degree = 20 (the degree of the result
// included), tetrahedron_size(d) finite values and finite barycentrics that sum to 1, checks all
// but the sum, and throws InputError otherwise. u = 2^-53; accuracies leave out underflow and terms
// of order u^2, hold inside the tetrahedron, and say the largest fraction of the bound that the
// tests have seen; costs are of one core of a Xeon with two cores and a load of 3.5. The kernels
// without checks, for hot loops and other scalars, are in tetrahedron_kernel.hpp.

#include <array>
#include <span>
#include <vector>

#include "bezel/bernstein/interval.hpp"
#include "bezel/bernstein/tetrahedron_index.hpp"
#include "bezel/bernstein/tetrahedron_kernel.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::bernstein::tetrahedron {

/// Barycentrics (l0, l1, l2, l3).
using Lambda = std::array<double, 4>;

/// p(lambda), by de Casteljau's algorithm; the corner coefficients at the corners, exactly.
///
/// @accuracy  within 3 d u sum |b_n| B_n(lambda), 0.25 of that seen
/// @cost      d (d+1)(d+2)(d+3) / 24 combinations of four: 16, 28 and 48 ns at d = 1, 2, 3 (Vec3:
/// 44, 73 and 133 ns); allocates above degree 5
/// @source    [farin2002, sec. 17.3], with one more barycentric
template <class Value>
Value evaluate(int d, std::span<const Value> b, const Lambda& lambda);

/// Value and the derivatives d/du, d/dv, d/dw where lambda = (1-u-v-w, u, v, w), from one sweep.
/// @accuracy  value as evaluate; derivatives within 6 d^2 u max|b|, 0.17 of that seen
template <class Value>
ValueAndGradient<Value> evaluate_gradient(int d, std::span<const Value> b, const Lambda& lambda);

/// Many points, structure of arrays: out[q] = p at lambda = (((1-u)-v)-w, u, v, w); the bits of the
/// scalar evaluate, on every SIMD target. 1.1, 2.0 and 4.3 ns per point at d = 1, 2, 3 (AVX-512).
/// @throws    also InputError when the sizes of u, v, w and out differ
void evaluate(int d, std::span<const double> b, std::span<const double> u,
              std::span<const double> v, std::span<const double> w, std::span<double> out);

/// Coefficients (degree d-1; d = 0: one zero) of d/du, d/dv and d/dw; two roundings each.
template <class Value>
std::array<std::vector<Value>, 3> differentiate(int d, std::span<const Value> b);

/// The polynomial on the tetrahedron whose corners have barycentrics corner[0..3] (blossom; any
/// affine tetrahedron).
///
/// @accuracy  each coefficient within 3 d u max|b| for corners in the tetrahedron, 0.14 of that
/// seen
/// @cost      about d^7 / 5040 combinations
template <class Value>
std::vector<Value> specialize(int d, std::span<const Value> b, const std::array<Lambda, 4>& corner);

/// The eight children of the midpoint split, all positively oriented, each an eighth of the volume.
/// With mab the midpoint of corners a and b: child c = 0..3 keeps corner c, the others halve
/// towards it; the octahedron inside is cut along the diagonal m02 m13 into
///   4: m02 m13 m01 m12    5: m02 m13 m12 m23    6: m02 m13 m23 m03    7: m02 m13 m03 m01.
///
/// @return    children whose shared faces agree bit for bit, with each other and, on the faces of
/// the tetrahedron, with those of a neighbour that has the same face coefficients and numbers the
/// face's corners in the same ascending order
/// @accuracy  each coefficient within d u max|b|, 0.51 of that seen
/// @cost      about d^7 / 630 combinations
template <class Value>
std::array<std::vector<Value>, 8> subdivide(int d, std::span<const Value> b);

/// Coefficients at degree d + by of the same polynomial; by >= 0.
/// @accuracy  within 6 by u max|b|, 0.25 of that seen
template <class Value>
std::vector<Value> elevate(int d, std::span<const Value> b, int by = 1);

/// Product of degrees da and db: degree da + db <= max_tetrahedron_degree.
/// @accuracy  each coefficient within (tetrahedron_size(min(da, db)) + 4) u times that of |a| |b|,
/// 0.27 of that seen
std::vector<double> multiply(int da, std::span<const double> a, int db, std::span<const double> b);

/// Integral over the reference tetrahedron (volume 1/6): a sixth of the mean of the coefficients,
/// summed in twice the precision: within 2 u of itself.
double integral(int d, std::span<const double> b);

/// Coefficients on a face (0..3, opposite to the corner of that number), in the order of a triangle
/// with the corners 1 2 3, 0 3 2, 0 1 3 or 0 2 1: counter-clockwise seen from outside.
template <class Value>
std::vector<Value> face(int d, std::span<const Value> b, int face);

/// Values at the equally spaced nodes (i,j,k,l)/d, in index order (d = 0: a copy).
/// @accuracy  u |result| + 64 (d+1) u^2 max|b|
/// @cost      O(d^5) double-double operations
template <class Value>
std::vector<Value> to_lagrange(int d, std::span<const Value> b);

/// Bernstein coefficients from the values at (i,j,k,l)/d: the inverse of to_lagrange, computed in
/// twice the precision for the values as given.
/// @accuracy  u |result| + 64 u^2 8^d max|values|; within u max|result| of the exact inverse in all
/// tests, up to degree 20
/// @cost      O(d^4) double-double operations
template <class Value>
std::vector<Value> from_lagrange(int d, std::span<const Value> values);

/// out[n] = Bernstein basis function n at lambda; out has size tetrahedron_size(d).
/// @accuracy  each within (d + 3) u of itself, 0.23 of that seen
void basis(int d, const Lambda& lambda, std::span<double> out);

/// Certified enclosure of the range on the tetrahedron, sharpened by halving to within
/// tol + 200 d u max|b| of the true one; as range() on the interval.
/// @limits    maxima along whole curves or surfaces need many pieces: after 20000 splits the
///            enclosure so far is returned, still certified, wider than tol
Range range(int d, std::span<const double> b, double tol = 0.0);

}  // namespace bezel::bernstein::tetrahedron
