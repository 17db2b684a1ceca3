#include "bezel/transfer/region_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/binomial.hpp"

// Few targets, for the sake of those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/region_fit.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on
#include "bezel/transfer/vector_lanes.hpp"

#ifndef BEZEL_TRANSFER_REGION_FIT_ONCE
#define BEZEL_TRANSFER_REGION_FIT_ONCE
namespace bezel::detail {
inline constexpr int max_fit_powers = 10;  // degree of a field
inline constexpr std::size_t max_fit_vectors = fit_stride(max_fit_moments) / lanes;

/// 1 / (a + b + 2) in rows as wide as those of the highest degree.
struct FitDivisors {
  double value[max_fit_moments + 1][max_fit_vectors * lanes];
};
inline const FitDivisors& fit_divisors() {
  static const FitDivisors table = [] {
    FitDivisors made{};
    for (int b = 0; b <= max_fit_moments; ++b)
      for (int a = 0; a <= max_fit_moments - b; ++a) made.value[b][a] = 1.0 / (a + b + 2.0);
    return made;
  }();
  return table;
}
}  // namespace bezel::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

/// 1, x, ... x^7.
HWY_INLINE void eight_powers(double x, Lanes& out) {
  const double x2 = x * x, x4 = x2 * x2;
  const Lanes one = lanes_of(1, x, 1, x, 1, x, 1, x);
  const Lanes two = lanes_of(1, 1, x2, x2, 1, 1, x2, x2);
  const Lanes four = lanes_of(1, 1, 1, 1, x4, x4, x4, x4);
  out = one * two * four;
}

/// Adds k x^a y^b of four points to rows of sums; wide: vectors in a row.
template <std::size_t wide>
HWY_INLINE void add_four(int degree, const double* x, const double* y, const double* k,
                         Lanes* sums) {
  constexpr std::size_t four = 4;
  Lanes powers[four][wide];
  double term[four];
  for (std::size_t i = 0; i < four; ++i) {
    eight_powers(x[i], powers[i][0]);
    if constexpr (wide > 1) {
      const double x2 = x[i] * x[i], x4 = x2 * x2;
      for (std::size_t w = 1; w < wide; ++w) powers[i][w] = powers[i][w - 1] * (x4 * x4);
    }
    term[i] = k[i];
  }
  for (int b = 0; b <= degree; ++b, sums += wide) {
    for (std::size_t w = 0; w < wide; ++w) {
      if (static_cast<int>(w * lanes) > degree - b) break;
      Lanes sum = sums[w];
      for (std::size_t i = 0; i < four; ++i) sum += term[i] * powers[i][w];
      sums[w] = sum;
    }
    for (std::size_t i = 0; i < four; ++i) term[i] *= y[i];
  }
}

template <std::size_t wide>
void moments_of(int degree, const double* x, const double* y, const double* dx, const double* dy,
                std::size_t count, const FitFrame& frame, const FitDivisors& divisors,
                double* moments) {
  Lanes sums[(max_fit_moments + 1) * wide];
  for (std::size_t i = 0; i < static_cast<std::size_t>(degree + 1) * wide; ++i) sums[i] = Lanes{};
  const double sx = 1.0 / frame.half[0], sy = 1.0 / frame.half[1];
  for (std::size_t at = 0; at < count; at += lanes) {
    const Lanes px = (load(x + at) - frame.centre[0]) * sx;
    const Lanes py = (load(y + at) - frame.centre[1]) * sy;
    double own_x[lanes], own_y[lanes], k[lanes];
    store(px, own_x);
    store(py, own_y);
    store(px * (load(dy + at) * sy) - py * (load(dx + at) * sx), k);
    add_four<wide>(degree, own_x, own_y, k, sums);
    if (at + 4 < count) add_four<wide>(degree, own_x + 4, own_y + 4, k + 4, sums);
  }
  for (int b = 0; b <= degree; ++b) {
    for (std::size_t w = 0; w < wide; ++w) {
      const std::size_t at = static_cast<std::size_t>(b) * wide + w;
      store(sums[at] * load(divisors.value[b] + w * lanes), moments + at * lanes);
    }
  }
}

