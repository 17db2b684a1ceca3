// Error-free transformations in every lane of a vector (eft.hpp for the meaning), and the few
// operations they need. On targets without fused products a "vector" is one double and std::fma
// serves, so that one kernel gives the same bits everywhere.
//
// For sources that Highway compiles once per target: included after "hwy/foreach_target.h", outside
// any namespace, with the usual include guard that is toggled per target.
#if defined(BEZEL_NUMERIC_EFT_SIMD_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BEZEL_NUMERIC_EFT_SIMD_HPP
#undef BEZEL_NUMERIC_EFT_SIMD_HPP
#else
#define BEZEL_NUMERIC_EFT_SIMD_HPP
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"

// The kernels keep vectors in arrays: not possible where their size is unknown to the compiler.
#undef BEZEL_SIMD_EFT
#if defined(HWY_NATIVE_FMA) && HWY_NATIVE_FMA && !HWY_HAVE_SCALABLE && HWY_TARGET != HWY_SCALAR
#define BEZEL_SIMD_EFT 1
#else
#define BEZEL_SIMD_EFT 0
#endif

HWY_BEFORE_NAMESPACE();
namespace bezel::HWY_NAMESPACE {

#if BEZEL_SIMD_EFT
namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::ScalableTag<double>;
using V = hn::Vec<Lanes>;
using Mask = hn::Mask<Lanes>;

/// The number of points in a vector.
HWY_INLINE std::size_t lane_count() {
  return hn::Lanes(Lanes());
}
/// The most there can be, for buffers.
inline constexpr std::size_t max_lane_count = hn::MaxLanes(Lanes());
/// Vectors that a kernel can keep in registers beside its temporaries.
inline constexpr int register_group = HWY_TARGET <= HWY_AVX3 || HWY_ARCH_ARM_A64 ? 4 : 2;

HWY_INLINE V set(double x) {
  return hn::Set(Lanes(), x);
}
HWY_INLINE V load(const double* p) {
  return hn::Load(Lanes(), p);
}
HWY_INLINE V load_unaligned(const double* p) {
  return hn::LoadU(Lanes(), p);
}
HWY_INLINE void store(V x, double* p) {
  hn::Store(x, Lanes(), p);
}
HWY_INLINE void store_unaligned(V x, double* p) {
  hn::StoreU(x, Lanes(), p);
}
HWY_INLINE V add(V a, V b) {
  return hn::Add(a, b);
}
HWY_INLINE V sub(V a, V b) {
  return hn::Sub(a, b);
}
HWY_INLINE V mul(V a, V b) {
  return hn::Mul(a, b);
}
HWY_INLINE V div(V a, V b) {
  return hn::Div(a, b);
}
HWY_INLINE V neg(V a) {
  return hn::Neg(a);
}
HWY_INLINE V abs(V a) {
  return hn::Abs(a);
}
/// a b + c, fused; a b - c; c - a b.
HWY_INLINE V mul_add(V a, V b, V c) {
  return hn::MulAdd(a, b, c);
}
HWY_INLINE V mul_sub(V a, V b, V c) {
  return hn::MulSub(a, b, c);
}
HWY_INLINE V neg_mul_add(V a, V b, V c) {
  return hn::NegMulAdd(a, b, c);
}
HWY_INLINE Mask greater(V a, V b) {
  return hn::Gt(a, b);
}
HWY_INLINE Mask less_equal(V a, V b) {
  return hn::Le(a, b);
}
HWY_INLINE Mask both(Mask a, Mask b) {
  return hn::And(a, b);
}
HWY_INLINE bool all(Mask m) {
  return hn::AllTrue(Lanes(), m);
}
/// 1 where the mask is set, 0 elsewhere.
HWY_INLINE V to_ones(Mask m) {
  return hn::IfThenElseZero(m, set(1.0));
}
/// Lane i gets what was in lane i + 1; the last lane keeps its own.
HWY_INLINE V shift_down(V x) {
  HWY_ALIGN std::int64_t from[max_lane_count];
  for (std::size_t i = 0; i < max_lane_count; ++i)
    from[i] = static_cast<std::int64_t>(i + 1 < lane_count() ? i + 1 : i);
  return hn::TableLookupLanes(x, hn::SetTableIndices(Lanes(), from));
}
HWY_INLINE double first_lane(V x) {
  return hn::GetLane(x);
}
#else
using V = double;
using Mask = bool;

HWY_INLINE std::size_t lane_count() {
  return 1;
}
inline constexpr std::size_t max_lane_count = 1;
inline constexpr int register_group = 2;

HWY_INLINE V set(double x) {
  return x;
}
HWY_INLINE V load(const double* p) {
  return *p;
}
HWY_INLINE V load_unaligned(const double* p) {
  return *p;
}
HWY_INLINE void store(V x, double* p) {
  *p = x;
}
HWY_INLINE void store_unaligned(V x, double* p) {
  *p = x;
}
HWY_INLINE V add(V a, V b) {
  return a + b;
}
HWY_INLINE V sub(V a, V b) {
  return a - b;
}
HWY_INLINE V mul(V a, V b) {
  return a * b;
}
HWY_INLINE V div(V a, V b) {
  return a / b;
}
HWY_INLINE V neg(V a) {
  return -a;
}
HWY_INLINE V abs(V a) {
  return std::fabs(a);
}
HWY_INLINE V mul_add(V a, V b, V c) {
  return std::fma(a, b, c);
}
HWY_INLINE V mul_sub(V a, V b, V c) {
  return std::fma(a, b, -c);
}
HWY_INLINE V neg_mul_add(V a, V b, V c) {
  return std::fma(-a, b, c);
}
HWY_INLINE Mask greater(V a, V b) {
  return a > b;
}
HWY_INLINE Mask less_equal(V a, V b) {
  return a <= b;
}
HWY_INLINE Mask both(Mask a, Mask b) {
  return a && b;
}
HWY_INLINE bool all(Mask m) {
  return m;
}
HWY_INLINE V to_ones(Mask m) {
  return m ? 1.0 : 0.0;
}
HWY_INLINE V shift_down(V x) {
  return x;
}
HWY_INLINE double first_lane(V x) {
  return x;
}
#endif

HWY_INLINE V two_sum(V a, V b, V& error) {
  const V s = add(a, b);
  const V z = sub(s, a);
  error = add(sub(a, sub(s, z)), sub(b, z));
  return s;
}

HWY_INLINE V two_prod(V a, V b, V& error) {
  const V p = mul(a, b);
  error = mul_sub(a, b, p);
  return p;
}

}  // namespace bezel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
