#pragma once
// Dense systems and least squares of at most 32 unknowns, without allocation.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "bezel/fit/small_kernels.hpp"

namespace bezel::small {

constexpr int capacity = 32;
using Vector = std::array<double, capacity>;

struct Matrix {
  std::array<double, std::size_t(capacity) * capacity> a;
  double* operator[](int i) { return a.data() + std::size_t(i) * capacity; }
  const double* operator[](int i) const { return a.data() + std::size_t(i) * capacity; }
};

/// a . b by four running sums: their order is fixed, and they do not wait for each other.
inline double product(const double* a, const double* b, int n) {
  double s0 = 0.0, s1 = 0.0, s2 = 0.0, s3 = 0.0;
  int i = 0;
  for (; i + 4 <= n; i += 4) {
    s0 += a[i] * b[i];
    s1 += a[i + 1] * b[i + 1];
    s2 += a[i + 2] * b[i + 2];
    s3 += a[i + 3] * b[i + 3];
  }
  for (; i < n; ++i) s0 += a[i] * b[i];
  return (s0 + s1) + (s2 + s3);
}

/// x from a triangle with its right-hand side in column n.
inline void substitute(int n, int stride, const double* a, Vector& x) {
  for (int r = n; r-- > 0;) {
    const double* row = a + std::ptrdiff_t(r) * stride;
    double sum = row[n];
    for (int k = n; --k > r;) sum -= row[k] * x[std::size_t(k)];
    x[std::size_t(r)] = sum / row[r];
  }
}

/// Solves A x = b by Gaussian elimination with partial pivoting. A is overwritten; b is its column
/// n. False when a pivot is zero or not finite.
inline bool solve(int n, Matrix& a, Vector& x) {
  if (!eliminate(n, capacity, a[0])) return false;
  substitute(n, capacity, a[0], x);
  return true;
}

/// Minimises |A x - b| and |A x - b|^2 + damping |x|^2 by Householder's method: half the digits
/// that normal equations lose are what the search for exact curves needs.
class LeastSquares {
 public:
  static constexpr int most_rows = 400;

  void start(int columns) {
    rows_ = 0;
    columns_ = columns;
    stride_ = padded(columns + 1);
  }
  /// The next row of A, to be filled, and then its entry of b; what lies behind is padding. Rows
  /// wanted: at least as many as columns.
  double* next_row() {
    double* row = a_.data() + std::ptrdiff_t(rows_++) * stride_;
    for (int k = stride_ - padding; k < stride_; ++k) row[k] = 0.0;
    return row;
  }
  /// Adds a row of A and its entry of b, both times a weight.
  void add(double weight, const double* values, double b) {
    double* row = next_row();
    for (int c = 0; c < columns_; ++c) row[c] = weight * values[c];
    row[columns_] = weight * b;
  }
  /// Reduces A to a triangle; solve() may then be called with any damping.
  void factor() {
    triangularise(columns_, {rows_, rows_, 0}, stride_, a_.data(), work_.data());
    Vector sum{};
    for (int r = 0; r < columns_; ++r)
      for (int c = r; c < columns_; ++c) sum[std::size_t(c)] += entry(r)[c] * entry(r)[c];
    largest_ = *std::max_element(sum.begin(), sum.begin() + columns_);
  }
  /// The largest |column of A|^2.
  double largest() const { return largest_; }
  /// @return false when not finite
  bool solve(double damping, Vector& x) const {
    // Row i of the damping directly after row i of the triangle: column c ends at row 2 c + 1.
    std::array<double, std::size_t(2) * capacity * capacity> a;
    std::array<double, std::size_t(4) * capacity> work;
    for (int r = 0; r < columns_; ++r) {
      double* row = a.data() + std::ptrdiff_t(2 * r) * stride_;
      std::fill(row, row + r, 0.0);
      std::copy(entry(r) + r, entry(r) + stride_, row + r);
      std::fill(row + stride_, row + 2 * stride_, 0.0);
      row[stride_ + r] = std::sqrt(damping);
    }
    triangularise(columns_, {2 * columns_, 2, 2}, stride_, a.data(), work.data());
    substitute(columns_, stride_, a.data(), x);
    return std::all_of(x.begin(), x.begin() + columns_, [](double v) { return std::isfinite(v); });
  }

 private:
  const double* entry(int r) const { return a_.data() + std::ptrdiff_t(r) * stride_; }
  int rows_ = 0, columns_ = 0, stride_ = 0;
  double largest_ = 0.0;
  std::array<double, std::size_t(most_rows) * capacity> a_;
  std::array<double, std::size_t(2) * most_rows> work_;
};

}  // namespace bezel::small
