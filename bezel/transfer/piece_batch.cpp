#include "bezel/transfer/piece_batch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/mass_rule.hpp"

// The bits are the same on every target, so the fewer the better for those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/piece_batch.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on
#include "bezel/transfer/polynomial_moves.hpp"
#include "bezel/transfer/vector_lanes.hpp"

#ifndef BEZEL_TRANSFER_PIECE_BATCH_ONCE
#define BEZEL_TRANSFER_PIECE_BATCH_ONCE
namespace bezel::detail {
/// About the target's centre a donor's polynomial may grow by this factor beyond its size on the
/// donor: so many roundings are lost.
inline constexpr double steepest = 32.0;
/// Of the matrices' rows, padded.
inline constexpr std::size_t most_blocks =
    padded_to_lanes(static_cast<std::size_t>(bernstein::triangle_size(2 * max_moment_degree))) /
    lanes;
}  // namespace bezel::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

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
          q[i] = mul_add(r_left, q[i], r * q[i + 1]);
        else
          q[i] = mul_add(s_left, q[i], s * q[i + 1]);
      }
    }
    out[k] = q[0];
  }
}

/// Rows become columns.
HWY_INLINE void transpose(Lanes* r) {
  Lanes t[8], u[8];
#pragma GCC unroll 4
  for (int i = 0; i < 8; i += 2) {
    t[i] = __builtin_shufflevector(r[i], r[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    t[i + 1] = __builtin_shufflevector(r[i], r[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
#pragma GCC unroll 2
  for (int i = 0; i < 8; i += 4) {
#pragma GCC unroll 2
    for (int k = 0; k < 2; ++k) {
      u[i + k] = __builtin_shufflevector(t[i + k], t[i + k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
      u[i + k + 2] = __builtin_shufflevector(t[i + k], t[i + k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
    }
  }
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    r[i] = __builtin_shufflevector(u[i], u[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
    r[i + 4] = __builtin_shufflevector(u[i], u[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
  }
}

/// The pieces' control points in the coordinates of `place`.
template <int G>
HWY_INLINE void local_control(const PieceBatch& batch, std::size_t block, const TargetPlace& place,
                              Lanes* a, Lanes* b) {
  Lanes from, to, u[G + 1], v[G + 1];
  from = load(batch.from.data() + block);
  to = load(batch.to.data() + block);
#pragma GCC unroll 4
  for (int i = 0; i <= G; ++i) {
    Lanes x, y;
    x = load(batch.x.data() + static_cast<std::size_t>(i) * batch.stride + block);
    y = load(batch.y.data() + static_cast<std::size_t>(i) * batch.stride + block);
    x -= place.centre.x();
    y -= place.centre.y();
    u[i] = mul_add(place.first.x(), x, place.first.y() * y);
    v[i] = mul_add(place.second.x(), x, place.second.y() * y);
  }
  part_control<G>(u, from, to, a);
  part_control<G>(v, from, to, b);
}

/// Numbers per piece and region with moments up to degree D: these, the step, the area of curved
/// pieces, and padding.
template <int G, int D>
constexpr std::size_t width_of =
    padded_to_lanes(static_cast<std::size_t>(bernstein::triangle_size(D)) + (G == 1 ? 2 : 3));

template <int G, int D>
void piece_moments_of(const PieceTable& table, const std::vector<double>& weights,
                      const Vec2& origin, const TargetPlace& place, PieceBatch& batch) {
  constexpr std::size_t size = static_cast<std::size_t>(bernstein::triangle_size(D));
  constexpr std::size_t width = width_of<G, D>;
  for (std::size_t block = 0; block < batch.stride; block += lanes) {
    Lanes a[G + 1], b[G + 1];
    local_control<G>(batch, block, place, a, b);
    Lanes sums[width] = {};
    for (int q = 0; q < table.points; ++q) {
      Lanes x, y, k;
      if constexpr (G == 1) {
        const double t = table.parameter[static_cast<std::size_t>(q)];
        x = mul_add(t, a[1] - a[0], a[0]);
        y = mul_add(t, b[1] - b[0], b[0]);
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
          x = mul_add(f, a[i], x);
          y = mul_add(f, b[i], y);
          dx = mul_add(d, a[i], dx);
          dy = mul_add(d, b[i], dy);
        }
        k = x * dy - y * dx;
      }
      std::size_t n = 0;
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
    std::size_t n = 0;
#pragma GCC unroll 8
    for (int j = 0; j <= D; ++j) {
#pragma GCC unroll 8
      for (int i = 0; i <= D - j; ++i, ++n) sums[n] *= 1.0 / static_cast<double>(i + j + 2);
    }
    sums[size] = a[G] - a[0];
    sums[size + 1] = b[G] - b[0];
    if constexpr (G == 1) {
      sums[0] = 0.5 * (a[0] * sums[size + 1] - b[0] * sums[size]);
    } else {
      // The area in the plane, whatever the coordinates and the degree: that of the chord, and of
      // what lies between it and the piece.
      const TargetPlace plane{origin, Vec2{{1, 0}}, Vec2{{0, 1}}, Vec2{{1, 0}}, Vec2{{0, 1}}, 1.0};
      local_control<G>(batch, block, plane, a, b);
      Lanes twice = a[0] * (b[G] - b[0]) - b[0] * (a[G] - a[0]);
      std::size_t w = G;
#pragma GCC unroll 4
      for (int i = 1; i < G; ++i)
#pragma GCC unroll 4
        for (int j = i + 1; j <= G; ++j, ++w)
          twice += weights[w] * ((a[i] - a[0]) * (b[j] - b[0]) - (b[i] - b[0]) * (a[j] - a[0]));
      sums[size + 2] = 0.5 * twice;
    }
    double* out = batch.moments.data() + block * width;
#pragma GCC unroll 4
    for (std::size_t m = 0; m < width; m += lanes) {
      transpose(sums + m);
#pragma GCC unroll 8
      for (std::size_t l = 0; l < lanes; ++l) store(sums[m + l], out + l * width + m);
    }
  }
}

/// A piece counts for the region on its left, and backwards for that on its right.
template <std::size_t width>
void sum_pieces(std::span<const BoundaryPiece> pieces, std::size_t regions, PieceBatch& batch) {
  std::fill_n(batch.sums.data(), regions * width, 0.0);
  const double* row = batch.moments.data();
  for (const BoundaryPiece& piece : pieces) {
    double* left = batch.sums.data() + static_cast<std::size_t>(piece.left) * width;
    double* right = piece.right < 0
                        ? nullptr
                        : batch.sums.data() + static_cast<std::size_t>(piece.right) * width;
#pragma GCC unroll 4
    for (std::size_t m = 0; m < width; m += lanes) {
      Lanes moments, sum;
      moments = load(row + m);
      sum = load(left + m);
      store(sum + moments, left + m);
      if (right == nullptr) continue;
      sum = load(right + m);
      store(sum - moments, right + m);
    }
    row += width;
  }
}

template <int G, int D>
void region_sums_of(const PieceTable& table, const Vec2& origin, const TargetPlace& place,
                    std::span<const BoundaryPiece> pieces, std::size_t regions, PieceBatch& batch) {
  constexpr std::size_t width = width_of<G, D>;
  batch.width = width;
  batch.open = static_cast<std::size_t>(bernstein::triangle_size(D));
  batch.area = G == 1 ? 0 : batch.open + 2;
  batch.area_unit = G == 1 ? place.area : 1.0;
  if (batch.moments.size() < batch.stride * width) batch.moments.resize(2 * batch.stride * width);
  if (batch.sums.size() < regions * width) batch.sums.resize(2 * regions * width);
  piece_moments_of<G, D>(table, area_weights(G), origin, place, batch);
  sum_pieces<width>(pieces, regions, batch);
}

template <int G>
void region_sums_degree(const PieceTable& table, int degree, const Vec2& origin,
                        const TargetPlace& place, std::span<const BoundaryPiece> pieces,
                        std::size_t regions, PieceBatch& batch) {
  switch (degree) {
    case 0:
      return region_sums_of<G, 0>(table, origin, place, pieces, regions, batch);
    case 2:
      return region_sums_of<G, 2>(table, origin, place, pieces, regions, batch);
    case 4:
      return region_sums_of<G, 4>(table, origin, place, pieces, regions, batch);
    default:
      return region_sums_of<G, 6>(table, origin, place, pieces, regions, batch);
  }
}

void region_sums_target(const PieceTable& table, int degree, const Vec2& origin,
                        const TargetPlace& place, std::span<const BoundaryPiece> pieces,
                        std::size_t regions, PieceBatch& batch) {
  if (table.degree == 1)
    return region_sums_degree<1>(table, degree, origin, place, pieces, regions, batch);
  if (table.degree == 2)
    return region_sums_degree<2>(table, degree, origin, place, pieces, regions, batch);
  return region_sums_degree<3>(table, degree, origin, place, pieces, regions, batch);
}

/// x := max(x, |y|)
HWY_INLINE void raise(Lanes& x, const Lanes& y) {
  x = x < y ? y : x;
  x = x < -y ? -y : x;
}

alignas(64) constexpr double zeros[2 * lanes] = {};

/// Where at most eight regions lie in their donors' coordinates, one in each lane, and their
/// moments; all zero for those that get nothing.
template <int P>
struct RegionLanes {
  static constexpr int size = bernstein::triangle_size(P), twice = bernstein::triangle_size(2 * P);
  Lanes moments[padded_to_lanes(static_cast<std::size_t>(twice))];
  Lanes m[4], s, t;
};

/// The same of one region.
template <int P>
struct RegionNumbers {
  double moments[RegionLanes<P>::twice];
  double m[4], s, t;
  Substitution<P, double> substitution;
};

/// @param number  of the first region in the batch
template <int P>
HWY_INLINE void place_regions(const TargetPlace& place, const PieceBatch& batch, std::size_t number,
                              std::span<BatchRegion> regions, Lanes* total_basis,
                              RegionLanes<P>& out) {
  static_assert(sizeof(Frame) == sizeof(Lanes));
  constexpr std::size_t rows = padded_to_lanes(static_cast<std::size_t>(out.twice));
  alignas(64) double keep[lanes] = {};
#pragma GCC unroll 4
  for (std::size_t m = 0; m < rows; m += lanes) {
    for (std::size_t l = 0; l < lanes; ++l)
      out.moments[m + l] = load(l < regions.size() ? batch.region(number + l) + m : zeros);
    transpose(out.moments + m);
  }
  // The donors' coordinates: centre x, y, then the gradients of the three barycentrics.
  Lanes frame[lanes];
  for (std::size_t l = 0; l < lanes; ++l) {
    const bool has = l < regions.size() && regions[l].donor != nullptr;
    keep[l] = has ? 1.0 : 0.0;
    if (has)
      std::memcpy(&frame[l], regions[l].frame, sizeof(Frame));
    else
      frame[l] = Lanes{};
  }
  transpose(frame);
  const Lanes apart_x = place.centre.x() - frame[0], apart_y = place.centre.y() - frame[1];
  Lanes m[4] = {frame[4] * place.along_first.x() + frame[5] * place.along_first.y(),
                frame[4] * place.along_second.x() + frame[5] * place.along_second.y(),
                frame[6] * place.along_first.x() + frame[7] * place.along_first.y(),
                frame[6] * place.along_second.x() + frame[7] * place.along_second.y()};
  const Lanes s = frame[4] * apart_x + frame[5] * apart_y,
              t = frame[6] * apart_x + frame[7] * apart_y;
  Lanes slope{}, reach{};
  for (const Lanes& x : m) raise(slope, x);
  raise(reach, s);
  raise(reach, t);
  const Lanes steep = slope + reach;
  Lanes power = Lanes{} + 1.0;
  for (int e = 0; e < P; ++e) power *= steep;
  Lanes kept;
  kept = load(keep);
  const auto near = (power <= steepest) & (kept > 0.0);
  const Lanes none{};
  for (int i = 0; i < 4; ++i) out.m[i] = near ? m[i] : none;
  out.s = near ? s : none;
  out.t = near ? t : none;
  const Lanes scale = near ? none + place.area : none;
  store(scale, keep);
  for (std::size_t l = 0; l < regions.size(); ++l)
    regions[l].far = regions[l].donor != nullptr && keep[l] == 0.0;
#pragma GCC unroll 28
  for (int n = 0; n < out.twice; ++n) out.moments[n] *= scale;
#pragma GCC unroll 4
  for (int b = 0; b <= P; ++b) {
#pragma GCC unroll 4
    for (int a = 0; a <= P - b; ++a) total_basis[at(P, a, b)] += out.moments[at(2 * P, a, b)];
  }
}

/// sums[n] = integral of f m_n from the moments, both polynomials in the target's coordinates.
template <int P, class S>
HWY_INLINE void multiply(const S* moments, const Lanes* f, Lanes* sums) {
#pragma GCC unroll 4
  for (int b = 0; b <= P; ++b) {
#pragma GCC unroll 4
    for (int a = 0; a <= P - b; ++a) {
      Lanes sum{};
#pragma GCC unroll 4
      for (int d = 0; d <= P; ++d) {
#pragma GCC unroll 4
        for (int e = 0; e <= P - d; ++e)
          sum = mul_add(moments[at(2 * P, a + e, b + d)], f[at(P, e, d)], sum);
      }
      sums[at(P, a, b)] = sum;
    }
  }
}

/// One component of at most eight regions.
template <int P>
void add_regions(const RegionLanes<P>& place, std::span<const BatchRegion> regions, double base,
                 double* product, double* mass) {
  constexpr auto size = static_cast<std::size_t>(place.size);
  constexpr std::size_t donor_rows = padded_to_lanes(size);
  Lanes f[donor_rows];
#pragma GCC unroll 2
  for (std::size_t r = 0; r < donor_rows; r += lanes) {
    for (std::size_t l = 0; l < lanes; ++l) {
      const bool has = l < regions.size() && regions[l].donor != nullptr;
      f[r + l] = load(has ? regions[l].donor + r : zeros);
    }
    transpose(f + r);
  }
  f[0] -= base;
  if constexpr (P > 0) {
    move_polynomial<P>(f, place.s, place.t);
    Substitution<P, Lanes>(place.m).apply(f);
  }
  Lanes sums[donor_rows] = {};
  multiply<P>(place.moments, f, sums);
  alignas(64) double masses[lanes];
  store(sums[0] + base * place.moments[0], masses);
  for (std::size_t l = 0; l < regions.size(); ++l) mass[l] = masses[l];
#pragma GCC unroll 2
  for (std::size_t r = 0; r < donor_rows; r += lanes) {
    transpose(sums + r);
    Lanes total = sums[r];
#pragma GCC unroll 8
    for (std::size_t l = 1; l < lanes; ++l) total += sums[r + l];
    alignas(64) double totals[lanes];
    store(total, totals);
    for (std::size_t n = r; n < std::min(r + lanes, size); ++n) product[n] += totals[n - r];
  }
}

/// The same for several components, eight of them in the lanes: each has the bits that it has
/// alone.
template <int P>
void add_components(const RegionLanes<P>& place, std::span<const BatchRegion> regions,
                    std::size_t components, const double* base, double* product, double* mass) {
  constexpr auto size = static_cast<std::size_t>(place.size);
  std::array<RegionNumbers<P>, lanes> numbers;
  for (std::size_t l = 0; l < regions.size(); ++l) {
    const auto lane = [&](const Lanes& x) { return x[l]; };
    RegionNumbers<P>& own = numbers[l];
    for (int n = 0; n < place.twice; ++n) own.moments[n] = lane(place.moments[n]);
    for (int i = 0; i < 4; ++i) own.m[i] = lane(place.m[i]);
    own.s = lane(place.s);
    own.t = lane(place.t);
    if constexpr (P > 0) own.substitution = Substitution<P, double>(own.m);
  }
  for (std::size_t c = 0; c < components; c += lanes) {
    const std::size_t count = std::min(lanes, components - c);
    const Lanes off = load(base + c);
    Lanes total[size] = {};
    for (std::size_t l = 0; l < regions.size(); ++l) {
      double* const own_mass = mass + l * components + c;
      if (regions[l].donor == nullptr || regions[l].far) {
        std::fill_n(own_mass, count, 0.0);
        continue;
      }
      Lanes f[size], sums[size];
#pragma GCC unroll 10
      for (std::size_t n = 0; n < size; ++n) f[n] = load(regions[l].donor + n * components + c);
      f[0] -= off;
      const RegionNumbers<P>& own = numbers[l];
      if constexpr (P > 0) {
        move_polynomial<P>(f, own.s, own.t);
        own.substitution.apply(f);
      }
      multiply<P>(own.moments, f, sums);
      store_part(sums[0] + off * own.moments[0], own_mass, count);
#pragma GCC unroll 10
      for (std::size_t n = 0; n < size; ++n) total[n] += sums[n];
    }
    for (std::size_t n = 0; n < size; ++n) {
      double* const to = product + n * components + c;
      store_part(load(to) + total[n], to, count);
    }
  }
}

template <int P>
void add_batch_of(const TargetPlace& place, const PieceBatch& batch, std::span<BatchRegion> regions,
                  std::size_t components, const double* base, double* product, double* basis,
                  double* mass) {
  constexpr int size = bernstein::triangle_size(P);
  Lanes total[size] = {};
  for (std::size_t first = 0; first < regions.size(); first += lanes) {
    const std::size_t count = std::min(lanes, regions.size() - first);
    const std::span<BatchRegion> some = regions.subspan(first, count);
    RegionLanes<P> placed;
    place_regions<P>(place, batch, first, some, total, placed);
    if (components == 1)
      add_regions<P>(placed, some, *base, product, mass + first);
    else
      add_components<P>(placed, some, components, base, product, mass + first * components);
  }
  for (int n = 0; n < size; ++n) basis[n] += sum_of(total[n]);
}

void add_batch_target(int degree, const TargetPlace& place, const PieceBatch& batch,
                      std::span<BatchRegion> regions, std::size_t components, const double* base,
                      double* product, double* basis, double* mass) {
  switch (degree) {
    case 0:
      return add_batch_of<0>(place, batch, regions, components, base, product, basis, mass);
    case 1:
      return add_batch_of<1>(place, batch, regions, components, base, product, basis, mass);
    case 2:
      return add_batch_of<2>(place, batch, regions, components, base, product, basis, mass);
    default:
      return add_batch_of<3>(place, batch, regions, components, base, product, basis, mass);
  }
}

/// y[n][c] += sum over m of matrix[m][n] x[m][c], rows of `padded` numbers.
void apply_matrix_target(std::size_t size, std::size_t padded, const double* matrix,
                         std::size_t components, const double* x, double* y) {
  for (std::size_t c = 0; c < components; ++c) {
    Lanes sums[most_blocks] = {};
    for (std::size_t m = 0; m < size; ++m) {
      const double value = x[m * components + c];
      for (std::size_t b = 0; b < padded / lanes; ++b) {
        Lanes row;
        row = load(matrix + m * padded + b * lanes);
        sums[b] = mul_add(value, row, sums[b]);
      }
    }
    double result[most_blocks * lanes];
    for (std::size_t b = 0; b < most_blocks; ++b) store(sums[b], result + b * lanes);
    for (std::size_t n = 0; n < size; ++n) y[n * components + c] += result[n];
  }
}

// Around the element's mean: what remains is small, so a constant comes back constant whatever the
// rounding of the matrix.
template <std::size_t blocks>
double solve_one(const StraightSystem& system, const double* matrix, double* coefficients) {
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(system.degree));
  const double scale = 0.5 / system.area, per_function = system.area / static_cast<double>(size);
  const double mass = *system.mass, mean = mass / system.covered;
  const double rest = mean - *system.base;
  Lanes x[blocks] = {};
  for (std::size_t m = 0; m < size; ++m) {
    const double value = (system.product[m] - rest * system.basis[m]) * scale;
#pragma GCC unroll 2
    for (std::size_t b = 0; b < blocks; ++b) {
      Lanes row;
      row = load(matrix + (m * blocks + b) * lanes);
      x[b] = mul_add(value, row, x[b]);
    }
  }
  double sum = sum_of(x[0]);
  if constexpr (blocks > 1) sum += sum_of(x[1]);
  const double got = sum * per_function + mean * system.area;
  const double shift = mean + (mass - got) / system.area;
  double values[blocks * lanes];
#pragma GCC unroll 2
  for (std::size_t b = 0; b < blocks; ++b) store(x[b] + shift, values + b * lanes);
  sum = 0.0;
  for (std::size_t n = 0; n < size; ++n) {
    coefficients[n] = values[n];
    sum += values[n];
  }
  return std::abs(mass - sum * per_function);
}

/// The same for several components, eight of them in the lanes: each has the bits that it has
/// alone.
template <int P>
double solve_components(const StraightSystem& system, const double* matrix, double* coefficients) {
  constexpr auto size = static_cast<std::size_t>(bernstein::triangle_size(P));
  constexpr std::size_t padded = padded_to_lanes(size);
  const auto nc = static_cast<std::size_t>(system.components);
  const double scale = 0.5 / system.area, per_function = system.area / static_cast<double>(size);
  double largest = 0.0;
  for (std::size_t c = 0; c < nc; c += lanes) {
    const std::size_t count = std::min(lanes, nc - c);
    const Lanes mass = load(system.mass + c), mean = mass / system.covered;
    const Lanes rest = mean - load(system.base + c);
    Lanes x[padded] = {};
#pragma GCC unroll 10
    for (std::size_t m = 0; m < size; ++m) {
      const Lanes value = (load(system.product + m * nc + c) - rest * system.basis[m]) * scale;
#pragma GCC unroll 10
      for (std::size_t n = 0; n < size; ++n) x[n] = mul_add(matrix[m * padded + n], value, x[n]);
    }
    // In the order of sum_of().
    const auto in_order = [](const Lanes* r) {
      return ((r[0] + r[4]) + (r[2] + r[6])) + ((r[1] + r[5]) + (r[3] + r[7]));
    };
    Lanes sum = in_order(x);
    if constexpr (padded > lanes) sum += in_order(x + lanes);
    const Lanes got = sum * per_function + mean * system.area;
    const Lanes shift = mean + (mass - got) / system.area;
    sum = Lanes{};
#pragma GCC unroll 10
    for (std::size_t n = 0; n < size; ++n) {
      const Lanes value = x[n] + shift;
      store_part(value, coefficients + n * nc + c, count);
      sum += value;
    }
    alignas(64) double defects[lanes];
    store(mass - sum * per_function, defects);
    for (std::size_t l = 0; l < count; ++l) largest = std::max(largest, std::abs(defects[l]));
  }
  return largest;
}

template <int P>
double solve_straight_of(const StraightSystem& system, const double* matrix, double* coefficients) {
  if (system.components == 1) return solve_one<(P < 3 ? 1 : 2)>(system, matrix, coefficients);
  return solve_components<P>(system, matrix, coefficients);
}

double solve_straight_target(const StraightSystem& system, const double* matrix,
                             double* coefficients) {
  switch (system.degree) {
    case 0:
      return solve_straight_of<0>(system, matrix, coefficients);
    case 1:
      return solve_straight_of<1>(system, matrix, coefficients);
    case 2:
      return solve_straight_of<2>(system, matrix, coefficients);
    default:
      return solve_straight_of<3>(system, matrix, coefficients);
  }
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {
namespace {

/// A transposed matrix, its rows filled up with zeros.
struct PaddedMatrix {
  PaddedMatrix() = default;
  PaddedMatrix(std::size_t size_in, const std::vector<double>& matrix)
      : size(size_in), padded(padded_to_lanes(size)), rows(size * padded, 0.0) {
    for (std::size_t n = 0; n < size; ++n)
      for (std::size_t m = 0; m < size; ++m) rows[m * padded + n] = matrix[n * size + m];
  }
  std::size_t size = 0, padded = 0;
  std::vector<double> rows;
};

using MatrixByDegree = std::array<PaddedMatrix, 2 * max_moment_degree + 1>;

const PaddedMatrix& padded_power_matrix(int degree) {
  static const auto matrices = [] {
    MatrixByDegree all;
    for (int d = 0; d <= 2 * max_moment_degree; ++d)
      all[static_cast<std::size_t>(d)] =
          PaddedMatrix(static_cast<std::size_t>(bernstein::triangle_size(d)), power_matrix(d));
    return all;
  }();
  return matrices[static_cast<std::size_t>(degree)];
}

/// The columns of `right`, an n x n matrix, solved for with the Bernstein mass matrix of the
/// triangle of area 1/2.
std::vector<double> solve_mass(int degree, std::vector<double> right) {
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(degree));
  std::vector<double> lower = bernstein::mass_matrix(degree);
  cholesky(n, lower);
  for (std::size_t c = 0; c < n; ++c) {
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) right[i * n + c] -= lower[i * n + k] * right[k * n + c];
      right[i * n + c] /= lower[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k)
        right[i * n + c] -= lower[k * n + i] * right[k * n + c];
      right[i * n + c] /= lower[i * n + i];
    }
  }
  return right;
}

/// From moments on the triangle of area 1/2 to Bernstein coefficients.
const PaddedMatrix& projection_matrix(int degree) {
  static const auto matrices = [] {
    MatrixByDegree all;
    for (int d = 0; d <= max_moment_degree; ++d) {
      const auto size = static_cast<std::size_t>(bernstein::triangle_size(d));
      const std::vector<double>& powers = power_matrix(d);
      const auto factors = multinomials(d);
      std::vector<double> scaled(size * size);
      for (std::size_t n = 0; n < size; ++n)
        for (std::size_t m = 0; m < size; ++m)
          scaled[n * size + m] = factors[n] * powers[n * size + m];
      all[static_cast<std::size_t>(d)] = PaddedMatrix(size, solve_mass(d, scaled));
    }
    return all;
  }();
  return matrices[static_cast<std::size_t>(degree)];
}

}  // namespace

HWY_EXPORT(region_sums_target);
HWY_EXPORT(apply_matrix_target);
HWY_EXPORT(solve_straight_target);
HWY_EXPORT(add_batch_target);

void PieceBatch::resize(std::size_t pieces, int degree) {
  count = pieces;
  const std::size_t needed = padded_to_lanes(pieces);
  stride = needed;
  const auto points = static_cast<std::size_t>(degree + 1);
  if (from.size() < needed) {
    from.resize(2 * needed);
    to.resize(2 * needed);
  }
  if (x.size() < points * needed) {
    x.resize(2 * points * needed);
    y.resize(2 * points * needed);
  }
}

void region_sums(const PieceTable& table, int degree, const Vec2& origin, const TargetPlace& place,
                 std::span<const BoundaryPiece> pieces, std::size_t regions, PieceBatch& batch) {
  HWY_DYNAMIC_DISPATCH(region_sums_target)(table, degree, origin, place, pieces, regions, batch);
}

void add_batch(int degree, const TargetPlace& place, const PieceBatch& batch,
               std::span<BatchRegion> regions, int components, const double* base, double* product,
               double* basis, double* mass) {
  HWY_DYNAMIC_DISPATCH(add_batch_target)
  (degree, place, batch, regions, static_cast<std::size_t>(components), base, product, basis, mass);
}

double solve_straight(const StraightSystem& system, double* coefficients) {
  return HWY_DYNAMIC_DISPATCH(solve_straight_target)(
      system, projection_matrix(system.degree).rows.data(), coefficients);
}

void powers_from_moments(int degree, int components, const double* moments, double* powers) {
  const PaddedMatrix& matrix = padded_power_matrix(degree);
  HWY_DYNAMIC_DISPATCH(apply_matrix_target)
  (matrix.size, matrix.padded, matrix.rows.data(), static_cast<std::size_t>(components), moments,
   powers);
}

}  // namespace bezel::detail
#endif
