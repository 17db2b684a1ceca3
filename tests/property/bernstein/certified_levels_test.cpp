// The level of precision that certified values need is the one that their conditioning asks for:
// the fast ones serve nearly all points, exact arithmetic only the worst.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "bezel/bernstein/certified.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "certified_check.hpp"
#include "support/exact_values.hpp"
#include "support/hard_polynomials.hpp"

namespace {

using namespace bezel::bernstein;
using support::ExactValues;
using support::Hard;
using support::HardPolynomials;
using Doubles = std::vector<double>;

TEST(CertifiedLevels, RandomPointsNeedTwiceTheWorkingPrecision) {
  HardPolynomials source(41, false);
  for (const int n : {1, 2, 3, 5, 8, 15, 30, 60}) {
    int doubled = 0, all = 0;
    for (int polynomial = 0; polynomial < 50; ++polynomial) {
      Doubles b(static_cast<std::size_t>(n) + 1), s(100);
      for (double& x : b) x = 2.0 * source.unit() - 1.0;
      for (double& x : s) x = source.unit();
      for (const CertifiedValue& x : support::certified_batch(b, s)) {
        doubled += x.certificate == Certificate::doubled ? 1 : 0;
        ++all;
      }
    }
    EXPECT_GT(doubled, 0.99 * all) << "degree " << n;
  }
}

// Huge and tiny coefficients are scaled, not sent to exact arithmetic.
TEST(CertifiedLevels, MagnitudesDoNotMatter) {
  HardPolynomials source(44, false);
  for (const int exponent : {-880, -400, 400, 1023}) {
    int doubled = 0, all = 0;
    for (int polynomial = 0; polynomial < 50; ++polynomial) {
      Doubles b(static_cast<std::size_t>(1 + source.degree(60))), s(40);
      for (double& x : b) x = std::ldexp(2.0 * source.unit() - 1.0, exponent);
      for (double& x : s) x = source.unit();
      const ExactValues exact(b);
      const std::vector<CertifiedValue> found = support::certified_batch(b, s);
      for (std::size_t q = 0; q < s.size(); ++q) {
        EXPECT_EQ(support::complaint(found[q], exact(s[q])), "") << support::described(b, s[q]);
        doubled += found[q].certificate == Certificate::doubled ? 1 : 0;
        ++all;
      }
    }
    EXPECT_GT(doubled, 0.99 * all) << "2^" << exponent;
  }
}

// With cond(p, s) 64 times below what the error bounds of K = 3 and 4 ask for, no higher level.
TEST(CertifiedLevels, CancelledPointsNeedNoMoreThanTheirConditionAsks) {
  HardPolynomials source(42, false);
  std::array<int, 6> expected{}, served{};
  for (int i = 0; i < 20000; ++i) {
    const int n = source.degree(30);
    const Hard hard = source.cancelled(n);
    if (!(hard.s > 0x1p-10 && hard.s < 1 - 0x1p-10)) continue;
    const long double size = std::fabs(support::approximate(ExactValues(hard.b)(hard.s)));
    const long double absolute = support::absolute_sum(hard.b, hard.s);
    if (size == 0.0L || size < 0x1p-300L || absolute > 0x1p300L) continue;
    const auto serves = [&](int K, long double multiplier) {
      return absolute / size < std::ldexp(1.0L, 53 * (K - 1)) / (64.0L * multiplier);
    };
    const int level = serves(2, 54.0L * n * n + 100.0L * n) ? 2
                      : serves(3, error_multiplier(n, 3))   ? 3
                      : serves(4, error_multiplier(n, 4))   ? 4
                                                            : 5;
    ++expected[static_cast<std::size_t>(level)];
    const CertifiedValue x = evaluate_certified(hard.b, hard.s);
    served[static_cast<std::size_t>(level)] += static_cast<int>(x.certificate) <= level ? 1 : 0;
  }
  for (const std::size_t level : {2U, 3U, 4U}) {
    EXPECT_GT(expected[level], 300) << level;
    EXPECT_GT(served[level], 0.99 * expected[level]) << level;
  }
}

// And the other way: what the error bounds of a level do not allow is not served by it. Of level
// K's value the error before rounding is at most c u^K p~, and certified when that is below u/2 of
// the value: cond <= 1 / (2 c u^(K-1)), with c = 27 d^2 + 72 d + 16 for K = 2 and error_multiplier
// for K = 3, 4 (docs/methods/certified.md). A test of values alone cannot tell a constant that is
// four times too small, as errors hardly come near their bounds.
TEST(CertifiedLevels, NoLevelServesBeyondItsBound) {
  HardPolynomials source(43, false);
  std::array<int, 6> near{};
  for (int i = 0; i < 30000; ++i) {
    const int n = source.degree(60);
    const Hard hard = source.cancelled(n);
    const CertifiedValue x = evaluate_certified(hard.b, hard.s);
    if (x.certificate == Certificate::exact || hard.s == 0.0 || hard.s == 1.0) continue;
    const int K = static_cast<int>(x.certificate);
    const long double c = K == 2 ? 27.0L * n * n + 72.0L * n + 16.0L
                                 : static_cast<long double>(error_multiplier(n, K));
    const long double size = std::fabs(support::approximate(ExactValues(hard.b)(hard.s)));
    if (size == 0.0L) continue;  // the zero polynomial
    const long double share =
        2 * std::ldexp(c, -53 * (K - 1)) * support::absolute_sum(hard.b, hard.s) / size;
    EXPECT_LE(share, 1.0L + 0x1p-20L) << "K " << K << "; " << support::described(hard.b, hard.s);
    // The returned bound contains both parts.
    EXPECT_GE(x.error_bound / (0.5L * 0x1p-53L * size * share), 1.0L - 0x1p-20L)
        << "K " << K << "; " << support::described(hard.b, hard.s);
    near[static_cast<std::size_t>(K)] += share > 0.25L ? 1 : 0;
  }
  for (const std::size_t K : {2U, 3U, 4U}) EXPECT_GT(near[K], 50) << K;
}

}  // namespace
