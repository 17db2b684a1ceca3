// Compensated evaluation at many points: SIMD lanes are points, each lane runs the scalar
// recurrence with the same operations in the same order, so every target gives the bits of the
// scalar kernel.
//
// Several vectors are worked on in turn within one update of the triangular scheme: the last rows
// of the scheme are short chains of dependent operations, and one vector alone would wait for them.

#include "bezel/bernstein/compensated_batch.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "bezel/bernstein/index.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/bernstein/compensated_batch.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
//
#include "bezel/numeric/eft_simd.hpp"

HWY_BEFORE_NAMESPACE();
namespace bezel::bernstein::HWY_NAMESPACE {

using namespace bezel::HWY_NAMESPACE;  // NOLINT: the vector operations of this target

constexpr std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// l = left-to-right sum of l and e[I..N-1], the errors in e[I-1..N-2].
template <int N, int I = 1>
HWY_INLINE V sum_with_errors(V l, V* e) {
  if constexpr (I < N) {
    V error;
    l = two_sum(l, e[I], error);
    e[I - 1] = error;
    return sum_with_errors<N, I + 1>(l, e);
  } else {
    return l;
  }
}

template <int N, int I = 1>
HWY_INLINE V plain_sum(V l, const V* e) {
  if constexpr (I < N) {
    return plain_sum<N, I + 1>(add(l, e[I]), e);
  } else {
    return l;
  }
}

HWY_INLINE V add_product_with_errors(V l, V factor, V b, V* e) {
  const V p = two_prod(factor, b, e[0]);
  return two_sum(l, p, e[1]);
}

/// 1 - s = r + rho.
struct Parameter {
  V r, rho, s;
};

/// Levels F..K-1 of one update, from the N local errors in e; b is the level below before its
/// update. `low` is overwritten.
template <int F, int K, int N>
HWY_INLINE void update_levels(V* e, V b, V* low, const V* high, const Parameter& x) {
  if constexpr (F == K - 1) {
    const V l = add(plain_sum<N>(e[0], e), mul(x.rho, b));
    low[F] = add(add(l, mul(x.s, high[F])), mul(x.r, low[F]));
  } else {
    V l = sum_with_errors<N>(e[0], e);
    l = add_product_with_errors(l, x.rho, b, e + (N - 1));
    l = add_product_with_errors(l, x.s, high[F], e + (N + 1));
    const V before = low[F];
    low[F] = add_product_with_errors(l, x.r, before, e + (N + 3));
    update_levels<F + 1, K, N + 5>(e, before, low, high, x);
  }
}

/// The same where the levels 1..K-1 of low and high are still 0: products with them vanish.
template <int F, int K, int N>
HWY_INLINE void first_levels(V* e, V b, V* low, const Parameter& x) {
  if constexpr (F == K - 1) {
    const V l = plain_sum<N>(e[0], e);
    low[F] = F == 1 ? add(l, mul(x.rho, b)) : l;
  } else if constexpr (F == 1) {
    V l = sum_with_errors<N>(e[0], e);
    low[F] = add_product_with_errors(l, x.rho, b, e + (N - 1));
    first_levels<F + 1, K, N + 1>(e, b, low, x);
  } else {
    low[F] = sum_with_errors<N>(e[0], e);
    first_levels<F + 1, K, N - 1>(e, b, low, x);
  }
}

template <int K>
HWY_INLINE V base_level(V low, V high, V* e, const Parameter& x) {
  const V p = two_prod(x.r, low, e[0]);
  const V q = two_prod(x.s, high, e[1]);
  return two_sum(p, q, e[2]);
}

constexpr int error_room(int K) {
  return K < 3 ? 3 : 5 * K - 7;  // the most local errors alive at once
}

/// Levels of G vectors of points: result[F * G + g]. `work` has room for d K G vectors.
template <int K, int G>
HWY_INLINE void sweep(int d, const double* HWY_RESTRICT b, const V* s, double* HWY_RESTRICT work,
                      V* result) {
  const std::size_t lanes = lane_count();
  Parameter x[G];
  for (int g = 0; g < G; ++g) {
    x[g].s = s[g];
    V rho;
    x[g].r = two_sum(set(1.0), neg(s[g]), rho);
    x[g].rho = rho;
  }
  if (d == 0) {
    for (int g = 0; g < G; ++g) {
      result[g] = set(b[0]);
      for (int f = 1; f < K; ++f) result[f * G + g] = set(0.0);
    }
    return;
  }
  const auto place = [&](int j, int f, int g) { return work + at((j * K + f) * G + g) * lanes; };
  for (int j = 0; j < d; ++j) {
    const V low_b = set(b[j]), high_b = set(b[j + 1]);
    for (int g = 0; g < G; ++g) {
      V e[error_room(K)], low[K];
      low[0] = base_level<K>(low_b, high_b, e, x[g]);
      first_levels<1, K, 3>(e, low_b, low, x[g]);
      for (int f = 0; f < K; ++f) store(low[f], place(j, f, g));
    }
  }
  for (int m = d - 1; m > 0; --m)
    for (int j = 0; j < m; ++j)
      for (int g = 0; g < G; ++g) {
        V e[error_room(K)], low[K], high[K];
        for (int f = 0; f < K; ++f) {
          low[f] = load(place(j, f, g));
          high[f] = load(place(j + 1, f, g));
        }
        const V before = low[0];
        low[0] = base_level<K>(before, high[0], e, x[g]);
        update_levels<1, K, 3>(e, before, low, high, x[g]);
        for (int f = 0; f < K; ++f) store(low[f], place(j, f, g));
      }
  for (int g = 0; g < G; ++g)
    for (int f = 0; f < K; ++f) result[f * G + g] = load(place(0, f, g));
}

/// sum_k of K levels at stride G.
template <int K, int G>
HWY_INLINE V sum_levels(const V* level) {
  // K = 2: the pass gives the rounded sum and its error, whose sum rounds to the former again.
  if constexpr (K == 2) return add(level[0], level[G]);
  V p[K];
  for (int f = 0; f < K; ++f) p[f] = level[f * G];
  for (int pass = 1; pass < K; ++pass)
    for (int f = 1; f < K; ++f) {
      V error;
      p[f] = two_sum(p[f], p[f - 1], error);
      p[f - 1] = error;
    }
  return plain_sum<K>(p[0], p);
}

/// One point: the lanes are the coefficients of a row, which do not depend on each other. `level`
/// gets the K levels in its first lanes. Lanes beyond a row hold garbage that no other lane reads.
template <int K>
HWY_INLINE void sweep_rows(int d, const double* HWY_RESTRICT b, double s, V* level) {
  constexpr std::size_t room = max_interval_degree + 1 + 2 * max_lane_count;
  const std::size_t lanes = lane_count();
  Parameter x;
  x.s = set(s);
  V rho;
  x.r = two_sum(set(1.0), neg(x.s), rho);
  x.rho = rho;
  HWY_ALIGN double c[room], w[at(K) * room];
  const auto n = at(d);
  std::copy(b, b + n + 1, c);
  std::fill(c + n + 1, c + n + 1 + lanes, 0.0);
  const auto row = [&](int f) { return w + at(f) * room; };
  for (std::size_t j = 0; j < n; j += lanes) {
    V e[error_room(K)];
    const V low = load_unaligned(c + j);
    level[0] = base_level<K>(low, load_unaligned(c + j + 1), e, x);
    first_levels<1, K, 3>(e, low, level, x);
    if (n > lanes)
      for (int f = 0; f < K; ++f) {
        store_unaligned(level[f], row(f) + j);
        row(f)[j + lanes] = 0.0;  // read as the last lane's neighbour
      }
  }
  std::size_t m = n - 1;
  V high[K];
  const auto update = [&] {
    V e[error_room(K)];
    const V before = level[0];
    level[0] = base_level<K>(before, high[0], e, x);
    update_levels<1, K, 3>(e, before, level, high, x);
  };
  for (; m + 1 > lanes; --m)
    for (std::size_t j = 0; j < m; j += lanes) {
      for (int f = 0; f < K; ++f) {
        level[f] = load_unaligned(row(f) + j);
        high[f] = load_unaligned(row(f) + j + 1);
      }
      update();
      for (int f = 0; f < K; ++f) store_unaligned(level[f], row(f) + j);
    }
  if (n > lanes)
    for (int f = 0; f < K; ++f) level[f] = load_unaligned(row(f));
  for (; m > 0; --m) {
    for (int f = 0; f < K; ++f) high[f] = shift_down(level[f]);
    update();
  }
}

constexpr int group = 4;  // vectors in turn

template <int K>
void run_fold(int d, const double* HWY_RESTRICT b, const double* HWY_RESTRICT s, std::size_t count,
              double* HWY_RESTRICT out, double* HWY_RESTRICT levels) {
  const std::size_t lanes = lane_count();
  HWY_ALIGN double work[at(max_interval_degree * K * group) * max_lane_count];
  std::size_t q = 0;
  for (; q + group * lanes <= count; q += group * lanes) {
    V parameter[group], result[K * group];
    for (std::size_t g = 0; g < group; ++g) parameter[g] = load_unaligned(s + q + g * lanes);
    sweep<K, group>(d, b, parameter, work, result);
    for (std::size_t g = 0; g < group; ++g) {
      if (out != nullptr) store_unaligned(sum_levels<K, group>(result + g), out + q + g * lanes);
      if (levels != nullptr)
        for (std::size_t f = 0; f < K; ++f)
          store_unaligned(result[f * group + g], levels + f * count + q + g * lanes);
    }
  }
  for (; q < count; q += lanes) {
    const std::size_t here = std::min(lanes, count - q);
    HWY_ALIGN double few[max_lane_count];
    for (std::size_t i = 0; i < lanes; ++i) few[i] = s[q + std::min(i, here - 1)];
    V result[K];
    if (here == 1 && lanes > 1 && d > 1) {
      sweep_rows<K>(d, b, s[q], result);
    } else {
      const V parameter = load(few);
      sweep<K, 1>(d, b, &parameter, work, result);
    }
    if (out != nullptr) {
      store(sum_levels<K, 1>(result), few);
      std::copy(few, few + here, out + q);
    }
    if (levels != nullptr)
      for (std::size_t f = 0; f < K; ++f) {
        store(result[f], few);
        std::copy(few, few + here, levels + f * count + q);
      }
  }
}

bool run(int d, const double* b, const double* s, std::size_t count, int K, double* out,
         double* levels) {
  switch (K) {
    case 2:
      run_fold<2>(d, b, s, count, out, levels);
      return true;
    case 3:
      run_fold<3>(d, b, s, count, out, levels);
      return true;
    case 4:
      run_fold<4>(d, b, s, count, out, levels);
      return true;
    default:
      return false;
  }
}

}  // namespace bezel::bernstein::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::bernstein {

HWY_EXPORT(run);

bool compensated_points(int d, const double* b, const double* s, std::size_t count, int K,
                        double* out) {
  return HWY_DYNAMIC_DISPATCH(run)(d, b, s, count, K, out, nullptr);
}

bool compensated_point_levels(int d, const double* b, const double* s, std::size_t count, int K,
                              double* levels) {
  return HWY_DYNAMIC_DISPATCH(run)(d, b, s, count, K, nullptr, levels);
}

}  // namespace bezel::bernstein
#endif  // HWY_ONCE
