#pragma once
// What `isolate` says of two curves against the exact truth.

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "bezel/geometry/isolate.hpp"
#include "support/curve_oracle.hpp"
#include "support/curve_pairs.hpp"

namespace support {

struct IsolationVerdict {
  std::string wrong;       ///< empty when nothing is
  double worst_error = 0;  ///< of parameters, in u max(condition, 1)
  bool undecided = false;  ///< the truth is not known
};

namespace isolation_detail {

inline bool strictly_inside(const CommonPoint& p, const bezel::geometry_kernel::IsolatedRoot& r) {
  return p.s_lo > r.s_lo && p.s_hi < r.s_hi && p.t_lo > r.t_lo && p.t_hi < r.t_hi;
}
inline bool touches(const CommonPoint& p, const mpq_class& s0, const mpq_class& s1,
                    const mpq_class& t0, const mpq_class& t1) {
  return p.s_hi >= s0 && p.s_lo <= s1 && p.t_hi >= t0 && p.t_lo <= t1;
}
inline RationalPoint exact_derivative(const std::vector<RationalPoint>& c, const mpq_class& s) {
  if (c.size() == 1) return {0, 0};
  std::vector<RationalPoint> e;
  for (std::size_t i = 0; i + 1 < c.size(); ++i)
    e.push_back({c[i + 1][0] - c[i][0], c[i + 1][1] - c[i][1]});
  return exact_point(e, s);  // up to the factor, which is positive
}

}  // namespace isolation_detail

/// Every common point must be in the box of one root, not on its border, or in an open box; each
/// box of a root must hold one transversal common point of the stated sign; an open box with a sign
/// at most one, and the sign must be right at samples.
inline IsolationVerdict judge_isolation(const CurvePair& pair, const CommonParts& truth,
                                        const bezel::geometry_kernel::Isolation& found) {
  using namespace isolation_detail;
  IsolationVerdict out;
  const auto wrong = [&](const char* what) {
    if (out.wrong.find(what) == std::string::npos)
      out.wrong += (out.wrong.empty() ? "" : ", ") + std::string(what);
  };
  for (const auto& r : found.roots)
    if (!(0 <= r.s_lo && r.s_lo <= r.s && r.s <= r.s_hi && r.s_hi <= 1 && 0 <= r.t_lo &&
          r.t_lo <= r.t && r.t <= r.t_hi && r.t_hi <= 1))
      wrong("a root's box");
  for (const auto& o : found.open)
    if (!(0 <= o.s0 && o.s0 <= o.s1 && o.s1 <= 1 && 0 <= o.t0 && o.t0 <= o.t1 && o.t1 <= 1))
      wrong("an open box");
  out.undecided = !truth.decided;
  if (out.undecided) return out;

  const auto open = [&](const auto& inside) {
    return std::any_of(found.open.begin(), found.open.end(), inside);
  };
  std::vector<int> held(found.roots.size(), 0);
  for (const CommonPoint& p : truth.points) {
    int holders = 0;
    for (std::size_t i = 0; i < found.roots.size(); ++i) {
      const auto& r = found.roots[i];
      if (!touches(p, r.s_lo, r.s_hi, r.t_lo, r.t_hi)) continue;
      if (!strictly_inside(p, r)) wrong("a root on the border of a root's box");
      ++holders;
      ++held[i];
      if (p.multiplicity != 1 || !p.smooth) wrong("a root that is not simple");
      if (p.sign != r.sign) wrong("the sign of a root");
      const double ds = mpq_class(abs(r.s - (p.s_lo + p.s_hi) / 2)).get_d();
      const double dt = mpq_class(abs(r.t - (p.t_lo + p.t_hi) / 2)).get_d();
      out.worst_error =
          std::max(out.worst_error, std::max(ds, dt) / (0x1p-53 * std::max(p.condition, 1.0)));
    }
    if (holders > 1) wrong("a point in two roots' boxes");
    if (holders == 0 && !open([&](const auto& o) { return touches(p, o.s0, o.s1, o.t0, o.t1); }))
      wrong("a point missed");
  }
  for (const CommonInterval& x : truth.intervals)
    for (int k = 0; k <= 16; ++k) {
      const mpq_class s = x.s0 + (x.s1 - x.s0) * mpq_class(k, 16);
      const mpq_class t = x.t0 + (x.t1 - x.t0) * mpq_class(k, 16);
      if (!open([&](const auto& o) { return s >= o.s0 && s <= o.s1 && t >= o.t0 && t <= o.t1; }))
        wrong("a common part missed");
      for (const auto& r : found.roots)
        if (s >= r.s_lo && s <= r.s_hi && t >= r.t_lo && t <= r.t_hi)
          wrong("a root's box on a common part");
    }
  for (const int n : held)
    if (n != 1) wrong("a root made up");

  const std::vector<RationalPoint> a = rational_points(pair.a), b = rational_points(pair.b);
  for (const auto& o : found.open) {
    if (o.sign == 0) continue;
    const mpq_class s0 = o.s0, t0 = o.t0, ds = (mpq_class(o.s1) - s0) / 8,
                    dt = (mpq_class(o.t1) - t0) / 8;
    int points = 0;
    for (const CommonPoint& p : truth.points)
      if (touches(p, s0 - ds, s0 + 9 * ds, t0 - dt, t0 + 9 * dt)) ++points;
    if (points > 1) wrong("two roots near an open box with a sign");
    for (int i = -1; i <= 9; i += 2)
      for (int j = -1; j <= 9; j += 2) {
        const RationalPoint p = exact_derivative(a, s0 + i * ds),
                            q = exact_derivative(b, t0 + j * dt);
        if (sgn(p[0] * q[1] - p[1] * q[0]) != o.sign) wrong("the sign of an open box");
      }
  }
  return out;
}

}  // namespace support
