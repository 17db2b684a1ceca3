#pragma once
// The inner loops of small dense algebra, compiled once per instruction set. Every sum belongs to
// one column or one point and runs in one order, so that all instruction sets give the same bits.

#include <cstddef>

namespace bezel::small {

/// Rows are padded to a multiple of this. What the padding holds does not matter, but it must be
/// initialised.
constexpr int padding = 4;
constexpr int padded(int n) {
  return (n + padding - 1) / padding * padding;
}

/// Rows of a matrix that may be nonzero in columns up to c: the first min(rows, first + growth c).
struct Profile {
  int rows, first, growth;
};

/// Reduces the first n columns of an n + 1 columns wide matrix to a triangle by Householder's
/// method; the last column is the right-hand side.
///
/// @param a     rows of `stride` numbers, padded; row r < n afterwards holds the triangle's row
///              from column r on
/// @param work  room for 2 rows numbers
void triangularise(int n, const Profile& profile, int stride, double* a, double* work);

/// The same for a square matrix by Gaussian elimination with partial pivoting. False when a pivot
/// is zero or not finite.
bool eliminate(int n, int stride, double* a);

/// out[a] = sum_k table[k stride + a] x[k], k < n, for a < stride (padded).
void combine(int n, int stride, const double* table, const double* x, double* out);

/// out[k] = d[k] (a x[k] + b y[k]) for k < padded(n). Too short a loop for a call.
inline void scaled_sum(int n, const double* d, double a, const double* x, double b, const double* y,
                       double* out) {
  for (int k = 0; k < n; k += padding)
    for (int lane = k; lane < k + padding; ++lane)
      out[lane] = d[lane] * (a * x[lane] + b * y[lane]);
}

}  // namespace bezel::small
