#include "bezel/transfer/accumulate.hpp"

#include <array>
#include <type_traits>
#include <vector>

#include "bezel/bernstein/index.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/accumulate.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on
#include "bezel/transfer/vector_lanes.hpp"

#ifndef BEZEL_TRANSFER_ACCUMULATE_ONCE
#define BEZEL_TRANSFER_ACCUMULATE_ONCE
namespace bezel::detail {
inline constexpr int max_accumulated_degree = 10;
inline constexpr int max_size = bernstein::triangle_size(max_accumulated_degree);

/// values: x, y with the powers of the degree, then d/du of x and y, d/dv of x and y with those of
/// one degree less; each times its multinomial.
struct ScaledMap {
  double x[2][max_size], du[2][max_size], dv[2][max_size];
};

}  // namespace bezel::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

// Plain loops over `lanes` points: the compiler turns them into this target's vectors. Nothing is
// fused
// (-ffp-contract=off) and sums stay per lane, so every target gives the same bits.
constexpr int max_degree = max_accumulated_degree;

template <int fixed>
inline void powers(int runtime_degree, const double* u, const double* v, double (*out)[lanes]) {
  const int d = fixed >= 0 ? fixed : runtime_degree;
  double p0[max_degree + 1][lanes];
  double p1[max_degree + 1][lanes];
  double p2[lanes];
  double first[lanes];
  for (std::size_t l = 0; l < lanes; ++l) {
    first[l] = 1.0 - u[l] - v[l];
    p0[0][l] = 1.0;
    p1[0][l] = 1.0;
    p2[l] = 1.0;
  }
  for (int i = 1; i <= d; ++i) {
    for (std::size_t l = 0; l < lanes; ++l) {
      p0[i][l] = p0[i - 1][l] * first[l];
      p1[i][l] = p1[i - 1][l] * u[l];
    }
  }
  int n = 0;
  for (int k = 0; k <= d; ++k) {
    for (int j = 0; j <= d - k; ++j, ++n) {
      for (std::size_t l = 0; l < lanes; ++l) out[n][l] = (p0[d - k - j][l] * p1[j][l]) * p2[l];
    }
    for (std::size_t l = 0; l < lanes; ++l) p2[l] *= v[l];
  }
}

/// 1, x, ... x^degree.
HWY_INLINE void powers_of(int degree, const Lanes& x, Lanes* out) {
  out[0] = Lanes{} + 1.0;
  for (int i = 1; i <= degree; ++i) out[i] = out[i - 1] * x;
}

template <int target_fixed, int donor_fixed, int nc>
void accumulate_chunk(int target_degree, int donor_degree, int components, const double* scaled,
                      const PointBlock& points, double* product, double* basis, double* mass) {
  const int pt = target_fixed >= 0 ? target_fixed : target_degree;
  const int pd = donor_fixed >= 0 ? donor_fixed : donor_degree;
  const int nt = bernstein::triangle_size(pt), nd = bernstein::triangle_size(pd);
  constexpr int room = target_fixed >= 0 ? bernstein::triangle_size(target_fixed) : max_size;
  Lanes sum[nc][room], plain[room], total[nc];
  const Lanes zero = Lanes{};
  for (int c = 0; c < nc; ++c) total[c] = zero;
  for (int n = 0; n < nt; ++n) {
    plain[n] = zero;
    for (int c = 0; c < nc; ++c) sum[c][n] = zero;
  }
  for (std::size_t at = 0; at < points.blocks * lanes; at += lanes) {
    Lanes first[max_degree + 1], second[max_degree + 1];
    const Lanes one = Lanes{} + 1.0;
    const Lanes du = load(points.donor_u + at), dv = load(points.donor_v + at);
    powers_of(pd, one - du - dv, first);
    powers_of(pd, du, second);
    Lanes value[nc], third = one;
    for (int c = 0; c < nc; ++c) value[c] = zero;
    for (int k = 0, n = 0; k <= pd; ++k) {
      Lanes row[nc];
      for (int c = 0; c < nc; ++c) row[c] = zero;
      for (int j = 0; j <= pd - k; ++j, ++n) {
        const Lanes psi = first[pd - k - j] * second[j];
        for (int c = 0; c < nc; ++c) row[c] += scaled[c * nd + n] * psi;
      }
      for (int c = 0; c < nc; ++c) value[c] += row[c] * third;
      third = third * dv;
    }
    Lanes w = load(points.weight + at);
    for (int c = 0; c < nc; ++c) {
      value[c] = value[c] * w;
      total[c] += value[c];
    }
    const Lanes tu = load(points.target_u + at), tv = load(points.target_v + at);
    powers_of(pt, one - tu - tv, first);
    powers_of(pt, tu, second);
    for (int k = 0, n = 0; k <= pt; ++k) {
      for (int j = 0; j <= pt - k; ++j, ++n) {
        const Lanes phi = first[pt - k - j] * second[j];
        plain[n] += w * phi;
        for (int c = 0; c < nc; ++c) sum[c][n] += value[c] * phi;
      }
      w = w * tv;
      for (int c = 0; c < nc; ++c) value[c] = value[c] * tv;
    }
  }
  for (int n = 0; n < nt; ++n) {
    for (int c = 0; c < nc; ++c) product[n * components + c] += sum_of(sum[c][n]);
    if (basis != nullptr) basis[n] += sum_of(plain[n]);
  }
  for (int c = 0; c < nc; ++c) mass[c] += sum_of(total[c]);
}

