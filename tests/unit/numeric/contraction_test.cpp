// A canary: fails when the compiler fuses products and sums, reassociates, or keeps excess
// precision. The operands are volatile, so nothing is folded at compile time.

#include <gtest/gtest.h>

#include <cmath>

namespace {

// a*b - c*d with a*b == c*d exactly as rounded products: 0 without contraction; fused, the rounding
// error of one product survives (here 2^-104 up to sign).
TEST(Contraction, DifferenceOfEqualProductsIsZero) {
  volatile double a = 1.0 + 0x1p-52, b = 1.0 - 0x1p-52;
  volatile double c = b, d = a;
  EXPECT_EQ(a * b - c * d, 0.0);
  const double fused = std::fma(a, b, -(c * d));
  EXPECT_EQ(fused, -0x1p-104);  // what a contracted build would return
}

TEST(Contraction, ProductPlusSumHasTwoRoundings) {
  volatile double a = 1.0 + 0x1p-30, b = 1.0 + 0x1p-30, c = -(1.0 + 0x1p-29);
  // a b = 1 + 2^-29 + 2^-60 rounds to 1 + 2^-29.
  EXPECT_EQ(a * b + c, 0.0);
  EXPECT_EQ(std::fma(a, b, c), 0x1p-60);
}

TEST(Contraction, LoopsAreNotFused) {
  // Factors read twice: a compiler that sees x y - y x returns 0 without computing.
  volatile double source[8] = {1.1, -2.3, 3.7, 0.3, 1e-3, -7.9, 5.3, 0.7};
  double x[8], y[8], z[8], w[8], out[8];
  for (int i = 0; i < 8; ++i) x[i] = source[i], y[i] = source[7 - i];
  for (int i = 0; i < 8; ++i) z[i] = source[i], w[i] = source[7 - i];
  for (int i = 0; i < 8; ++i) out[i] = x[i] * y[i] - z[i] * w[i];
  for (int i = 0; i < 8; ++i) EXPECT_EQ(out[i], 0.0) << i;
}

TEST(Contraction, SumsAreNotReassociated) {
  volatile double source_big = 1e16, source_one = 1.0;
  const double big = source_big, one = source_one;  // so that a compiler may see equal terms
  EXPECT_EQ((one + big) - big, 0.0);
  EXPECT_EQ(one + (big - big), 1.0);
  const double z = (one + big) - one;  // the heart of two_sum
  EXPECT_EQ((one - ((one + big) - z)) + (big - z), 1.0);
  volatile double tenth = 0.1;
  double sum = 0.0;
  for (int i = 0; i < 10; ++i) sum += tenth;
  EXPECT_EQ(sum, 0x1.fffffffffffffp-1);  // 1 - 2^-53; a reordered sum gives 1
}

TEST(Contraction, SignedZeroInfinityAndNanAreKept) {
  volatile double zero = 0.0, nan = std::nan("");
  EXPECT_TRUE(std::signbit(-zero + -zero));
  EXPECT_FALSE(nan == nan);
  EXPECT_TRUE(std::isinf(1.0 / zero));
}

TEST(Contraction, DivisionIsNotAReciprocalProduct) {
  volatile double a = 5.0, b = 49.0;
  EXPECT_EQ(a / b * b, 5.0 / 49.0 * 49.0);
  volatile double reciprocal = 1.0 / b;
  EXPECT_NE(b * reciprocal, 1.0);
  EXPECT_EQ(b / b, 1.0);
}

}  // namespace
