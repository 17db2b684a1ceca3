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

#include "bezel/numeric/lanes.hpp"
#include "hwy/highway.h"

// load() is always inlined: how a vector is returned does not matter.
#pragma GCC diagnostic ignored "-Wpsabi"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

// Eight numbers side by side, as one of the compiler's vectors (g++ and clang) where registers are
// that wide. Only mul_add() is fused, so every target that can fuse gives the same bits.
#if HWY_TARGET <= HWY_AVX3

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

// Elsewhere as several of them: g++ takes vectors wider than the registers apart by way of memory,
// which is five times as slow.
#if HWY_TARGET <= HWY_AVX2
constexpr std::size_t part_size = lanes / 2;
#else
constexpr std::size_t part_size = lanes / 4;
#endif
constexpr std::size_t part_count = lanes / part_size;

struct Lanes {
  using Part [[gnu::vector_size(sizeof(double) * part_size)]] = double;
  using Truth = decltype(Part{} < Part{});
  struct Mask {
    Truth part[part_count];
    HWY_INLINE std::int64_t operator[](std::size_t l) const {
      return part[l / part_size][l % part_size];
    }
    friend HWY_INLINE Mask operator&(const Mask& a, const Mask& b) {
      return each<Mask>([&](std::size_t i) -> Truth { return a.part[i] & b.part[i]; });
    }
  };
  Part part[part_count];

  template <class Result, class Make>
  HWY_INLINE static Result each(const Make& make) {
    Result r;
#pragma GCC unroll 4
    for (std::size_t i = 0; i < part_count; ++i) r.part[i] = make(i);
    return r;
  }
  HWY_INLINE static Lanes all(double x) {
    return each<Lanes>([&](std::size_t) -> Part { return x - Part{}; });
  }
  HWY_INLINE double operator[](std::size_t l) const {
    return part[l / part_size][l % part_size];
  }
  HWY_INLINE Lanes operator-() const {
    return each<Lanes>([&](std::size_t i) -> Part { return -part[i]; });
  }
  friend HWY_INLINE Lanes operator+(const Lanes& a, const Lanes& b) {
    return each<Lanes>([&](std::size_t i) -> Part { return a.part[i] + b.part[i]; });
  }
  friend HWY_INLINE Lanes operator-(const Lanes& a, const Lanes& b) {
    return each<Lanes>([&](std::size_t i) -> Part { return a.part[i] - b.part[i]; });
  }
  friend HWY_INLINE Lanes operator*(const Lanes& a, const Lanes& b) {
    return each<Lanes>([&](std::size_t i) -> Part { return a.part[i] * b.part[i]; });
  }
  friend HWY_INLINE Lanes operator/(const Lanes& a, const Lanes& b) {
    return each<Lanes>([&](std::size_t i) -> Part { return a.part[i] / b.part[i]; });
  }
  friend HWY_INLINE Lanes operator+(const Lanes& a, double b) {
    return a + all(b);
  }
  friend HWY_INLINE Lanes operator-(const Lanes& a, double b) {
    return a - all(b);
  }
  friend HWY_INLINE Lanes operator*(const Lanes& a, double b) {
    return a * all(b);
  }
  friend HWY_INLINE Lanes operator/(const Lanes& a, double b) {
    return a / all(b);
  }
  friend HWY_INLINE Lanes operator+(double a, const Lanes& b) {
    return all(a) + b;
  }
  friend HWY_INLINE Lanes operator-(double a, const Lanes& b) {
    return all(a) - b;
  }
  friend HWY_INLINE Lanes operator*(double a, const Lanes& b) {
    return all(a) * b;
  }
  friend HWY_INLINE Lanes operator/(double a, const Lanes& b) {
    return all(a) / b;
  }
  HWY_INLINE Lanes& operator+=(const Lanes& b) {
    return *this = *this + b;
  }
  HWY_INLINE Lanes& operator*=(const Lanes& b) {
    return *this = *this * b;
  }
  HWY_INLINE Lanes& operator-=(const Lanes& b) {
    return *this = *this - b;
  }
  HWY_INLINE Lanes& operator-=(double b) {
    return *this = *this - b;
  }
  HWY_INLINE Lanes& operator*=(double b) {
    return *this = *this * b;
  }
  friend HWY_INLINE Mask operator<(const Lanes& a, const Lanes& b) {
    return each<Mask>([&](std::size_t i) -> Truth { return a.part[i] < b.part[i]; });
  }
  friend HWY_INLINE Mask operator<=(const Lanes& a, double b) {
    return each<Mask>([&](std::size_t i) -> Truth { return a.part[i] <= Part{} + b; });
  }
  friend HWY_INLINE Mask operator<=(const Lanes& a, const Lanes& b) {
    return each<Mask>([&](std::size_t i) -> Truth { return a.part[i] <= b.part[i]; });
  }
  friend HWY_INLINE Mask operator>=(const Lanes& a, double b) {
    return each<Mask>([&](std::size_t i) -> Truth { return a.part[i] >= Part{} + b; });
  }
  friend HWY_INLINE Mask operator>(const Lanes& a, double b) {
    return each<Mask>([&](std::size_t i) -> Truth { return a.part[i] > Part{} + b; });
  }
  friend HWY_INLINE Mask operator==(const Lanes& a, const Lanes& b) {
    return each<Mask>([&](std::size_t i) -> Truth { return a.part[i] == b.part[i]; });
  }
};

