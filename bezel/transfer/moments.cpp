#include "bezel/transfer/moments.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "bezel/bernstein/index.hpp"

// The bits are the same on every target, so the fewer the better for those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/moments.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on
#include "bezel/transfer/polynomial_moves.hpp"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

// Plain loops over the lanes, which the compiler turns into this target's vectors; nothing is
// fused, and sums stay per lane, so every target gives the same bits.

constexpr std::size_t max_points = 256;  // worked on in one sweep

struct Points {
  alignas(64) double x[max_points + lanes], y[max_points + lanes];
  alignas(64) double k[max_points + lanes];  // (x - c) x dx, weighted
};

/// Points of one piece at the end of the list; the padding is overwritten by the next piece's.
inline std::size_t put_points(const MomentPiece& piece, Points& to, std::size_t count) {
  const PieceTable& table = *piece.table;
  const Vec2* p = piece.control;
  double* x = to.x + count;
  double* y = to.y + count;
  double* k = to.k + count;
  if (table.degree == 1) {
    const double ax = p[0].x(), ay = p[0].y();
    const double dx = p[1].x() - ax, dy = p[1].y() - ay;
    const double area = ax * dy - ay * dx;
    for (std::size_t b = 0; b < table.stride; b += lanes) {
      for (std::size_t l = 0; l < lanes; ++l) {
        const double s = table.parameter[b + l];
        x[b + l] = ax + s * dx;
        y[b + l] = ay + s * dy;
        k[b + l] = area * table.weight[b + l];
      }
    }
  } else {
    for (std::size_t b = 0; b < table.stride; b += lanes) {
      double sx[lanes] = {}, sy[lanes] = {};
      double dx[lanes] = {}, dy[lanes] = {};
      for (int i = 0; i <= table.degree; ++i) {
        const double* value = table.value.data() + static_cast<std::size_t>(i) * table.stride + b;
        const double* slope = table.slope.data() + static_cast<std::size_t>(i) * table.stride + b;
        const double px = p[i].x(), py = p[i].y();
        for (std::size_t l = 0; l < lanes; ++l) {
          sx[l] += value[l] * px;
          sy[l] += value[l] * py;
          dx[l] += slope[l] * px;
          dy[l] += slope[l] * py;
        }
      }
      for (std::size_t l = 0; l < lanes; ++l) {
        x[b + l] = sx[l];
        y[b + l] = sy[l];
        k[b + l] = sx[l] * dy[l] - sy[l] * dx[l];
      }
    }
  }
  return count + static_cast<std::size_t>(table.points);
}

/// Adds k x^a y^b of whole blocks of points to sums[a, b][lane].
template <int D>
void sum_points(const Points& points, std::size_t blocks, double (*sums)[lanes]) {
  for (std::size_t block = 0; block < blocks; ++block) {
    const double* x = points.x + block * lanes;
    const double* y = points.y + block * lanes;
    double row[lanes];  // k y^b
    for (std::size_t l = 0; l < lanes; ++l) row[l] = points.k[block * lanes + l];
    int n = 0;
    for (int b = 0; b <= D; ++b) {
      double term[lanes];
      for (std::size_t l = 0; l < lanes; ++l) term[l] = row[l];
      for (int a = 0; a <= D - b; ++a, ++n) {
        for (std::size_t l = 0; l < lanes; ++l) sums[n][l] += term[l];
        for (std::size_t l = 0; l < lanes; ++l) term[l] *= x[l];
      }
      for (std::size_t l = 0; l < lanes; ++l) row[l] *= y[l];
    }
  }
}

