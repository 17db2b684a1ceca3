#include "bezel/transfer/element_batch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "bezel/bernstein/index.hpp"

// Few targets, for the sake of those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/element_batch.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on
#include "bezel/transfer/region_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

/// A row of an element's sums: product, basis, mass, area.
template <int P>
struct RowOf {
  static constexpr auto size = static_cast<std::size_t>(bernstein::triangle_size(P));
  static constexpr std::size_t basis = size, mass = 2 * size, area = 2 * size + 1;
  static constexpr std::size_t width = padded_to_lanes(2 * size + 2);
};

/// Eight regions from number `first` on: where they lie and which are ordinary. Returns their
/// areas.
template <int P, bool curved>
HWY_INLINE Lanes place_block(const ElementBatch& batch, std::size_t first, RegionLanes<P>& out,
                             Lanes& worst, Lanes& gap_of_size, ElementSums& result) {
  constexpr auto moments = static_cast<std::size_t>(RegionLanes<P>::twice);
  constexpr std::size_t width = sums_width(moments, curved);
  const std::size_t last = batch.regions() - 1;
  Lanes sums[width];
#pragma GCC unroll 4
  for (std::size_t m = 0; m < width; m += lanes) {
#pragma GCC unroll 8
    for (std::size_t l = 0; l < lanes; ++l)
      sums[m + l] = load(batch.pieces.sums.data() + std::min(first + l, last) * width + m);
    transpose(sums + m);
  }
  Lanes frame[lanes];
  for (std::size_t l = 0; l < lanes; ++l)
    frame[l] = load(reinterpret_cast<const double*>(batch.frame[first + l]));
  const TargetPlaces& places = batch.places;
  const std::int64_t* const owner = batch.owner.data() + first;
  const TargetLanes target{
      pick(places.centre_x.data(), owner),       pick(places.centre_y.data(), owner),
      pick(places.along_first_x.data(), owner),  pick(places.along_first_y.data(), owner),
      pick(places.along_second_x.data(), owner), pick(places.along_second_y.data(), owner)};
  const Lanes power = place_donors<P>(target, frame, out.m, out.s, out.t);
  const Lanes unit = pick(places.area.data(), owner);
  Lanes area = sums[sums_area(moments, curved)];
  if constexpr (!curved) area *= unit;
#pragma GCC unroll 28
  for (int n = 0; n < out.twice; ++n) out.moments[n] = sums[n] * unit;

  // As closes() has it.
  const Lanes open_x = sums[sums_open(moments)], open_y = sums[sums_open(moments) + 1];
  const Lanes step_x = open_x * target.along_first_x + open_y * target.along_second_x,
              step_y = open_x * target.along_first_y + open_y * target.along_second_y;
  const Lanes gap = root(step_x * step_x + step_y * step_y);
  const Lanes size = pick(batch.size.data(), owner), own_area = pick(batch.area.data(), owner);
  const Lanes donor_size = load(batch.donor_size.data() + first),
              donor_area = load(batch.donor_area.data() + first);
  const auto ordinary = (power <= steepest) & (area >= 0.0) &
                        (gap * size <= 2.0 * largest_joint_gap * own_area) &
                        (gap * donor_size <= 2.0 * largest_joint_gap * donor_area);
  const Lanes none{};
  const Lanes mark = select(ordinary, none + 1.0, none);
  store(mark, result.ordinary.data() + first);
  worst = select(mark < worst, mark, worst);
  raise(gap_of_size, select(ordinary, gap / select(size < donor_size, size, donor_size), none));
  store(area, result.region_area.data() + first);
  return area;
}

/// Adds the regions' rows to those of their elements.
template <std::size_t width>
HWY_INLINE void add_rows(const ElementBatch& batch, std::size_t first, std::size_t count,
                         Lanes* rows, double* sums) {
#pragma GCC unroll 3
  for (std::size_t m = 0; m < width; m += lanes) {
    transpose(rows + m);
    for (std::size_t l = 0; l < count; ++l) {
      double* const to = sums + static_cast<std::size_t>(batch.owner[first + l]) * width + m;
      store(load(to) + rows[m + l], to);
    }
  }
}

