// Internal: included once per SIMD target, inside a file of several targets. What is done with one
// region, or with one in each lane.

#if defined(BEZEL_TRANSFER_REGION_KERNELS_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BEZEL_TRANSFER_REGION_KERNELS_HPP
#undef BEZEL_TRANSFER_REGION_KERNELS_HPP
#else
#define BEZEL_TRANSFER_REGION_KERNELS_HPP
#endif

#include "bezel/bernstein/index.hpp"
#include "bezel/transfer/piece_batch.hpp"
#include "bezel/transfer/polynomial_moves.hpp"
#include "bezel/transfer/vector_lanes.hpp"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

/// About the target's centre a donor's polynomial may grow by this factor beyond its size on the
/// donor: so many roundings are lost.
constexpr double steepest = 32.0;

/// x := max(x, |y|)
HWY_INLINE void raise(Lanes& x, const Lanes& y) {
  x = select(x < y, y, x);
  x = select(x < -y, -y, x);
}

/// Coordinates of the regions' target elements and their inverses.
struct TargetLanes {
  Lanes centre_x, centre_y, along_first_x, along_first_y, along_second_x, along_second_y;
};

/// Where regions lie in their donors' coordinates, one in each lane, and their moments.
template <int P>
struct RegionLanes {
  static constexpr int size = bernstein::triangle_size(P), twice = bernstein::triangle_size(2 * P);
  Lanes moments[padded_to_lanes(static_cast<std::size_t>(twice))];
  Lanes m[4], s, t;
};

/// The donors' coordinates are s, t and m times the targets'.
/// @param frame  the donors' frames, one after the other; taken apart here
/// @return how much the polynomials may grow
template <int P>
HWY_INLINE Lanes place_donors(const TargetLanes& target, Lanes* frame, Lanes* m, Lanes& s,
                              Lanes& t) {
  static_assert(sizeof(Frame) == sizeof(Lanes));
  // Centre x, y, then the gradients of the three barycentrics.
  transpose(frame);
  const Lanes apart_x = target.centre_x - frame[0], apart_y = target.centre_y - frame[1];
  m[0] = frame[4] * target.along_first_x + frame[5] * target.along_first_y;
  m[1] = frame[4] * target.along_second_x + frame[5] * target.along_second_y;
  m[2] = frame[6] * target.along_first_x + frame[7] * target.along_first_y;
  m[3] = frame[6] * target.along_second_x + frame[7] * target.along_second_y;
  s = frame[4] * apart_x + frame[5] * apart_y;
  t = frame[6] * apart_x + frame[7] * apart_y;
  Lanes slope{}, reach{};
  for (int i = 0; i < 4; ++i) raise(slope, m[i]);
  raise(reach, s);
  raise(reach, t);
  const Lanes steep = slope + reach;
  Lanes power = Lanes{} + 1.0;
  for (int e = 0; e < P; ++e) power *= steep;
  return power;
}

/// sums[n] = integral of f m_n from the moments, both polynomials in the target's coordinates.
template <int P, class S, class V>
HWY_INLINE void multiply(const S* moments, const V* f, V* sums) {
#pragma GCC unroll 4
  for (int b = 0; b <= P; ++b) {
#pragma GCC unroll 4
    for (int a = 0; a <= P - b; ++a) {
      V sum{};
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

/// One of the regions.
template <int P>
struct RegionNumbers {
  static constexpr int size = bernstein::triangle_size(P), twice = bernstein::triangle_size(2 * P);
  double moments[twice];
  double m[4], s, t;
  Substitution<P, double> substitution;

  HWY_INLINE void take(const RegionLanes<P>& place, std::size_t l) {
    const auto lane = [&](const Lanes& x) { return x[l]; };
    for (int n = 0; n < twice; ++n) moments[n] = lane(place.moments[n]);
    for (int i = 0; i < 4; ++i) m[i] = lane(place.m[i]);
    s = lane(place.s);
    t = lane(place.t);
    if constexpr (P > 0) substitution.set(m);
  }

  /// Some components of the donor's polynomial, [n][component], less `off`, as many as V holds:
  /// integrals with the target's monomials; those of the whole polynomial are returned.
  template <class V>
  HWY_INLINE V integrate(const double* donor, std::size_t components, const V& off, V* sums) const {
    V f[size];
#pragma GCC unroll 10
    for (int n = 0; n < size; ++n)
      f[n] = load_as<V>(donor + static_cast<std::size_t>(n) * components);
    f[0] -= off;
    if constexpr (P > 0) {
      move_polynomial<P>(f, s, t);
      substitution.apply(f);
    }
    multiply<P>(moments, f, sums);
    return sums[0] + off * moments[0];
  }
};

/// The L2 projection on a straight triangle in each lane, or of eight components on one. Around the
/// element's mean: what remains is small, so a constant comes back constant whatever the rounding
/// of the matrix.
/// @param product, values  [n]; the other parameters as in StraightSystem
/// @return mass received less the result's
template <int P, class S>
HWY_INLINE Lanes solve_lanes(const Lanes* product, const S* basis, const Lanes& mass,
                             const Lanes& base, const S& area, const S& covered,
                             const double* matrix, Lanes* values) {
  constexpr auto size = static_cast<std::size_t>(bernstein::triangle_size(P));
  constexpr std::size_t padded = padded_to_lanes(size);
  const S scale = 0.5 / area, per_function = area / static_cast<double>(size);
  const Lanes mean = mass / covered;
  const Lanes rest = mean - base;
  Lanes right[size], x[padded] = {};
#pragma GCC unroll 10
  for (std::size_t m = 0; m < size; ++m) right[m] = (product[m] - rest * basis[m]) * scale;
  constexpr std::size_t rows = rows_at_once<size>;
#pragma GCC unroll 2
  for (std::size_t row = 0; row < size; row += rows) {
    Lanes own[rows] = {};
    for (std::size_t m = 0; m < size; ++m) {
#pragma GCC unroll 10
      for (std::size_t n = 0; n < rows; ++n)
        own[n] = mul_add(matrix[m * padded + row + n], right[m], own[n]);
    }
#pragma GCC unroll 10
    for (std::size_t n = 0; n < rows; ++n) x[row + n] = own[n];
  }
  // In the order of sum_of().
  const auto in_order = [](const Lanes* r) {
    return ((r[0] + r[4]) + (r[2] + r[6])) + ((r[1] + r[5]) + (r[3] + r[7]));
  };
  Lanes sum = in_order(x);
  if constexpr (padded > lanes) sum += in_order(x + lanes);
  const Lanes got = sum * per_function + mean * area;
  const Lanes shift = mean + (mass - got) / area;
  sum = Lanes{};
#pragma GCC unroll 10
  for (std::size_t n = 0; n < size; ++n) {
    values[n] = x[n] + shift;
    sum += values[n];
  }
  return mass - sum * per_function;
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
