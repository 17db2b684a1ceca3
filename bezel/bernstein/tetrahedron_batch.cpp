// Evaluation on the tetrahedron at many points; as batch.cpp: lanes are points, the products and
// sums of the scalar de Casteljau in the same order, none fused.

#include <cstddef>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/tetrahedron.hpp"
#include "bezel/bernstein/tetrahedron_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/bernstein/tetrahedron_batch.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bezel::bernstein::tetrahedron::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// One step of degree m to m-1. load(n) gives coefficient n of degree m; `work` may be where it
// reads.
template <class V, class Load>
HWY_INLINE void step(int m, V l0, V l1, V l2, V l3, const Load& load, double* work) {
  const hn::ScalableTag<double> tag;
  const std::size_t lanes = hn::Lanes(tag);
  int lower = 0, above = triangle_size(m);
  for (int l = 0; l < m; ++l) {
    const int n = m - l;
    for (int k = 0; k < n; ++k) {
      const int upper = lower + (n - k + 1);
      auto left = load(lower);
      for (int j = 0; j < n - k; ++j, ++above) {
        const auto right = load(lower + j + 1);
        const auto first = hn::Add(hn::Mul(l0, left), hn::Mul(l1, right));
        const auto second = hn::Add(hn::Mul(l2, load(upper + j)), hn::Mul(l3, load(above)));
        hn::Store(hn::Add(first, second), tag, work);
        work += lanes;
        left = right;
      }
      lower = upper;
    }
    ++lower;
  }
}

void evaluate_many(int d, const double* b, const double* HWY_RESTRICT u,
                   const double* HWY_RESTRICT v, const double* HWY_RESTRICT w, std::size_t count,
                   double* HWY_RESTRICT out, double* work) {
  const hn::ScalableTag<double> tag;
  const std::size_t lanes = hn::Lanes(tag);
  std::size_t q = 0;
  for (; q + lanes <= count; q += lanes) {
    if (d == 0) {
      hn::StoreU(hn::Set(tag, b[0]), tag, out + q);
      continue;
    }
    const auto l1 = hn::LoadU(tag, u + q), l2 = hn::LoadU(tag, v + q), l3 = hn::LoadU(tag, w + q);
    const auto l0 = hn::Sub(hn::Sub(hn::Sub(hn::Set(tag, 1.0), l1), l2), l3);
    step(
        d, l0, l1, l2, l3, [&](int n) { return hn::Set(tag, b[n]); }, work);
    const auto load = [&](int n) {
      return hn::Load(tag, work + static_cast<std::size_t>(n) * lanes);
    };
    for (int m = d - 1; m > 0; --m) step(m, l0, l1, l2, l3, load, work);
    hn::StoreU(hn::Load(tag, work), tag, out + q);
  }
  for (; q < count; ++q)
    out[q] =
        kernel::evaluate_unchecked(d, b, Lambda{((1.0 - u[q]) - v[q]) - w[q], u[q], v[q], w[q]});
}

std::size_t lane_count() {
  return hn::Lanes(hn::ScalableTag<double>());
}

}  // namespace bezel::bernstein::tetrahedron::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "hwy/aligned_allocator.h"

namespace bezel::bernstein::tetrahedron {

HWY_EXPORT(evaluate_many);
HWY_EXPORT(lane_count);

void evaluate(int d, std::span<const double> b, std::span<const double> u,
              std::span<const double> v, std::span<const double> w, std::span<double> out) {
  checks::tetrahedron(d, b);
  checks::size(v.size(), u.size(), "coordinates v");
  checks::size(w.size(), u.size(), "coordinates w");
  checks::size(out.size(), u.size(), "places for values");
  checks::finite(u, "coordinate u");
  checks::finite(v, "coordinate v");
  checks::finite(w, "coordinate w");
  const std::size_t lanes = HWY_DYNAMIC_DISPATCH(lane_count)();
  const auto work = hwy::AllocateAligned<double>(b.size() * lanes);
  HWY_DYNAMIC_DISPATCH(evaluate_many)
  (d, b.data(), u.data(), v.data(), w.data(), u.size(), out.data(), work.get());
}

}  // namespace bezel::bernstein::tetrahedron
#endif  // HWY_ONCE
