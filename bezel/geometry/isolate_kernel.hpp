#pragma once
// Two plane curves side by side, one in each lane: what both need is computed at once.

#include <cmath>
#include <cstddef>
#include <tuple>

#include "bezel/geometry/curve_kernel.hpp"

#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace bezel::geometry_kernel {

// Vectors of the compiler's (g++ and clang): two doubles in one register where there are such.
using Lanes [[gnu::vector_size(16)]] = double;
using LaneMask = decltype(Lanes{} < Lanes{});  // of integers: all bits or none

inline Lanes lanes(const double* p) {
  return Lanes{p[0], p[1]};
}
inline void store(Lanes x, double* p) {
  p[0] = x[0];
  p[1] = x[1];
}
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
inline bool any(LaneMask m) {
#ifdef __SSE2__
  return _mm_movemask_pd(reinterpret_cast<__m128d>(m)) != 0;
#else
  return (m[0] | m[1]) != 0;
#endif
}
inline bool all(LaneMask m) {
#ifdef __SSE2__
  return _mm_movemask_pd(reinterpret_cast<__m128d>(m)) == 3;
#else
  return (m[0] & m[1]) != 0;
#endif
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
  alignas(16) double x[2 * Room];
  alignas(16) double y[2 * Room];

  PairVector at(int i) const { return {lanes(x + 2 * i), lanes(y + 2 * i)}; }
  void set(int i, PairVector p) {
    store(p.x, x + 2 * i);
    store(p.y, y + 2 * i);
  }
};

/// The degrees of both. D: when both are D at compile time, else 0.
template <int D>
struct PairDegrees {
  int degree[2];
  int max() const { return D > 0 ? D : degree[0] > degree[1] ? degree[0] : degree[1]; }
  int of(int lane) const { return D > 0 ? D : degree[lane]; }
  Lanes as_factor() const {
    alignas(16) const double d[2] = {static_cast<double>(of(0)), static_cast<double>(of(1))};
    return lanes(d);
  }
};

/// Differences of successive control points; the shorter list is filled up with copies of its last.
template <int D, int Room>
PairVector edge(const PairDegrees<D>& degrees, const PairPoints<Room>& p, int i) {
  if constexpr (D > 0) {
    return p.at(i + 1) - p.at(i);
  } else {
    alignas(16) double x[2], y[2];
    for (int lane = 0; lane < 2; ++lane) {
      const int d = degrees.of(lane), j = 2 * (i < d ? i : d > 0 ? d - 1 : 0) + lane;
      x[lane] = d > 0 ? p.x[j + 2] - p.x[j] : 0.0;
      y[lane] = d > 0 ? p.y[j + 2] - p.y[j] : 0.0;
    }
    return {lanes(x), lanes(y)};
  }
}

/// Both curves halved by de Casteljau.
template <int D, int Room>
void halve_both(const PairDegrees<D>& degrees, const PairPoints<Room>& p, PairPoints<Room>& left,
                PairPoints<Room>& right) {
  if constexpr (D > 0) {
    const Lanes half = both(0.5);
    PairVector q[D + 1];
    for (int i = 0; i <= D; ++i) q[i] = p.at(i);
    left.set(0, q[0]);
    right.set(D, q[D]);
    for (int r = 1; r <= D; ++r) {
      for (int i = 0; i <= D - r; ++i) q[i] = half * (q[i] + q[i + 1]);
      left.set(r, q[0]);
      right.set(D - r, q[D - r]);
    }
  } else {
    const int n = degrees.max();
    for (int lane = 0; lane < 2; ++lane) {
      const int d = degrees.of(lane);
      for (const auto& [from, to_left, to_right] :
           {std::tuple{p.x + lane, left.x + lane, right.x + lane},
            std::tuple{p.y + lane, left.y + lane, right.y + lane}}) {
        for (int i = 0; i <= d; ++i) to_right[2 * i] = from[2 * i];
        to_left[0] = to_right[0];
        for (int r = 1; r <= d; ++r) {
          for (int i = 0; i <= d - r; ++i)
            to_right[2 * i] = 0.5 * (to_right[2 * i] + to_right[2 * i + 2]);
          to_left[2 * r] = to_right[0];
        }
        for (int i = d + 1; i <= n; ++i) {
          to_left[2 * i] = to_left[2 * d];
          to_right[2 * i] = to_right[2 * d];
        }
      }
    }
  }
}

/// Expansions about the parameters s, by de Casteljau: values within (3 d + 1) u max|p| for s in
/// [0, 1]. Where the degree is not known at compile time the third derivative is left out.
template <int D, int Room>
PairTaylor expand(const PairDegrees<D>& degrees, const PairPoints<Room>& p, Lanes s) {
  const Lanes r = both(1.0) - s;
  const PairVector none{both(0.0), both(0.0)};
  if constexpr (D == 1) {
    return {r * p.at(0) + s * p.at(1), p.at(1) - p.at(0), none, none};
  } else if constexpr (D == 2) {
    const PairVector e = p.at(1) - p.at(0), f = p.at(2) - p.at(1);
    const PairVector w0 = r * p.at(0) + s * p.at(1), w1 = r * p.at(1) + s * p.at(2);
    return {r * w0 + s * w1, both(2.0) * (w1 - w0), f - e, none};
  } else if constexpr (D == 3) {
    const PairVector p0 = p.at(0), p1 = p.at(1), p2 = p.at(2), p3 = p.at(3);
    const PairVector q0 = r * p0 + s * p1, q1 = r * p1 + s * p2, q2 = r * p2 + s * p3;
    const PairVector w0 = r * q0 + s * q1, w1 = r * q1 + s * q2;
    const Lanes three = both(3.0);
    return {r * w0 + s * w1, three * (w1 - w0), three * ((q2 - q1) - (q1 - q0)),
            (p3 - p0) - three * (p2 - p1)};
  } else {
    alignas(16) double s_of[2], out[6][2];
    store(s, s_of);
    for (int lane = 0; lane < 2; ++lane) {
      const int d = degrees.of(lane);
      const double t = s_of[lane], rest = 1.0 - t;
      for (int c = 0; c < 2; ++c) {
        const double* from = (c == 0 ? p.x : p.y) + lane;
        double q[Room];
        for (int i = 0; i <= d; ++i) q[i] = from[2 * i];
        double slope = 0, bend = 0;
        for (int k = d; k > 0; --k) {
          if (k == 2) bend = 0.5 * d * (d - 1) * ((q[2] - q[1]) - (q[1] - q[0]));
          if (k == 1) slope = d * (q[1] - q[0]);
          for (int i = 0; i < k; ++i) q[i] = rest * q[i] + t * q[i + 1];
        }
        out[c][lane] = q[0];
        out[2 + c][lane] = slope;
        out[4 + c][lane] = bend;
      }
    }
    return {{lanes(out[0]), lanes(out[1])},
            {lanes(out[2]), lanes(out[3])},
            {lanes(out[4]), lanes(out[5])},
            none};
  }
}

}  // namespace bezel::geometry_kernel
