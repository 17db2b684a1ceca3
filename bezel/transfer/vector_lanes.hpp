// Internal: included once per SIMD target, inside a file of several targets.

#if defined(BEZEL_TRANSFER_VECTOR_LANES_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BEZEL_TRANSFER_VECTOR_LANES_HPP
#undef BEZEL_TRANSFER_VECTOR_LANES_HPP
#else
#define BEZEL_TRANSFER_VECTOR_LANES_HPP
#endif

#include <cstring>

#include "bezel/transfer/lanes.hpp"
#include "hwy/highway.h"

// load() is always inlined: how a vector is returned does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

// Eight numbers side by side: the compiler's vectors (g++ and clang), split into registers where
// they are narrower. Only mul_add() is fused, so every target that can fuse gives the same bits.
using Lanes [[gnu::vector_size(sizeof(double) * lanes)]] = double;

HWY_INLINE Lanes load(const double* p) {
  Lanes x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
HWY_INLINE void store(const Lanes& x, double* p) {
  std::memcpy(p, &x, sizeof x);
}
/// The first `count` numbers, at most eight.
HWY_INLINE void store_part(const Lanes& x, double* p, std::size_t count) {
  if (count >= lanes) return store(x, p);
  for (std::size_t l = 0; l < count; ++l) p[l] = x[l];
}

/// a b + c, rounded once where the target can.
HWY_INLINE double mul_add(double a, double b, double c) {
#if HWY_NATIVE_FMA
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}
HWY_INLINE Lanes mul_add(const Lanes& a, const Lanes& b, const Lanes& c) {
#if HWY_NATIVE_FMA
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<double, lanes> d;
  alignas(64) double x[lanes], y[lanes], z[lanes];
  store(a, x);
  store(b, y);
  store(c, z);
  for (std::size_t i = 0; i < lanes; i += hn::Lanes(d))
    hn::StoreU(hn::MulAdd(hn::LoadU(d, x + i), hn::LoadU(d, y + i), hn::LoadU(d, z + i)), d, z + i);
  return load(z);
#else
  return a * b + c;
#endif
}
HWY_INLINE Lanes mul_add(double a, const Lanes& b, const Lanes& c) {
  return mul_add(Lanes{a, a, a, a, a, a, a, a}, b, c);
}

HWY_INLINE double sum_of(const Lanes& x) {
  return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
