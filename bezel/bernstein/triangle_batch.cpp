// Evaluation on the triangle at many points, lanes are points: as interval_batch.cpp, Horner's
// scheme with scaled coefficients, 3 operations a coefficient where de Casteljau's algorithm takes
// 5 (d+2) / 3. No product is fused: every target and the scalar kernel give the same bits.

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <type_traits>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/bernstein/triangle_kernel.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/bernstein/triangle_batch.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bezel::bernstein::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using kernel::at;

#if HWY_TARGET <= HWY_AVX3
constexpr int vectors = 4;
#else
constexpr int vectors = 2;  // 16 registers
#endif

/// count vectors of points, d >= 1.
template <int count>
HWY_INLINE void evaluate_vectors(int d, const double* HWY_RESTRICT c, const double* u,
                                 const double* v, double* out) {
  const hn::ScalableTag<double> tag;
  using V = hn::Vec<decltype(tag)>;
  const std::size_t lanes = hn::Lanes(tag);
  V l0[count], l1[count], l2[count], p[count], row[count];
  V power[max_triangle_degree][count];  // of l1, from the first
  c += triangle_size(d) - 1;
  for (int g = 0; g < count; ++g) {
    l1[g] = power[0][g] = hn::LoadU(tag, u + at(g) * lanes);
    l2[g] = hn::LoadU(tag, v + at(g) * lanes);
    l0[g] = hn::Sub(hn::Sub(hn::Set(tag, 1.0), l1[g]), l2[g]);
    p[g] = hn::Set(tag, *c);
  }
  for (int n = 1; n <= d; ++n) {
    c -= n + 1;
    for (int g = 0; g < count; ++g) row[g] = hn::Mul(l0[g], hn::Set(tag, c[0]));
    for (int j = 1; j < n; ++j) {
      const V next = hn::Set(tag, c[j]);
      for (int g = 0; g < count; ++g)
        row[g] = hn::Mul(l0[g], hn::Add(row[g], hn::Mul(power[j - 1][g], next)));
    }
    const V last = hn::Set(tag, c[n]);
    for (int g = 0; g < count; ++g) {
      row[g] = hn::Add(row[g], hn::Mul(power[n - 1][g], last));
      p[g] = hn::Add(hn::Mul(l2[g], p[g]), row[g]);
      if (n < d) power[n][g] = hn::Mul(power[n - 1][g], l1[g]);
    }
  }
  for (int g = 0; g < count; ++g) hn::StoreU(p[g], tag, out + at(g) * lanes);
}

void evaluate_scaled(int d, const double* c, const double* u, const double* v, std::size_t count,
                     double* out) {
  const std::size_t lanes = hn::Lanes(hn::ScalableTag<double>());
  std::size_t q = 0;
  const auto whole = [&](auto vectors_at_once) {
    const std::size_t points = at(vectors_at_once) * lanes;
    for (; q + points <= count; q += points)
      evaluate_vectors<vectors_at_once>(d, c, u + q, v + q, out + q);
  };
  whole(std::integral_constant<int, vectors>());
  whole(std::integral_constant<int, 1>());
  for (; q < count; ++q)
    out[q] = kernel::evaluate_scaled_triangle(d, c, Lambda{(1.0 - u[q]) - v[q], u[q], v[q]});
}

}  // namespace bezel::bernstein::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::bernstein {

HWY_EXPORT(evaluate_scaled);

void evaluate(int d, std::span<const double> b, std::span<const double> u,
              std::span<const double> v, std::span<double> out) {
  checks::triangle(d, b);
  checks::size(v.size(), u.size(), "coordinates v");
  checks::size(out.size(), u.size(), "places for values");
  checks::finite(u, "coordinate u");
  checks::finite(v, "coordinate v");
  std::array<double, kernel::max_triangle_size> c;
  bool small = d > 0;
  for (int k = 0, n = 0; k <= d; ++k)
    for (int j = 0; j + k <= d; ++j, ++n) {
      c[kernel::at(n)] = kernel::trinomial<double>(d, j, k) * b[kernel::at(n)];
      small = small && std::fabs(c[kernel::at(n)]) <= kernel::largest_scaled;
    }
  if (small) {
    HWY_DYNAMIC_DISPATCH(evaluate_scaled)(d, c.data(), u.data(), v.data(), u.size(), out.data());
    return;
  }
  for (std::size_t q = 0; q < u.size(); ++q)
    out[q] = kernel::evaluate_unchecked(d, b.data(), Lambda{(1.0 - u[q]) - v[q], u[q], v[q]});
}

}  // namespace bezel::bernstein
#endif  // HWY_ONCE
