#pragma once
// What `intersect` says of two curves against the exact truth.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include "bezel/geometry/curve.hpp"
#include "support/curve_oracle.hpp"
#include "support/curve_pairs.hpp"

namespace support {

struct Verdict {
  std::string silent;  ///< what is wrong without being said; empty when nothing is
  /// The wrong claims are only of the kind that `intersect` documents: end points within 2 u of the
  /// largest coordinate of the other curve count as on it, curves within that of each other
  /// coincide.
  bool within_rounding = false;
  bool unresolved = false;
  double widest_box = 0;   ///< of the unresolved ones
  double worst_error = 0;  ///< of parameters of simple crossings, in u max(condition, 1)
};

namespace verdict_detail {

inline mpq_class larger(const mpq_class& x, const mpq_class& y) {
  return x > y ? x : y;
}

/// a(s) and b(t) are within tau, in the maximum norm.
inline bool near(const std::vector<RationalPoint>& a, double s, const std::vector<RationalPoint>& b,
                 double t, const mpq_class& tau) {
  const RationalPoint p = exact_point(a, s), q = exact_point(b, t);
  return abs(p[0] - q[0]) <= tau && abs(p[1] - q[1]) <= tau;
}

}  // namespace verdict_detail

/// Every common point needs its own Crossing (of the right sign, where one is given), or Tangency
/// when it is not transversal, or must lie in an unresolved box. Where an end point is involved, or
/// a curve is singular, either will do. Anything beyond is made up. Simple crossings must be within
/// 2^-20 of a true one, touching ones within 2^-10; how far they are is measured apart.
inline Verdict judge(const CurvePair& pair, const CommonParts& truth,
                     const bezel::CurveIntersections& found) {
  Verdict out;
  const std::vector<RationalPoint> a = rational_points(pair.a), b = rational_points(pair.b);
  mpq_class magnitude = 0;
  for (const auto* c : {&a, &b})
    for (const RationalPoint& p : *c)
      magnitude = verdict_detail::larger(magnitude, verdict_detail::larger(abs(p[0]), abs(p[1])));
  const mpq_class tau = magnitude * mpq_class(0x1p-52);
  bool excused = true;
  const auto wrong = [&](const std::string& what, bool by_rounding) {
    if (out.silent.find(what) == std::string::npos)
      out.silent += (out.silent.empty() ? "" : ", ") + what;
    excused = excused && by_rounding;
  };

  for (const auto& box : found.unresolved) {
    out.unresolved = true;
    out.widest_box = std::max({out.widest_box, box.s_hi - box.s_lo, box.t_hi - box.t_lo});
  }
  const auto open = [&](double s, double t) {
    return std::any_of(found.unresolved.begin(), found.unresolved.end(), [&](const auto& box) {
      return s >= box.s_lo - 0x1p-40 && s <= box.s_hi + 0x1p-40 && t >= box.t_lo - 0x1p-40 &&
             t <= box.t_hi + 0x1p-40;
    });
  };

  // Overlaps: each reported one near a true one, and the other way round.
  std::vector<bool> covered(truth.intervals.size(), false);
  for (const auto& o : found.overlaps) {
    bool right = false;
    for (std::size_t i = 0; i < truth.intervals.size(); ++i) {
      const CommonInterval& x = truth.intervals[i];
      if (!covered[i] && std::fabs(o.s0 - x.s0.get_d()) <= 0x1p-40 &&
          std::fabs(o.s1 - x.s1.get_d()) <= 0x1p-40 && std::fabs(o.t0 - x.t0.get_d()) <= 0x1p-40 &&
          std::fabs(o.t1 - x.t1.get_d()) <= 0x1p-40)
        covered[i] = right = true;
      if (right) break;
    }
    bool close = true;
    for (int k = 0; k <= 8; ++k) {
      // The nearest point of b, for curves whose parameters match up to an affine change.
      const double x = k / 8.0;
      close = close && verdict_detail::near(a, o.s0 + x * (o.s1 - o.s0), b,
                                            o.t0 + x * (o.t1 - o.t0), 2 * tau);
    }
    if (!right) wrong("false overlap", close);
  }
  for (std::size_t i = 0; i < covered.size(); ++i) {
    const CommonInterval& x = truth.intervals[i];
    if (!covered[i] && !open(x.s0.get_d(), x.t0.get_d()) && !open(x.s1.get_d(), x.t1.get_d()))
      wrong("overlap missed", false);
  }

  // Points: the nearest pairs of a claim and a truth belong together.
  struct Claim {
    double s, t;
    const bezel::Crossing* crossing;
    const bezel::Tangency* tangency;
  };
  std::vector<Claim> claims;
  for (const auto& c : found.crossings) claims.push_back({c.s, c.t, &c, nullptr});
  for (const auto& c : found.tangencies) claims.push_back({c.s, c.t, nullptr, &c});
  // Two roots may share their nearest doubles: then signs tell them apart.
  std::vector<std::tuple<double, bool, std::size_t, std::size_t>> distances;
  for (std::size_t i = 0; i < claims.size(); ++i)
    for (std::size_t j = 0; j < truth.points.size(); ++j) {
      const CommonPoint& p = truth.points[j];
      const mpq_class ds = abs(mpq_class(claims[i].s) - (p.s_lo + p.s_hi) / 2);
      const mpq_class dt = abs(mpq_class(claims[i].t) - (p.t_lo + p.t_hi) / 2);
      const double distance = std::max(ds.get_d(), dt.get_d());
      if (distance <= (p.multiplicity == 1 && p.smooth ? 0x1p-20 : 0x1p-10))
        distances.emplace_back(
            distance, claims[i].crossing != nullptr && claims[i].crossing->sign != p.sign, i, j);
    }
  std::sort(distances.begin(), distances.end());
  std::vector<bool> used(claims.size(), false), seen(truth.points.size(), false);
  for (const auto& [distance, other_sign, i, j] : distances) {
    if (used[i] || seen[j]) continue;
    used[i] = seen[j] = true;
    const CommonPoint& p = truth.points[j];
    const Claim& c = claims[i];
    if (p.s_end || p.t_end || !p.smooth || p.multiplicity == 0) continue;
    if (p.multiplicity == 1) {
      if (c.tangency != nullptr) wrong("a crossing called tangency", false);
      if (c.crossing != nullptr && c.crossing->sign != 0 && p.sign != 0 &&
          c.crossing->sign != p.sign)
        wrong("wrong sign", false);
      out.worst_error =
          std::max(out.worst_error, distance / (0x1p-53 * std::fmax(p.condition, 1.0)));
    } else {
      if (p.multiplicity % 2 == 0 && c.crossing != nullptr && c.crossing->sign != 0)
        wrong("a tangency called crossing", false);
      if (c.tangency != nullptr && c.tangency->order != 0 && c.tangency->order != p.multiplicity)
        wrong("wrong order of contact", false);
    }
  }
  for (std::size_t j = 0; j < seen.size(); ++j) {
    const CommonPoint& p = truth.points[j];
    if (seen[j] || open(p.s(), p.t())) continue;
    // Swallowed by a claim of coincidence or a contact that rounding explains, or lost.
    const bool by_rounding =
        std::any_of(
            found.overlaps.begin(), found.overlaps.end(),
            [&](const auto& o) { return p.s() >= o.s0 - 0x1p-40 && p.s() <= o.s1 + 0x1p-40; }) &&
        !out.silent.empty() && excused;
    wrong("a point missed", by_rounding);
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (used[i]) continue;
    const Claim& c = claims[i];
    const bool end = c.s == 0 || c.s == 1 || c.t == 0 || c.t == 1;
    wrong(c.tangency != nullptr ? "a tangency made up" : "a crossing made up",
          (end || c.tangency != nullptr) && verdict_detail::near(a, c.s, b, c.t, 2 * tau));
  }
  out.within_rounding = !out.silent.empty() && excused;
  return out;
}

}  // namespace support
