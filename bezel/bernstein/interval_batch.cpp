// Evaluation at many points, lanes are points. Horner's scheme with scaled coefficients
// c_i = C(d,i) b_i and growing powers of s,
//
//   a_0 = c_0 (1-s),  a_i = (a_(i-1) + s^i c_i) (1-s),  p(s) = a_(d-1) + s^d c_d,
//
// takes 4 operations a degree where de Casteljau's algorithm takes 3 (d+1) / 2, for the same error
// bound (docs/methods/bernstein.md). Products and sums are not fused: every target, and the scalar
// kernel that finishes a batch, give the same bits.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/numeric/binomial.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/bernstein/interval_batch.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bezel::bernstein::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using kernel::at;

// A step's sum and product wait for each other: several vectors in turn hide that.
#if HWY_TARGET <= HWY_AVX3
constexpr int vectors = 4;
#else
constexpr int vectors = 2;  // 16 registers
#endif

/// count vectors of points; components polynomials, c_i of each in turn.
template <int count, int components>
HWY_INLINE void evaluate_vectors(int d, const double* HWY_RESTRICT c, const double* s,
                                 double* const* out) {
  const hn::ScalableTag<double> tag;
  using V = hn::Vec<decltype(tag)>;
  const std::size_t lanes = hn::Lanes(tag);
  V t[count], r[count], power[count], a[count][components];
  for (int v = 0; v < count; ++v) {
    power[v] = t[v] = hn::LoadU(tag, s + at(v) * lanes);
    r[v] = hn::Sub(hn::Set(tag, 1.0), t[v]);
    for (int k = 0; k < components; ++k) a[v][k] = hn::Mul(hn::Set(tag, c[k]), r[v]);
  }
  c += components;
  for (int i = 1; i < d; ++i, c += components) {
    for (int k = 0; k < components; ++k) {
      const V next = hn::Set(tag, c[k]);
      for (int v = 0; v < count; ++v)
        a[v][k] = hn::Mul(hn::Add(a[v][k], hn::Mul(power[v], next)), r[v]);
    }
    for (int v = 0; v < count; ++v) power[v] = hn::Mul(power[v], t[v]);
  }
  for (int k = 0; k < components; ++k) {
    const V last = hn::Set(tag, c[k]);
    for (int v = 0; v < count; ++v)
      hn::StoreU(hn::Add(a[v][k], hn::Mul(power[v], last)), tag, out[k] + at(v) * lanes);
  }
}

template <int components>
void evaluate_all(int d, const double* HWY_RESTRICT c, const double* s, std::size_t count,
                  double* const* out) {
  const std::size_t lanes = hn::Lanes(hn::ScalableTag<double>());
  double* place[components];
  std::size_t q = 0;
  const auto one_by_one = [&](std::size_t end) {
    for (; q < end; ++q)
      for (int k = 0; k < components; ++k)
        out[k][q] = kernel::evaluate_scaled<components>(d, c + k, 1.0 - s[q], s[q]);
  };
  const auto whole = [&](auto vectors_at_once) {
    const std::size_t points = at(vectors_at_once) * lanes;
    for (; q + points <= count; q += points) {
      for (int k = 0; k < components; ++k) place[k] = out[k] + q;
      evaluate_vectors<vectors_at_once, components>(d, c, s + q, place);
    }
  };
  // A store across two cache lines takes twice as long: worth some points one by one.
  if (count >= 512)
    while (q < lanes && reinterpret_cast<std::uintptr_t>(out[0] + q) % (lanes * 8) != 0)
      one_by_one(q + 1);
  whole(std::integral_constant<int, vectors>());
  whole(std::integral_constant<int, 1>());
  one_by_one(count);
}

void evaluate_scaled(int d, const double* c, const double* s, std::size_t count, double* const* out,
                     int components) {
  components == 1 ? evaluate_all<1>(d, c, s, count, out) : evaluate_all<2>(d, c, s, count, out);
}

}  // namespace bezel::bernstein::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::bernstein {

HWY_EXPORT(evaluate_scaled);

namespace {

using kernel::at;

/// coefficient(i, k) is coefficient i of polynomial k.
template <int components, class Coefficient>
void evaluate_many(int d, const Coefficient& coefficient, std::span<const double> s,
                   const std::array<double*, at(components)>& out) {
  std::array<double, at(components * (max_interval_degree + 1))> c;
  bool small = d > 0;
  for (int i = 0; i <= d; ++i) {
    const double scale = binomial(d, i);
    for (int k = 0; k < components; ++k) {
      double& scaled = c[at(i * components + k)];
      scaled = scale * coefficient(i, k);
      small = small && std::fabs(scaled) <= kernel::largest_scaled;
    }
  }
  if (small) {
    HWY_DYNAMIC_DISPATCH(evaluate_scaled)(d, c.data(), s.data(), s.size(), out.data(), components);
    return;
  }
  for (int k = 0; k < components; ++k) {
    for (int i = 0; i <= d; ++i) c[at(i)] = coefficient(i, k);
    for (std::size_t q = 0; q < s.size(); ++q)
      out[at(k)][q] = kernel::evaluate_unchecked(d, c.data(), s[q]);
  }
}

}  // namespace

void evaluate(std::span<const double> b, std::span<const double> s, std::span<double> out) {
  const int d = checks::interval(b);
  checks::finite(s, "parameter");
  checks::size(out.size(), s.size(), "places for values");
  evaluate_many<1>(d, [&](int i, int) { return b[at(i)]; }, s, {out.data()});
}

void evaluate(std::span<const Vec2> b, std::span<const double> s, std::span<double> x,
              std::span<double> y) {
  const int d = checks::interval(b);
  checks::finite(s, "parameter");
  checks::size(x.size(), s.size(), "places for x");
  checks::size(y.size(), s.size(), "places for y");
  evaluate_many<2>(d, [&](int i, int k) { return b[at(i)][k]; }, s, {x.data(), y.data()});
}

}  // namespace bezel::bernstein
#endif  // HWY_ONCE
