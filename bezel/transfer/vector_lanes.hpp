// Internal: included once per SIMD target, inside a file of several targets.

#if defined(BEZEL_TRANSFER_VECTOR_LANES_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef BEZEL_TRANSFER_VECTOR_LANES_HPP
#undef BEZEL_TRANSFER_VECTOR_LANES_HPP
#else
#define BEZEL_TRANSFER_VECTOR_LANES_HPP
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "bezel/numeric/lanes.hpp"
#include "hwy/highway.h"

// load() is always inlined: how a vector is returned does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

// Eight numbers side by side, as one of the compiler's vectors (g++ and clang) where registers are
// that wide. Only mul_add() is fused, so every target that can fuse gives the same bits.
#if HWY_TARGET <= HWY_AVX3

constexpr std::size_t part_size = lanes;
using Lanes [[gnu::vector_size(sizeof(double) * lanes)]] = double;

HWY_INLINE Lanes lanes_of(double a, double b, double c, double d, double e, double f, double g,
                          double h) {
  return Lanes{a, b, c, d, e, f, g, h};
}
template <class Mask>
HWY_INLINE Lanes select(const Mask& mask, const Lanes& yes, const Lanes& no) {
  return mask ? yes : no;
}

#else

// Elsewhere as halves, and halves of halves, that fit registers: g++ takes wider vectors apart by
// way of memory, and arrays of registers too, which is five times as slow.
#if HWY_TARGET <= HWY_AVX2
constexpr std::size_t part_size = lanes / 2;
#else
constexpr std::size_t part_size = lanes / 4;
#endif
using LanesPart [[gnu::vector_size(sizeof(double) * part_size)]] = double;

template <class Truth>
HWY_INLINE LanesPart select(const Truth& mask, const LanesPart& yes, const LanesPart& no) {
  return mask ? yes : no;
}

template <class Half>
struct Two {
  Half low, high;

  HWY_INLINE double operator[](std::size_t l) const {
    return reinterpret_cast<const double*>(this)[l];
  }
  HWY_INLINE Two operator-() const { return {-low, -high}; }
  HWY_INLINE Two& operator+=(const Two& b) { return *this = *this + b; }
  HWY_INLINE Two& operator-=(const Two& b) { return *this = *this - b; }
  HWY_INLINE Two& operator*=(const Two& b) { return *this = *this * b; }
  HWY_INLINE Two& operator-=(double b) { return *this = *this - b; }
  HWY_INLINE Two& operator*=(double b) { return *this = *this * b; }
  friend HWY_INLINE Two operator+(const Two& a, const Two& b) {
    return {a.low + b.low, a.high + b.high};
  }
  friend HWY_INLINE Two operator-(const Two& a, const Two& b) {
    return {a.low - b.low, a.high - b.high};
  }
  friend HWY_INLINE Two operator*(const Two& a, const Two& b) {
    return {a.low * b.low, a.high * b.high};
  }
  friend HWY_INLINE Two operator/(const Two& a, const Two& b) {
    return {a.low / b.low, a.high / b.high};
  }
  friend HWY_INLINE Two operator+(const Two& a, double b) { return {a.low + b, a.high + b}; }
  friend HWY_INLINE Two operator-(const Two& a, double b) { return {a.low - b, a.high - b}; }
  friend HWY_INLINE Two operator*(const Two& a, double b) { return {a.low * b, a.high * b}; }
  friend HWY_INLINE Two operator/(const Two& a, double b) { return {a.low / b, a.high / b}; }
  friend HWY_INLINE Two operator+(double a, const Two& b) { return {a + b.low, a + b.high}; }
  friend HWY_INLINE Two operator-(double a, const Two& b) { return {a - b.low, a - b.high}; }
  friend HWY_INLINE Two operator*(double a, const Two& b) { return {a * b.low, a * b.high}; }
  friend HWY_INLINE Two operator/(double a, const Two& b) { return {a / b.low, a / b.high}; }
};

