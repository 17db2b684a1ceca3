#include "bezel/field/survey_lanes.hpp"

// Few targets, for the sake of those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/field/survey_lanes.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace bezel::field_detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Comparisons tell, not Min and Max: which zero these take depends on the machine.
template <class V>
HWY_INLINE V smaller(const V& a, const V& b) {
  return hn::IfThenElse(hn::Lt(b, a), b, a);
}
template <class V>
HWY_INLINE V larger(const V& a, const V& b) {
  return hn::IfThenElse(hn::Gt(b, a), b, a);
}

void look_target(std::size_t first, std::size_t elements, std::size_t size, const double* c,
                 const double* basis, const double* share, LaneSurvey& found) {
  const hn::CappedTag<double, lanes> d;
  for (std::size_t k = 0; k < lanes; k += hn::Lanes(d)) {
    auto low = hn::LoadU(d, found.low.data() + k), high = hn::LoadU(d, found.high.data() + k),
         slack = hn::LoadU(d, found.slack.data() + k);
    const double* from = c + k;
    for (std::size_t e = 0; e < elements; ++e) {
      auto least = hn::LoadU(d, from), most = least, total = hn::Zero(d);
      for (std::size_t n = 0; n < size; ++n, from += lanes) {
        const auto x = hn::LoadU(d, from);
        least = smaller(least, x);
        most = larger(most, x);
        if (basis != nullptr) total = hn::Add(total, hn::Mul(hn::Set(d, basis[e * size + n]), x));
      }
      const std::size_t place = (first + e) * lanes + k;
      if (basis != nullptr) hn::StoreU(total, d, found.integral.data() + place);
      hn::StoreU(least, d, found.least.data() + place);
      hn::StoreU(most, d, found.most.data() + place);
      if (share != nullptr) {
        const auto wider = hn::Mul(hn::Set(d, share[e]), hn::Sub(most, least));
        slack = larger(slack, wider);
        least = hn::Sub(least, wider);
        most = hn::Add(most, wider);
      }
      low = smaller(low, least);
      high = larger(high, most);
    }
    hn::StoreU(low, d, found.low.data() + k);
    hn::StoreU(high, d, found.high.data() + k);
    hn::StoreU(slack, d, found.slack.data() + k);
  }
}

}  // namespace bezel::field_detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::field_detail {

HWY_EXPORT(look_target);

void look_at_lanes(std::size_t first, std::size_t elements, std::size_t size, const double* c,
                   const double* basis, const double* share, LaneSurvey& found) {
  HWY_DYNAMIC_DISPATCH(look_target)(first, elements, size, c, basis, share, found);
}

}  // namespace bezel::field_detail
#endif
