// A canary in vector code, on every SIMD target: products and sums of vectors are not fused by the
// compiler (g++ does so with intrinsics unless told not to), and the error-free transformations of
// eft_simd.hpp give exact errors in every lane.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/unit/numeric/contraction_simd_test.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
//
#include "bezel/numeric/eft_simd.hpp"

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace bezel::HWY_NAMESPACE {
namespace canary = hwy::HWY_NAMESPACE;
using CanaryTag = canary::ScalableTag<double>;

// In all of these, count is a multiple of the number of lanes.

/// out = a b + c with two roundings, in Highway's own operations.
HWY_ATTR void multiply_add(const double* a, const double* b, const double* c, std::size_t count,
                           double* out) {
  const CanaryTag tag;
  for (std::size_t i = 0; i < count; i += canary::Lanes(tag))
    canary::StoreU(canary::Add(canary::Mul(canary::LoadU(tag, a + i), canary::LoadU(tag, b + i)),
                               canary::LoadU(tag, c + i)),
                   tag, out + i);
}

/// out = a b - c likewise.
HWY_ATTR void multiply_subtract(const double* a, const double* b, const double* c,
                                std::size_t count, double* out) {
  const CanaryTag tag;
  for (std::size_t i = 0; i < count; i += canary::Lanes(tag))
    canary::StoreU(canary::Sub(canary::Mul(canary::LoadU(tag, a + i), canary::LoadU(tag, b + i)),
                               canary::LoadU(tag, c + i)),
                   tag, out + i);
}

/// out = a b + c in the operations of eft_simd.hpp.
HWY_ATTR void multiply_then_add(const double* a, const double* b, const double* c,
                                std::size_t count, double* out) {
  for (std::size_t i = 0; i < count; i += lane_count())
    store_unaligned(add(mul(load_unaligned(a + i), load_unaligned(b + i)), load_unaligned(c + i)),
                    out + i);
}

/// a b + c, a b - c and c - a b, fused.
HWY_ATTR void fused(const double* a, const double* b, const double* c, std::size_t count,
                    double* plus, double* minus, double* negative) {
  for (std::size_t i = 0; i < count; i += lane_count()) {
    const V x = load_unaligned(a + i), y = load_unaligned(b + i), z = load_unaligned(c + i);
    store_unaligned(mul_add(x, y, z), plus + i);
    store_unaligned(mul_sub(x, y, z), minus + i);
    store_unaligned(neg_mul_add(x, y, z), negative + i);
  }
}

HWY_ATTR void sums(const double* a, const double* b, std::size_t count, double* sum,
                   double* error) {
  for (std::size_t i = 0; i < count; i += lane_count()) {
    V e = set(0.0);
    store_unaligned(two_sum(load_unaligned(a + i), load_unaligned(b + i), e), sum + i);
    store_unaligned(e, error + i);
  }
}

HWY_ATTR void products(const double* a, const double* b, std::size_t count, double* product,
                       double* error) {
  for (std::size_t i = 0; i < count; i += lane_count()) {
    V e = set(0.0);
    store_unaligned(two_prod(load_unaligned(a + i), load_unaligned(b + i), e), product + i);
    store_unaligned(e, error + i);
  }
}

}  // namespace bezel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "bezel/numeric/eft.hpp"
#include "support/simd_targets.hpp"

