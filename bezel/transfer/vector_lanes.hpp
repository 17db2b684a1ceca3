// Internal: included once per SIMD target, inside a file of several targets.

#if defined(BEZEL_TRANSFER_VECTOR_LANES_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BEZEL_TRANSFER_VECTOR_LANES_HPP
#undef BEZEL_TRANSFER_VECTOR_LANES_HPP
#else
#define BEZEL_TRANSFER_VECTOR_LANES_HPP
#endif

#include <cstring>

#include "bezel/numeric/lanes.hpp"
#include "hwy/highway.h"

// load() is always inlined: how a vector is returned does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

// Eight numbers side by side: the compiler's vectors (g++ and clang), split into registers where
// they are narrower. Nothing is fused, so every target gives the same bits.
using Lanes [[gnu::vector_size(sizeof(double) * lanes)]] = double;

HWY_INLINE Lanes load(const double* p) {
  Lanes x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
HWY_INLINE void store(const Lanes& x, double* p) {
  std::memcpy(p, &x, sizeof x);
}
HWY_INLINE double sum_of(const Lanes& x) {
  return sum_of_lanes(x);
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
