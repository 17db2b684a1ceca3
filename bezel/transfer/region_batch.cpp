// What the regions of a batch give: integrals with donors' polynomials, and the solution on a
// straight triangle.

#include "bezel/transfer/piece_batch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/triangle.hpp"
#include "bezel/transfer/accumulate.hpp"
#include "bezel/transfer/mass_rule.hpp"

// Few targets, for the sake of those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/region_batch.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on
#include "bezel/transfer/region_kernels.hpp"

#ifndef BEZEL_TRANSFER_REGION_BATCH_ONCE
#define BEZEL_TRANSFER_REGION_BATCH_ONCE
namespace bezel::detail {
/// Of the matrices' rows, padded.
inline constexpr std::size_t most_blocks =
    padded_to_lanes(static_cast<std::size_t>(bernstein::triangle_size(2 * max_moment_degree))) /
    lanes;
}  // namespace bezel::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

alignas(64) constexpr double zeros[2 * lanes] = {};

/// All zero in the lanes of regions that get nothing.
/// @param number  of the first region in the batch
template <int P>
HWY_INLINE void place_regions(const TargetPlace& place, const PieceBatch& batch, std::size_t number,
                              std::span<BatchRegion> regions, Lanes* total_basis,
                              RegionLanes<P>& out) {
  static_assert(sizeof(Frame) == sizeof(Lanes));
  constexpr std::size_t rows = padded_to_lanes(static_cast<std::size_t>(RegionLanes<P>::twice));
  alignas(64) double keep[lanes] = {};
#pragma GCC unroll 4
  for (std::size_t m = 0; m < rows; m += lanes) {
    for (std::size_t l = 0; l < lanes; ++l)
      out.moments[m + l] = load(l < regions.size() ? batch.region(number + l) + m : zeros);
    transpose(out.moments + m);
  }
  Lanes frame[lanes];
  for (std::size_t l = 0; l < lanes; ++l) {
    const bool has = l < regions.size() && regions[l].donor != nullptr;
    keep[l] = has ? 1.0 : 0.0;
    if (has)
      frame[l] = load(reinterpret_cast<const double*>(regions[l].frame));
    else
      frame[l] = Lanes{};
  }
  const Lanes none{};
  const TargetLanes target{none + place.centre.x(),       none + place.centre.y(),
                           none + place.along_first.x(),  none + place.along_first.y(),
                           none + place.along_second.x(), none + place.along_second.y()};
  Lanes m[4], s, t;
  const Lanes power = place_donors<P>(target, frame, m, s, t);
  Lanes kept;
  kept = load(keep);
  const auto near = (power <= steepest) & (kept > 0.0);
  for (int i = 0; i < 4; ++i) out.m[i] = select(near, m[i], none);
  out.s = select(near, s, none);
  out.t = select(near, t, none);
  const Lanes scale = select(near, none + place.area, none);
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

/// One component of at most eight regions.
template <int P>
void add_regions(const RegionLanes<P>& place, std::span<const BatchRegion> regions, double base,
                 double* product, double* mass) {
  constexpr auto size = static_cast<std::size_t>(RegionLanes<P>::size);
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

/// The same for several components, side by side: each has the bits that it has alone.
template <int P>
void add_components(const RegionLanes<P>& place, std::span<const BatchRegion> regions,
                    std::size_t components, const double* base, double* product, double* mass) {
  constexpr auto size = static_cast<std::size_t>(RegionLanes<P>::size);
  std::array<RegionNumbers<P>, lanes> numbers;
  for (std::size_t l = 0; l < regions.size(); ++l) numbers[l].take(place, l);
  for (std::size_t c = 0; c < components; c += part_size) {
    const std::size_t count = std::min(part_size, components - c);
    const LanesPart off = load_as<LanesPart>(base + c);
    LanesPart total[size] = {};
    for (std::size_t l = 0; l < regions.size(); ++l) {
      double* const own_mass = mass + l * components + c;
      if (regions[l].donor == nullptr || regions[l].far) {
        std::fill_n(own_mass, count, 0.0);
        continue;
      }
      LanesPart sums[size];
      store_part(numbers[l].integrate(regions[l].donor + c, components, off, sums), own_mass,
                 count);
#pragma GCC unroll 10
      for (std::size_t n = 0; n < size; ++n) total[n] += sums[n];
    }
#pragma GCC unroll 10
    for (std::size_t n = 0; n < size; ++n) {
      double* const to = product + n * components + c;
      store_part(load_as<LanesPart>(to) + total[n], to, count);
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
  const auto nc = static_cast<std::size_t>(system.components);
  double largest = 0.0;
  for (std::size_t c = 0; c < nc; c += lanes) {
    const std::size_t count = std::min(lanes, nc - c);
    Lanes product[size], values[size];
#pragma GCC unroll 10
    for (std::size_t n = 0; n < size; ++n) product[n] = load(system.product + n * nc + c);
    const Lanes defect =
        solve_lanes<P>(product, system.basis, load(system.mass + c), load(system.base + c),
                       system.area, system.covered, matrix, values);
#pragma GCC unroll 10
    for (std::size_t n = 0; n < size; ++n) store_part(values[n], coefficients + n * nc + c, count);
    alignas(64) double defects[lanes];
    store(defect, defects);
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

HWY_EXPORT(apply_matrix_target);
HWY_EXPORT(solve_straight_target);
HWY_EXPORT(add_batch_target);

void add_batch(int degree, const TargetPlace& place, const PieceBatch& batch,
               std::span<BatchRegion> regions, int components, const double* base, double* product,
               double* basis, double* mass) {
  HWY_DYNAMIC_DISPATCH(add_batch_target)
  (degree, place, batch, regions, static_cast<std::size_t>(components), base, product, basis, mass);
}

const double* projection_rows(int degree) {
  return projection_matrix(degree).rows.data();
}

double solve_straight(const StraightSystem& system, double* coefficients) {
  return HWY_DYNAMIC_DISPATCH(solve_straight_target)(system, projection_rows(system.degree),
                                                     coefficients);
}

void powers_from_moments(int degree, int components, const double* moments, double* powers) {
  const PaddedMatrix& matrix = padded_power_matrix(degree);
  HWY_DYNAMIC_DISPATCH(apply_matrix_target)
  (matrix.size, matrix.padded, matrix.rows.data(), static_cast<std::size_t>(components), moments,
   powers);
}

}  // namespace bezel::detail
#endif
