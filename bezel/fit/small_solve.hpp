#pragma once
// Dense systems and least squares of at most 32 unknowns, without allocation.

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
    const double inverse = 1.0 / head;
    for (int r = c + 1; r < n; ++r) {
      double* row = a[r];
      const double factor = row[c] * inverse;
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

/// Minimises |A x - b| and |A x - b|^2 + damping |x|^2 by Householder's method: half the digits
/// that normal equations lose are what the search for exact curves needs.
class LeastSquares {
 public:
  static constexpr int most_rows = 400;

  void start(int columns) {
    rows_ = 0;
    columns_ = columns;
  }
  /// Adds a row of A and its entry of b, both times a weight.
  void add(double weight, const double* row, double b) {
    for (int c = 0; c < columns_; ++c) column(c)[rows_] = weight * row[c];
    b_[std::size_t(rows_++)] = weight * b;
  }
  /// Reduces A to a triangle; solve() may then be called with any damping. Rows added: at least as
  /// many as columns.
  void factor() {
    for (int c = 0; c < columns_; ++c) {
      diagonal_[std::size_t(c)] = reduce(column(c), c, rows_);
      for (int k = c + 1; k < columns_; ++k) reflect(column(c), c, rows_, column(k));
      reflect(column(c), c, rows_, b_.data());
    }
    largest_ = 0.0;
    for (int c = 0; c < columns_; ++c) {
      double sum = diagonal_[std::size_t(c)] * diagonal_[std::size_t(c)];
      for (int r = 0; r < c; ++r) sum += column(c)[r] * column(c)[r];
      largest_ = std::max(largest_, sum);
    }
  }
  /// @param mu  damping over the largest |column of A|^2 @return false when not finite
  bool solve(double mu, Vector& x) const {
    // The triangle above a diagonal block: column c of both has entries in rows 0..c of each.
    std::array<double, std::size_t(2) * capacity * capacity> work{};
    std::array<double, std::size_t(2) * capacity> b{};
    const int n = columns_;
    const auto work_column = [&](int c) { return work.data() + std::size_t(c) * 2 * capacity; };
    // Order of rows: damping row i directly after triangle row i, so that column c ends at 2 c + 1.
    for (int c = 0; c < n; ++c) {
      for (int r = 0; r < c; ++r) work_column(c)[2 * r] = column(c)[r];
      work_column(c)[2 * c] = diagonal_[std::size_t(c)];
      work_column(c)[2 * c + 1] = std::sqrt(mu * largest_);
      b[std::size_t(2 * c)] = b_[std::size_t(c)];
    }
    std::array<double, capacity> diagonal;
    for (int c = 0; c < n; ++c) {
      const int end = 2 * c + 2;
      diagonal[std::size_t(c)] = reduce(work_column(c), c, end);
      for (int k = c + 1; k < n; ++k) reflect(work_column(c), c, end, work_column(k));
      reflect(work_column(c), c, end, b.data());
    }
    for (int r = n; r-- > 0;) {
      double sum = b[std::size_t(r)];
      for (int k = r + 1; k < n; ++k) sum -= work_column(k)[r] * x[std::size_t(k)];
      x[std::size_t(r)] = sum / diagonal[std::size_t(r)];
      if (!std::isfinite(x[std::size_t(r)])) return false;
    }
    return true;
  }

 private:
  double* column(int c) { return a_.data() + std::size_t(c) * most_rows; }
  const double* column(int c) const { return a_.data() + std::size_t(c) * most_rows; }

  // v[first..end) becomes the reflector (v . v = 2) that maps it to a multiple of e_first; returns
  // that multiple.
  static double reduce(double* v, int first, int end) {
    const double length = std::sqrt(product(v + first, v + first, end - first));
    if (!(length > 0.0)) return 0.0;
    const double image = v[first] > 0.0 ? -length : length;
    v[first] -= image;
    const double scale = std::sqrt(2.0 / product(v + first, v + first, end - first));
    for (int r = first; r < end; ++r) v[r] *= scale;
    return image;
  }
  static void reflect(const double* v, int first, int end, double* x) {
    const double factor = product(v + first, x + first, end - first);
    for (int r = first; r < end; ++r) x[r] -= factor * v[r];
  }
  int rows_ = 0, columns_ = 0;
  double largest_ = 0.0;
  std::array<double, std::size_t(most_rows) * capacity> a_;
  std::array<double, std::size_t(most_rows)> b_;
  std::array<double, capacity> diagonal_;
};

}  // namespace bezel::small
