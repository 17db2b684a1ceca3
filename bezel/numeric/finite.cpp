#include "bezel/numeric/finite.hpp"

#include <cmath>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/numeric/finite.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bezel::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// x - x is 0 for a finite x and NaN otherwise; zeros and NaNs add up to zero or NaN.
bool all_finite(const double* HWY_RESTRICT x, std::size_t count) {
  const hn::ScalableTag<double> tag;
  const std::size_t lanes = hn::Lanes(tag);
  auto sum0 = hn::Zero(tag), sum1 = hn::Zero(tag);
  std::size_t i = 0;
  for (; i + 2 * lanes <= count; i += 2 * lanes) {
    const auto a = hn::LoadU(tag, x + i), b = hn::LoadU(tag, x + i + lanes);
    sum0 = hn::Add(sum0, hn::Sub(a, a));
    sum1 = hn::Add(sum1, hn::Sub(b, b));
  }
  sum0 = hn::Add(sum0, sum1);
  bool finite = hn::AllTrue(tag, hn::Eq(sum0, sum0));
  for (; i < count; ++i) finite = finite && std::isfinite(x[i]);
  return finite;
}

}  // namespace bezel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel {

HWY_EXPORT(all_finite);

bool all_finite(std::span<const double> values) {
  return HWY_DYNAMIC_DISPATCH(all_finite)(values.data(), values.size());
}

}  // namespace bezel
#endif  // HWY_ONCE
