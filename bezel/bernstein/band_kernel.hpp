#pragma once
// Symmetric positive definite band matrices in any scalar: the systems of degree reduction.

#include <cstddef>
#include <vector>

namespace bezel::bernstein::kernel {

constexpr std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// The lower band of a symmetric positive definite n x n matrix; entries (i, j), i - width <= j <=
/// i.
template <class Scalar>
class BandMatrix {
 public:
  BandMatrix(int n, int width) : n_(n), width_(width), a_(at(n) * at(width + 1), Scalar(0)) {}
  Scalar& operator()(int i, int j) { return a_[at(i) * at(width_ + 1) + at(i - j)]; }

  /// x <- A^-1 x by L D L^T, which overwrites the matrix; n width^2 / 2 products, in a fixed order.
  template <class Value>
  void solve(Value* x) {
    BandMatrix& a = *this;
    for (int i = 0; i < n_; ++i) {
      const int first = i > width_ ? i - width_ : 0;
      for (int j = first; j < i; ++j) {
        // a(i, j) becomes l_ij d_j until row i is complete.
        const int from = j > width_ ? (first > j - width_ ? first : j - width_) : first;
        Scalar sum = a(i, j);
        for (int k = from; k < j; ++k) sum = Scalar(sum - Scalar(a(i, k) * a(j, k)));
        a(i, j) = sum;
      }
      Scalar pivot = a(i, i);
      for (int j = first; j < i; ++j) {
        const Scalar scaled = Scalar(a(i, j) / a(j, j));
        pivot = Scalar(pivot - Scalar(scaled * a(i, j)));
        a(i, j) = scaled;
        x[i] = Value(x[i] - Value(scaled * x[j]));
      }
      a(i, i) = pivot;
    }
    for (int i = n_ - 1; i >= 0; --i) {
      x[i] = Value(x[i] * Scalar(Scalar(1) / a(i, i)));
      for (int k = i + 1; k < n_ && k <= i + width_; ++k)
        x[i] = Value(x[i] - Value(a(k, i) * x[k]));
    }
  }

 private:
  int n_, width_;
  std::vector<Scalar> a_;
};

}  // namespace bezel::bernstein::kernel
