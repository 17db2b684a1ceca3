#pragma once
// Pairs of curves, and the truth about their common points to judge libraries by.
//
// A true root is what Newton's method with compensated residuals, and a last step in extended
// precision, converges to from a root that one of the libraries reported. A root that no library
// reports is not counted against any of them.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/geometry/newton_intersection.hpp"
#include "peers/peers.hpp"

namespace truth {

using bezel::Vec2;
using peers::Parameters;
using Curve = std::span<const Vec2>;

struct Pair {
  Curve a, b;
};

/// Curves of one degree, one after the other in memory.
class Pairs {
 public:
  Pairs(int degree, std::size_t count) : points_(static_cast<std::size_t>(degree) + 1) {
    control_.reserve(2 * points_ * count);
  }
  std::size_t size() const { return control_.size() / (2 * points_); }
  Pair operator[](std::size_t i) const {
    const Curve both = Curve(control_).subspan(2 * points_ * i, 2 * points_);
    return {both.first(points_), both.last(points_)};
  }
  void push(const Vec2& p) { control_.push_back(p); }

 private:
  std::size_t points_;
  std::vector<Vec2> control_;
};

/// Control points uniform in the unit square; bits > 0: the second curve is the first with every
/// coordinate moved by up to 2^-bits.
inline Pairs random_pairs(int degree, std::size_t count, int bits) {
  bezel::RandomStream random("geometry_bench", static_cast<std::uint64_t>(100 * bits + degree));
  Pairs out(degree, count);
  std::vector<Vec2> c(static_cast<std::size_t>(degree) + 1);
  const auto point = [&](double lo, double hi) {
    const double x = random.uniform(lo, hi), y = random.uniform(lo, hi);
    return Vec2{{x, y}};
  };
  const double size = std::ldexp(1.0, -bits);
  for (std::size_t i = 0; i < count; ++i) {
    for (Vec2& p : c) out.push(p = point(0, 1));
    for (Vec2& p : c) out.push(bits == 0 ? point(0, 1) : p + point(-size, size));
  }
  return out;
}

struct TrueRoot {
  double s, t;
  double ds, dt;     ///< to be added, so that the root is known beyond the rounding of s and t
  double condition;  ///< largest |coordinate| / (slower speed * sine of the angle)
};

/// Reported parameters further than this from every true root are not a root.
inline constexpr double largest_error = 0x1p-12;

inline double distance(double s, double t, const TrueRoot& r) {
  return std::max(std::fabs((s - r.s) - r.ds), std::fabs((t - r.t) - r.dt));
}

/// d/ds c(s) by de Casteljau.
inline Vec2 derivative(Curve c, double s) {
  std::vector<Vec2> q(c.begin(), c.end());
  for (std::size_t d = q.size() - 1; d >= 2; --d)
    for (std::size_t i = 0; i < d; ++i) q[i] = (1.0 - s) * q[i] + s * q[i + 1];
  return static_cast<double>(c.size() - 1) * (q[1] - q[0]);
}

/// a(s) - b(t) in extended precision.
inline Vec2 residual(const Pair& pair, double s, double t) {
  const auto value = [](Curve c, double at, int axis) {
    std::vector<long double> q;
    for (const Vec2& p : c) q.push_back(p[axis]);
    const long double x = at;
    for (std::size_t d = q.size() - 1; d > 0; --d)
      for (std::size_t i = 0; i < d; ++i) q[i] = (1 - x) * q[i] + x * q[i + 1];
    return q[0];
  };
  const auto difference = [&](int axis) {
    return static_cast<double>(value(pair.a, s, axis) - value(pair.b, t, axis));
  };
  return Vec2{{difference(0), difference(1)}};
}

/// Adds the root next to `start` unless there is none or it is known.
inline void add_root(const Pair& pair, const Parameters& start, std::vector<TrueRoot>& roots) {
  constexpr double u = 0x1p-53;
  const auto found = bezel::newton_intersection(pair.a, pair.b, start.s, start.t,
                                                bezel::ResidualForm::compensated);
  using bezel::bernstein::NewtonStop;
  // Steps may end above the tolerance by alternating between neighbouring doubles.
  if (found.stop == NewtonStop::zero_derivative || found.stop == NewtonStop::not_finite) return;
  const auto& h = found.history;
  if (h.size() >= 2) {
    const auto &last = h[h.size() - 1], &before = h[h.size() - 2];
    if (std::max(std::fabs(last.s - before.s), std::fabs(last.t - before.t)) > 16 * u) return;
  }
  double largest = 0;
  for (const Curve& c : {pair.a, pair.b})
    for (const Vec2& p : c) largest = std::max({largest, std::fabs(p.x()), std::fabs(p.y())});
  const Vec2 da = derivative(pair.a, found.s), db = derivative(pair.b, found.t);
  const double faster = std::max(norm(da), norm(db));
  const double det = cross(da, db);
  TrueRoot root{found.s, found.t, 0, 0, largest * faster / std::fabs(det)};
  if (root.condition < 0x1p10) {
    // One step more: the residual is good for 2^-10 u condition, less than the rounding of s.
    const Vec2 rest = residual(pair, found.s, found.t);
    root.ds = -cross(rest, db) / det;
    root.dt = -cross(rest, da) / det;
  }
  const double slack = 4 * u * root.condition;
  const auto inside = [&](double x) { return x >= -slack && x <= 1 + slack; };
  if (!inside(root.s) || !inside(root.t)) return;
  if (!(distance(start.s, start.t, root) <= largest_error)) return;
  for (const TrueRoot& r : roots)
    if (std::max(std::fabs(root.s - r.s), std::fabs(root.t - r.t)) <= 64 * u) return;
  roots.push_back(root);
}

/// How a library's answers compare with the truth.
struct Score {
  std::size_t roots = 0, missed = 0, extra = 0;
  std::vector<double> errors;  ///< parameter errors in units of u * condition

  void add(std::span<const TrueRoot> truth, std::span<const Parameters> found) {
    std::vector<bool> used(truth.size(), false);
    std::size_t matched = 0;
    for (const Parameters& f : found) {
      std::size_t best = truth.size();
      for (std::size_t i = 0; i < truth.size(); ++i)
        if (!used[i] && distance(f.s, f.t, truth[i]) <= largest_error &&
            (best == truth.size() ||
             distance(f.s, f.t, truth[i]) < distance(f.s, f.t, truth[best])))
          best = i;
      if (best == truth.size()) {
        ++extra;
        continue;
      }
      used[best] = true;
      ++matched;
      errors.push_back(distance(f.s, f.t, truth[best]) / (0x1p-53 * truth[best].condition));
    }
    roots += truth.size();
    missed += truth.size() - matched;
  }
  /// The error that a share of the roots found does not exceed.
  double error_of(double share) {
    if (errors.empty()) return 0.0;
    const auto last = static_cast<double>(errors.size() - 1);
    const auto at = errors.begin() + static_cast<std::ptrdiff_t>(share * last);
    std::nth_element(errors.begin(), at, errors.end());
    return *at;
  }
};

}  // namespace truth
