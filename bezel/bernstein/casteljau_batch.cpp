// SIMD lanes are points, each lane runs the scalar de Casteljau with the same products and sums in
// the same order, so every target and the scalar functions give the same bits.

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

constexpr std::size_t as_size(int i) {
  return static_cast<std::size_t>(i);
}

// One step of de Casteljau on m coefficients in registers, unrolled. No fused products: a target
// without them (SSE4) must give the same bits as one that has them.
template <int M, int J = 0, class V>
HWY_INLINE void step(V* w, V r, V s) {
  if constexpr (J < M) {
    w[J] = hn::Add(hn::Mul(r, w[J]), hn::Mul(s, w[J + 1]));
    step<M, J + 1>(w, r, s);
  }
}
template <int M, class V>
HWY_INLINE void reduce_to_one(V* w, V r, V s) {
  if constexpr (M > 0) {
    step<M>(w, r, s);
    reduce_to_one<M - 1>(w, r, s);
  }
}

/// Whole vectors of points, the degree known to the compiler; returns how many points.
template <int D>
std::size_t evaluate_degree(const double* HWY_RESTRICT b, const double* HWY_RESTRICT s,
                            std::size_t count, double* HWY_RESTRICT out) {
  const hn::ScalableTag<double> tag;
  const std::size_t lanes = hn::Lanes(tag);
  std::size_t q = 0;
  for (; q + lanes <= count; q += lanes) {
    const auto sv = hn::LoadU(tag, s + q);
    const auto rv = hn::Sub(hn::Set(tag, 1.0), sv);
    hn::Vec<decltype(tag)> w[D + 1];
    for (int j = 0; j <= D; ++j) w[j] = hn::Set(tag, b[j]);
    reduce_to_one<D>(w, rv, sv);
    hn::StoreU(w[0], tag, out + q);
  }
  return q;
}

void evaluate_interval(int d, const double* HWY_RESTRICT b, const double* HWY_RESTRICT s,
                       std::size_t count, double* HWY_RESTRICT out, double* HWY_RESTRICT work) {
  const hn::ScalableTag<double> tag;
  const std::size_t lanes = hn::Lanes(tag);
  std::size_t q = 0;
#if !HWY_HAVE_SCALABLE  // vectors in arrays
  using Evaluate = std::size_t(const double*, const double*, std::size_t, double*);
  constexpr Evaluate* known[] = {
      evaluate_degree<0>,  evaluate_degree<1>,  evaluate_degree<2>,  evaluate_degree<3>,
      evaluate_degree<4>,  evaluate_degree<5>,  evaluate_degree<6>,  evaluate_degree<7>,
      evaluate_degree<8>,  evaluate_degree<9>,  evaluate_degree<10>, evaluate_degree<11>,
      evaluate_degree<12>, evaluate_degree<13>, evaluate_degree<14>, evaluate_degree<15>};
  if (d < 16) q = known[d](b, s, count, out);
#endif
  for (; q + lanes <= count; q += lanes) {
    const auto sv = hn::LoadU(tag, s + q);
    const auto rv = hn::Sub(hn::Set(tag, 1.0), sv);
    if (d == 0) {
      hn::StoreU(hn::Set(tag, b[0]), tag, out + q);
      continue;
    }
    auto low = hn::Set(tag, b[0]);
    for (int j = 0; j < d; ++j) {
      const auto high = hn::Set(tag, b[j + 1]);
      hn::Store(hn::Add(hn::Mul(rv, low), hn::Mul(sv, high)), tag, work + as_size(j) * lanes);
      low = high;
    }
    for (int m = d - 1; m > 0; --m) {
      low = hn::Load(tag, work);
      for (int j = 0; j < m; ++j) {
        const auto high = hn::Load(tag, work + as_size(j + 1) * lanes);
        hn::Store(hn::Add(hn::Mul(rv, low), hn::Mul(sv, high)), tag, work + as_size(j) * lanes);
        low = high;
      }
    }
    hn::StoreU(hn::Load(tag, work), tag, out + q);
  }
  for (; q < count; ++q) out[q] = kernel::evaluate_unchecked(d, b, s[q]);
}

std::size_t lane_count() {
  return hn::Lanes(hn::ScalableTag<double>());
}

}  // namespace bezel::bernstein::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "hwy/aligned_allocator.h"

namespace bezel::bernstein {

HWY_EXPORT(evaluate_interval);
HWY_EXPORT(lane_count);

void casteljau_points(int d, const double* b, const double* s, std::size_t count, double* out) {
  const std::size_t lanes = HWY_DYNAMIC_DISPATCH(lane_count)();
  const auto work = hwy::AllocateAligned<double>(static_cast<std::size_t>(d + 1) * lanes);
  HWY_DYNAMIC_DISPATCH(evaluate_interval)(d, b, s, count, out, work.get());
}

}  // namespace bezel::bernstein
#endif  // HWY_ONCE