/// Three components in one sweep, the basis functions in the first.
template <int target_fixed, int donor_fixed>
void accumulate_fixed(int target_degree, int donor_degree, int components, const double* scaled,
                      const PointBlock& points, double* product, double* basis, double* mass) {
  const int nd = bernstein::triangle_size(donor_degree);
  for (int c = 0; c < components; c += 3) {
    const auto sweep = [&](auto count) {
      accumulate_chunk<target_fixed, donor_fixed, decltype(count)::value>(
          target_degree, donor_degree, components, scaled + c * nd, points, product + c,
          c == 0 ? basis : nullptr, mass + c);
    };
    if (components - c == 1) {
      sweep(std::integral_constant<int, 1>());
    } else if (components - c == 2) {
      sweep(std::integral_constant<int, 2>());
    } else {
      sweep(std::integral_constant<int, 3>());
    }
  }
}

void accumulate_target(int target_degree, int donor_degree, int components, const double* scaled,
                       const PointBlock& points, double* product, double* basis, double* mass) {
  if (target_degree == donor_degree) {
    switch (target_degree) {
      case 0:
        return accumulate_fixed<0, 0>(0, 0, components, scaled, points, product, basis, mass);
      case 1:
        return accumulate_fixed<1, 1>(1, 1, components, scaled, points, product, basis, mass);
      case 2:
        return accumulate_fixed<2, 2>(2, 2, components, scaled, points, product, basis, mass);
      case 3:
        return accumulate_fixed<3, 3>(3, 3, components, scaled, points, product, basis, mass);
      default:
        break;
    }
  }
  accumulate_fixed<-1, -1>(target_degree, donor_degree, components, scaled, points, product, basis,
                           mass);
}

template <int fixed>
void map_points_fixed(int runtime_degree, const ScaledMap& map, std::size_t blocks, const double* u,
                      const double* v, double* x, double* y, double* det) {
  const int d = fixed >= 0 ? fixed : runtime_degree;
  const int size = bernstein::triangle_size(d), lower = bernstein::triangle_size(d - 1);
  constexpr int room = fixed >= 0 ? bernstein::triangle_size(fixed) : max_size;
  double phi[room][lanes];
  for (std::size_t b = 0; b < blocks; ++b) {
    const std::size_t at = b * lanes;
    powers<fixed>(d, u + at, v + at, phi);
    for (int k = 0; k < 2; ++k) {
      double sum[lanes] = {};
      for (int n = 0; n < size; ++n)
        for (std::size_t l = 0; l < lanes; ++l) sum[l] += map.x[k][n] * phi[n][l];
      double* to = (k == 0 ? x : y) + at;
      for (std::size_t l = 0; l < lanes; ++l) to[l] = sum[l];
    }
    powers<(fixed > 0 ? fixed - 1 : fixed)>(d - 1, u + at, v + at, phi);
    double slope[4][lanes] = {};
    for (int n = 0; n < lower; ++n) {
      for (std::size_t l = 0; l < lanes; ++l) {
        slope[0][l] += map.du[0][n] * phi[n][l];
        slope[1][l] += map.du[1][n] * phi[n][l];
        slope[2][l] += map.dv[0][n] * phi[n][l];
        slope[3][l] += map.dv[1][n] * phi[n][l];
      }
    }
    for (std::size_t l = 0; l < lanes; ++l)
      det[at + l] = slope[0][l] * slope[3][l] - slope[1][l] * slope[2][l];
  }
}