/// What comparisons of halves give, side by side.
template <class Half>
struct TwoTruths {
  Half low, high;
  HWY_INLINE std::int64_t operator[](std::size_t l) const {
    return reinterpret_cast<const std::int64_t*>(this)[l];
  }
  friend HWY_INLINE TwoTruths operator&(const TwoTruths& a, const TwoTruths& b) {
    return {a.low & b.low, a.high & b.high};
  }
};
template <class Half>
TwoTruths(Half, Half) -> TwoTruths<Half>;

template <class Half>
HWY_INLINE auto operator<(const Two<Half>& a, const Two<Half>& b) {
  return TwoTruths{a.low < b.low, a.high < b.high};
}
template <class Half>
HWY_INLINE auto operator<=(const Two<Half>& a, const Two<Half>& b) {
  return TwoTruths{a.low <= b.low, a.high <= b.high};
}
template <class Half>
HWY_INLINE auto operator==(const Two<Half>& a, const Two<Half>& b) {
  return TwoTruths{a.low == b.low, a.high == b.high};
}
template <class Half>
HWY_INLINE auto operator<=(const Two<Half>& a, double b) {
  return TwoTruths{a.low <= b, a.high <= b};
}
template <class Half>
HWY_INLINE auto operator>=(const Two<Half>& a, double b) {
  return TwoTruths{a.low >= b, a.high >= b};
}
template <class Half>
HWY_INLINE auto operator>(const Two<Half>& a, double b) {
  return TwoTruths{a.low > b, a.high > b};
}
template <class Truth, class Half>
HWY_INLINE Two<Half> select(const TwoTruths<Truth>& mask, const Two<Half>& yes,
                            const Two<Half>& no) {
  return {select(mask.low, yes.low, no.low), select(mask.high, yes.high, no.high)};
}

#if HWY_TARGET <= HWY_AVX2
using Lanes = Two<LanesPart>;
#else
using Lanes = Two<Two<LanesPart> >;
#endif

#endif

// What fits a register, wherever it lies.
#if HWY_TARGET <= HWY_AVX3
using LanesPart = Lanes;
#endif
using LoosePart
    [[gnu::vector_size(sizeof(LanesPart)), gnu::aligned(alignof(double)), gnu::may_alias]] = double;

template <class Some>
HWY_INLINE Some load_as(const double* p) {
  if constexpr (std::is_same_v<Some, LanesPart>) {
    return *reinterpret_cast<const LoosePart*>(p);
  } else {
    using Half = decltype(Some::low);
    return {load_as<Half>(p), load_as<Half>(p + sizeof(Half) / sizeof(double))};
  }
}
template <class Some>
HWY_INLINE void store_as(const Some& x, double* p) {
  if constexpr (std::is_same_v<Some, LanesPart>) {
    *reinterpret_cast<LoosePart*>(p) = x;
  } else {
    store_as(x.low, p);
    store_as(x.high, p + sizeof(x.low) / sizeof(double));
  }
}
HWY_INLINE Lanes load(const double* p) {
  return load_as<Lanes>(p);
}
HWY_INLINE void store(const Lanes& x, double* p) {
  store_as(x, p);
}
#if !(HWY_TARGET <= HWY_AVX3)
HWY_INLINE Lanes lanes_of(double a, double b, double c, double d, double e, double f, double g,
                          double h) {
#if HWY_TARGET <= HWY_AVX2
  return {LanesPart{a, b, c, d}, LanesPart{e, f, g, h}};
#else
  return {{LanesPart{a, b}, LanesPart{c, d}}, {LanesPart{e, f}, LanesPart{g, h}}};
#endif
}
#endif
/// How many rows of a product of matrices are summed side by side: as many as registers hold, and
/// enough of them to hide how long a sum takes.
template <std::size_t rows>
constexpr std::size_t rows_at_once = HWY_TARGET <= HWY_AVX3 || rows < 10 ? rows : rows / 2;

/// The first `count` numbers, at most all.
template <class Some>
HWY_INLINE void store_part(const Some& x, double* p, std::size_t count) {
  constexpr std::size_t most = sizeof(Some) / sizeof(double);
  if (count >= most) return store_as(x, p);
  alignas(64) double all[most];
  store_as(x, all);
  for (std::size_t l = 0; l < count; ++l) p[l] = all[l];
}

