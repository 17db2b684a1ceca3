#pragma once
// Values as if computed in K times the working precision and rounded once: the K-fold compensated
// de Casteljau algorithm.
//
// Every function takes 0 <= degree <= max_interval_degree (triangle: max_triangle_degree), finite
// coefficients and parameters and 1 <= K <= max_precision, checks all of it, and throws InputError
// otherwise. K = 1 is the plain algorithm. u = 2^-53; p~ is the sum of |b_j| |B_j|, the value of
// the polynomial with coefficients |b_j| at (|1-s|, |s|). Accuracies leave out underflow; s outside
// [0, 1] is allowed, and the bounds hold there too, with that p~, as long as nothing overflows (a
// value that is not finite tells). Needs round-to-nearest and
// -ffp-contract=off. evaluate_certified (certified.hpp) proves its result instead.

#include <span>

#include "bezel/bernstein/compensated_kernel.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::bernstein {

/// p(s).
///
/// @param b   d+1 coefficients (Value double) or control points (Vec2, Vec3: each coordinate)
/// @return    b[0] at s = 0 and b[d] at s = 1, exactly
/// @accuracy  |error| <= (u + O(u^2)) |p| + error_multiplier(d, K) u^K p~. The first term is the
///            final rounding, reached next to powers of two; of the second 0.93, 0.25, 0.05, 0.013
///            and 0.001 were seen for K = 1 to 5, in 10^6 values made to be hard
/// @cost      K = 2, 3, 4: 18 T + 13, 59 T + 32, 130 T + 63 flops with T = d (d+1) / 2, counting a
///            fused product as one; (15 K^2 + 11 K - 34) T + ... with Dekker's products. No
///            allocation up to degree 15 and K = 4. Many points at once are about ten times cheaper
/// @source    [hermes2018, algorithm 5.3, theorem 5.2]; docs/methods/compensated.md
template <class Value>
Value evaluate_compensated(std::span<const Value> b, double s, int K);

/// Many points: out[q] = p(s[q]); the bits of the scalar version, on every SIMD target.
///
/// @throws    also InputError when the sizes of s and out differ
/// @cost      lanes are points; K = 2, 3, 4 run vectorised where the machine has fused products
void evaluate_compensated(std::span<const double> b, std::span<const double> s,
                          std::span<double> out, int K);

/// The K numbers whose sum is p(s): the plain value, its first compensation, the next ... Level F
/// does not depend on K.
void compensated_levels(std::span<const double> b, double s, std::span<double> levels);

/// p'(s): the differences of the coefficients are split exactly into two levels. Degree 0: zero.
///
/// @accuracy  |error| <= (3 u + O(u^2)) |p'| + error_multiplier(d-1, K) u^K d q~ with q~ the p~ of
///            the differences (K = 1: and u d q~ for rounding them)
template <class Value>
Value evaluate_derivative_compensated(std::span<const Value> b, double s, int K);

/// p(lambda) on the triangle, the barycentrics taken as exact (homogeneous: they need not sum to
/// 1).
///
/// @accuracy  |error| <= (u + O(u^2)) |p| + triangle_error_multiplier(d, K) u^K p~
/// @cost      about K^2 times the plain algorithm's and up
template <class Value>
Value evaluate_compensated(int d, std::span<const Value> b, const Lambda& lambda, int K);

/// p at lambda = (1-u-v, u, v), with 1-u-v exact to the last bit.
template <class Value>
Value evaluate_compensated(int d, std::span<const Value> b, double u, double v, int K);

/// cond(p, s) = p~ / |p|, at least 1 for s in [0, 1]; infinite where p(s) = 0 (both exactly), 1 for
/// the zero polynomial. @accuracy within 4 u (d+2) of itself: computed with the certified value
double condition_number(std::span<const double> b, double s);
double condition_number(int d, std::span<const double> b, const Lambda& lambda);

/// p~(s), rounded: within 4 (d+1) u of itself.
double absolute_value_sum(std::span<const double> b, double s);
double absolute_value_sum(int d, std::span<const double> b, const Lambda& lambda);

/// The factor of u^K p~ in the bound of the error before the final rounding:
/// 3n, 9 C(n,2) + 15 n, 27 C(n,3) + 135 C(n,2) + 150 n ...; n = 0: 0. An integer, exact below 2^53,
/// rounded to nearest above. Terms of order u^(K+1) are below 2^-40 of it for n <= 60 and K <= 20.
/// @throws  InputError when n or K is out of range
/// @source  [hermes2018, lemma 5.3]: q_F(k) = q_F(k-1) + r_F(k), r_{F+1}(k) = 3 q_F(k-1) + 5 F
/// r_F(k)
double error_multiplier(int n, int K);
/// The same on the triangle, for both forms: 4 n, 8 n (n-1) + 36 n, ...
/// @source  docs/methods/compensated.md: r_1 = 4, r_{F+1}(k) = 4 q_F(k-1) + 9 F r_F(k)
double triangle_error_multiplier(int n, int K);

/// A-priori bound of |evaluate_compensated(b, s, K) - p(s)|, rounded up:
/// u |p| (1 + 2^-40) + error_multiplier(d, K) u^K p~ (1 + 2^-40); underflow excluded.
double compensated_error_bound(std::span<const double> b, double s, int K);
/// The same on the triangle, with triangle_error_multiplier.
double compensated_error_bound(int d, std::span<const double> b, const Lambda& lambda, int K);

/// Operations of evaluate_compensated on the interval, K >= 2 and n >= 1.
struct FlopCount {
  double fused;      ///< a product with its error counts 2
  double dekker;     ///< it counts 17
  double two_prods;  ///< products with error among them
};
FlopCount compensated_flops(int n, int K);

}  // namespace bezel::bernstein