/// Several components, side by side.
template <int P>
void add_components(const ElementBatch& batch, std::size_t first, std::size_t count,
                    const RegionLanes<P>& place, std::size_t components, const double* base,
                    ElementSums& result) {
  constexpr auto size = static_cast<std::size_t>(RegionLanes<P>::size);
  std::array<RegionNumbers<P>, lanes> numbers;
  for (std::size_t l = 0; l < count; ++l) numbers[l].take(place, l);
  for (std::size_t begin = 0; begin < count;) {
    const std::int64_t owner = batch.owner[first + begin];
    std::size_t end = begin + 1;
    while (end < count && batch.owner[first + end] == owner) ++end;
    const auto e = static_cast<std::size_t>(owner);
    double* const product = result.product.data() + e * result.product_stride;
    double* const mass = result.masses.data() + e * result.mass_stride;
    // As many components at once as registers hold.
    for (std::size_t c = 0; c < components; c += part_size) {
      const std::size_t some = std::min(part_size, components - c);
      const LanesPart off = load_as<LanesPart>(base + e * components + c);
      LanesPart total[size], total_mass = load_as<LanesPart>(mass + c);
#pragma GCC unroll 10
      for (std::size_t n = 0; n < size; ++n)
        total[n] = load_as<LanesPart>(product + n * components + c);
      for (std::size_t l = begin; l < end; ++l) {
        LanesPart sums[size];
        total_mass += numbers[l].integrate(batch.donor[first + l] + c, components, off, sums);
#pragma GCC unroll 10
        for (std::size_t n = 0; n < size; ++n) total[n] += sums[n];
      }
      store_part(total_mass, mass + c, some);
#pragma GCC unroll 10
      for (std::size_t n = 0; n < size; ++n)
        store_part(total[n], product + n * components + c, some);
    }
    begin = end;
  }
}

template <int P, bool curved>
void add_elements_of(const ElementBatch& batch, std::size_t components, const double* base,
                     ElementSums& result) {
  using Row = RowOf<P>;
  constexpr std::size_t size = Row::size, donor_rows = padded_to_lanes(size);
  result.width = Row::width;
  result.basis = Row::basis;
  result.mass = Row::mass;
  result.area = Row::area;
  result.rows.resize(std::max(result.rows.size(), lanes * Row::width));
  std::fill_n(result.rows.data(), batch.elements * Row::width, 0.0);
  Lanes worst = Lanes{} + 1.0, gap{};
  for (std::size_t first = 0; first < batch.regions(); first += lanes) {
    const std::size_t count = std::min(lanes, batch.regions() - first);
    RegionLanes<P> placed;
    Lanes rows[Row::width] = {};
    rows[Row::area] = place_block<P, curved>(batch, first, placed, worst, gap, result);
#pragma GCC unroll 4
    for (int b = 0; b <= P; ++b) {
#pragma GCC unroll 4
      for (int a = 0; a <= P - b; ++a)
        rows[Row::basis + static_cast<std::size_t>(at(P, a, b))] = placed.moments[at(2 * P, a, b)];
    }
    if (components == 1) {
      Lanes f[donor_rows];
#pragma GCC unroll 2
      for (std::size_t r = 0; r < donor_rows; r += lanes) {
        for (std::size_t l = 0; l < lanes; ++l) f[r + l] = load(batch.donor[first + l] + r);
        transpose(f + r);
      }
      const Lanes off = pick(base, batch.owner.data() + first);
      f[0] -= off;
      if constexpr (P > 0) {
        move_polynomial<P>(f, placed.s, placed.t);
        Substitution<P, Lanes>(placed.m).apply(f);
      }
      multiply<P>(placed.moments, f, rows);
      rows[Row::mass] = rows[0] + off * placed.moments[0];
    } else {
      add_components<P>(batch, first, count, placed, components, base, result);
    }
    add_rows<Row::width>(batch, first, count, rows, result.rows.data());
  }
  alignas(64) double all[lanes];
  store(worst, all);
  result.all_ordinary = *std::min_element(all, all + lanes) == 1.0;
  store(gap, all);
  result.max_joint_gap = *std::max_element(all, all + lanes);
}

