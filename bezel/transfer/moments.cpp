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

#ifndef BEZEL_TRANSFER_MOMENTS_ONCE
#define BEZEL_TRANSFER_MOMENTS_ONCE
namespace bezel::detail {
/// About the target's centre a donor's polynomial may grow by this factor beyond its size on the
/// donor: so many roundings are lost.
inline constexpr double steepest = 32.0;
}  // namespace bezel::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

// Plain loops over the lanes, which the compiler turns into this target's vectors; nothing is
// fused, and sums stay per lane, so every target gives the same bits.

constexpr std::size_t max_points = 256;  // worked on in one sweep

struct Points {
  alignas(64) double x[max_points + moment_lanes], y[max_points + moment_lanes];
  alignas(64) double k[max_points + moment_lanes];  // (x - c) x dx, weighted
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
    for (std::size_t b = 0; b < table.stride; b += moment_lanes) {
      for (std::size_t l = 0; l < moment_lanes; ++l) {
        const double s = table.parameter[b + l];
        x[b + l] = ax + s * dx;
        y[b + l] = ay + s * dy;
        k[b + l] = area * table.weight[b + l];
      }
    }
  } else {
    for (std::size_t b = 0; b < table.stride; b += moment_lanes) {
      double sx[moment_lanes] = {}, sy[moment_lanes] = {};
      double dx[moment_lanes] = {}, dy[moment_lanes] = {};
      for (int i = 0; i <= table.degree; ++i) {
        const double* value = table.value.data() + static_cast<std::size_t>(i) * table.stride + b;
        const double* slope = table.slope.data() + static_cast<std::size_t>(i) * table.stride + b;
        const double px = p[i].x(), py = p[i].y();
        for (std::size_t l = 0; l < moment_lanes; ++l) {
          sx[l] += value[l] * px;
          sy[l] += value[l] * py;
          dx[l] += slope[l] * px;
          dy[l] += slope[l] * py;
        }
      }
      for (std::size_t l = 0; l < moment_lanes; ++l) {
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
void sum_points(const Points& points, std::size_t blocks, double (*sums)[moment_lanes]) {
  for (std::size_t block = 0; block < blocks; ++block) {
    const double* x = points.x + block * moment_lanes;
    const double* y = points.y + block * moment_lanes;
    double row[moment_lanes];  // k y^b
    for (std::size_t l = 0; l < moment_lanes; ++l) row[l] = points.k[block * moment_lanes + l];
    int n = 0;
    for (int b = 0; b <= D; ++b) {
      double term[moment_lanes];
      for (std::size_t l = 0; l < moment_lanes; ++l) term[l] = row[l];
      for (int a = 0; a <= D - b; ++a, ++n) {
        for (std::size_t l = 0; l < moment_lanes; ++l) sums[n][l] += term[l];
        for (std::size_t l = 0; l < moment_lanes; ++l) term[l] *= x[l];
      }
      for (std::size_t l = 0; l < moment_lanes; ++l) row[l] *= y[l];
    }
  }
}

template <int D>
void region_moments_of(std::span<const MomentPiece> pieces, double* moments) {
  constexpr int size = bernstein::triangle_size(D);
  alignas(64) double sums[size][moment_lanes] = {};
  Points points;
  std::size_t count = 0;
  const auto flush = [&] {
    const std::size_t blocks = (count + moment_lanes - 1) / moment_lanes;
    for (std::size_t i = count; i < blocks * moment_lanes; ++i)
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

constexpr int at(int degree, int a, int b) {
  return bernstein::triangle_index(degree, a, b);
}

// V: a number or a vector of them; S: the same or a number.

/// f(x + s, y + t) for the monomials' coefficients.
template <int P, class V, class S>
HWY_INLINE void move_polynomial(V* f, const S& s, const S& t) {
#pragma GCC unroll 4
  for (int b = 0; b < P; ++b) {
#pragma GCC unroll 4
    for (int r = 0; r < P - b; ++r) {
#pragma GCC unroll 4
      for (int a = P - b - 1; a >= r; --a) f[at(P, a, b)] += s * f[at(P, a + 1, b)];
    }
  }
#pragma GCC unroll 4
  for (int a = 0; a < P; ++a) {
#pragma GCC unroll 4
    for (int r = 0; r < P - a; ++r) {
#pragma GCC unroll 4
      for (int b = P - a - 1; b >= r; --b) f[at(P, a, b)] += t * f[at(P, a, b + 1)];
    }
  }
}

/// Integrals with the monomials in (x + s, y + t) from those in (x, y).
template <int P, class V, class S>
HWY_INLINE void move_integrals(V* g, const S& s, const S& t) {
  for (int b = 0; b < P; ++b) {
    for (int r = 1; r <= P - b; ++r)
      for (int a = P - b; a >= r; --a) g[at(P, a, b)] += s * g[at(P, a - 1, b)];
  }
  for (int a = 0; a < P; ++a) {
    for (int r = 1; r <= P - a; ++r)
      for (int b = P - a; b >= r; --b) g[at(P, a, b)] += t * g[at(P, a, b - 1)];
  }
}

/// The coefficients of f(m0 x + m1 y, m2 x + m3 y).
template <int P, class V, class S>
HWY_INLINE void substitute(V* f, const S* m) {
  // Row j of `powers`: (m0 x + m1 y)^(e-j) (m2 x + m3 y)^j, its coefficient of x^(e-i) y^i at i.
  S powers[P + 1][P + 1];
  powers[0][0] = S{} + 1.0;
#pragma GCC unroll 4
  for (int e = 1; e <= P; ++e) {
    powers[e][e] = m[3] * powers[e - 1][e - 1];
#pragma GCC unroll 4
    for (int i = e - 1; i > 0; --i)
      powers[e][i] = m[2] * powers[e - 1][i] + m[3] * powers[e - 1][i - 1];
    powers[e][0] = m[2] * powers[e - 1][0];
#pragma GCC unroll 4
    for (int j = 0; j < e; ++j) {
      powers[j][e] = m[1] * powers[j][e - 1];
#pragma GCC unroll 4
      for (int i = e - 1; i > 0; --i) powers[j][i] = m[0] * powers[j][i] + m[1] * powers[j][i - 1];
      powers[j][0] = m[0] * powers[j][0];
    }
    V old[P + 1];
#pragma GCC unroll 4
    for (int j = 0; j <= e; ++j) old[j] = f[at(P, e - j, j)];
#pragma GCC unroll 4
    for (int i = 0; i <= e; ++i) {
      V sum = powers[0][i] * old[0];
#pragma GCC unroll 4
      for (int j = 1; j <= e; ++j) sum += powers[j][i] * old[j];
      f[at(P, e - i, i)] = sum;
    }
  }
}

template <int P>
void add_region_of(const RegionPlace& place, const double* moments, int components,
                   const double* donor, double* product, double* basis, double* mass) {
  constexpr int size = bernstein::triangle_size(P);
  double g[size];
  for (int b = 0; b <= P; ++b)
    for (int a = 0; a <= P - b; ++a) g[at(P, a, b)] = moments[at(2 * P, a, b)];
  if constexpr (P > 0) move_integrals<P>(g, place.in_target[0], place.in_target[1]);
  for (int n = 0; n < size; ++n) basis[n] += g[n];
  for (int c = 0; c < components; ++c) {
    double f[size];
    for (int n = 0; n < size; ++n) f[n] = donor[n * components + c];
    if constexpr (P > 0) {
      move_polynomial<P>(f, place.in_donor[0], place.in_donor[1]);
      substitute<P>(f, place.to_donor.data());
    }
    for (int b = 0; b <= P; ++b) {
      for (int a = 0; a <= P - b; ++a) {
        double sum = 0.0;
        for (int d = 0; d <= P; ++d)
          for (int e = 0; e <= P - d; ++e) sum += moments[at(2 * P, a + e, b + d)] * f[at(P, e, d)];
        g[at(P, a, b)] = sum;
      }
    }
    mass[c] = g[0];
    if constexpr (P > 0) move_integrals<P>(g, place.in_target[0], place.in_target[1]);
    for (int n = 0; n < size; ++n) product[n * components + c] += g[n];
  }
}

void add_region_target(int degree, const RegionPlace& place, const double* moments, int components,
                       const double* donor, double* product, double* basis, double* mass) {
  switch (degree) {
    case 0:
      return add_region_of<0>(place, moments, components, donor, product, basis, mass);
    case 1:
      return add_region_of<1>(place, moments, components, donor, product, basis, mass);
    case 2:
      return add_region_of<2>(place, moments, components, donor, product, basis, mass);
    default:
      return add_region_of<3>(place, moments, components, donor, product, basis, mass);
  }
}

// Eight pieces, or eight regions, side by side: the compiler's vectors (g++ and clang), split into
// registers where they are narrower.
using Lanes [[gnu::vector_size(64)]] = double;

HWY_INLINE void load(const double* p, Lanes& x) {
  std::memcpy(&x, p, sizeof x);
}
HWY_INLINE void store(const Lanes& x, double* p) {
  std::memcpy(p, &x, sizeof x);
}
HWY_INLINE double sum_of(const Lanes& x) {
  return ((x[0] + x[4]) + (x[2] + x[6])) + ((x[1] + x[5]) + (x[3] + x[7]));
}

/// Points of the blossom with k parameters s and the others r, k = 0 .. G: the part's control
/// points.
template <int G>
HWY_INLINE void part_control(const Lanes* p, const Lanes& r, const Lanes& s, Lanes* out) {
  const Lanes one = Lanes{} + 1.0;
  const Lanes r_left = one - r, s_left = one - s;
#pragma GCC unroll 4
  for (int k = 0; k <= G; ++k) {
    Lanes q[G + 1];
#pragma GCC unroll 4
    for (int i = 0; i <= G; ++i) q[i] = p[i];
#pragma GCC unroll 4
    for (int level = 0; level < G; ++level) {
#pragma GCC unroll 4
      for (int i = 0; i < G - level; ++i) {
        if (level < G - k)
          q[i] = r_left * q[i] + r * q[i + 1];
        else
          q[i] = s_left * q[i] + s * q[i + 1];
      }
    }
    out[k] = q[0];
  }
}

/// The pieces' control points in the coordinates of `place`.
template <int G>
HWY_INLINE void local_control(const PieceBatch& batch, std::size_t block, const TargetPlace& place,
                              Lanes* a, Lanes* b) {
  Lanes from, to, u[G + 1], v[G + 1];
  load(batch.from.data() + block, from);
  load(batch.to.data() + block, to);
#pragma GCC unroll 4
  for (int i = 0; i <= G; ++i) {
    Lanes x, y;
    load(batch.x.data() + static_cast<std::size_t>(i) * batch.stride + block, x);
    load(batch.y.data() + static_cast<std::size_t>(i) * batch.stride + block, y);
    x -= place.centre.x();
    y -= place.centre.y();
    u[i] = place.first.x() * x + place.first.y() * y;
    v[i] = place.second.x() * x + place.second.y() * y;
  }
  part_control<G>(u, from, to, a);
  part_control<G>(v, from, to, b);
}

template <int G>
void piece_shapes_of(const std::vector<double>& weights, const Vec2& origin, PieceBatch& batch) {
  const TargetPlace plane{origin, Vec2{{1, 0}}, Vec2{{0, 1}}, Vec2{{1, 0}}, Vec2{{0, 1}}, 1.0};
  for (std::size_t block = 0; block < batch.stride; block += moment_lanes) {
    Lanes a[G + 1], b[G + 1];
    local_control<G>(batch, block, plane, a, b);
    store(a[G] - a[0], batch.step_x.data() + block);
    store(b[G] - b[0], batch.step_y.data() + block);
    Lanes twice{};
    std::size_t n = 0;
    for (int i = 0; i < G; ++i)
      for (int j = i + 1; j <= G; ++j, ++n) twice += weights[n] * (a[i] * b[j] - b[i] * a[j]);
    store(0.5 * twice, batch.area.data() + block);
  }
}

template <int G, int D>
void piece_moments_of(const PieceTable& table, const TargetPlace& place, PieceBatch& batch) {
  constexpr int size = bernstein::triangle_size(D);
  const std::size_t stride = batch.stride;
  for (std::size_t block = 0; block < stride; block += moment_lanes) {
    Lanes a[G + 1], b[G + 1];
    local_control<G>(batch, block, place, a, b);
    Lanes sums[size] = {};
    for (int q = 0; q < table.points; ++q) {
      Lanes x, y, k;
      if constexpr (G == 1) {
        const double t = table.parameter[static_cast<std::size_t>(q)];
        x = a[0] + t * (a[1] - a[0]);
        y = b[0] + t * (b[1] - b[0]);
        k = table.weight[static_cast<std::size_t>(q)] * (a[0] * b[1] - b[0] * a[1]);
      } else {
        Lanes dx{}, dy{};
        x = y = dx;
        const double* value = table.value.data() + q;
        const double* slope = table.slope.data() + q;
#pragma GCC unroll 4
        for (int i = 0; i <= G; ++i) {
          const double f = value[static_cast<std::size_t>(i) * table.stride];
          const double d = slope[static_cast<std::size_t>(i) * table.stride];
          x += f * a[i];
          y += f * b[i];
          dx += d * a[i];
          dy += d * b[i];
        }
        k = x * dy - y * dx;
      }
      int n = 0;
#pragma GCC unroll 8
      for (int j = 0; j <= D; ++j) {
        Lanes term = k;
#pragma GCC unroll 8
        for (int i = 0; i <= D - j; ++i, ++n) {
          sums[n] += term;
          term *= x;
        }
        k *= y;
      }
    }
    double* out = batch.moments.data() + block;
    int n = 0;
    for (int j = 0; j <= D; ++j)
      for (int i = 0; i <= D - j; ++i, ++n, out += stride)
        store((1.0 / static_cast<double>(i + j + 2)) * sums[n], out);
  }
}

template <int G>
void piece_moments_degree(const PieceTable& table, int moment_degree, const TargetPlace& place,
                          PieceBatch& batch) {
  switch (moment_degree) {
    case 0:
      return piece_moments_of<G, 0>(table, place, batch);
    case 2:
      return piece_moments_of<G, 2>(table, place, batch);
    case 4:
      return piece_moments_of<G, 4>(table, place, batch);
    default:
      return piece_moments_of<G, 6>(table, place, batch);
  }
}

void piece_shapes_target(int degree, const std::vector<double>& weights, const Vec2& origin,
                         PieceBatch& batch) {
  if (degree == 1) return piece_shapes_of<1>(weights, origin, batch);
  if (degree == 2) return piece_shapes_of<2>(weights, origin, batch);
  return piece_shapes_of<3>(weights, origin, batch);
}

void piece_moments_target(const PieceTable& table, int moment_degree, const TargetPlace& place,
                          PieceBatch& batch) {
  if (table.degree == 1) return piece_moments_degree<1>(table, moment_degree, place, batch);
  if (table.degree == 2) return piece_moments_degree<2>(table, moment_degree, place, batch);
  return piece_moments_degree<3>(table, moment_degree, place, batch);
}

/// At most eight regions, one in each lane.
template <int P>
void add_regions(const TargetPlace& place, const PieceBatch& batch, std::span<BatchRegion> regions,
                 int components, Lanes* total_basis, double* product, double* mass) {
  constexpr int size = bernstein::triangle_size(P), twice = bernstein::triangle_size(2 * P);
  alignas(64) double offset[2][moment_lanes] = {}, map[4][moment_lanes] = {};
  alignas(64) double sums[twice][moment_lanes] = {};
  for (std::size_t l = 0; l < regions.size(); ++l) {
    BatchRegion& region = regions[l];
    if (region.donor == nullptr) continue;
    const Vec2 apart = place.centre - region.frame->centre;
    const Vec2 &first = region.frame->gradient[1], &second = region.frame->gradient[2];
    const double m[4] = {dot(first, place.along_first), dot(first, place.along_second),
                         dot(second, place.along_first), dot(second, place.along_second)};
    offset[0][l] = dot(first, apart);
    offset[1][l] = dot(second, apart);
    const double steep = std::max(std::max(std::abs(m[0]), std::abs(m[1])),
                                  std::max(std::abs(m[2]), std::abs(m[3]))) +
                         std::max(std::abs(offset[0][l]), std::abs(offset[1][l]));
    double power = 1.0;
    for (int e = 0; e < P; ++e) power *= steep;
    region.far = !(power <= steepest);
    if (region.far) continue;
    for (int i = 0; i < 4; ++i) map[i][l] = m[i];
    const double* row = batch.moments.data() + region.begin;
    const std::uint32_t pieces = region.end - region.begin;
    for (int n = 0; n < twice; ++n, row += batch.stride) {
      double sum = row[0];
      for (std::uint32_t i = 1; i < pieces; ++i) sum += row[i];
      sums[n][l] = sum;
    }
  }
  Lanes moments[twice], s, t, m[4];
  for (int n = 0; n < twice; ++n) {
    load(sums[n], moments[n]);
    moments[n] *= place.area;
  }
  load(offset[0], s);
  load(offset[1], t);
  for (int i = 0; i < 4; ++i) load(map[i], m[i]);
#pragma GCC unroll 4
  for (int b = 0; b <= P; ++b) {
#pragma GCC unroll 4
    for (int a = 0; a <= P - b; ++a) total_basis[at(P, a, b)] += moments[at(2 * P, a, b)];
  }

  for (int c = 0; c < components; ++c) {
    Lanes f[size];
    for (int n = 0; n < size; ++n) {
      alignas(64) double values[moment_lanes] = {};
      for (std::size_t l = 0; l < regions.size(); ++l)
        if (regions[l].donor != nullptr) values[l] = regions[l].donor[n * components + c];
      load(values, f[n]);
    }
    if constexpr (P > 0) {
      move_polynomial<P>(f, s, t);
      substitute<P>(f, m);
    }
    for (int b = 0; b <= P; ++b) {
      for (int a = 0; a <= P - b; ++a) {
        Lanes sum{};
#pragma GCC unroll 4
        for (int d = 0; d <= P; ++d) {
#pragma GCC unroll 4
          for (int e = 0; e <= P - d; ++e) sum += moments[at(2 * P, a + e, b + d)] * f[at(P, e, d)];
        }
        product[at(P, a, b) * components + c] += sum_of(sum);
        if (a + b == 0) {
          for (std::size_t l = 0; l < regions.size(); ++l)
            mass[l * static_cast<std::size_t>(components) + static_cast<std::size_t>(c)] = sum[l];
        }
      }
    }
  }
}

template <int P>
void add_batch_of(const TargetPlace& place, const PieceBatch& batch, std::span<BatchRegion> regions,
                  int components, double* product, double* basis, double* mass) {
  constexpr int size = bernstein::triangle_size(P);
  Lanes total[size] = {};
  for (std::size_t first = 0; first < regions.size(); first += moment_lanes) {
    const std::size_t count = std::min(moment_lanes, regions.size() - first);
    add_regions<P>(place, batch, regions.subspan(first, count), components, total, product,
                   mass + first * static_cast<std::size_t>(components));
  }
  for (int n = 0; n < size; ++n) basis[n] += sum_of(total[n]);
}

void add_batch_target(int degree, const TargetPlace& place, const PieceBatch& batch,
                      std::span<BatchRegion> regions, int components, double* product,
                      double* basis, double* mass) {
  if (degree == 0) return add_batch_of<0>(place, batch, regions, components, product, basis, mass);
  if (degree == 1) return add_batch_of<1>(place, batch, regions, components, product, basis, mass);
  if (degree == 2) return add_batch_of<2>(place, batch, regions, components, product, basis, mass);
  return add_batch_of<3>(place, batch, regions, components, product, basis, mass);
}

/// y[n][c] += sum over m of matrix[m][n] x[m][c], rows of `padded` numbers.
void apply_matrix_target(std::size_t size, std::size_t padded, const double* matrix,
                         std::size_t components, const double* x, double* y) {
  for (std::size_t c = 0; c < components; ++c) {
    Lanes sums[2] = {};
    for (std::size_t m = 0; m < size; ++m) {
      const double value = x[m * components + c];
      for (std::size_t b = 0; b < padded / moment_lanes; ++b) {
        Lanes row;
        load(matrix + m * padded + b * moment_lanes, row);
        sums[b] += value * row;
      }
    }
    double result[2 * moment_lanes];
    store(sums[0], result);
    store(sums[1], result + moment_lanes);
    for (std::size_t n = 0; n < size; ++n) y[n * components + c] += result[n];
  }
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {
namespace {

/// The transposed power matrix, its rows filled up with zeros.
struct PaddedMatrix {
  std::size_t size, padded;
  std::vector<double> rows;
};

const PaddedMatrix& padded_power_matrix(int degree) {
  static const auto matrices = [] {
    std::array<PaddedMatrix, max_moment_degree + 1> all;
    for (int d = 0; d <= max_moment_degree; ++d) {
      const std::vector<double>& matrix = power_matrix(d);
      const auto size = static_cast<std::size_t>(bernstein::triangle_size(d));
      const std::size_t padded = (size + moment_lanes - 1) / moment_lanes * moment_lanes;
      PaddedMatrix& to = all[static_cast<std::size_t>(d)];
      to = {size, padded, std::vector<double>(size * padded, 0.0)};
      for (std::size_t n = 0; n < size; ++n)
        for (std::size_t m = 0; m < size; ++m) to.rows[m * padded + n] = matrix[n * size + m];
    }
    return all;
  }();
  return matrices[static_cast<std::size_t>(degree)];
}

}  // namespace

HWY_EXPORT(region_moments_target);
HWY_EXPORT(add_region_target);

void region_moments(int degree, std::span<const MomentPiece> pieces, double* moments) {
  HWY_DYNAMIC_DISPATCH(region_moments_target)(degree, pieces, moments);
}

void add_region(int degree, const RegionPlace& place, const double* moments, int components,
                const double* donor, double* product, double* basis, double* mass) {
  HWY_DYNAMIC_DISPATCH(add_region_target)
  (degree, place, moments, components, donor, product, basis, mass);
}

HWY_EXPORT(piece_shapes_target);
HWY_EXPORT(piece_moments_target);
HWY_EXPORT(apply_matrix_target);
HWY_EXPORT(add_batch_target);

void PieceBatch::resize(std::size_t pieces, int degree, int moment_degree) {
  count = pieces;
  const std::size_t needed = (pieces + moment_lanes - 1) / moment_lanes * moment_lanes;
  stride = needed;
  const auto points = static_cast<std::size_t>(degree + 1);
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(moment_degree));
  if (from.size() < needed) {
    for (std::vector<double>* array : {&from, &to, &area, &step_x, &step_y})
      array->resize(2 * needed);
  }
  if (x.size() < points * needed) {
    x.resize(2 * points * needed);
    y.resize(2 * points * needed);
  }
  if (moments.size() < size * needed) moments.resize(2 * size * needed);
}

void piece_shapes(int degree, const Vec2& origin, PieceBatch& batch) {
  HWY_DYNAMIC_DISPATCH(piece_shapes_target)(degree, area_weights(degree), origin, batch);
}

void powers_from_moments(int degree, int components, const double* moments, double* powers) {
  const PaddedMatrix& matrix = padded_power_matrix(degree);
  HWY_DYNAMIC_DISPATCH(apply_matrix_target)
  (matrix.size, matrix.padded, matrix.rows.data(), static_cast<std::size_t>(components), moments,
   powers);
}

void piece_moments(const PieceTable& table, int moment_degree, const TargetPlace& place,
                   PieceBatch& batch) {
  HWY_DYNAMIC_DISPATCH(piece_moments_target)(table, moment_degree, place, batch);
}

void add_batch(int degree, const TargetPlace& place, const PieceBatch& batch,
               std::span<BatchRegion> regions, int components, double* product, double* basis,
               double* mass) {
  HWY_DYNAMIC_DISPATCH(add_batch_target)
  (degree, place, batch, regions, components, product, basis, mass);
}

}  // namespace bezel::detail
#endif