void moments_target(int degree, const double* x, const double* y, const double* dx,
                    const double* dy, std::size_t count, const FitFrame& frame,
                    const FitDivisors& divisors, double* moments) {
  if (degree < 8) return moments_of<1>(degree, x, y, dx, dy, count, frame, divisors, moments);
  if (degree < 16) return moments_of<2>(degree, x, y, dx, dy, count, frame, divisors, moments);
  return moments_of<3>(degree, x, y, dx, dy, count, frame, divisors, moments);
}

template <int fixed>
HWY_INLINE void powers_of(int runtime_degree, const Lanes& u, const Lanes& v, Lanes* out) {
  const int d = fixed >= 0 ? fixed : runtime_degree;
  Lanes p0[max_fit_powers + 1], p1[max_fit_powers + 1];
  const Lanes first = 1.0 - u - v;
  p0[0] = p1[0] = Lanes{} + 1.0;
  Lanes p2 = p0[0];
  for (int i = 1; i <= d; ++i) {
    p0[i] = p0[i - 1] * first;
    p1[i] = p1[i - 1] * u;
  }
  int n = 0;
  for (int k = 0; k <= d; ++k) {
    for (int j = 0; j <= d - k; ++j, ++n) out[n] = (p0[d - k - j] * p1[j]) * p2;
    p2 *= v;
  }
}

template <int fixed>
void values_of(int degree, int components, const double* scaled, const double* mean,
               std::size_t padded, const double* u, const double* v, double* values) {
  const int size = bernstein::triangle_size(fixed >= 0 ? fixed : degree);
  Lanes psi[bernstein::triangle_size(fixed >= 0 ? fixed : max_fit_powers)];
  for (std::size_t at = 0; at < padded; at += lanes) {
    const Lanes s = load(u + at), t = load(v + at);
    powers_of<fixed>(degree, s, t, psi);
    for (int c = 0; c < components; ++c) {
      const double* f = scaled + c * size;
      Lanes sum{};
      for (int n = 0; n < size; ++n) sum += f[n] * psi[n];
      store(sum - mean[c], values + static_cast<std::size_t>(c) * padded + at);
    }
  }
}

void values_target(int degree, int components, const double* scaled, const double* mean,
                   std::size_t padded, const double* u, const double* v, double* values) {
  if (degree == 0) return values_of<0>(0, components, scaled, mean, padded, u, v, values);
  if (degree == 1) return values_of<1>(1, components, scaled, mean, padded, u, v, values);
  if (degree == 2) return values_of<2>(2, components, scaled, mean, padded, u, v, values);
  if (degree == 3) return values_of<3>(3, components, scaled, mean, padded, u, v, values);
  return values_of<-1>(degree, components, scaled, mean, padded, u, v, values);
}

/// Two functions at once.
void tails_target(std::size_t count, std::size_t high, const double* matrix, const double* u,
                  const double* v, double* out) {
  for (std::size_t n = 0; n < high; n += lanes) {
    Lanes first{}, second{};
    for (std::size_t q = 0; q < count; ++q) {
      const Lanes row = load(matrix + q * high + n);
      first += u[q] * row;
      second += v[q] * row;
    }
    store(first, out + n);
    store(second, out + high + n);
  }
}

/// Sums of w times the powers of a degree over points.
HWY_INLINE void add_powers(int degree, const Lanes& w, const Lanes& u, const Lanes& v,
                           Lanes* sums) {
  Lanes first[2 * max_fit_powers + 1], second[2 * max_fit_powers + 1];
  const Lanes rest = 1.0 - u - v;
  first[0] = second[0] = Lanes{} + 1.0;
  for (int i = 1; i <= degree; ++i) {
    first[i] = first[i - 1] * rest;
    second[i] = second[i - 1] * u;
  }
  Lanes third = w;
  for (int k = 0; k <= degree; ++k) {
    for (int j = 0; j <= degree - k; ++j, ++sums)
      *sums += (first[degree - k - j] * second[j]) * third;
    third *= v;
  }
}