/// The table's numbers at eight places.
HWY_INLINE Lanes pick(const double* table, const std::int64_t* at) {
#if HWY_TARGET <= HWY_AVX3
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<double, lanes> d;
  const hn::RebindToSigned<decltype(d)> di;
  Lanes r;
  hn::StoreU(hn::TableLookupLanes(hn::LoadU(d, table), hn::IndicesFromVec(d, hn::LoadU(di, at))), d,
             reinterpret_cast<double*>(&r));
  return r;
#else
  return lanes_of(table[at[0]], table[at[1]], table[at[2]], table[at[3]], table[at[4]],
                  table[at[5]], table[at[6]], table[at[7]]);
#endif
}

/// a b + c, rounded once where the target can.
HWY_INLINE double mul_add(double a, double b, double c) {
#if HWY_NATIVE_FMA
  return __builtin_fma(a, b, c);
#else
  return a * b + c;
#endif
}
template <class Some>
HWY_INLINE Some mul_add(const Some& a, const Some& b, const Some& c) {
#if HWY_NATIVE_FMA
  if constexpr (std::is_same_v<Some, LanesPart>) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<double, sizeof(LanesPart) / sizeof(double)> d;
    const auto* x = reinterpret_cast<const double*>(&a);
    const auto* y = reinterpret_cast<const double*>(&b);
    const auto* z = reinterpret_cast<const double*>(&c);
    LanesPart r;
    hn::StoreU(hn::MulAdd(hn::LoadU(d, x), hn::LoadU(d, y), hn::LoadU(d, z)), d,
               reinterpret_cast<double*>(&r));
    return r;
  } else {
    return {mul_add(a.low, b.low, c.low), mul_add(a.high, b.high, c.high)};
  }
#else
  return a * b + c;
#endif
}
template <class Some>
HWY_INLINE Some mul_add(double a, const Some& b, const Some& c) {
  return mul_add(a - Some{}, b, c);
}

template <class Some>
HWY_INLINE Some root(const Some& x) {
  if constexpr (std::is_same_v<Some, LanesPart>) {
    LanesPart r;
#if HWY_TARGET == HWY_SCALAR
    for (std::size_t l = 0; l < sizeof(r) / sizeof(double); ++l) r[l] = std::sqrt(x[l]);
#else
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::CappedTag<double, sizeof(LanesPart) / sizeof(double)> d;
    hn::StoreU(hn::Sqrt(hn::LoadU(d, reinterpret_cast<const double*>(&x))), d,
               reinterpret_cast<double*>(&r));
#endif
    return r;
  } else {
    return {root(x.low), root(x.high)};
  }
}

HWY_INLINE double sum_of(const Lanes& x) {
  alignas(64) double numbers[lanes];
  store(x, numbers);
  return sum_of_lanes(numbers);
}

/// Rows become columns.
HWY_INLINE void transpose(Lanes* r) {
#if HWY_TARGET <= HWY_AVX3
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
#elif HWY_TARGET <= HWY_AVX2
  const auto turn = [](const LanesPart& a, const LanesPart& b, const LanesPart& c,
                       const LanesPart& d, LanesPart* to) {
    const LanesPart ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6),
                    ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7),
                    cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6),
                    cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    to[0] = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
    to[1] = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
    to[2] = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
    to[3] = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
  };
  LanesPart block[4][4];
  turn(r[0].low, r[1].low, r[2].low, r[3].low, block[0]);
  turn(r[0].high, r[1].high, r[2].high, r[3].high, block[1]);
  turn(r[4].low, r[5].low, r[6].low, r[7].low, block[2]);
  turn(r[4].high, r[5].high, r[6].high, r[7].high, block[3]);
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    r[i] = {block[0][i], block[2][i]};
    r[i + 4] = {block[1][i], block[3][i]};
  }
#else
  double rows[lanes][lanes], columns[lanes][lanes];
  std::memcpy(rows, r, sizeof rows);
  for (std::size_t i = 0; i < lanes; ++i)
    for (std::size_t k = 0; k < lanes; ++k) columns[k][i] = rows[i][k];
  std::memcpy(r, columns, sizeof columns);
#endif
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