HWY_INLINE Lanes select(const Lanes::Mask& mask, const Lanes& yes, const Lanes& no) {
  return Lanes::each<Lanes>(
      [&](std::size_t i) -> Lanes::Part { return mask.part[i] ? yes.part[i] : no.part[i]; });
}

#endif

// What fits a register.
#if HWY_TARGET <= HWY_AVX3
using LanesPart = Lanes;
#else
using LanesPart = Lanes::Part;
#endif

HWY_INLINE Lanes load(const double* p) {
  Lanes x;
  std::memcpy(&x, p, sizeof x);
  return x;
}
HWY_INLINE void store(const Lanes& x, double* p) {
  std::memcpy(p, &x, sizeof x);
}
#if !(HWY_TARGET <= HWY_AVX3)
HWY_INLINE Lanes lanes_of(double a, double b, double c, double d, double e, double f, double g,
                          double h) {
  const double all[lanes] = {a, b, c, d, e, f, g, h};
  return load(all);
}
#endif
/// The first `count` numbers, at most eight.
HWY_INLINE void store_part(const Lanes& x, double* p, std::size_t count) {
  if (count >= lanes) return store(x, p);
  for (std::size_t l = 0; l < count; ++l) p[l] = x[l];
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
  double all[lanes];
  for (std::size_t l = 0; l < lanes; ++l) all[l] = table[at[l]];
  return load(all);
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
HWY_INLINE Lanes mul_add(const Lanes& a, const Lanes& b, const Lanes& c) {
#if HWY_NATIVE_FMA
  namespace hn = hwy::HWY_NAMESPACE;
  using Part = LanesPart;
  const hn::CappedTag<double, sizeof(Part) / sizeof(double)> d;
  const auto* x = reinterpret_cast<const double*>(&a);
  const auto* y = reinterpret_cast<const double*>(&b);
  const auto* z = reinterpret_cast<const double*>(&c);
  Lanes r;
  auto* to = reinterpret_cast<double*>(&r);
#pragma GCC unroll 4
  for (std::size_t i = 0; i < lanes; i += sizeof(Part) / sizeof(double))
    hn::StoreU(hn::MulAdd(hn::LoadU(d, x + i), hn::LoadU(d, y + i), hn::LoadU(d, z + i)), d,
               to + i);
  return r;
#else
  return a * b + c;
#endif
}
HWY_INLINE Lanes mul_add(double a, const Lanes& b, const Lanes& c) {
#if HWY_TARGET <= HWY_AVX3
  return mul_add(Lanes{a, a, a, a, a, a, a, a}, b, c);
#else
  return mul_add(Lanes::all(a), b, c);
#endif
}

HWY_INLINE Lanes root(const Lanes& x) {
  Lanes r;
#if HWY_TARGET == HWY_SCALAR
  double all[lanes];
  store(x, all);
  for (double& a : all) a = std::sqrt(a);
  r = load(all);
#else
  namespace hn = hwy::HWY_NAMESPACE;
  using Part = LanesPart;
  const hn::CappedTag<double, sizeof(Part) / sizeof(double)> d;
  const auto* from = reinterpret_cast<const double*>(&x);
  auto* to = reinterpret_cast<double*>(&r);
#pragma GCC unroll 4
  for (std::size_t i = 0; i < lanes; i += sizeof(Part) / sizeof(double))
    hn::StoreU(hn::Sqrt(hn::LoadU(d, from + i)), d, to + i);
#endif
  return r;
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