template <int P>
void add_elements_degree(const ElementBatch& batch, std::size_t components, const double* base,
                         ElementSums& result) {
  if (batch.pieces.area_in_units) return add_elements_of<P, false>(batch, components, base, result);
  return add_elements_of<P, true>(batch, components, base, result);
}

void add_elements_target(int degree, const ElementBatch& batch, std::size_t components,
                         const double* base, ElementSums& result) {
  switch (degree) {
    case 0:
      return add_elements_degree<0>(batch, components, base, result);
    case 1:
      return add_elements_degree<1>(batch, components, base, result);
    case 2:
      return add_elements_degree<2>(batch, components, base, result);
    default:
      return add_elements_degree<3>(batch, components, base, result);
  }
}

template <int P>
void solve_elements_of(const ElementBatch& batch, const ElementSums& sums, const double* base,
                       const double* matrix, std::span<double* const> coefficients,
                       TargetPlaces::Row& defects) {
  using Row = RowOf<P>;
  constexpr std::size_t size = Row::size, padded = padded_to_lanes(size);
  Lanes rows[Row::width];
#pragma GCC unroll 3
  for (std::size_t m = 0; m < Row::width; m += lanes) {
    for (std::size_t l = 0; l < lanes; ++l)
      rows[m + l] = load(sums.row(std::min(l, batch.elements - 1)) + m);
    transpose(rows + m);
  }
  Lanes values[padded] = {};
  const Lanes area = load(batch.area.data()), off = load(base);
  const Lanes defect = solve_lanes<P>(rows, rows + Row::basis, rows[Row::mass], off, area,
                                      rows[Row::area], matrix, values);
  const Lanes none{};
  store(select(defect < none, -defect, defect), defects.data());
#pragma GCC unroll 2
  for (std::size_t m = 0; m < padded; m += lanes) {
    transpose(values + m);
    for (std::size_t l = 0; l < batch.elements; ++l)
      store_part(values[m + l], coefficients[l] + m, std::min(lanes, size - m));
  }
}

void solve_elements_target(int degree, const ElementBatch& batch, const ElementSums& sums,
                           const double* base, const double* matrix,
                           std::span<double* const> coefficients, TargetPlaces::Row& defects) {
  switch (degree) {
    case 0:
      return solve_elements_of<0>(batch, sums, base, matrix, coefficients, defects);
    case 1:
      return solve_elements_of<1>(batch, sums, base, matrix, coefficients, defects);
    case 2:
      return solve_elements_of<2>(batch, sums, base, matrix, coefficients, defects);
    default:
      return solve_elements_of<3>(batch, sums, base, matrix, coefficients, defects);
  }
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {

HWY_EXPORT(add_elements_target);
HWY_EXPORT(solve_elements_target);

void ElementBatch::resize(std::size_t regions) {
  const std::size_t needed = padded_to_lanes(regions);
  if (owner.size() >= needed) return;
  owner.resize(2 * needed);
  frame.resize(2 * needed);
  donor.resize(2 * needed);
  donor_area.resize(2 * needed);
  donor_size.resize(2 * needed);
}

void add_elements(int degree, const ElementBatch& batch, int components, const double* base,
                  ElementSums& sums) {
  const std::size_t needed = padded_to_lanes(batch.regions());
  const auto nc = static_cast<std::size_t>(components);
  if (sums.ordinary.size() < needed) {
    sums.ordinary.resize(2 * needed);
    sums.region_area.resize(2 * needed);
  }
  if (nc > 1) {
    sums.product_stride =
        static_cast<std::size_t>(bernstein::triangle_size(degree)) * nc + batch_padding;
    sums.mass_stride = nc + batch_padding;
    sums.product.assign(batch.elements * sums.product_stride, 0.0);
    sums.masses.assign(batch.elements * sums.mass_stride, 0.0);
  }
  HWY_DYNAMIC_DISPATCH(add_elements_target)(degree, batch, nc, base, sums);
}

TargetPlaces::Row solve_elements(int degree, const ElementBatch& batch, const ElementSums& sums,
                                 const double* base, std::span<double* const> coefficients) {
  TargetPlaces::Row defects;
  HWY_DYNAMIC_DISPATCH(solve_elements_target)
  (degree, batch, sums, base, projection_rows(degree), coefficients, defects);
  return defects;
}

}  // namespace bezel::detail
#endif