namespace bezel {

HWY_EXPORT(multiply_add);
HWY_EXPORT(multiply_subtract);
HWY_EXPORT(multiply_then_add);
HWY_EXPORT(fused);
HWY_EXPORT(sums);
HWY_EXPORT(products);

namespace {

constexpr std::size_t count = 4096;  // of every number of lanes a multiple
using Doubles = std::vector<double>;

Doubles any(std::uint64_t seed, int exponents) {
  std::mt19937_64 random(seed);
  Doubles out(count);
  for (double& x : out)
    x = std::ldexp(static_cast<double>(random() >> 11) - 0x1p52,
                   static_cast<int>(random() % static_cast<unsigned>(exponents)) - exponents / 2);
  return out;
}

TEST(ContractionSimd, ProductPlusSumHasTwoRoundings) {
  // (1 + 2^-30)^2 = 1 + 2^-29 + 2^-60 rounds to 1 + 2^-29.
  const Doubles a(count, 1.0 + 0x1p-30), c(count, -(1.0 + 0x1p-29)), d(count, 1.0 + 0x1p-29);
  EXPECT_EQ(std::fma(a[0], a[0], c[0]), 0x1p-60);  // what fused code would return
  support::on_every_target([&] {
    Doubles sum(count, 1.0), difference(count, 1.0);
    HWY_DYNAMIC_DISPATCH(multiply_add)(a.data(), a.data(), c.data(), count, sum.data());
    HWY_DYNAMIC_DISPATCH(multiply_subtract)(a.data(), a.data(), d.data(), count, difference.data());
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(sum[i], 0.0) << i;
      ASSERT_EQ(difference[i], 0.0) << i;
    }
  });
}

TEST(ContractionSimd, RandomProductsPlusSumsHaveTwoRoundings) {
  const Doubles a = any(1, 20), b = any(2, 20), c = any(3, 120);
  int differ = 0;
  Doubles expected(count);
  for (std::size_t i = 0; i < count; ++i) {
    const volatile double product = a[i] * b[i];
    expected[i] = product + c[i];
    differ += std::fma(a[i], b[i], c[i]) != expected[i] ? 1 : 0;
  }
  EXPECT_GT(differ, 50);
  support::on_every_target([&] {
    Doubles found(count), plus(count), minus(count), negative(count);
    HWY_DYNAMIC_DISPATCH(multiply_add)(a.data(), b.data(), c.data(), count, found.data());
    EXPECT_EQ(found, expected);
    HWY_DYNAMIC_DISPATCH(multiply_then_add)(a.data(), b.data(), c.data(), count, found.data());
    EXPECT_EQ(found, expected);
    HWY_DYNAMIC_DISPATCH(fused)
    (a.data(), b.data(), c.data(), count, plus.data(), minus.data(), negative.data());
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(plus[i], std::fma(a[i], b[i], c[i]));
      ASSERT_EQ(minus[i], std::fma(a[i], b[i], -c[i]));
      ASSERT_EQ(negative[i], std::fma(-a[i], b[i], c[i]));
    }
  });
}

TEST(ContractionSimd, ErrorsOfSumsAreExact) {
  Doubles a = any(4, 120), b = any(5, 120);
  for (std::size_t i = 0; i < count; i += 7) b[i] = -a[i] * (1.0 + 0x1p-50);
  for (std::size_t i = 3; i < count; i += 64) a[i] = 0x1p-1074, b[i] = 1.0 + 0x1p-52;
  support::on_every_target([&] {
    Doubles sum(count), error(count);
    HWY_DYNAMIC_DISPATCH(sums)(a.data(), b.data(), count, sum.data(), error.data());
    for (std::size_t i = 0; i < count; ++i) {
      const WithError expected = two_sum(a[i], b[i]);  // itself tested against integers
      ASSERT_EQ(sum[i], expected.value);
      ASSERT_EQ(error[i], expected.error);
    }
  });
}

TEST(ContractionSimd, ErrorsOfProductsAreExact) {
  __extension__ using Wide = __int128;
  const Doubles a = any(6, 1), b = any(7, 1);  // integers below 2^53
  support::on_every_target([&] {
    Doubles product(count), error(count);
    HWY_DYNAMIC_DISPATCH(products)(a.data(), b.data(), count, product.data(), error.data());
    for (std::size_t i = 0; i < count; ++i) {
      ASSERT_EQ(product[i], a[i] * b[i]);
      ASSERT_TRUE(static_cast<Wide>(product[i]) + static_cast<Wide>(error[i]) ==
                  static_cast<Wide>(a[i]) * static_cast<Wide>(b[i]))
          << i;
    }
  });
}

}  // namespace
}  // namespace bezel

#endif  // HWY_ONCE