/// Sums of w psi_i psi_j and w psi_i over points, psi the powers of a degree: the products are the
/// powers of twice the degree.
void products_target(int degree, std::size_t padded, const double* weight, const double* u,
                     const double* v, double* products, double* integrals) {
  Lanes twice[bernstein::triangle_size(2 * max_fit_powers)];
  Lanes once[bernstein::triangle_size(max_fit_powers)];
  const int size = bernstein::triangle_size(degree);
  const int all = bernstein::triangle_size(2 * degree);
  for (int i = 0; i < size; ++i) once[i] = Lanes{};
  for (int i = 0; i < all; ++i) twice[i] = Lanes{};
  for (std::size_t at = 0; at < padded; at += lanes) {
    const Lanes s = load(u + at), t = load(v + at), w = load(weight + at);
    add_powers(degree, w, s, t, once);
    add_powers(2 * degree, w, s, t, twice);
  }
  for (int i = 0; i < size; ++i) integrals[i] = sum_of(once[i]);
  double sums[bernstein::triangle_size(2 * max_fit_powers)];
  for (int i = 0; i < all; ++i) sums[i] = sum_of(twice[i]);
  for (int k = 0; k <= degree; ++k) {
    for (int j = 0; j <= degree - k; ++j) {
      for (int l = 0; l <= k; ++l) {
        const double* from = sums + bernstein::triangle_index(2 * degree, j, k + l);
        const int last = l < k ? degree - l : j;
        for (int i = 0; i <= last; ++i) *products++ = from[i];
      }
    }
  }
}

void interpolate_target(std::size_t count, std::size_t padded, std::size_t terms,
                        const double* matrix, int components, const double* values, double* out) {
  for (int c = 0; c < components; ++c) {
    const double* f = values + static_cast<std::size_t>(c) * padded;
    for (std::size_t n = 0; n < terms; n += 2 * lanes) {
      Lanes sum{}, next{};
      const bool both = n + lanes < terms;
      for (std::size_t q = 0; q < count; ++q) {
        sum += f[q] * load(matrix + q * terms + n);
        if (both) next += f[q] * load(matrix + q * terms + n + lanes);
      }
      store(sum, out + static_cast<std::size_t>(c) * terms + n);
      if (both) store(next, out + static_cast<std::size_t>(c) * terms + n + lanes);
    }
  }
}

/// K: the degree of the target's monomials when known at compile time (below 8), or -1.
template <int K>
void add_of(int fit_degree, std::size_t terms_count, int degree, int components,
            const double* terms, const double* moments, const FitFrame& frame,
            const std::array<double, 2>& centre, const double (*binomials)[2 * lanes],
            double* sums) {
  constexpr std::size_t W = K >= 0 ? 1 : 2;  // vectors in a row
  constexpr std::size_t room = W * lanes;    // > degree
  constexpr std::size_t most = K >= 0 ? static_cast<std::size_t>(K) + 1 : room;
  const std::size_t rows = K >= 0 ? most : static_cast<std::size_t>(degree + 1);
  const std::size_t stride = fit_stride(fit_degree + degree);
  // x - centre = shift + half xi: (x - centre)^c = sum_a C(c, a) shift^(c-a) half^a xi^a.
  const double sx = frame.centre[0] - centre[0], sy = frame.centre[1] - centre[1];
  double power[2 * room] = {};  // power[room + i] = shift^i, before it zeros
  power[room] = 1.0;
  for (std::size_t i = 1; i < rows; ++i) power[room + i] = power[room + i - 1] * sx;
  Lanes move[most * W];
  double scale = frame.half[0] * frame.half[1];
  for (std::size_t a = 0; a < rows; ++a) {
    for (std::size_t w = 0; w < W; ++w)
      move[a * W + w] =
          scale * (load(binomials[a] + w * lanes) * load(power + room + w * lanes - a));
    scale *= frame.half[0];
  }
  for (int c = 0; c <= components; ++c) {
    Lanes own[most * W];
    if (c < components) {
      // In the region's frame.
      for (std::size_t i = 0; i < rows * W; ++i) own[i] = Lanes{};
      const double* term = terms + static_cast<std::size_t>(c) * terms_count;
      for (int b = 0; b <= fit_degree; ++b) {
        const double* from = moments + static_cast<std::size_t>(b) * stride;
        for (int a = 0; a <= fit_degree - b; ++a, ++from, ++term) {
          const double value = *term;
          for (std::size_t d = 0; d < rows; ++d)
            for (std::size_t w = 0; w < W; ++w)
              own[d * W + w] += value * load(from + d * stride + w * lanes);
        }
      }
    } else {
      for (std::size_t d = 0; d < rows; ++d)
        for (std::size_t w = 0; w < W; ++w) own[d * W + w] = load(moments + d * stride + w * lanes);
    }
    // Across.
    double factor = 1.0;
    for (std::size_t d = 0; d < rows; ++d) {
      double from[room];
      for (std::size_t w = 0; w < W; ++w) store(own[d * W + w], from + w * lanes);
      Lanes to[W] = {};
      for (std::size_t a = 0; a < rows - d; ++a)
        for (std::size_t w = 0; w < W; ++w) to[w] += from[a] * move[a * W + w];
      for (std::size_t w = 0; w < W; ++w) own[d * W + w] = factor * to[w];
      factor *= frame.half[1];
    }
    // Up, by the scheme of Horner for powers of sums.
    for (std::size_t r = 1; r < rows; ++r)
      for (std::size_t d = rows - 1; d >= r; --d)
        for (std::size_t w = 0; w < W; ++w) own[d * W + w] += sy * own[(d - 1) * W + w];
    double* to = sums + static_cast<std::size_t>(c) * rows * room;
    for (std::size_t i = 0; i < rows * W; ++i) store(own[i] + load(to + i * lanes), to + i * lanes);
  }
}