template <int D>
void region_moments_of(std::span<const MomentPiece> pieces, double* moments) {
  constexpr int size = bernstein::triangle_size(D);
  alignas(64) double sums[size][lanes] = {};
  Points points;
  std::size_t count = 0;
  const auto flush = [&] {
    const std::size_t blocks = padded_to_lanes(count) / lanes;
    for (std::size_t i = count; i < blocks * lanes; ++i)
      points.x[i] = points.y[i] = points.k[i] = 0.0;
    sum_points<D>(points, blocks, sums);
    count = 0;
  };
  for (const MomentPiece& piece : pieces) {
    if (count + piece.table->stride > max_points) flush();
    count = put_points(piece, points, count);
  }
  flush();
  int n = 0;
  for (int b = 0; b <= D; ++b) {
    for (int a = 0; a <= D - b; ++a, ++n) {
      const double* s = sums[n];
      moments[n] = (((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]))) *
                   (1.0 / static_cast<double>(a + b + 2));
    }
  }
}

void region_moments_target(int degree, std::span<const MomentPiece> pieces, double* moments) {
  switch (degree) {
    case 0:
      return region_moments_of<0>(pieces, moments);
    case 1:
      return region_moments_of<1>(pieces, moments);
    case 2:
      return region_moments_of<2>(pieces, moments);
    case 3:
      return region_moments_of<3>(pieces, moments);
    case 4:
      return region_moments_of<4>(pieces, moments);
    case 5:
      return region_moments_of<5>(pieces, moments);
    default:
      return region_moments_of<6>(pieces, moments);
  }
}

template <int P>
void add_region_of(const RegionPlace& place, const double* moments, int components,
                   const double* donor, const double* base, double* product, double* basis,
                   double* mass) {
  constexpr int size = bernstein::triangle_size(P);
  double g[size];
  for (int b = 0; b <= P; ++b)
    for (int a = 0; a <= P - b; ++a) g[at(P, a, b)] = moments[at(2 * P, a, b)];
  if constexpr (P > 0) move_integrals<P>(g, place.in_target[0], place.in_target[1]);
  for (int n = 0; n < size; ++n) basis[n] += g[n];
  const Substitution<P, double> substitution(place.to_donor.data());
  for (int c = 0; c < components; ++c) {
    double f[size];
    for (int n = 0; n < size; ++n) f[n] = donor[n * components + c];
    f[0] -= base[c];
    if constexpr (P > 0) {
      move_polynomial<P>(f, place.in_donor[0], place.in_donor[1]);
      substitution.apply(f);
    }
    for (int b = 0; b <= P; ++b) {
      for (int a = 0; a <= P - b; ++a) {
        double sum = 0.0;
        for (int d = 0; d <= P; ++d)
          for (int e = 0; e <= P - d; ++e)
            sum = mul_add(moments[at(2 * P, a + e, b + d)], f[at(P, e, d)], sum);
        g[at(P, a, b)] = sum;
      }
    }
    mass[c] = g[0] + base[c] * moments[0];
    if constexpr (P > 0) move_integrals<P>(g, place.in_target[0], place.in_target[1]);
    for (int n = 0; n < size; ++n) product[n * components + c] += g[n];
  }
}

void add_region_target(int degree, const RegionPlace& place, const double* moments, int components,
                       const double* donor, const double* base, double* product, double* basis,
                       double* mass) {
  switch (degree) {
    case 0:
      return add_region_of<0>(place, moments, components, donor, base, product, basis, mass);
    case 1:
      return add_region_of<1>(place, moments, components, donor, base, product, basis, mass);
    case 2:
      return add_region_of<2>(place, moments, components, donor, base, product, basis, mass);
    default:
      return add_region_of<3>(place, moments, components, donor, base, product, basis, mass);
  }
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {

HWY_EXPORT(region_moments_target);
HWY_EXPORT(add_region_target);

void region_moments(int degree, std::span<const MomentPiece> pieces, double* moments) {
  HWY_DYNAMIC_DISPATCH(region_moments_target)(degree, pieces, moments);
}

void add_region(int degree, const RegionPlace& place, const double* moments, int components,
                const double* donor, const double* base, double* product, double* basis,
                double* mass) {
  HWY_DYNAMIC_DISPATCH(add_region_target)
  (degree, place, moments, components, donor, base, product, basis, mass);
}

}  // namespace bezel::detail
#endif
