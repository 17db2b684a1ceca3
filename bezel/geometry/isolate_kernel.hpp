#pragma once
// Two plane curves side by side, one in each lane: what both need is computed at once.

#include <cmath>
#include <cstddef>

#include "bezel/geometry/curve_kernel.hpp"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace bezel::geometry_kernel {

// Vectors of the compiler's (g++ and clang): two doubles in one register where there are such.
using Lanes [[gnu::vector_size(16)]] = double;
using LaneMask = decltype(Lanes{} < Lanes{});  // of integers: all bits or none

inline Lanes both(double x) {
  return Lanes{x, x};
}
/// The other curve's value in each lane.
inline Lanes swapped(Lanes x) {
  return __builtin_shufflevector(x, x, 1, 0);
}
inline Lanes first_in_both(Lanes x) {
  return __builtin_shufflevector(x, x, 0, 0);
}
/// The second lanes of a and b.
inline Lanes seconds(Lanes a, Lanes b) {
  return __builtin_shufflevector(a, b, 1, 3);
}
/// a's first lane, b's second.
inline Lanes joined(Lanes a, Lanes b) {
  return __builtin_shufflevector(a, b, 0, 3);
}
/// The second one where one is NaN.
inline Lanes smaller(Lanes x, Lanes y) {
  return x < y ? x : y;
}
inline Lanes larger(Lanes x, Lanes y) {
  return x > y ? x : y;
}
inline double larger(Lanes x) {
  return larger(x, swapped(x))[0];
}
/// x where m is set, else y.
inline Lanes where(LaneMask m, Lanes x, Lanes y) {
  return m ? x : y;
}
inline Lanes abs(Lanes x) {
  constexpr long long magnitude = 0x7fffffffffffffff;
  return reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(x) & LaneMask{magnitude, magnitude});
}
/// Bit i: lane i is set.
inline unsigned lane_bits(LaneMask m) {
#ifdef __SSE2__
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(m)));
#else
  return (m[0] != 0 ? 1U : 0U) | (m[1] != 0 ? 2U : 0U);
#endif
}
inline bool any(LaneMask m) {
  return lane_bits(m) != 0;
}
inline bool all(LaneMask m) {
  return lane_bits(m) == 3;
}

/// A point or vector of each curve.
struct PairVector {
  Lanes x, y;
};
inline PairVector operator-(PairVector p, PairVector q) {
  return {p.x - q.x, p.y - q.y};
}
inline PairVector operator+(PairVector p, PairVector q) {
  return {p.x + q.x, p.y + q.y};
}
inline PairVector operator*(Lanes s, PairVector p) {
  return {s * p.x, s * p.y};
}
inline Lanes cross(PairVector p, PairVector q) {
  return p.x * q.y - p.y * q.x;
}
inline PairVector swapped(PairVector p) {
  return {swapped(p.x), swapped(p.y)};
}
inline PairVector where(LaneMask m, PairVector p, PairVector q) {
  return {where(m, p.x, q.x), where(m, p.y, q.y)};
}
inline PairVector joined(PairVector a, PairVector b) {
  return {joined(a.x, b.x), joined(a.y, b.y)};
}
/// |x| + |y|
inline Lanes sum_norm(PairVector p) {
  return abs(p.x) + abs(p.y);
}
/// a - b in both lanes.
inline PairVector first_minus_second(PairVector p) {
  const PairVector d = p - swapped(p);
  return {first_in_both(d.x), first_in_both(d.y)};
}

/// Value, derivative, half the second derivative and a sixth of the third.
struct PairTaylor {
  PairVector value, slope, bend, twist;
};

/// Control points of both; the shorter list is filled up with copies of its last point.
template <int Room>
struct PairPoints {
  PairVector p[Room];
};

/// The degrees of both. D: when both are D at compile time, else 0.
template <int D>
struct PairDegrees {
  int degree[2];
  int max() const { return D > 0 ? D : degree[0] > degree[1] ? degree[0] : degree[1]; }
  int of(int lane) const { return D > 0 ? D : degree[lane]; }
  /// x for the curves of degree above i, y for others.
  template <class X>
  X where_edge(int i, X x, X y) const {
    if (D > 0 || degree[0] == degree[1]) return x;
    return where(LaneMask{i < degree[0] ? -1 : 0, i < degree[1] ? -1 : 0}, x, y);
  }
  Lanes as_factor() const { return Lanes{static_cast<double>(of(0)), static_cast<double>(of(1))}; }
};

