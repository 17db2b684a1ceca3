#pragma once
// Dense systems of at most 32 unknowns, without allocation.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace bezel::small {

constexpr int capacity = 32;
using Vector = std::array<double, capacity>;

struct Matrix {
  std::array<double, std::size_t(capacity) * capacity> a;
  double* operator[](int i) { return a.data() + std::size_t(i) * capacity; }
  const double* operator[](int i) const { return a.data() + std::size_t(i) * capacity; }
};

/// Solves A x = b by Gaussian elimination with partial pivoting; A is overwritten, b becomes x.
/// False when a pivot is zero or not finite.
inline bool solve(int n, Matrix& a, Vector& b) {
  for (int c = 0; c < n; ++c) {
    int pivot = c;
    for (int r = c + 1; r < n; ++r)
      if (std::fabs(a[r][c]) > std::fabs(a[pivot][c])) pivot = r;
    const double head = a[pivot][c];
    if (!(std::fabs(head) > 0.0) || !std::isfinite(head)) return false;
    if (pivot != c) {
      std::swap_ranges(a[c] + c, a[c] + n, a[pivot] + c);
      std::swap(b[std::size_t(c)], b[std::size_t(pivot)]);
    }
    const double* top = a[c];
    for (int r = c + 1; r < n; ++r) {
      double* row = a[r];
      const double factor = row[c] / head;
      for (int k = c + 1; k < n; ++k) row[k] -= factor * top[k];
      b[std::size_t(r)] -= factor * b[std::size_t(c)];
    }
  }
  for (int r = n; r-- > 0;) {
    double sum = b[std::size_t(r)];
    for (int k = r + 1; k < n; ++k) sum -= a[r][k] * b[std::size_t(k)];
    b[std::size_t(r)] = sum / a[r][r];
  }
  return true;
}

/// Solves A x = b for a symmetric positive definite A, given by its lower triangle, which is
/// overwritten; b becomes x. False when A is not positive definite to rounding.
inline bool solve_spd(int n, Matrix& a, Vector& b) {
  for (int r = 0; r < n; ++r) {
    double* row = a[r];
    for (int c = 0; c <= r; ++c) {
      double sum = row[c];
      for (int k = 0; k < c; ++k) sum -= row[k] * a[c][k];
      if (c < r) {
        row[c] = sum / a[c][c];
      } else {
        if (!(sum > 0.0) || !std::isfinite(sum)) return false;
        row[r] = std::sqrt(sum);
      }
    }
  }
  for (int r = 0; r < n; ++r) {
    double sum = b[std::size_t(r)];
    for (int k = 0; k < r; ++k) sum -= a[r][k] * b[std::size_t(k)];
    b[std::size_t(r)] = sum / a[r][r];
  }
  for (int r = n; r-- > 0;) {
    double sum = b[std::size_t(r)];
    for (int k = r + 1; k < n; ++k) sum -= a[k][r] * b[std::size_t(k)];
    b[std::size_t(r)] = sum / a[r][r];
  }
  return true;
}

}  // namespace bezel::small
