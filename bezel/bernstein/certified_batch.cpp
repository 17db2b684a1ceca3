// One point per lane; several vectors of points share the coefficients and hide each other's
// latency. docs/methods/certified.md derives every constant.

#include "bezel/bernstein/certified_batch.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/binomial_kernel.hpp"
#include "bezel/numeric/double_double.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/bernstein/certified_batch.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
//
#include "bezel/numeric/eft_simd.hpp"

HWY_BEFORE_NAMESPACE();
namespace bezel::bernstein::HWY_NAMESPACE {
using namespace bezel::HWY_NAMESPACE;  // NOLINT: the vector operations of this target

constexpr double smallest = 0x1p-940;  // 2 / u times what underflow can do, with room
constexpr double smallest_bound = 0x1p-1000;
constexpr double unit = 0x1p-53 * (1.0 + 0x1p-30);  // u, and the rounding of the bound itself

/// value, bound and success of G vectors at s.
template <int G>
HWY_INLINE bool evaluate_vectors(const DoubledForm& form, const double* s, double* value,
                                 double* bound, double* good) {
  const std::size_t lanes = lane_count();
  const int d = form.degree;
  const V one = set(1.0);
  V r[G], minus_rho[G], t[G], t_low[G], h[G], e[G], a[G];
  for (int g = 0; g < G; ++g) {
    const V x = load_unaligned(s + static_cast<std::size_t>(g) * lanes);
    // 1 - s = r - minus_rho exactly, as |s| <= 1.
    r[g] = sub(one, x);
    minus_rho[g] = add(x, sub(r[g], one));
    // t + t_low = s / (1 - s) (1 + 15 u^2)
    const V inverse = div(one, r[g]);
    t[g] = mul(x, inverse);
    const V rest = mul_add(t[g], minus_rho[g], neg_mul_add(t[g], r[g], x));
    t_low[g] = mul(rest, inverse);
    h[g] = set(form.high[static_cast<std::size_t>(d)]);
    e[g] = set(form.low[static_cast<std::size_t>(d)]);
    a[g] = set(form.magnitude[static_cast<std::size_t>(d)]);
  }
  for (int j = d - 1; j >= 0; --j) {
    const auto at = static_cast<std::size_t>(j);
    const V high = set(form.high[at]), low = set(form.low[at]), magnitude = set(form.magnitude[at]);
    for (int g = 0; g < G; ++g) {
      V product_error, sum_error;
      const V p = two_prod(h[g], t[g], product_error);
      const V local = mul_add(h[g], t_low[g], product_error);
      h[g] = two_sum(p, high, sum_error);
      e[g] = mul_add(e[g], t[g], add(add(local, sum_error), low));
      a[g] = mul_add(a[g], t[g], magnitude);
    }
  }
  // (1 - s)^d = w + w_low by squaring and multiplying, from the top bit of d down.
  V w[G], w_low[G];
  for (int g = 0; g < G; ++g) {
    w[g] = r[g];
    w_low[g] = neg(minus_rho[g]);
  }
  int bit = 1;
  while (2 * bit <= d) bit *= 2;
  for (bit /= 2; bit > 0; bit /= 2) {
    for (int g = 0; g < G; ++g) {
      V error;
      const V square = two_prod(w[g], w[g], error);
      w_low[g] = mul_add(add(w[g], w[g]), w_low[g], error);
      w[g] = square;
    }
    if ((d & bit) == 0) continue;
    for (int g = 0; g < G; ++g) {
      V error;
      const V product = two_prod(w[g], r[g], error);
      w_low[g] = mul_add(w_low[g], r[g], neg_mul_add(w[g], minus_rho[g], error));
      w[g] = product;
    }
  }
  const V threshold = set(form.threshold), factor = set(form.bound_factor), s_max = set(form.s_max);
  bool all_good = true;
  for (int g = 0; g < G; ++g) {
    const std::size_t offset = static_cast<std::size_t>(g) * lanes;
    V error;
    const V high = two_prod(h[g], w[g], error);
    const V low = mul_add(e[g], w[g], mul_add(h[g], w_low[g], error));
    const V result = add(high, low);
    const V size = abs(result), absolute = mul(a[g], w[g]);
    const V x = load_unaligned(s + offset);
    const Mask ok = both(both(greater(x, set(0.0)), less_equal(x, s_max)),
                         greater(size, mul_add(absolute, threshold, set(smallest))));
    store_unaligned(result, value + offset);
    if (bound != nullptr)
      store_unaligned(mul_add(size, set(unit), mul_add(absolute, factor, set(smallest_bound))),
                      bound + offset);
    if (!all(ok)) {
      if (all_good) std::fill(good, good + static_cast<std::size_t>(G) * lanes, 1.0);
      all_good = false;
      store_unaligned(to_ones(ok), good + offset);
    }
  }
  return all_good;
}

std::size_t run(const DoubledForm& form, const double* s, std::size_t count, double* value,
                double* bound, std::size_t* failed) {
  constexpr auto group = static_cast<std::size_t>(register_group);
  const std::size_t lanes = lane_count();
  double good[group * max_lane_count];
  std::size_t failures = 0, q = 0;
  const auto collect = [&](std::size_t here) {
    for (std::size_t i = 0; i < here; ++i)
      if (good[i] == 0.0) failed[failures++] = q + i;
  };
  for (; q + group * lanes <= count; q += group * lanes)
    if (!evaluate_vectors<register_group>(form, s + q, value + q,
                                          bound == nullptr ? nullptr : bound + q, good))
      collect(group * lanes);
  for (; q < count; q += lanes) {
    const std::size_t here = std::min(lanes, count - q);
    double few[max_lane_count], few_values[max_lane_count], few_bounds[max_lane_count];
    for (std::size_t i = 0; i < lanes; ++i) few[i] = s[q + std::min(i, here - 1)];
    if (!evaluate_vectors<1>(form, few, few_values, few_bounds, good)) collect(here);
    std::copy(few_values, few_values + here, value + q);
    if (bound != nullptr) std::copy(few_bounds, few_bounds + here, bound + q);
  }
  return failures;
}

}  // namespace bezel::bernstein::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::bernstein {