void add_target(int fit_degree, std::size_t terms_count, int degree, int components,
                const double* terms, const double* moments, const FitFrame& frame,
                const std::array<double, 2>& centre, const double (*binomials)[2 * lanes],
                double* sums) {
  const auto add = [&](auto own) {
    add_of<decltype(own)::value>(fit_degree, terms_count, degree, components, terms, moments, frame,
                                 centre, binomials, sums);
  };
  switch (degree) {
    case 0:
      return add(std::integral_constant<int, 0>());
    case 1:
      return add(std::integral_constant<int, 1>());
    case 2:
      return add(std::integral_constant<int, 2>());
    case 3:
      return add(std::integral_constant<int, 3>());
    case 4:
      return add(std::integral_constant<int, 4>());
    case 5:
      return add(std::integral_constant<int, 5>());
    case 6:
      return add(std::integral_constant<int, 6>());
    case 7:
      return add(std::integral_constant<int, 7>());
    default:
      return add(std::integral_constant<int, -1>());
  }
}

double dot_target(std::size_t count, const double* a, const double* b) {
  Lanes sum{};
  for (std::size_t i = 0; i < count; i += lanes) sum += load(a + i) * load(b + i);
  return sum_of(sum);
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {
namespace {

/// sum c[i] T_i(x) -> sum c[i] x^i in place, c[i] = at(i).
template <class At>
void chebyshev_to_powers(int degree, const At& at) {
  // t[i][j]: the coefficient of x^j in T_i.
  static const auto t = [] {
    std::array<std::array<double, max_fit_degree + 1>, max_fit_degree + 1> made{};
    made[0][0] = made[1][1] = 1.0;
    for (std::size_t i = 2; i < made.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        made[i][j] = (j > 0 ? 2.0 * made[i - 1][j - 1] : 0.0) - made[i - 2][j];
    return made;
  }();
  for (int j = 0; j <= degree; ++j) {
    double sum = t[static_cast<std::size_t>(j)][static_cast<std::size_t>(j)] * at(j);
    for (int i = j + 2; i <= degree; i += 2)
      sum += t[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] * at(i);
    at(j) = sum;
  }
}

void to_monomials(int degree, double* terms) {
  for (int b = 0; b <= degree; ++b) {
    double* row = terms + bernstein::triangle_index(degree, 0, b);
    chebyshev_to_powers(degree - b, [&](int i) -> double& { return row[i]; });
  }
  for (int a = 0; a <= degree; ++a)
    chebyshev_to_powers(degree - a, [&](int i) -> double& {
      return terms[bernstein::triangle_index(degree, a, i)];
    });
}

}  // namespace

HWY_EXPORT(moments_target);
HWY_EXPORT(values_target);
HWY_EXPORT(interpolate_target);
HWY_EXPORT(tails_target);
HWY_EXPORT(products_target);
HWY_EXPORT(add_target);
HWY_EXPORT(dot_target);

FitFrame fit_frame(const CurvePoints& boundary) {
  double low[2] = {boundary.x[0], boundary.y[0]}, high[2] = {boundary.x[0], boundary.y[0]};
  for (std::size_t i = 1; i < boundary.count; ++i) {
    low[0] = std::min(low[0], boundary.x[i]);
    high[0] = std::max(high[0], boundary.x[i]);
    low[1] = std::min(low[1], boundary.y[i]);
    high[1] = std::max(high[1], boundary.y[i]);
  }
  return {{0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])},
          {0.5 * (high[0] - low[0]), 0.5 * (high[1] - low[1])}};
}

void fit_moments(int degree, const CurvePoints& boundary, const FitFrame& frame, double* moments) {
  HWY_DYNAMIC_DISPATCH(moments_target)
  (degree, boundary.x.data(), boundary.y.data(), boundary.dx.data(), boundary.dy.data(),
   boundary.count, frame, fit_divisors(), moments);
}

void fit_values(int degree, int components, const double* scaled, const double* mean,
                std::size_t padded, const double* u, const double* v, double* values) {
  HWY_DYNAMIC_DISPATCH(values_target)
  (degree, components, scaled, mean, padded, u, v, values);
}

void fit_interpolate(const FitTable& table, int components, const double* values, double* terms) {
  HWY_DYNAMIC_DISPATCH(interpolate_target)
  (table.count, table.padded, table.terms, table.chebyshev.data(), components, values, terms);
  for (int c = 0; c < components; ++c)
    to_monomials(table.degree, terms + static_cast<std::size_t>(c) * table.terms);
}

std::array<double, 2> fit_tails(const FitTable& table, const double* u, const double* v) {
  std::array<double, 2 * padded_to_lanes(2 * max_fit_degree + 3)> found;
  HWY_DYNAMIC_DISPATCH(tails_target)
  (table.count, table.high, table.tails.data(), u, v, found.data());
  const auto d = static_cast<std::size_t>(table.degree);
  double size[3] = {0.0, 0.0, 0.0};
  for (std::size_t i = 0; i < 2 * d + 3; ++i)
    size[i <= d ? 0 : i <= 2 * d ? 1 : 2] += std::abs(found[i]) + std::abs(found[table.high + i]);
  return {size[0] / size[2], size[1] / size[2]};
}

void fit_add(const FitTable& table, int degree, int components, const double* terms,
             const double* moments, const FitFrame& frame, const std::array<double, 2>& centre,
             double* sums) {
  static const auto binomials = [] {
    std::array<std::array<double, 2 * lanes>, 2 * lanes> made{};
    for (std::size_t n = 0; n < 2 * lanes; ++n)  // [k][n], zeros where k > n
      for (std::size_t k = 0; k <= n; ++k)
        made[k][n] = binomial(static_cast<int>(n), static_cast<int>(k));
    return made;
  }();
  HWY_DYNAMIC_DISPATCH(add_target)
  (table.degree, table.terms, degree, components, terms, moments, frame, centre,
   reinterpret_cast<const double(*)[2 * lanes]>(binomials.data()), sums);
}

void fit_products(int degree, std::size_t padded, const double* weight, const double* u,
                  const double* v, double* products, double* integrals) {
  HWY_DYNAMIC_DISPATCH(products_target)(degree, padded, weight, u, v, products, integrals);
}

double fit_dot(int degree, const double* a, const double* b) {
  return HWY_DYNAMIC_DISPATCH(dot_target)(fit_rows(degree), a, b);
}

}  // namespace bezel::detail
#endif
