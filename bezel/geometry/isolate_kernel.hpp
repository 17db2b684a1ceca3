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
  /// x for the curves of degree above i, `otherwise` for others.
  Lanes where_edge(int i, Lanes x, double otherwise) const {
    if constexpr (D > 0) return x;
    return Lanes{i < of(0) ? x[0] : otherwise, i < of(1) ? x[1] : otherwise};
  }
  Lanes as_factor() const { return Lanes{static_cast<double>(of(0)), static_cast<double>(of(1))}; }
};

/// Differences of successive control points; the shorter list is filled up with zeros.
template <int D, int Room>
PairVector edge(const PairDegrees<D>& degrees, const PairPoints<Room>& p, int i) {
  const PairVector e = p.p[i + 1] - p.p[i];
  return {degrees.where_edge(i, e.x, 0.0), degrees.where_edge(i, e.y, 0.0)};
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
    const int n = degrees.max();
    for (int lane = 0; lane < 2; ++lane) {
      const int d = degrees.of(lane);
      const auto copy = [lane](PairVector& to, const PairVector& from) {
        to.x[lane] = from.x[lane];
        to.y[lane] = from.y[lane];
      };
      for (int i = 0; i <= n; ++i) copy(right.p[i], p.p[i]);
      for (int i = 0; i <= n; ++i) copy(left.p[i], p.p[0]);
      for (int r = 1; r <= d; ++r) {
        for (int i = 0; i <= d - r; ++i) {
          right.p[i].x[lane] = 0.5 * (right.p[i].x[lane] + right.p[i + 1].x[lane]);
          right.p[i].y[lane] = 0.5 * (right.p[i].y[lane] + right.p[i + 1].y[lane]);
        }
        for (int i = r; i <= n; ++i) copy(left.p[i], right.p[0]);
      }
    }
  }
}

/// Expansions about the parameters s, by de Casteljau: values within (3 d + 1) u max|p| for s in
/// [0, 1]. Where the degree is not known at compile time the third derivative is left out.
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
    for (int lane = 0; lane < 2; ++lane) {
      const int d = degrees.of(lane);
      const double t = s[lane], rest = r[lane];
      double x[Room], y[Room];
      for (int i = 0; i <= d; ++i) {
        x[i] = p[i].x[lane];
        y[i] = p[i].y[lane];
      }
      for (int k = d; k > 0; --k) {
        if (k == 2) {
          out.bend.x[lane] = 0.5 * d * (d - 1) * ((x[2] - x[1]) - (x[1] - x[0]));
          out.bend.y[lane] = 0.5 * d * (d - 1) * ((y[2] - y[1]) - (y[1] - y[0]));
        } else if (k == 1) {
          out.slope.x[lane] = d * (x[1] - x[0]);
          out.slope.y[lane] = d * (y[1] - y[0]);
        }
        for (int i = 0; i < k; ++i) {
          x[i] = rest * x[i] + t * x[i + 1];
          y[i] = rest * y[i] + t * y[i + 1];
        }
      }
      out.value.x[lane] = d > 0 ? x[0] : p[0].x[lane];
      out.value.y[lane] = d > 0 ? y[0] : p[0].y[lane];
    }
    return out;
  }
}

}  // namespace bezel::geometry_kernel
