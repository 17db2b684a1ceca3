// Two plane curves side by side, one in each lane of a vector: what both need is computed at once.
//
// For sources that Highway compiles once per target: included after "hwy/foreach_target.h", outside
// any namespace, with the usual include guard that is toggled per target. Highway's own vectors do
// not serve: without SSSE3 they hold one double. The operations and their order, and so all bits,
// are the same on every target.
#if defined(BEZEL_GEOMETRY_ISOLATE_VECTOR_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BEZEL_GEOMETRY_ISOLATE_VECTOR_HPP
#undef BEZEL_GEOMETRY_ISOLATE_VECTOR_HPP
#else
#define BEZEL_GEOMETRY_ISOLATE_VECTOR_HPP
#endif

#include "hwy/highway.h"

#ifdef __SSE2__
#include <immintrin.h>
#endif

HWY_BEFORE_NAMESPACE();
namespace bezel::geometry_kernel::HWY_NAMESPACE {

// Vectors of the compiler's (g++ and clang): two doubles in one register where there are such.
using Lanes [[gnu::vector_size(16)]] = double;
using LaneMask = decltype(Lanes{} < Lanes{});  // of integers: all bits or none

HWY_INLINE Lanes both(double x) {
  return Lanes{x, x};
}
/// The other curve's value in each lane.
HWY_INLINE Lanes swapped(Lanes x) {
  return __builtin_shufflevector(x, x, 1, 0);
}
HWY_INLINE Lanes first_in_both(Lanes x) {
  return __builtin_shufflevector(x, x, 0, 0);
}
/// The second one where one is NaN.
HWY_INLINE Lanes smaller(Lanes x, Lanes y) {
  return x < y ? x : y;
}
HWY_INLINE Lanes larger(Lanes x, Lanes y) {
  return x > y ? x : y;
}
HWY_INLINE double larger(Lanes x) {
  return larger(x, swapped(x))[0];
}
/// x where m is set, else y.
HWY_INLINE Lanes where(LaneMask m, Lanes x, Lanes y) {
  return m ? x : y;
}
HWY_INLINE Lanes abs(Lanes x) {
  constexpr long long magnitude = 0x7fffffffffffffff;
  return reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(x) & LaneMask{magnitude, magnitude});
}
/// Bit i: lane i is set.
HWY_INLINE unsigned lane_bits(LaneMask m) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(m)));
#else
  return (m[0] != 0 ? 1U : 0U) | (m[1] != 0 ? 2U : 0U);
#endif
}
HWY_INLINE bool any(LaneMask m) {
  return lane_bits(m) != 0;
}
HWY_INLINE bool all(LaneMask m) {
  return lane_bits(m) == 3;
}

/// A point or vector of each curve. (Both coordinates in one register of four lanes were slower.)
struct PairVector {
  Lanes x, y;
};
HWY_INLINE PairVector operator-(PairVector p, PairVector q) {
  return {p.x - q.x, p.y - q.y};
}
HWY_INLINE PairVector operator+(PairVector p, PairVector q) {
  return {p.x + q.x, p.y + q.y};
}
HWY_INLINE PairVector operator*(Lanes s, PairVector p) {
  return {s * p.x, s * p.y};
}
HWY_INLINE PairVector swapped(PairVector p) {
  return {swapped(p.x), swapped(p.y)};
}
/// a's first lane, b's second.
HWY_INLINE PairVector joined(PairVector a, PairVector b) {
  return {__builtin_shufflevector(a.x, b.x, 0, 3), __builtin_shufflevector(a.y, b.y, 0, 3)};
}
HWY_INLINE PairVector first_in_both(PairVector p) {
  return {first_in_both(p.x), first_in_both(p.y)};
}
/// The second lanes of a and b.
HWY_INLINE PairVector seconds(PairVector a, PairVector b) {
  return {__builtin_shufflevector(a.x, b.x, 1, 3), __builtin_shufflevector(a.y, b.y, 1, 3)};
}
HWY_INLINE PairVector smaller(PairVector p, PairVector q) {
  return {smaller(p.x, q.x), smaller(p.y, q.y)};
}
HWY_INLINE PairVector larger(PairVector p, PairVector q) {
  return {larger(p.x, q.x), larger(p.y, q.y)};
}
/// In each lane, whether the closed boxes have a common point.
HWY_INLINE unsigned overlap_bits(PairVector lo, PairVector hi, PairVector other_lo,
                                 PairVector other_hi) {
  return lane_bits((lo.x <= other_hi.x) & (hi.x >= other_lo.x) & (lo.y <= other_hi.y) &
                   (hi.y >= other_lo.y));
}

HWY_INLINE Lanes cross(PairVector p, PairVector q) {
  return p.x * q.y - p.y * q.x;
}
HWY_INLINE PairVector where(LaneMask m, PairVector p, PairVector q) {
  return {where(m, p.x, q.x), where(m, p.y, q.y)};
}
/// |x| + |y|
HWY_INLINE Lanes sum_norm(PairVector p) {
  return abs(p.x) + abs(p.y);
}
/// a - b in both lanes.
HWY_INLINE PairVector first_minus_second(PairVector p) {
  return first_in_both(p - swapped(p));
}

}  // namespace bezel::geometry_kernel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target guard
