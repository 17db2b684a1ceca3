// Curve-curve intersection: rejection, then the exact method, or the one with a distance.

#include <algorithm>
#include <cmath>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/geometry/curve_check.hpp"
#include "bezel/geometry/curve_kernel.hpp"
#include "bezel/geometry/intersect_exact.hpp"
#include "bezel/geometry/intersect_search.hpp"

namespace bezel {

using geometry_kernel::IntersectSearch;

namespace {

/// The control points of `other` all lie on one side of `curve`'s fat line, further than margin.
bool outside_fat_line(const CurveCache& curve, const CurveCache& other, double margin) {
  const Vec2 origin = curve.control.front();
  const double slack = margin * curve.chord_length;
  const double lo = curve.band_lo - slack, hi = curve.band_hi + slack;
  bool below = true, above = true;
  for (const Vec2& p : other.control) {
    const double c = cross(curve.chord, p - origin);
    below = below && c < lo;
    above = above && c > hi;
    if (!below && !above) return false;
  }
  return true;
}

CurveCache checked_box_cache(std::span<const Vec2> control) {
  geometry_kernel::checked_degree(control);
  return geometry_kernel::box_cache(control);
}

/// With a distance, of curves whose products would overflow or vanish: scaled by a power of two.
void intersect_scaled(const CurveCache& a, const CurveCache& b, double tol,
                      CurveIntersections& out) {
  const int exponent = std::ilogb(std::max(a.magnitude, b.magnitude)) + 1;
  const auto scaled = [](const Vec2& p, int by) {
    return Vec2{{std::ldexp(p.x(), by), std::ldexp(p.y(), by)}};
  };
  std::vector<Vec2> c, d;
  for (const Vec2& p : a.control) c.push_back(scaled(p, -exponent));
  for (const Vec2& p : b.control) d.push_back(scaled(p, -exponent));
  // A distance far above the curves, or below their rounding, is as good as any such.
  IntersectOptions options;
  options.coincidence_distance = std::clamp(std::ldexp(tol, -exponent), 0x1p-100, 4.0);
  IntersectSearch(cache_curve(c), cache_curve(d), options, out).run();
  for (Crossing& x : out.crossings) {
    x.point_a = scaled(x.point_a, exponent);
    x.point_b = scaled(x.point_b, exponent);
  }
  for (Overlap& x : out.overlaps) x.gap = std::ldexp(x.gap, exponent);
}

}  // namespace

void intersect(const CurveCache& a, const CurveCache& b, const IntersectOptions& options,
               CurveIntersections& out) {
  out.crossings.clear();
  out.tangencies.clear();
  out.overlaps.clear();
  out.unresolved.clear();
  const double tol = options.coincidence_distance;
  if (!(tol >= 0) || !std::isfinite(tol))
    throw InputError("the coincidence distance must be finite and not negative");
  if (tol == 0.0) {
    if (a.box.overlaps(b.box)) geometry_kernel::intersect_exactly(a, b, out);
    return;
  }
  const double magnitude = std::max(a.magnitude, b.magnitude);
  if (magnitude > 0.0 && !(magnitude > 0x1p-300 && magnitude < 0x1p300)) {
    intersect_scaled(a, b, tol, out);
    return;
  }
  const double margin = std::max(tol, 0x1p-51 * magnitude);
  if (a.box.lo.x() > b.box.hi.x() + margin || b.box.lo.x() > a.box.hi.x() + margin ||
      a.box.lo.y() > b.box.hi.y() + margin || b.box.lo.y() > a.box.hi.y() + margin)
    return;
  // The fat line's own rounding: products of differences, relative to the chord.
  const double slack = margin + 0x1p-50 * std::max(a.box.diameter(), b.box.diameter());
  if (outside_fat_line(a, b, slack) || outside_fat_line(b, a, slack)) return;
  IntersectSearch(a, b, options, out).run();
}

void intersect(std::span<const Vec2> a, std::span<const Vec2> b, const IntersectOptions& options,
               CurveIntersections& out) {
  if (options.coincidence_distance == 0.0)
    intersect(checked_box_cache(a), checked_box_cache(b), options, out);
  else
    intersect(cache_curve(a), cache_curve(b), options, out);
}

CurveIntersections intersect(std::span<const Vec2> a, std::span<const Vec2> b,
                             const IntersectOptions& options) {
  CurveIntersections out;
  intersect(a, b, options, out);
  return out;
}

}  // namespace bezel