HWY_EXPORT(run);

std::size_t evaluate_doubled(const DoubledForm& form, const double* s, std::size_t count,
                             double* value, double* bound, std::size_t* failed) {
  return HWY_DYNAMIC_DISPATCH(run)(form, s, count, value, bound, failed);
}

DoubledForm doubled_form(int d, const double* b, bool reversed) {
  constexpr double u = 0x1p-53, up = 1.0 + 0x1p-30;
  DoubledForm form;
  form.degree = d;
  for (int j = 0; j <= d; ++j) {
    const double c = b[reversed ? d - j : j];
    const DoubleDouble binomial = d <= max_exact_binomial
                                      ? DoubleDouble(bezel::kernel::Binomial<double>::get(d, j))
                                      : bezel::kernel::Binomial<DoubleDouble>::get(d, j);
    const WithError product = two_prod(binomial.hi, c);
    const auto at = static_cast<std::size_t>(j);
    form.high[at] = product.value;
    form.low[at] = std::fma(binomial.lo, c, product.error);
    form.magnitude[at] = std::fabs(product.value);
  }
  // |high + low - p(s)| <= constant u^2 p~, p~ as computed.
  const double constant = 27.0 * d * d + 72.0 * d + 16.0;
  form.threshold = 2.0 * constant * u * up;
  form.bound_factor = constant * u * u * up;
  // (1 - s)^d >= 2^-900 keeps its error terms normal.
  form.s_max = 1.0 - std::ldexp(1.0, -std::min(53, 900 / d));
  return form;
}

}  // namespace bezel::bernstein
#endif  // HWY_ONCE
