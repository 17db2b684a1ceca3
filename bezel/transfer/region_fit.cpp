#include "bezel/transfer/region_fit.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/binomial.hpp"

// The bits are the same on every target, so the fewer the better for those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/region_fit.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on

#ifndef BEZEL_TRANSFER_REGION_FIT_ONCE
#define BEZEL_TRANSFER_REGION_FIT_ONCE
namespace bezel::detail {
inline constexpr int max_fit_map = 10;     // degree of a map
inline constexpr int max_fit_powers = 10;  // degree of a field
inline constexpr std::size_t max_fit_vectors = fit_stride(max_fit_moments) / fit_lanes;

/// 1 / (a + b + 2) in rows as wide as those of the highest degree.
struct FitDivisors {
  double value[max_fit_moments + 1][max_fit_vectors * fit_lanes];
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

// Eight numbers side by side: the compiler's vectors (g++ and clang), split into registers where
// they are narrower. Nothing is fused, so every target gives the same bits.
using Lanes [[gnu::vector_size(64)]] = double;

using Stored [[gnu::vector_size(64), gnu::aligned(8), gnu::may_alias]] = double;

HWY_INLINE const Stored& load(const double* p) {
  return *reinterpret_cast<const Stored*>(p);
}
HWY_INLINE void store(const Lanes& x, double* p) {
  *reinterpret_cast<Stored*>(p) = x;
}
HWY_INLINE double sum_of(const Lanes& x) {
  return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

/// Value and derivatives of sum c[a, b] u^a v^b. G: the degree when known at compile time, or -1.
template <int G>
HWY_INLINE void horner(int degree, const double* c, const Lanes& u, const Lanes& v, Lanes& value,
                       Lanes& du, Lanes& dv) {
  const int g = G > 0 ? G : degree;
  value = Lanes{} + c[bernstein::triangle_index(g, 0, g)];
  du = dv = Lanes{};
#pragma GCC unroll 4
  for (int b = g - 1; b >= 0; --b) {
    const double* row = c + bernstein::triangle_index(g, 0, b);
    Lanes r = Lanes{} + row[g - b], slope{};
#pragma GCC unroll 4
    for (int a = g - b - 1; a >= 0; --a) {
      slope = slope * u + r;
      r = r * u + row[a];
    }
    dv = dv * v + value;
    value = value * v + r;
    du = du * v + slope;
  }
}

template <int G>
void map_of(const MapPolynomial& map, std::size_t blocks, const double* u, const double* v,
            double* x, double* y, double* det) {
  for (std::size_t at = 0; at < blocks * fit_lanes; at += fit_lanes) {
    const Lanes s = load(u + at) - map.centre, t = load(v + at) - map.centre;
    Lanes px, py, xu, xv, yu, yv;
    horner<G>(map.degree, map.x.data(), s, t, px, xu, xv);
    horner<G>(map.degree, map.y.data(), s, t, py, yu, yv);
    store(px + map.base.x(), x + at);
    store(py + map.base.y(), y + at);
    if (det != nullptr) store(xu * yv - xv * yu, det + at);
  }
}

template <int G>
bool invert_of(const MapPolynomial& map, std::size_t blocks, const double* x, const double* y,
               double* u, double* v, double* dx, double* dy) {
  constexpr int most_steps = 12;
  constexpr double converged = 0x1p-56;  // of the squared step: the next is its square
  const int g = map.degree;
  const double *cx = map.x.data(), *cy = map.y.data();
  const int first = bernstein::triangle_index(g, 1, 0), second = bernstein::triangle_index(g, 0, 1);
  const double xu0 = cx[first], xv0 = cx[second], yu0 = cy[first], yv0 = cy[second];
  const double det0 = xu0 * yv0 - xv0 * yu0;
  if (!(det0 > 0.0)) return false;
  const double scale = 1.0 / det0;
  for (std::size_t at = 0; at < blocks * fit_lanes; at += fit_lanes) {
    const Lanes px = load(x + at) - map.base.x(), py = load(y + at) - map.base.y();
    Lanes s = (px * yv0 - py * xv0) * scale, t = (py * xu0 - px * yu0) * scale;
    Lanes wx, wy, xu, xv, yu, yv;
    bool done = G == 1;
    for (int step = 0; step < most_steps && !done; ++step) {
      horner<G>(g, cx, s, t, wx, xu, xv);
      horner<G>(g, cy, s, t, wy, yu, yv);
      const Lanes det = xu * yv - xv * yu, inverse = 1.0 / det;
      const Lanes rx = px - wx, ry = py - wy;
      const Lanes ds = (rx * yv - ry * xv) * inverse, dt = (ry * xu - rx * yu) * inverse;
      s += ds;
      t += dt;
      const Lanes size = ds * ds + dt * dt;
      done = true;
      for (std::size_t l = 0; l < fit_lanes; ++l)
        done = done && size[l] <= converged && det[l] > 0.0;
    }
    if (!done) return false;
    store(s + map.centre, u + at);
    store(t + map.centre, v + at);
    if (dx == nullptr) continue;
    horner<G>(g, cx, s, t, wx, xu, xv);
    horner<G>(g, cy, s, t, wy, yu, yv);
    const Lanes inverse = 1.0 / (xu * yv - xv * yu);
    const Lanes ax = load(dx + at), ay = load(dy + at);
    store((ax * yv - ay * xv) * inverse, dx + at);
    store((ay * xu - ax * yu) * inverse, dy + at);
  }
  return true;
}

void map_target(const MapPolynomial& map, std::size_t blocks, const double* u, const double* v,
                double* x, double* y, double* det) {
  if (map.degree == 1) return map_of<1>(map, blocks, u, v, x, y, det);
  if (map.degree == 2) return map_of<2>(map, blocks, u, v, x, y, det);
  if (map.degree == 3) return map_of<3>(map, blocks, u, v, x, y, det);
  return map_of<-1>(map, blocks, u, v, x, y, det);
}

bool invert_target(const MapPolynomial& map, std::size_t blocks, const double* x, const double* y,
                   double* u, double* v, double* dx, double* dy) {
  if (map.degree == 1) return invert_of<1>(map, blocks, x, y, u, v, dx, dy);
  if (map.degree == 2) return invert_of<2>(map, blocks, x, y, u, v, dx, dy);
  if (map.degree == 3) return invert_of<3>(map, blocks, x, y, u, v, dx, dy);
  return invert_of<-1>(map, blocks, x, y, u, v, dx, dy);
}

template <int G>
HWY_INLINE void curve_of(int degree, const double* px, const double* py, double from, double step,
                         std::size_t blocks, const double* node, const double* weight, double* x,
                         double* y, double* dx, double* dy) {
  const int g = G > 0 ? G : degree;
  for (std::size_t at = 0; at < blocks * fit_lanes; at += fit_lanes) {
    const Lanes r = from + step * load(node + at), left = 1.0 - r;
    const Lanes scale = (g * step) * load(weight + at);
    Lanes a[(G > 0 ? G : max_fit_map) + 1], b[(G > 0 ? G : max_fit_map) + 1];
    for (int i = 0; i <= g; ++i) {
      a[i] = Lanes{} + px[i];
      b[i] = Lanes{} + py[i];
    }
    for (int level = g; level > 1; --level) {
      for (int i = 0; i < level; ++i) {
        a[i] = left * a[i] + r * a[i + 1];
        b[i] = left * b[i] + r * b[i + 1];
      }
    }
    store(left * a[0] + r * a[1], x + at);
    store(left * b[0] + r * b[1], y + at);
    store((a[1] - a[0]) * scale, dx + at);
    store((b[1] - b[0]) * scale, dy + at);
  }
}

void curve_target(int degree, const double* px, const double* py, double from, double step,
                  std::size_t blocks, const double* node, const double* weight, double* x,
                  double* y, double* dx, double* dy) {
  if (degree == 1)
    return curve_of<1>(degree, px, py, from, step, blocks, node, weight, x, y, dx, dy);
  if (degree == 2)
    return curve_of<2>(degree, px, py, from, step, blocks, node, weight, x, y, dx, dy);
  if (degree == 3)
    return curve_of<3>(degree, px, py, from, step, blocks, node, weight, x, y, dx, dy);
  return curve_of<-1>(degree, px, py, from, step, blocks, node, weight, x, y, dx, dy);
}

/// 1, x, ... x^7.
HWY_INLINE void eight_powers(double x, Lanes& out) {
  const double x2 = x * x, x4 = x2 * x2;
  const Lanes one = {1, x, 1, x, 1, x, 1, x};
  const Lanes two = {1, 1, x2, x2, 1, 1, x2, x2};
  const Lanes four = {1, 1, 1, 1, x4, x4, x4, x4};
  out = one * two * four;
}

void moments_target(int degree, const double* x, const double* y, const double* dx,
                    const double* dy, std::size_t count, const FitFrame& frame,
                    const FitDivisors& divisors, double* moments) {
  const std::size_t wide = fit_stride(degree) / fit_lanes;
  Lanes sums[(max_fit_moments + 1) * max_fit_vectors];
  for (std::size_t i = 0; i < static_cast<std::size_t>(degree + 1) * wide; ++i) sums[i] = Lanes{};
  const double sx = 1.0 / frame.half[0], sy = 1.0 / frame.half[1];
  for (std::size_t at = 0; at < count; at += fit_lanes) {
    const Lanes px = (load(x + at) - frame.centre[0]) * sx;
    const Lanes py = (load(y + at) - frame.centre[1]) * sy;
    const Lanes k = px * (load(dy + at) * sy) - py * (load(dx + at) * sx);
    const std::size_t here = std::min(fit_lanes, count - at);
    for (std::size_t l = 0; l < here; ++l) {
      const double p = px[l], q = py[l];
      Lanes powers[max_fit_vectors];
      eight_powers(p, powers[0]);
      if (wide > 1) {
        const double p2 = p * p, p4 = p2 * p2;
        for (std::size_t w = 1; w < wide; ++w) powers[w] = powers[w - 1] * (p4 * p4);
      }
      double term = k[l];
      Lanes* row = sums;
      for (int b = 0; b <= degree; ++b, row += wide) {
        const auto own = static_cast<std::size_t>(degree - b) / fit_lanes;
        for (std::size_t w = 0; w <= own; ++w) row[w] += term * powers[w];
        term *= q;
      }
    }
  }
  for (int b = 0; b <= degree; ++b) {
    for (std::size_t w = 0; w < wide; ++w) {
      const std::size_t at = static_cast<std::size_t>(b) * wide + w;
      store(sums[at] * load(divisors.value[b] + w * fit_lanes), moments + at * fit_lanes);
    }
  }
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
  for (std::size_t at = 0; at < padded; at += fit_lanes) {
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

void interpolate_target(std::size_t count, std::size_t padded, std::size_t terms,
                        const double* matrix, int components, const double* values, double* out) {
  for (int c = 0; c < components; ++c) {
    const double* f = values + static_cast<std::size_t>(c) * padded;
    for (std::size_t n = 0; n < terms; n += 2 * fit_lanes) {
      Lanes sum{}, next{};
      const bool both = n + fit_lanes < terms;
      for (std::size_t q = 0; q < count; ++q) {
        sum += f[q] * load(matrix + q * terms + n);
        if (both) next += f[q] * load(matrix + q * terms + n + fit_lanes);
      }
      store(sum, out + static_cast<std::size_t>(c) * terms + n);
      if (both) store(next, out + static_cast<std::size_t>(c) * terms + n + fit_lanes);
    }
  }
}

/// Rows of the integrals of f m in the region's frame. W: vectors in a row.
template <std::size_t W>
HWY_INLINE void contract(int fit_degree, int degree, const double* terms, const double* moments,
                         std::size_t stride, Lanes* rows) {
  for (int d = 0; d <= degree; ++d) {
    Lanes sum[W] = {};
    int n = 0;
    for (int b = 0; b <= fit_degree; ++b) {
      const double* from = moments + static_cast<std::size_t>(b + d) * stride;
      for (int a = 0; a <= fit_degree - b; ++a, ++n)
        for (std::size_t w = 0; w < W; ++w)
          sum[w] += terms[n] * load(from + a + static_cast<int>(w * fit_lanes));
    }
    for (std::size_t w = 0; w < W; ++w) rows[static_cast<std::size_t>(d) * W + w] = sum[w];
  }
}

template <std::size_t W>
void add_of(int fit_degree, std::size_t terms_count, int degree, int components,
            const double* terms, const double* moments, const FitFrame& frame,
            const std::array<double, 2>& centre, const double (*binomials)[2 * fit_lanes],
            double* sums) {
  constexpr std::size_t room = W * fit_lanes;  // > degree
  const std::size_t stride = fit_stride(fit_degree + degree);
  const auto rows = static_cast<std::size_t>(degree + 1);
  // x - centre = shift + half xi: (x - centre)^c = sum_a C(c, a) shift^(c-a) half^a xi^a.
  const double sx = frame.centre[0] - centre[0], sy = frame.centre[1] - centre[1];
  const double area = frame.half[0] * frame.half[1];
  double move[room][room] = {};
  double power[room];
  power[0] = 1.0;
  for (std::size_t i = 1; i < rows; ++i) power[i] = power[i - 1] * sx;
  double scale = area;
  for (std::size_t a = 0; a < rows; ++a) {
    for (std::size_t c = a; c < rows; ++c) move[a][c] = binomials[c][a] * power[c - a] * scale;
    scale *= frame.half[0];
  }
  for (int c = 0; c <= components; ++c) {
    Lanes own[room * W];
    if (c < components) {
      contract<W>(fit_degree, degree, terms + static_cast<std::size_t>(c) * terms_count, moments,
                  stride, own);
    } else {
      for (std::size_t d = 0; d < rows; ++d)
        for (std::size_t w = 0; w < W; ++w)
          own[d * W + w] = load(moments + d * stride + w * fit_lanes);
    }
    // Across.
    double factor = 1.0;
    for (std::size_t d = 0; d < rows; ++d) {
      double from[room];
      for (std::size_t w = 0; w < W; ++w) store(own[d * W + w], from + w * fit_lanes);
      Lanes to[W] = {};
      for (std::size_t a = 0; a < rows - d; ++a)
        for (std::size_t w = 0; w < W; ++w) to[w] += from[a] * load(move[a] + w * fit_lanes);
      for (std::size_t w = 0; w < W; ++w) own[d * W + w] = factor * to[w];
      factor *= frame.half[1];
    }
    // Up, by the scheme of Horner for powers of sums.
    for (std::size_t r = 1; r < rows; ++r)
      for (std::size_t d = rows - 1; d >= r; --d)
        for (std::size_t w = 0; w < W; ++w) own[d * W + w] += sy * own[(d - 1) * W + w];
    double* to = sums + static_cast<std::size_t>(c) * rows * room;
    for (std::size_t i = 0; i < rows * W; ++i)
      store(own[i] + load(to + i * fit_lanes), to + i * fit_lanes);
  }
}

void add_target(int fit_degree, std::size_t terms_count, int degree, int components,
                const double* terms, const double* moments, const FitFrame& frame,
                const std::array<double, 2>& centre, const double (*binomials)[2 * fit_lanes],
                double* sums) {
  if (degree < 8)
    return add_of<1>(fit_degree, terms_count, degree, components, terms, moments, frame, centre,
                     binomials, sums);
  return add_of<2>(fit_degree, terms_count, degree, components, terms, moments, frame, centre,
                   binomials, sums);
}

double dot_target(std::size_t count, const double* a, const double* b) {
  Lanes sum{};
  for (std::size_t i = 0; i < count; i += fit_lanes) sum += load(a + i) * load(b + i);
  return sum_of(sum);
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {
namespace {

/// Solves matrix * x = columns in place (size x size both, row major), with pivots.
void solve_all(std::size_t size, std::vector<long double>& matrix,
               std::vector<long double>& columns) {
  for (std::size_t j = 0; j < size; ++j) {
    std::size_t pivot = j;
    for (std::size_t i = j; i < size; ++i)
      if (std::abs(matrix[i * size + j]) > std::abs(matrix[pivot * size + j])) pivot = i;
    for (std::size_t k = 0; k < size; ++k) {
      std::swap(matrix[pivot * size + k], matrix[j * size + k]);
      std::swap(columns[pivot * size + k], columns[j * size + k]);
    }
    const long double inverse = 1.0L / matrix[j * size + j];
    for (std::size_t k = 0; k < size; ++k) {
      matrix[j * size + k] *= inverse;
      columns[j * size + k] *= inverse;
    }
    for (std::size_t i = 0; i < size; ++i) {
      if (i == j) continue;
      const long double factor = matrix[i * size + j];
      if (factor == 0.0L) continue;
      for (std::size_t k = j; k < size; ++k) matrix[i * size + k] -= factor * matrix[j * size + k];
      for (std::size_t k = 0; k < size; ++k)
        columns[i * size + k] -= factor * columns[j * size + k];
    }
  }
}

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

FitTable::FitTable(int with_degree)
    : degree(with_degree),
      count(static_cast<std::size_t>(bernstein::triangle_size(with_degree))),
      padded(fit_padded(count)),
      terms(padded) {
  const int d = degree;
  for (int j = 0; j <= d; ++j) {
    for (int k = j % 2; k <= d + 1; k += 2) {
      x.push_back(d == 0 ? 0.0 : std::cos(j * std::numbers::pi / d));
      y.push_back(d == 0 ? 0.0 : std::cos(k * std::numbers::pi / (d + 1)));
    }
  }
  std::vector<long double> matrix, columns(count * count, 0.0L);
  std::vector<long double> tx(static_cast<std::size_t>(d) + 2, 1.0L), ty = tx;
  for (std::size_t q = 0; q < count; ++q) {
    tx[1] = x[q];
    ty[1] = y[q];
    for (std::size_t i = 2; i < tx.size(); ++i) {
      tx[i] = 2.0L * tx[1] * tx[i - 1] - tx[i - 2];
      ty[i] = 2.0L * ty[1] * ty[i - 1] - ty[i - 2];
    }
    for (std::size_t b = 0; b + 1 < ty.size(); ++b)
      for (std::size_t a = 0; a + b + 1 < tx.size(); ++a) matrix.push_back(tx[a] * ty[b]);
    columns[q * count + q] = 1.0L;
  }
  solve_all(count, matrix, columns);
  chebyshev.assign(count * terms, 0.0);
  for (std::size_t n = 0; n < count; ++n)
    for (std::size_t q = 0; q < count; ++q)
      chebyshev[q * terms + n] = static_cast<double>(columns[n * count + q]);
  x.resize(padded, x.back());
  y.resize(padded, y.back());
}

const FitTable& fit_table(int degree) {
  static std::array<std::once_flag, max_fit_degree + 1> made;
  static std::array<std::unique_ptr<FitTable>, max_fit_degree + 1> tables;
  const auto at = static_cast<std::size_t>(degree);
  std::call_once(made[at], [&] { tables[at] = std::make_unique<FitTable>(degree); });
  return *tables[at];
}

void MapPolynomial::set(int with_degree, std::span<const Vec2> control) {
  degree = with_degree;
  centre = 1.0 / 3.0;
  // The Bernstein form in monomials about the centroid: differences of blossoms, all arguments the
  // centroid but those of the derivatives.
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(degree));
  x.assign(size, 0.0);
  y.assign(size, 0.0);
  std::array<Vec2, static_cast<std::size_t>(bernstein::triangle_size(max_fit_map))> p;
  for (int b = 0; b <= degree; ++b) {
    for (int a = 0; a <= degree - b; ++a) {
      std::copy(control.begin(), control.end(), p.begin());
      int left = degree;
      const auto reduce = [&](int ku, int kv) {
        std::size_t to = 0;
        for (int k = 0; k < left; ++k) {
          for (int j = 0; j < left - k; ++j, ++to) {
            const Vec2& here = p[static_cast<std::size_t>(bernstein::triangle_index(left, j, k))];
            const Vec2& right =
                p[static_cast<std::size_t>(bernstein::triangle_index(left, j + 1, k))];
            const Vec2& up = p[static_cast<std::size_t>(bernstein::triangle_index(left, j, k + 1))];
            p[to] = ku > 0 ? right - here : kv > 0 ? up - here : (here + right + up) * (1.0 / 3.0);
          }
        }
        --left;
      };
      for (int i = 0; i < a; ++i) reduce(1, 0);
      for (int i = 0; i < b; ++i) reduce(0, 1);
      while (left > 0) reduce(0, 0);
      const auto at = static_cast<std::size_t>(bernstein::triangle_index(degree, a, b));
      const double factor = binomial(degree, a) * binomial(degree - a, b);
      if (at == 0) {
        base = p[0];
        continue;
      }
      x[at] = factor * p[0].x();
      y[at] = factor * p[0].y();
    }
  }
}

void MapPolynomial::set_affine(const Vec2& at, const Vec2& first, const Vec2& second) {
  degree = 1;
  centre = 0.0;
  base = at;
  x = {0.0, first.x(), second.x()};
  y = {0.0, first.y(), second.y()};
}

std::size_t CurvePoints::append(std::size_t n) {
  const std::size_t first = count;
  count += n;
  if (x.size() < count + fit_lanes)
    for (std::vector<double>* array : {&x, &y, &dx, &dy}) array->resize(2 * (count + fit_lanes));
  return first;
}

HWY_EXPORT(map_target);
HWY_EXPORT(invert_target);
HWY_EXPORT(curve_target);
HWY_EXPORT(moments_target);
HWY_EXPORT(values_target);
HWY_EXPORT(interpolate_target);
HWY_EXPORT(add_target);
HWY_EXPORT(dot_target);

void fit_map(const MapPolynomial& map, std::size_t blocks, const double* u, const double* v,
             double* x, double* y, double* det) {
  HWY_DYNAMIC_DISPATCH(map_target)(map, blocks, u, v, x, y, det);
}

bool fit_invert(const MapPolynomial& map, std::size_t blocks, const double* x, const double* y,
                double* u, double* v, double* dx, double* dy) {
  return HWY_DYNAMIC_DISPATCH(invert_target)(map, blocks, x, y, u, v, dx, dy);
}

void fit_curve(std::span<const Vec2> control, const Vec2& origin, double from, double step,
               std::size_t blocks, const double* node, const double* weight, double* x, double* y,
               double* dx, double* dy) {
  std::array<double, max_fit_map + 1> px{}, py{};
  for (std::size_t i = 0; i < control.size(); ++i) {
    px[i] = control[i].x() - origin.x();
    py[i] = control[i].y() - origin.y();
  }
  HWY_DYNAMIC_DISPATCH(curve_target)
  (static_cast<int>(control.size()) - 1, px.data(), py.data(), from, step, blocks, node, weight, x,
   y, dx, dy);
}

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
  std::array<double, fit_padded(bernstein::triangle_size(max_fit_degree))> terms;
  const int d = table.degree;
  double high = 0.0, next = 0.0, linear = 0.0;
  for (const double* values : {u, v}) {
    HWY_DYNAMIC_DISPATCH(interpolate_target)
    (table.count, 0, table.terms, table.chebyshev.data(), 1, values, terms.data());
    const auto size = [&](int a, int b) {
      return std::abs(terms[static_cast<std::size_t>(bernstein::triangle_index(d, a, b))]);
    };
    for (int b = 0; b <= d; ++b) high += size(d - b, b);
    for (int b = 0; b < d; ++b) next += size(d - 1 - b, b);
    linear += size(1, 0) + size(0, 1);
  }
  return {high / linear, next / linear};
}

void fit_add(const FitTable& table, int degree, int components, const double* terms,
             const double* moments, const FitFrame& frame, const std::array<double, 2>& centre,
             double* sums) {
  static const auto binomials = [] {
    std::array<std::array<double, 2 * fit_lanes>, 2 * fit_lanes> made{};
    for (std::size_t n = 0; n < 2 * fit_lanes; ++n)
      for (std::size_t k = 0; k <= n; ++k)
        made[n][k] = binomial(static_cast<int>(n), static_cast<int>(k));
    return made;
  }();
  HWY_DYNAMIC_DISPATCH(add_target)
  (table.degree, table.terms, degree, components, terms, moments, frame, centre,
   reinterpret_cast<const double(*)[2 * fit_lanes]>(binomials.data()), sums);
}

double fit_dot(int degree, const double* a, const double* b) {
  return HWY_DYNAMIC_DISPATCH(dot_target)(fit_rows(degree), a, b);
}

}  // namespace bezel::detail
#endif
