// SIMD lanes are points, each lane runs the scalar de Casteljau with the same products and sums in
// the same order, none fused, so every target and the scalar functions give the same bits.

#include "bezel/bernstein/casteljau_batch.hpp"

#include <cstddef>

#include "bezel/bernstein/interval_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/bernstein/casteljau_batch.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bezel::bernstein::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using kernel::at;

/// count vectors of points, in turn: the last rows are short chains of dependent operations.
/// `work` has room for d times as many vectors. d >= 1.
template <int count>
HWY_INLINE void sweep(int d, const double* HWY_RESTRICT b, const double* s, double* out,
                      double* HWY_RESTRICT work) {
  const hn::ScalableTag<double> tag;
  using V = hn::Vec<decltype(tag)>;
  const std::size_t lanes = hn::Lanes(tag);
  V t[count], r[count], low[count];
  for (int g = 0; g < count; ++g) {
    t[g] = hn::LoadU(tag, s + at(g) * lanes);
    r[g] = hn::Sub(hn::Set(tag, 1.0), t[g]);
    low[g] = hn::Set(tag, b[0]);
  }
  const auto place = [&](int j, int g) { return work + at(j * count + g) * lanes; };
  for (int j = 0; j < d; ++j) {
    const V high = hn::Set(tag, b[j + 1]);
    for (int g = 0; g < count; ++g) {
      hn::Store(hn::Add(hn::Mul(r[g], low[g]), hn::Mul(t[g], high)), tag, place(j, g));
      low[g] = high;
    }
  }
  for (int m = d - 1; m > 0; --m) {
    for (int g = 0; g < count; ++g) low[g] = hn::Load(tag, place(0, g));
    for (int j = 0; j < m; ++j)
      for (int g = 0; g < count; ++g) {
        const V high = hn::Load(tag, place(j + 1, g));
        hn::Store(hn::Add(hn::Mul(r[g], low[g]), hn::Mul(t[g], high)), tag, place(j, g));
        low[g] = high;
      }
  }
  for (int g = 0; g < count; ++g) hn::StoreU(hn::Load(tag, place(0, g)), tag, out + at(g) * lanes);
}

constexpr int group = 4;

void evaluate_interval(int d, const double* HWY_RESTRICT b, const double* s, std::size_t count,
                       double* out, double* HWY_RESTRICT work) {
  const std::size_t lanes = hn::Lanes(hn::ScalableTag<double>());
  std::size_t q = 0;
  if (d > 0) {
    for (; q + group * lanes <= count; q += group * lanes) sweep<group>(d, b, s + q, out + q, work);
    for (; q + lanes <= count; q += lanes) sweep<1>(d, b, s + q, out + q, work);
  }
  for (; q < count; ++q) out[q] = kernel::evaluate_unchecked(d, b, s[q]);
}

std::size_t work_size(int d) {
  return at(d * group) * hn::Lanes(hn::ScalableTag<double>());
}

}  // namespace bezel::bernstein::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "hwy/aligned_allocator.h"

namespace bezel::bernstein {

HWY_EXPORT(evaluate_interval);
HWY_EXPORT(work_size);

void casteljau_points(int d, const double* b, const double* s, std::size_t count, double* out) {
  const auto work = hwy::AllocateAligned<double>(HWY_DYNAMIC_DISPATCH(work_size)(d) + 1);
  HWY_DYNAMIC_DISPATCH(evaluate_interval)(d, b, s, count, out, work.get());
}

}  // namespace bezel::bernstein
#endif  // HWY_ONCE
