#include "bezel/geometry/intersect_collinear.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "bezel/bernstein/interval.hpp"
#include "bezel/bernstein/roots.hpp"

namespace bezel::geometry_kernel {
namespace {

/// Between turning points: [s0, s1] and the values at its ends.
struct Run {
  double s0, s1, x0, x1;
};

std::vector<double> coordinate(std::span<const Vec2> c, int axis) {
  std::vector<double> out;
  for (const Vec2& p : c) out.push_back(p[axis]);
  return out;
}

std::vector<Run> runs(const std::vector<double>& x) {
  std::vector<double> breaks{0.0};
  std::vector<double> slope;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) slope.push_back(x[i + 1] - x[i]);
  for (const bernstein::Root& root : bernstein::roots(slope))
    if (root.min_multiplicity % 2 == 1 && root.s > breaks.back() && root.s < 1.0)
      breaks.push_back(root.s);
  breaks.push_back(1.0);
  std::vector<Run> out;
  const auto value = [&](double s) {
    return s == 0.0   ? x.front()
           : s == 1.0 ? x.back()
                      : bernstein::evaluate(std::span<const double>(x), s);
  };
  for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
    out.push_back({breaks[i], breaks[i + 1], value(breaks[i]), value(breaks[i + 1])});
  return out;
}

/// The parameter in a run where the coordinate has the value.
double parameter(const std::vector<double>& x, const Run& run, double value) {
  if (value == run.x0) return run.s0;
  if (value == run.x1) return run.s1;
  std::vector<double> shifted = x;
  for (double& v : shifted) v -= value;
  double best = run.s0, distance = std::numeric_limits<double>::infinity();
  for (const bernstein::Root& root : bernstein::roots(shifted)) {
    const double off = std::max({0.0, run.s0 - root.s, root.s - run.s1});
    if (off < distance) {
      distance = off;
      best = root.s;
    }
  }
  return std::clamp(best, run.s0, run.s1);
}

}  // namespace

bool collinear(std::span<const Vec2> a, std::span<const Vec2> b) {
  const Vec2& origin = a.front();
  const Vec2* other = nullptr;
  for (const Vec2& p : a)
    if (!(p == origin)) {
      other = &p;
      break;
    }
  if (other == nullptr) return false;
  const auto difference = [](const Vec2& p, const Vec2& q) {
    return ExactPoint{Dyadic(p.x()) - Dyadic(q.x()), Dyadic(p.y()) - Dyadic(q.y())};
  };
  const ExactPoint d = difference(*other, origin);
  for (const auto& c : {a, b})
    for (const Vec2& p : c) {
      const ExactPoint e = difference(p, origin);
      if (!(d[0] * e[1] == d[1] * e[0])) return false;
    }
  return true;
}

void intersect_collinear(std::span<const Vec2> a, std::span<const Vec2> b,
                         CurveIntersections& out) {
  // The coordinate in which the line is longer; only ends and turning points are compared.
  Box2 box;
  for (const auto& c : {a, b})
    for (const Vec2& p : c) box.include(p);
  const int axis = box.hi.x() - box.lo.x() >= box.hi.y() - box.lo.y() ? 0 : 1;
  const std::vector<double> x = coordinate(a, axis), y = coordinate(b, axis);
  for (const Run& p : runs(x))
    for (const Run& q : runs(y)) {
      const double lo = std::max(std::min(p.x0, p.x1), std::min(q.x0, q.x1));
      const double hi = std::min(std::max(p.x0, p.x1), std::max(q.x0, q.x1));
      if (lo > hi) continue;
      const double s_lo = parameter(x, p, lo), t_lo = parameter(y, q, lo);
      if (lo < hi) {
        const double s_hi = parameter(x, p, hi), t_hi = parameter(y, q, hi);
        if (s_lo < s_hi)
          out.overlaps.push_back({s_lo, s_hi, t_lo, t_hi, 0.0});
        else
          out.overlaps.push_back({s_hi, s_lo, t_hi, t_lo, 0.0});
        continue;
      }
      const bool seen = std::any_of(out.crossings.begin(), out.crossings.end(),
                                    [&](const auto& c) { return c.s == s_lo && c.t == t_lo; });
      if (seen) continue;
      Crossing c{};
      c.s = c.s_lo = c.s_hi = s_lo;
      c.t = c.t_lo = c.t_hi = t_lo;
      c.point_a = s_lo == 0.0 ? a.front() : s_lo == 1.0 ? a.back() : bernstein::evaluate(a, s_lo);
      c.point_b = t_lo == 0.0 ? b.front() : t_lo == 1.0 ? b.back() : bernstein::evaluate(b, t_lo);
      c.condition = std::numeric_limits<double>::infinity();
      out.crossings.push_back(c);
    }
  // A single point at the end of an overlap is part of it.
  std::erase_if(out.crossings, [&](const Crossing& c) {
    return std::any_of(out.overlaps.begin(), out.overlaps.end(), [&](const Overlap& o) {
      return c.s >= o.s0 && c.s <= o.s1 && c.t >= std::min(o.t0, o.t1) &&
             c.t <= std::max(o.t0, o.t1);
    });
  });
  const auto earlier = [](const auto& p, const auto& q) { return p.s < q.s; };
  std::sort(out.crossings.begin(), out.crossings.end(), earlier);
  std::sort(out.overlaps.begin(), out.overlaps.end(),
            [](const Overlap& p, const Overlap& q) { return p.s0 < q.s0; });
}

}  // namespace bezel::geometry_kernel
