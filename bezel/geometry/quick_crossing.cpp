#include "bezel/geometry/quick_crossing.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/geometry/curve_kernel.hpp"

namespace bezel::geometry_kernel {
namespace {

constexpr int max_degree = 10;
/// A root this near to an end of a parameter interval is left to `intersect`.
constexpr double end_margin = 1e-9;
/// How far beyond [0, 1] the caches' slopes hold.
constexpr double reach = 0.25;
constexpr double least_sine = 0.01;
/// Newton's steps are quadratic below this: the next one is the last.
constexpr double last_step = 1e-7;

/// All of q on one side of the band around the chord of `curve`.
template <int N>
bool misses(const CurveCache& curve, const Vec2* q, int degree, double slack, double& first,
            double& last) {
  const int n = N > 0 ? N : degree;
  const Vec2 origin = curve.control.front();
  first = cross(curve.chord, q[0] - origin);
  last = cross(curve.chord, q[n] - origin);
  double lo = std::min(first, last), hi = std::max(first, last);
  for (int j = 1; j < n; ++j) {
    const double c = cross(curve.chord, q[j] - origin);
    lo = c < lo ? c : lo;
    hi = c > hi ? c : hi;
  }
  const double room = slack * curve.chord_length;
  return hi < curve.band_lo - room || lo > curve.band_hi + room;
}

/// Value and derivative; D: the degree when known at compile time.
template <int D>
CurvePoint point_at(const Vec2* b, int degree, double s) {
  if constexpr (D > 0)
    return curve_point(D, b, s);
  else
    return curve_point(degree, b, s);
}

template <int M, int N>
Meeting meet(const CurveCache& a, const CurveCache& b, double distance, QuickCrossing& out) {
  const int m = static_cast<int>(a.control.size()) - 1, n = static_cast<int>(b.control.size()) - 1;
  // The fat lines' own rounding: products of differences, relative to the chord.
  const double slack = distance + 0x1p-50 * std::max(a.diameter, b.diameter);
  double b_first = 0, b_last = 0, a_first = 0, a_last = 0;
  if (misses<N>(a, b.control.data(), n, slack, b_first, b_last)) return Meeting::none;
  if (misses<M>(b, a.control.data(), m, slack, a_first, a_last)) return Meeting::none;

  // With derivatives u + alpha u', v + beta v' (u' is u turned by 90 degrees, the same for v):
  // cross = cross(u, v) (1 + alpha beta) + dot(u, v) (beta - alpha), extreme where both are.
  const double sine = cross(a.chord, b.chord);
  const double lengths = a.chord_length * b.chord_length, least = least_sine * lengths;
  bool positive = sine > 0;
  double smallest = std::fabs(sine);  // cross product seen
  if constexpr (M == 1 && N == 1) {
    if (!(std::fabs(sine) >= least)) return Meeting::unclear;
  } else {
    if (!(a.slope_hi - a.slope_lo <= 1.0 && b.slope_hi - b.slope_lo <= 1.0))
      return Meeting::unclear;
    const double cosine = dot(a.chord, b.chord);
    for (const double alpha : {a.slope_lo, a.slope_hi}) {
      for (const double beta : {b.slope_lo, b.slope_hi}) {
        const double value = sine * (1.0 + alpha * beta) + cosine * (beta - alpha);
        // The derivatives' lengths are at most sqrt(2) chords.
        if (!(std::fabs(value) >= 2.0 * least) || (value > 0) != positive) return Meeting::unclear;
        smallest = std::min(smallest, 0.5 * std::fabs(value));
      }
    }
  }
  // An end is far enough from the other curve when its parameter is off by end_margin.
  if (!(distance * lengths < 0.1 * end_margin * smallest * std::min(a.diameter, b.diameter)))
    return Meeting::unclear;

  double s = a_first / (a_first - a_last);
  double t = b_first / (b_first - b_last);
  out.gap = 0;
  if constexpr (M == 1 && N == 1) {
    const Vec2 p = a.control[0] - b.control[0];
    out.gap = norm(p + s * a.chord - t * b.chord);
  } else {
    s = std::clamp(s, 0.0, 1.0);
    t = std::clamp(t, 0.0, 1.0);
    // Relative to a's first point: the residual is accurate to u times the curves' size.
    const Vec2 origin = a.control.front();
    constexpr int room_m = M > 0 ? M + 1 : max_degree + 1, room_n = N > 0 ? N + 1 : max_degree + 1;
    PointBuffer<room_m> room_p;
    PointBuffer<room_n> room_q;
    Vec2 *p = room_p.data(), *q = room_q.data();
    for (int i = 0; i <= (M > 0 ? M : m); ++i)
      p[i] = a.control[static_cast<std::size_t>(i)] - origin;
    for (int j = 0; j <= (N > 0 ? N : n); ++j)
      q[j] = b.control[static_cast<std::size_t>(j)] - origin;
    bool settled = false;
    for (int round = 0; round < 8; ++round) {
      const CurvePoint x = point_at<M>(p, m, s), y = point_at<N>(q, n, t);
      const Vec2 f = x.value - y.value;
      out.gap = norm(f);
      // a' ds - b' dt = -f
      const double inverse = 1.0 / cross(y.derivative, x.derivative);
      const double ds = cross(f, y.derivative) * inverse, dt = cross(f, x.derivative) * inverse;
      s += ds;
      t += dt;
      if (settled) break;
      if (!(s > -reach && s < 1.0 + reach && t > -reach && t < 1.0 + reach))
        return Meeting::unclear;
      settled = std::fabs(ds) < last_step && std::fabs(dt) < last_step;
    }
    if (!settled) return Meeting::unclear;
  }
  if (s > end_margin && s < 1.0 - end_margin && t > end_margin && t < 1.0 - end_margin) {
    out.s = s;
    out.t = t;
    out.sign = positive ? 1 : -1;
    return Meeting::crossing;
  }
  // The two polynomials have no other common point within reach.
  if (s < -end_margin || s > 1.0 + end_margin || t < -end_margin || t > 1.0 + end_margin)
    return Meeting::none;
  return Meeting::unclear;
}

}  // namespace

Meeting meet_quickly(const CurveCache& a, const CurveCache& b, double distance,
                     QuickCrossing& out) {
  const std::size_t m = a.control.size() - 1, n = b.control.size() - 1;
  if (m == n) {
    switch (m) {
      case 1:
        return meet<1, 1>(a, b, distance, out);
      case 2:
        return meet<2, 2>(a, b, distance, out);
      case 3:
        return meet<3, 3>(a, b, distance, out);
      default:
        break;
    }
  }
  if (m < 1 || n < 1 || m > max_degree || n > max_degree) return Meeting::unclear;
  return meet<0, 0>(a, b, distance, out);
}

}  // namespace bezel::geometry_kernel
