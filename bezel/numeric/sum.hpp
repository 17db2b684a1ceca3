#pragma once
// Sums that do not lose digits, always in the given order: the same bits on every machine.

#include <span>

namespace bezel {

/// Compensated sum of values, as if computed in twice the working precision and rounded once.
///
/// @param values  any number of finite values (empty: 0), no overflow of a partial sum
/// @accuracy  |error| <= u |S| + n^2 u^2 sum |values|, S the exact sum, u = 2^-53
/// @cost      7 flops per value, one pass
/// @source    [ogita2005, algorithm 4.4, corollary 4.5]
double sum(std::span<const double> values);

/// Compensated dot product of equally long a and b, accurate as if in twice the working precision.
///
/// @throws    InputError when the lengths differ
/// @accuracy  |error| <= u |S| + n^2 u^2 sum |a_i b_i|, barring underflow
/// @cost      10 flops per pair
/// @source    [ogita2005, algorithm 5.3]
double dot(std::span<const double> a, std::span<const double> b);

/// One error-free pass: p_j, p_{j-1} = two_sum(p_j, p_{j-1}) for j = 2..n, in place. The sum of the
/// values stays exactly the same; the last becomes the rounded left-to-right sum.
///
/// @cost      6 (n - 1) flops
/// @source    [ogita2005, algorithm 4.3]
void vec_sum(std::span<double> values);

/// Sum as if computed in K times the working precision and rounded once: K - 1 passes of vec_sum,
/// then a plain sum.
///
/// @param K   1 <= K; 1 is the plain left-to-right sum
/// @throws    InputError when K < 1
/// @accuracy  |error| <= (u + 3 g(n-1)^2) |S| + g(2n-2)^K sum |values|, S the exact sum,
///            g(k) = k u / (1 - k u), for 4 n u <= 1 (K = 1: g(n-1) sum |values|)
/// @cost      (6K - 5) (n - 1) flops; allocates above 32 values
/// @source    [ogita2005, algorithm 4.8, proposition 4.10]
double sum_k(std::span<const double> values, int K);

}  // namespace bezel
