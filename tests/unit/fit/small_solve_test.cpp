// The vectorised loops of small dense algebra against plain sums.
#include "bezel/fit/small_solve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bezel/base/random.hpp"

namespace {

using namespace bezel;
using small::Vector;

TEST(SmallSolve, SystemsOfEverySize) {
  RandomStream random("SmallSolve.Systems", 1);
  for (int n = 1; n <= 29; ++n) {
    small::Matrix a{}, kept{};
    Vector exact{}, x{};
    for (int r = 0; r < n; ++r) exact[std::size_t(r)] = random.uniform(-1.0, 1.0);
    for (int r = 0; r < n; ++r) {
      double sum = 0.0;
      for (int c = 0; c < n; ++c) {
        a[r][c] = random.uniform(-1.0, 1.0) + (r == (c + 1) % n ? 4.0 : 0.0);
        sum += a[r][c] * exact[std::size_t(c)];
      }
      a[r][n] = sum;
    }
    kept = a;
    ASSERT_TRUE(small::solve(n, a, x)) << n;
    // The row permutation of 4 I plus a perturbation: condition numbers below 1e3 (seen 60).
    for (int r = 0; r < n; ++r)
      EXPECT_NEAR(x[std::size_t(r)], exact[std::size_t(r)], 1e-13) << n << " " << r;
    // A row of zeros, and one that is not finite.
    for (const double bad : {0.0, HUGE_VAL}) {
      small::Matrix broken = kept;
      for (int c = 0; c < n; ++c) broken[n / 2][c] = bad;
      EXPECT_FALSE(small::solve(n, broken, x)) << n << " " << bad;
    }
  }
}

// |A^T (b - A x) - mu x|, which is zero at the minimum of |A x - b|^2 + mu |x|^2.
double gradient(const std::vector<Vector>& rows, const std::vector<double>& b, int n, double mu,
                const Vector& x) {
  double largest = 0.0;
  for (int c = 0; c < n; ++c) {
    double sum = -mu * x[std::size_t(c)];
    for (std::size_t r = 0; r < rows.size(); ++r) {
      double residual = b[r];
      for (int k = 0; k < n; ++k) residual -= rows[r][std::size_t(k)] * x[std::size_t(k)];
      sum += rows[r][std::size_t(c)] * residual;
    }
    largest = std::max(largest, std::fabs(sum));
  }
  return largest;
}

TEST(SmallSolve, LeastSquaresOfEverySizeWithAndWithoutDamping) {
  RandomStream random("SmallSolve.LeastSquares", 1);
  for (int n = 1; n <= 29; ++n)
    for (const int more : {0, 1, 3 * n + 4}) {
      small::LeastSquares squares;
      squares.start(n);
      std::vector<Vector> rows(std::size_t(n + more));
      std::vector<double> b(rows.size());
      for (std::size_t r = 0; r < rows.size(); ++r) {
        for (int c = 0; c < n; ++c)
          rows[r][std::size_t(c)] = random.uniform(-1.0, 1.0) + (int(r) % n == c ? 4.0 : 0.0);
        b[r] = random.uniform(-1.0, 1.0);
        squares.add(1.0, rows[r].data(), b[r]);
      }
      squares.factor();
      double largest = 0.0;
      for (int c = 0; c < n; ++c) {
        double sum = 0.0;
        for (const Vector& row : rows) sum += row[std::size_t(c)] * row[std::size_t(c)];
        largest = std::max(largest, sum);
      }
      EXPECT_NEAR(squares.largest(), largest, 1e-13 * largest);
      for (const double mu : {0.0, 1e-20, 1e-3, 10.0}) {
        Vector x;
        ASSERT_TRUE(squares.solve(mu, x)) << n << " " << more;
        EXPECT_LE(gradient(rows, b, n, mu, x), 1e-12) << n << " " << more << " " << mu;
      }
    }
}

TEST(SmallSolve, LeastSquaresWithoutRankNeedDamping) {
  small::LeastSquares squares;
  squares.start(2);
  const Vector row{1.0, 1.0};
  for (int r = 0; r < 3; ++r) squares.add(1.0, row.data(), 1.0);
  squares.factor();
  Vector x;
  ASSERT_TRUE(squares.solve(1e-6, x));
  EXPECT_NEAR(x[0], 0.5, 1e-6);
  EXPECT_NEAR(x[1], 0.5, 1e-6);
}

TEST(SmallSolve, CombinesColumns) {
  RandomStream random("SmallSolve.Combine", 1);
  for (const int stride : {4, 8, 12, 20, 120})
    for (const int n : {1, 2, 7, 31}) {
      std::vector<double> table(std::size_t(n * stride)), x, out(std::size_t(stride), 0.0);
      for (double& v : table) v = random.uniform(-1.0, 1.0);
      for (int k = 0; k < n; ++k) x.push_back(random.uniform(-1.0, 1.0));
      small::combine(n, stride, table.data(), x.data(), out.data());
      for (int a = 0; a < stride; ++a) {
        // In the same order: the same bits, whatever the instruction set.
        double sum = 0.0;
        for (int k = 0; k < n; ++k) sum += table[std::size_t(k * stride + a)] * x[std::size_t(k)];
        EXPECT_EQ(out[std::size_t(a)], sum) << stride << " " << n << " " << a;
      }
    }
}

}  // namespace
