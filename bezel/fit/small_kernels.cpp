#include "bezel/fit/small_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/fit/small_kernels.cpp"
// Vectors of four suffice, and targets between SSE2 and AVX2 differ little.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace bezel::small::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, padding>;

// Rows [from, to) of one or two vectors of columns: x -= v[r] f, then the sum of next[r] x is added
// to `sum`. In the block of the next pivot column, `next` is taken from it.
template <bool with_pivot, bool two>
HWY_INLINE void sweep(double* a, int stride, int from, int to, const double* v, const double* f,
                      const double* pivot, double* next, double* sum) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const auto factor = hn::LoadU(d, f);
  const auto factor2 = two ? hn::LoadU(d, f + lanes) : factor;
  auto total = hn::Zero(d), total2 = total;
  for (int r = from; r < to; ++r) {
    double* row = a + std::ptrdiff_t(r) * stride;
    const auto head = hn::Set(d, v[r]);
    const auto x = hn::Sub(hn::LoadU(d, row), hn::Mul(head, factor));
    hn::StoreU(x, d, row);
    if constexpr (with_pivot) next[r] = pivot[std::ptrdiff_t(r) * stride];
    const auto weight = hn::Set(d, next[r]);
    total = hn::Add(total, hn::Mul(weight, x));
    if constexpr (two) {
      const auto x2 = hn::Sub(hn::LoadU(d, row + lanes), hn::Mul(head, factor2));
      hn::StoreU(x2, d, row + lanes);
      total2 = hn::Add(total2, hn::Mul(weight, x2));
    }
  }
  hn::StoreU(total, d, sum);
  if constexpr (two) hn::StoreU(total2, d, sum + lanes);
}

void triangularise(int n, const Profile& profile, int stride, double* a, double* work) {
  const int lanes = int(hn::Lanes(D()));
  const int width = padded(n + 1);
  constexpr int most = 32;
  double f[most] = {}, sum[most];
  double *v = work, *next = work + profile.rows;
  std::fill(v, v + profile.rows, 0.0);
  // Column c = -1 changes nothing: it sets up the sums of column 0.
  for (int c = -1; c < n; ++c) {
    const int end = std::min(profile.rows, profile.first + profile.growth * (c + 1));
    if (c >= 0) {
      double* row = a + std::ptrdiff_t(c) * stride;
      // sum[k]: column c times column k, from row c on. The reflector is v = column c - image e_c,
      // v . v / 2 = sum[c] + |head| length.
      const double head = row[c], length = std::sqrt(sum[c]);
      const double image = head > 0.0 ? -length : length;
      const double half = sum[c] + std::fabs(head) * length;
      const double inverse = half > 0.0 ? 1.0 / half : 0.0;
      for (int k = c + 1; k <= n; ++k) {
        f[k] = (sum[k] - image * row[k]) * inverse;
        row[k] -= (head - image) * f[k];
      }
      f[c] = 0.0;
      row[c] = image;
      if (c + 1 == n) break;
    }
    const int first = (c + 1) / lanes * lanes;
    int k = first + lanes;
    if (k < width) {
      sweep<true, true>(a + first, stride, c + 1, end, v, f + first, a + c + 1, next, sum + first);
      k += lanes;
    } else {
      sweep<true, false>(a + first, stride, c + 1, end, v, f + first, a + c + 1, next, sum + first);
    }
    for (; k + lanes < width; k += 2 * lanes)
      sweep<false, true>(a + k, stride, c + 1, end, v, f + k, nullptr, next, sum + k);
    if (k < width) sweep<false, false>(a + k, stride, c + 1, end, v, f + k, nullptr, next, sum + k);
    std::swap(v, next);
    // Rows that come in with the next column have not been in a reflector yet.
    const int more = std::min(profile.rows, profile.first + profile.growth * (c + 2));
    std::fill(v + end, v + more, 0.0);
  }
}

bool eliminate(int n, int stride, double* a) {
  const D d;
  const int lanes = int(hn::Lanes(d));
  const int width = padded(n + 1);
  for (int c = 0; c < n; ++c) {
    double* top = a + std::ptrdiff_t(c) * stride;
    int pivot = c;
    double largest = std::fabs(top[c]);
    for (int r = c + 1; r < n; ++r) {
      const double size = std::fabs(a[std::ptrdiff_t(r) * stride + c]);
      if (size > largest) {
        largest = size;
        pivot = r;
      }
    }
    if (!(largest > 0.0) || !std::isfinite(largest)) return false;
    const int first = c / lanes * lanes;
    if (pivot != c) {
      double* other = a + std::ptrdiff_t(pivot) * stride;
      std::swap_ranges(top + first, top + width, other + first);
    }
    const double inverse = 1.0 / top[c];
    for (int r = c + 1; r < n; ++r) {
      double* row = a + std::ptrdiff_t(r) * stride;
      const auto factor = hn::Set(d, row[c] * inverse);
      for (int k = first; k < width; k += lanes) {
        const auto x = hn::Sub(hn::LoadU(d, row + k), hn::Mul(factor, hn::LoadU(d, top + k)));
        hn::StoreU(x, d, row + k);
      }
    }
  }
  return true;
}

void combine(int n, int stride, const double* table, const double* x, double* out) {
  const D d;
  const int lanes = int(hn::Lanes(d));
  int a = 0;
  for (; a + lanes < stride; a += 2 * lanes) {
    auto total = hn::Zero(d), total2 = total;
    const double* column = table + a;
    for (int k = 0; k < n; ++k, column += stride) {
      const auto factor = hn::Set(d, x[k]);
      total = hn::Add(total, hn::Mul(hn::LoadU(d, column), factor));
      total2 = hn::Add(total2, hn::Mul(hn::LoadU(d, column + lanes), factor));
    }
    hn::StoreU(total, d, out + a);
    hn::StoreU(total2, d, out + a + lanes);
  }
  if (a == stride) return;
  auto total = hn::Zero(d);
  const double* column = table + a;
  for (int k = 0; k < n; ++k, column += stride)
    total = hn::Add(total, hn::Mul(hn::LoadU(d, column), hn::Set(d, x[k])));
  hn::StoreU(total, d, out + a);
}

}  // namespace bezel::small::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::small {

HWY_EXPORT(triangularise);
HWY_EXPORT(eliminate);
HWY_EXPORT(combine);

void triangularise(int n, const Profile& profile, int stride, double* a, double* work) {
  HWY_DYNAMIC_DISPATCH(triangularise)(n, profile, stride, a, work);
}
bool eliminate(int n, int stride, double* a) {
  return HWY_DYNAMIC_DISPATCH(eliminate)(n, stride, a);
}
void combine(int n, int stride, const double* table, const double* x, double* out) {
  HWY_DYNAMIC_DISPATCH(combine)(n, stride, table, x, out);
}

}  // namespace bezel::small
#endif  // HWY_ONCE
