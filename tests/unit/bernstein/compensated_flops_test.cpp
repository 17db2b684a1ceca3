// The operation counts of compensated evaluation: the algorithm written once more on a scalar that
// counts, with fused and with Dekker's products; its values are the library's, bit for bit.

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "bezel/bernstein/compensated.hpp"

namespace {

using namespace bezel::bernstein;

struct Counting {
  static inline long operations = 0;
  double x = 0.0;
};
Counting operator+(Counting a, Counting b) {
  ++Counting::operations;
  return {a.x + b.x};
}
Counting operator-(Counting a, Counting b) {
  ++Counting::operations;
  return {a.x - b.x};
}
Counting operator*(Counting a, Counting b) {
  ++Counting::operations;
  return {a.x * b.x};
}
Counting fma_minus(Counting a, Counting b, Counting c) {
  ++Counting::operations;
  return {std::fma(a.x, b.x, -c.x)};
}

using Pair = std::pair<Counting, Counting>;
using List = std::vector<Counting>;

Pair sum_with_error(Counting a, Counting b) {
  const Counting s = a + b, z = s - a;
  return {s, (a - (s - z)) + (b - z)};
}

Pair split(Counting a) {
  const Counting c = Counting{0x1p27 + 1.0} * a;
  const Counting high = c - (c - a);
  return {high, a - high};
}

class Algorithm {
 public:
  explicit Algorithm(bool fused) : fused_(fused) {}
  long products = 0;

  Counting value(const std::vector<double>& coefficients, double parameter, int K) {
    const int n = static_cast<int>(coefficients.size()) - 1;
    std::vector<List> level(static_cast<std::size_t>(K), List(coefficients.size()));
    for (std::size_t j = 0; j < coefficients.size(); ++j) level[0][j].x = coefficients[j];
    const Counting s{parameter};
    const auto [r, rho] = sum_with_error({1.0}, {-parameter});
    for (int k = n - 1; k >= 0; --k)
      for (std::size_t j = 0; j <= static_cast<std::size_t>(k); ++j) {
        List e;
        Counting below = level[0][j];
        const Counting p = product(r, below, e), q = product(s, level[0][j + 1], e);
        level[0][j] = sum(p, q, e);
        for (std::size_t f = 1; f + 1 < static_cast<std::size_t>(K); ++f) {
          List eta;
          Counting l = e[0];
          for (std::size_t i = 1; i < e.size(); ++i) l = sum(l, e[i], eta);
          l = sum(l, product(rho, below, eta), eta);
          l = sum(l, product(s, level[f][j + 1], eta), eta);
          below = level[f][j];
          level[f][j] = sum(l, product(r, below, eta), eta);
          e = eta;
        }
        List& last = level.back();
        Counting l = e[0];
        for (std::size_t i = 1; i < e.size(); ++i) l = l + e[i];
        l = l + rho * below;
        last[j] = (l + s * last[j + 1]) + r * last[j];
      }
    List p;
    for (const List& one : level) p.push_back(one[0]);
    for (int pass = 1; pass < K; ++pass)
      for (std::size_t i = 1; i < p.size(); ++i)
        std::tie(p[i], p[i - 1]) = sum_with_error(p[i], p[i - 1]);
    Counting total = p[0];
    for (std::size_t i = 1; i < p.size(); ++i) total = total + p[i];
    return total;
  }

 private:
  static Counting sum(Counting a, Counting b, List& errors) {
    const auto [value, error] = sum_with_error(a, b);
    errors.push_back(error);
    return value;
  }
  Counting product(Counting a, Counting b, List& errors) {
    ++products;
    const Counting p = a * b;
    if (fused_) {
      errors.push_back(fma_minus(a, b, p));
    } else {
      const auto [ah, al] = split(a);
      const auto [bh, bl] = split(b);
      errors.push_back(al * bl - (((p - ah * bh) - al * bh) - ah * bl));
    }
    return p;
  }
  bool fused_;
};

TEST(CompensatedFlops, AreThoseOfTheAlgorithm) {
  std::mt19937_64 random(1);
  for (int n = 1; n <= 20; ++n) {
    std::vector<double> b;
    for (int j = 0; j <= n; ++j) b.push_back(static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
    const double s = static_cast<double>(random() >> 11) * 0x1p-53;
    for (int K = 2; K <= 6; ++K) {
      SCOPED_TRACE(testing::Message() << "n " << n << " K " << K);
      const double expected = evaluate_compensated(std::span<const double>(b), s, K);
      const FlopCount flops = compensated_flops(n, K);
      for (const bool fused : {true, false}) {
        Algorithm algorithm(fused);
        Counting::operations = 0;
        const double found = algorithm.value(b, s, K).x;
        EXPECT_EQ(std::bit_cast<std::uint64_t>(found), std::bit_cast<std::uint64_t>(expected))
            << fused;
        EXPECT_EQ(static_cast<double>(Counting::operations), fused ? flops.fused : flops.dekker);
        EXPECT_EQ(static_cast<double>(algorithm.products), flops.two_prods);
      }
    }
  }
}

}  // namespace