void map_points_target(int degree, const ScaledMap& map, std::size_t blocks, const double* u,
                       const double* v, double* x, double* y, double* det) {
  switch (degree) {
    case 1:
      return map_points_fixed<1>(1, map, blocks, u, v, x, y, det);
    case 2:
      return map_points_fixed<2>(2, map, blocks, u, v, x, y, det);
    case 3:
      return map_points_fixed<3>(3, map, blocks, u, v, x, y, det);
    default:
      return map_points_fixed<-1>(degree, map, blocks, u, v, x, y, det);
  }
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {

HWY_EXPORT(accumulate_target);

void accumulate(int target_degree, int donor_degree, int components, const double* scaled,
                const PointBlock& points, double* product, double* basis, double* mass) {
  HWY_DYNAMIC_DISPATCH(accumulate_target)
  (target_degree, donor_degree, components, scaled, points, product, basis, mass);
}

HWY_EXPORT(map_points_target);

void map_points(int degree, const Vec2* control, std::size_t blocks, const double* u,
                const double* v, double* x, double* y, double* det) {
  ScaledMap map;
  const auto factors = multinomials(degree);
  const auto lower = multinomials(degree - 1);
  for (int k = 0, n = 0, m = 0; k <= degree; ++k) {
    for (int j = 0; j <= degree - k; ++j, ++n) {
      const Vec2& p = control[n];
      for (int c = 0; c < 2; ++c) map.x[c][n] = factors[static_cast<std::size_t>(n)] * p[c];
      if (j + k == degree) continue;
      const double factor = degree * lower[static_cast<std::size_t>(m)];
      const Vec2& next = control[bernstein::triangle_index(degree, j + 1, k)];
      const Vec2& above = control[bernstein::triangle_index(degree, j, k + 1)];
      for (int c = 0; c < 2; ++c) {
        map.du[c][m] = factor * (next[c] - p[c]);
        map.dv[c][m] = factor * (above[c] - p[c]);
      }
      ++m;
    }
  }
  HWY_DYNAMIC_DISPATCH(map_points_target)(degree, map, blocks, u, v, x, y, det);
}

void evaluate_scaled(int degree, int components, const double* scaled, double u, double v,
                     double* values) {
  const double first = 1.0 - u - v;
  std::array<double, 11> p0{};
  std::array<double, 11> p1{};
  p0[0] = p1[0] = 1.0;
  for (std::size_t i = 1; i <= static_cast<std::size_t>(degree); ++i) {
    p0[i] = p0[i - 1] * first;
    p1[i] = p1[i - 1] * u;
  }
  const int size = bernstein::triangle_size(degree);
  for (int c = 0; c < components; ++c) values[c] = 0.0;
  double p2 = 1.0;
  int n = 0;
  for (int k = 0; k <= degree; ++k) {
    for (int j = 0; j <= degree - k; ++j, ++n) {
      const double m =
          (p0[static_cast<std::size_t>(degree - k - j)] * p1[static_cast<std::size_t>(j)]) * p2;
      for (int c = 0; c < components; ++c) values[c] += scaled[c * size + n] * m;
    }
    p2 *= v;
  }
}

void basis_at(int degree, double u, double v, double* values) {
  const double first = 1.0 - u - v;
  std::array<double, 11> p0{};
  std::array<double, 11> p1{};
  p0[0] = p1[0] = 1.0;
  for (std::size_t i = 1; i <= static_cast<std::size_t>(degree); ++i) {
    p0[i] = p0[i - 1] * first;
    p1[i] = p1[i - 1] * u;
  }
  const auto factors = multinomials(degree);
  double p2 = 1.0;
  std::size_t n = 0;
  for (int k = 0; k <= degree; ++k) {
    for (int j = 0; j <= degree - k; ++j, ++n) {
      values[n] = (p0[static_cast<std::size_t>(degree - k - j)] * p1[static_cast<std::size_t>(j)]) *
                  p2 * factors[n];
    }
    p2 *= v;
  }
}

}  // namespace bezel::detail
#endif
