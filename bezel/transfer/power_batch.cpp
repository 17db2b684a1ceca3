#include "bezel/transfer/power_batch.hpp"

#include "bezel/bernstein/index.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/moments.hpp"

// Few targets, for the sake of those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/power_batch.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on
#include "bezel/transfer/vector_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

template <int P>
void powers_of_degree(std::size_t elements, const double* c, const double* factors,
                      const double* matrix, std::size_t count, std::size_t components, double* to) {
  constexpr auto size = static_cast<std::size_t>(bernstein::triangle_size(P));
  for (std::size_t e = 0; e < elements; ++e, c += size * lanes, to += size * components) {
    Lanes f[size];
    for (std::size_t i = 0; i < size; ++i) f[i] = load(c + i * lanes) * factors[i];
    constexpr std::size_t rows = rows_at_once<size>;
    for (std::size_t m = 0; m < size; m += rows) {
      Lanes sum[rows] = {};
      for (std::size_t i = 0; i < size; ++i) {
#pragma GCC unroll 10
        for (std::size_t n = 0; n < rows; ++n) sum[n] += f[i] * matrix[i * size + m + n];
      }
#pragma GCC unroll 10
      for (std::size_t n = 0; n < rows; ++n) store_part(sum[n], to + (m + n) * components, count);
    }
  }
}

void powers_target(int degree, std::size_t elements, const double* c, const double* factors,
                   const double* matrix, std::size_t count, std::size_t components, double* to) {
  switch (degree) {
    case 0:
      return powers_of_degree<0>(elements, c, factors, matrix, count, components, to);
    case 1:
      return powers_of_degree<1>(elements, c, factors, matrix, count, components, to);
    case 2:
      return powers_of_degree<2>(elements, c, factors, matrix, count, components, to);
    default:
      return powers_of_degree<3>(elements, c, factors, matrix, count, components, to);
  }
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {

HWY_EXPORT(powers_target);

void powers_of(int degree, std::size_t elements, const double* c, std::size_t count,
               std::size_t components, double* to) {
  HWY_DYNAMIC_DISPATCH(powers_target)
  (degree, elements, c, multinomials(degree).data(), power_matrix(degree).data(), count, components,
   to);
}

}  // namespace bezel::detail
#endif