/// Differences of successive control points; the shorter list is filled up with zeros.
template <int D, int Room>
PairVector edge(const PairDegrees<D>& degrees, const PairPoints<Room>& p, int i) {
  return degrees.where_edge(i, p.p[i + 1] - p.p[i], PairVector{both(0.0), both(0.0)});
}

/// Both curves halved by de Casteljau.
template <int D, int Room>
void halve_both(const PairDegrees<D>& degrees, const PairPoints<Room>& p, PairPoints<Room>& left,
                PairPoints<Room>& right) {
  const Lanes half = both(0.5);
  if constexpr (D > 0) {
    PairVector q[D + 1];
    for (int i = 0; i <= D; ++i) q[i] = p.p[i];
    left.p[0] = q[0];
    right.p[D] = q[D];
    for (int r = 1; r <= D; ++r) {
      for (int i = 0; i <= D - r; ++i) q[i] = half * (q[i] + q[i + 1]);
      left.p[r] = q[0];
      right.p[D - r] = q[D - r];
    }
  } else {
    // In the lane of the lower degree the last point and then the first stay as they are.
    const int n = degrees.max();
    PairVector* q = right.p;
    for (int i = 0; i <= n; ++i) q[i] = p.p[i];
    left.p[0] = q[0];
    for (int r = 1; r <= n; ++r) {
      for (int i = 0; i <= n - r; ++i)
        q[i] = degrees.where_edge(i + r - 1, half * (q[i] + q[i + 1]), q[i]);
      left.p[r] = q[0];
    }
  }
}

/// Expansions about the parameters s, by de Casteljau: values within (3 d + 1) u max|p| for s in
/// [0, 1].
template <int D, int Room>
PairTaylor expand(const PairDegrees<D>& degrees, const PairPoints<Room>& points, Lanes s) {
  const PairVector* p = points.p;
  const Lanes r = both(1.0) - s;
  const PairVector none{both(0.0), both(0.0)};
  if constexpr (D == 1) {
    return {r * p[0] + s * p[1], p[1] - p[0], none, none};
  } else if constexpr (D == 2) {
    const PairVector e = p[1] - p[0], f = p[2] - p[1];
    const PairVector w0 = r * p[0] + s * p[1], w1 = r * p[1] + s * p[2];
    return {r * w0 + s * w1, both(2.0) * (w1 - w0), f - e, none};
  } else if constexpr (D == 3) {
    const PairVector q0 = r * p[0] + s * p[1], q1 = r * p[1] + s * p[2], q2 = r * p[2] + s * p[3];
    const PairVector w0 = r * q0 + s * q1, w1 = r * q1 + s * q2;
    const Lanes three = both(3.0);
    return {r * w0 + s * w1, three * (w1 - w0), three * ((q2 - q1) - (q1 - q0)),
            (p[3] - p[0]) - three * (p[2] - p[1])};
  } else {
    PairTaylor out{p[0], none, none, none};
    const int n = degrees.max();
    const Lanes d = degrees.as_factor(), one = both(1.0), two = both(2.0), three = both(3.0);
    PairVector q[Room];
    for (int i = 0; i <= n; ++i) q[i] = p[i];
    for (int level = 1; level <= n; ++level) {
      // The degree that is left.
      const Lanes rest = d - both(level - 1);
      if (any(rest <= three)) {
        const PairVector e = q[1] - q[0];
        if (any(rest == three)) {
          const PairVector third = (q[3] - q[0]) - three * (q[2] - q[1]);
          out.twist =
              where(rest == three, d * (d - one) * (d - two) / both(6.0) * third, out.twist);
        }
        if (any(rest == two))
          out.bend = where(rest == two, both(0.5) * d * (d - one) * ((q[2] - q[1]) - e), out.bend);
        if (any(rest == one)) out.slope = where(rest == one, d * e, out.slope);
      }
      for (int i = 0; i <= n - level; ++i)
        q[i] = degrees.where_edge(i + level - 1, r * q[i] + s * q[i + 1], q[i]);
    }
    if (n > 0) out.value = q[0];
    return out;
  }
}

}  // namespace bezel::geometry_kernel
