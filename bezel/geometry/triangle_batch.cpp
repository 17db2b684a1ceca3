// The inverse of one triangle's map at many points: SIMD lanes are points, each lane does what
// `invert` and `locate` do for one point, with the same products and sums in the same order and
// without fused products, so every target gives their bits. Lanes that need more than plain Newton
// steps are left to them.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/geometry/triangle_check.hpp"
#include "bezel/geometry/triangle_hull.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/geometry/triangle_batch.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bezel::HWY_NAMESPACE {
namespace {

using geometry_kernel::LocateSetup;
using geometry_kernel::TriangleNet;

#if HWY_HAVE_SCALABLE  // vectors of unknown size cannot be kept in arrays
std::size_t invert_vectors(const TriangleNet&, const Vec2*, const Lambda*, std::size_t,
                           InverseResult*, std::uint8_t*) {
  return 0;
}
std::size_t locate_vectors(const TriangleNet&, const LocateSetup&, const Vec2*, std::size_t,
                           LocateResult*, std::uint8_t*) {
  return 0;
}
#else
namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::ScalableTag<double>;
using V = hn::Vec<Lanes>;
using M = hn::Mask<Lanes>;
constexpr Lanes tag;
constexpr std::size_t max_lanes = hn::MaxLanes(tag);
constexpr int group = 2;  // vectors of points at a time: they hide each other's latency
constexpr std::size_t group_points = group * max_lanes;

HWY_INLINE V set(double x) {
  return hn::Set(tag, x);
}

/// a x b
HWY_INLINE V cross_of(V ax, V ay, V bx, V by) {
  return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx));
}

/// The map minus a point per lane, and its derivatives; as geometry_kernel::map_gradient. Any
/// degree up to G; known to the compiler up to 4.
template <int G>
struct MapMinusPoints {
  static constexpr int size = bernstein::triangle_size(G),
                       low_size = bernstein::triangle_size(G - 1);
  int run_time_degree;
  V qx[size], qy[size];
  V side_x[2], side_y[2];  // the derivatives of an affine map
  V x, y, du_x, du_y, dv_x, dv_y;

  HWY_INLINE void start(const TriangleNet& t, V px, V py) {
    run_time_degree = t.degree;
    const int n = G <= 4 ? size : bernstein::triangle_size(t.degree);
    for (int i = 0; i < n; ++i) {
      qx[i] = hn::Sub(set(t.control[i].x()), px);
      qy[i] = hn::Sub(set(t.control[i].y()), py);
    }
    if (G == 1)
      for (int k = 0; k < 2; ++k) {
        const Vec2 d = t.control[k + 1] - t.control[0];
        side_x[k] = set(d.x());
        side_y[k] = set(d.y());
      }
  }

  HWY_INLINE void at(V u, V v) {
    if constexpr (G == 1) {
      du_x = side_x[0];
      du_y = side_y[0];
      dv_x = side_x[1];
      dv_y = side_y[1];
      x = hn::Add(hn::Add(qx[0], hn::Mul(u, du_x)), hn::Mul(v, dv_x));
      y = hn::Add(hn::Add(qy[0], hn::Mul(u, du_y)), hn::Mul(v, dv_y));
    } else {
      const V w = hn::Sub(hn::Sub(set(1.0), u), v);
      coordinate(qx, w, u, v, x, du_x, dv_x);
      coordinate(qy, w, u, v, y, du_y, dv_y);
    }
  }

 private:
  HWY_INLINE static V combine(V w, V u, V v, V a, V b, V c) {
    return hn::Add(hn::Add(hn::Mul(w, a), hn::Mul(u, b)), hn::Mul(v, c));
  }
  HWY_INLINE void coordinate(const V* q, V w, V u, V v, V& value, V& du, V& dv) const {
    const int g = G <= 4 ? G : run_time_degree;
    V r[low_size < 3 ? 3 : low_size];
    const V* read = q;
    for (int d = g; d >= 2; --d) {
      int at = 0, low = 0;  // rows of degree d-1 (written) and d (read)
      for (int k = 0; k < d; ++k) {
        const int high = low + (d - k) + 1;
        for (int j = 0; j < d - k; ++j, ++at)
          r[at] = combine(w, u, v, read[low + j], read[low + j + 1], read[high + j]);
        low = high;
      }
      read = r;
    }
    const V f = set(g);
    value = combine(w, u, v, r[0], r[1], r[2]);
    du = hn::Mul(f, hn::Sub(r[1], r[0]));
    dv = hn::Mul(f, hn::Sub(r[2], r[0]));
  }
};

/// Newton's method from u, v, which become the result where `converged`; elsewhere `invert` has to
/// begin again.
template <int G>
HWY_INLINE void newton(MapMinusPoints<G>* map, V* u, V* v, M* converged) {
  constexpr int most_steps = 16;  // the slowest lane keeps the others waiting
  V best[group];
  M active[group];
  for (int n = 0; n < group; ++n) {
    best[n] = set(hwy::HighestValue<double>());
    active[n] = hn::Le(set(0.0), set(0.0));
    converged[n] = hn::Lt(set(0.0), set(0.0));
  }
  for (int step = 0; step < most_steps; ++step) {
    bool any = false;
    for (int n = 0; n < group; ++n) {
      MapMinusPoints<G>& f = map[n];
      f.at(u[n], v[n]);
      const V residual = hn::Add(hn::Mul(f.x, f.x), hn::Mul(f.y, f.y));
      const V det = cross_of(f.du_x, f.du_y, f.dv_x, f.dv_y);
      const V inverse = hn::Div(set(1.0), det);
      const V step_u = hn::Mul(cross_of(f.x, f.y, f.dv_x, f.dv_y), inverse);
      const V step_v = hn::Mul(cross_of(f.du_x, f.du_y, f.x, f.y), inverse);
      const V length_u = hn::Abs(step_u), length_v = hn::Abs(step_v);
      M good = hn::And(active[n], hn::Le(residual, best[n]));
      good = hn::And(good, hn::Ne(det, set(0.0)));
      good = hn::And(good, hn::And(hn::Lt(length_u, set(1e6)), hn::Lt(length_v, set(1e6))));
      best[n] = residual;
      u[n] = hn::IfThenElse(good, hn::Sub(u[n], step_u), u[n]);
      v[n] = hn::IfThenElse(good, hn::Sub(v[n], step_v), v[n]);
      const M small = hn::And(hn::Le(length_u, set(4e-9)), hn::Le(length_v, set(4e-9)));
      converged[n] = hn::Or(converged[n], hn::And(good, small));
      active[n] = hn::AndNot(small, good);
      any = any || !hn::AllFalse(tag, active[n]);
    }
    if (!any) break;
  }
}

/// Whole groups of points, padded with the last one; p_x and so on hold group_points numbers.
template <class Run>
HWY_INLINE void for_groups(const Vec2* p, std::size_t count, const Run& run) {
  const std::size_t lanes = hn::Lanes(tag), together = group * lanes;
  for (std::size_t q = 0; q < count; q += together) {
    const std::size_t here = std::min(together, count - q);
    HWY_ALIGN double x[group_points], y[group_points];
    for (std::size_t i = 0; i < together; ++i) {
      const Vec2& point = p[q + std::min(i, here - 1)];
      x[i] = point.x();
      y[i] = point.y();
    }
    V px[group], py[group];
    for (int n = 0; n < group; ++n) {
      px[n] = hn::Load(tag, x + static_cast<std::size_t>(n) * lanes);
      py[n] = hn::Load(tag, y + static_cast<std::size_t>(n) * lanes);
    }
    run(q, here, px, py);
  }
}
HWY_INLINE void store(const V* from, double* to) {
  for (int n = 0; n < group; ++n)
    hn::Store(from[n], tag, to + static_cast<std::size_t>(n) * hn::Lanes(tag));
}
HWY_INLINE void store(const M* from, double* to) {
  V ones[group];
  for (int n = 0; n < group; ++n) ones[n] = hn::IfThenElseZero(from[n], set(1.0));
  store(ones, to);
}

template <int G>
void invert_degree(const TriangleNet& t, const Vec2* p, const Lambda* start, std::size_t count,
                   InverseResult* out, std::uint8_t* left) {
  for_groups(p, count, [&](std::size_t q, std::size_t here, const V* px, const V* py) {
    HWY_ALIGN double s[3][group_points];
    const std::size_t lanes = hn::Lanes(tag);
    for (std::size_t i = 0; i < group * lanes; ++i) {
      const Lambda& from = start[q + std::min(i, here - 1)];
      s[1][i] = from[1];
      s[2][i] = from[2];
    }
    MapMinusPoints<G> map[group];
    V u[group], v[group], w[group];
    M converged[group];
    for (int n = 0; n < group; ++n) {
      map[n].start(t, px[n], py[n]);
      u[n] = hn::Load(tag, s[1] + static_cast<std::size_t>(n) * lanes);
      v[n] = hn::Load(tag, s[2] + static_cast<std::size_t>(n) * lanes);
    }
    newton(map, u, v, converged);
    for (int n = 0; n < group; ++n) w[n] = hn::Sub(hn::Sub(set(1.0), u[n]), v[n]);
    HWY_ALIGN double good[group_points];
    store(w, s[0]);
    store(u, s[1]);
    store(v, s[2]);
    store(converged, good);
    for (std::size_t i = 0; i < here; ++i) {
      out[q + i] = {{s[0][i], s[1][i], s[2][i]}, true};
      left[q + i] = good[i] == 0.0;
    }
  });
}

/// std::clamp(x, 0, 1)
HWY_INLINE V clamp_unit(V x) {
  const V zero = hn::Zero(tag), one = set(1.0);
  return hn::IfThenElse(hn::Lt(x, zero), zero, hn::IfThenElse(hn::Lt(one, x), one, x));
}
/// std::max(0, x)
HWY_INLINE V not_negative(V x) {
  const V zero = hn::Zero(tag);
  return hn::IfThenElse(hn::Lt(zero, x), x, zero);
}

/// Outside the hull of the control points, as `locate` has it.
HWY_INLINE M separated(const LocateSetup& setup, V px, V py) {
  const geometry_kernel::HullMargin& m = setup.margin;
  const V x = hn::Abs(px), y = hn::Abs(py);
  const V far = hn::IfThenElse(hn::Lt(x, y), y, x);
  const V near = hn::IfThenElseZero(hn::Lt(far, set(m.far_at)), far);
  const V margin = hn::Add(set(m.fixed), hn::Mul(set(0x1p-50), hn::Add(set(m.extent), near)));
  M out = hn::Lt(px, hn::Sub(set(setup.box.lo.x()), margin));
  out = hn::Or(out, hn::Lt(hn::Add(set(setup.box.hi.x()), margin), px));
  out = hn::Or(out, hn::Lt(py, hn::Sub(set(setup.box.lo.y()), margin)));
  out = hn::Or(out, hn::Lt(hn::Add(set(setup.box.hi.y()), margin), py));
  for (const geometry_kernel::SideRange& r : setup.side) {
    const V at = cross_of(set(r.chord.x()), set(r.chord.y()), hn::Sub(px, set(r.from.x())),
                          hn::Sub(py, set(r.from.y())));
    const V slack = hn::Mul(margin, set(r.length));
    out = hn::Or(out, hn::Lt(at, hn::Sub(set(r.lo), slack)));
    out = hn::Or(out, hn::Lt(hn::Add(set(r.hi), slack), at));
  }
  return out;
}

/// The barycentrics in the triangle of the corners, moved into it; as
/// geometry_kernel::corner_start.
HWY_INLINE void corner_start(const geometry_kernel::CornerFrame& f, V px, V py, V& u, V& v) {
  if (f.det == 0) {
    u = v = set(1.0 / 3);
    return;
  }
  const V x = hn::Sub(px, set(f.origin.x())), y = hn::Sub(py, set(f.origin.y()));
  const V det = set(f.det), one = set(1.0), half = set(0.5);
  u = clamp_unit(hn::Div(cross_of(x, y, set(f.dv.x()), set(f.dv.y())), det));
  v = clamp_unit(hn::Div(cross_of(set(f.du.x()), set(f.du.y()), x, y), det));
  const V sum = hn::Add(u, v);
  const M beyond = hn::Lt(one, sum);
  const V excess = hn::Mul(half, hn::Sub(sum, one));
  u = hn::IfThenElse(beyond, not_negative(hn::Sub(u, excess)), u);
  v = hn::IfThenElse(beyond, not_negative(hn::Sub(v, excess)), v);
}

template <int G>
void locate_degree(const TriangleNet& t, const LocateSetup& setup, const Vec2* p, std::size_t count,
                   LocateResult* out, std::uint8_t* left) {
  for_groups(p, count, [&](std::size_t q, std::size_t here, const V* px, const V* py) {
    MapMinusPoints<G> map[group];
    V u[group], v[group], w[group], residual[group];
    M converged[group], outside[group], inside[group];
    for (int n = 0; n < group; ++n) {
      map[n].start(t, px[n], py[n]);
      corner_start(setup.corners, px[n], py[n], u[n], v[n]);
      outside[n] = separated(setup, px[n], py[n]);
    }
    newton(map, u, v, converged);
    const V third = set(1.0 / 3), least = set(-setup.tolerance);
    for (int n = 0; n < group; ++n) {
      w[n] = hn::Sub(hn::Sub(set(1.0), u[n]), v[n]);
      inside[n] = hn::And(hn::Le(least, w[n]), hn::And(hn::Le(least, u[n]), hn::Le(least, v[n])));
      inside[n] = hn::And(converged[n], inside[n]);
      w[n] = hn::IfThenElse(outside[n], third, w[n]);
      u[n] = hn::IfThenElse(outside[n], third, u[n]);
      v[n] = hn::IfThenElse(outside[n], third, v[n]);
      inside[n] = hn::AndNot(outside[n], inside[n]);
      // What converged to a place outside an affine map's triangle is outside.
      if (G == 1) outside[n] = hn::Or(outside[n], converged[n]);
      map[n].at(u[n], v[n]);
      residual[n] = hn::Sqrt(hn::Add(hn::Mul(map[n].x, map[n].x), hn::Mul(map[n].y, map[n].y)));
    }
    HWY_ALIGN double lambda[3][group_points], distance[group_points], in[group_points],
        beyond[group_points];
    store(w, lambda[0]);
    store(u, lambda[1]);
    store(v, lambda[2]);
    store(residual, distance);
    store(inside, in);
    store(outside, beyond);
    for (std::size_t i = 0; i < here; ++i) {
      out[q + i] = {in[i] != 0.0 ? Location::inside : Location::outside,
                    {lambda[0][i], lambda[1][i], lambda[2][i]},
                    distance[i]};
      left[q + i] = in[i] == 0.0 && beyond[i] == 0.0;
    }
  });
}

constexpr int largest_degree = 10;

std::size_t invert_vectors(const TriangleNet& t, const Vec2* p, const Lambda* start,
                           std::size_t count, InverseResult* out, std::uint8_t* left) {
  if (t.degree > largest_degree) return 0;
  using Invert = void(const TriangleNet&, const Vec2*, const Lambda*, std::size_t, InverseResult*,
                      std::uint8_t*);
  constexpr Invert* known[] = {invert_degree<1>, invert_degree<2>, invert_degree<3>,
                               invert_degree<4>, invert_degree<largest_degree>};
  known[std::min(t.degree, 5) - 1](t, p, start, count, out, left);
  return count;
}

std::size_t locate_vectors(const TriangleNet& t, const LocateSetup& setup, const Vec2* p,
                           std::size_t count, LocateResult* out, std::uint8_t* left) {
  if (t.degree > largest_degree) return 0;
  using Locate = void(const TriangleNet&, const LocateSetup&, const Vec2*, std::size_t,
                      LocateResult*, std::uint8_t*);
  constexpr Locate* known[] = {locate_degree<1>, locate_degree<2>, locate_degree<3>,
                               locate_degree<4>, locate_degree<largest_degree>};
  known[std::min(t.degree, 5) - 1](t, setup, p, count, out, left);
  return count;
}
#endif

}  // namespace
}  // namespace bezel::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel {
namespace {

HWY_EXPORT(invert_vectors);
HWY_EXPORT(locate_vectors);

constexpr std::size_t chunk = 256;  // points between whose flags are looked at

void check_size(std::size_t found, std::size_t expected, const char* what) {
  if (found != expected)
    throw InputError("found " + std::to_string(found) + " " + what + ", expected " +
                     std::to_string(expected));
}

}  // namespace

void invert(int g, std::span<const Vec2> control, std::span<const Vec2> p,
            std::span<const Lambda> start, std::span<InverseResult> out) {
  geometry_kernel::check_triangle(g, control, bernstein::max_triangle_degree);
  check_size(start.size(), p.size(), "starts");
  check_size(out.size(), p.size(), "places for results");
  const geometry_kernel::TriangleNet triangle{g, control.data()};
  std::uint8_t left[chunk];
  for (std::size_t q = 0; q < p.size(); q += chunk) {
    const std::size_t here = std::min(chunk, p.size() - q);
    std::fill(left, left + here, std::uint8_t{1});
    HWY_DYNAMIC_DISPATCH(invert_vectors)
    (triangle, p.data() + q, start.data() + q, here, out.data() + q, left);
    for (std::size_t i = 0; i < here; ++i)
      if (left[i] != 0) out[q + i] = invert(g, control, p[q + i], start[q + i]);
  }
}

void locate(int g, std::span<const Vec2> control, std::span<const Vec2> p,
            std::span<LocateResult> out, double tolerance) {
  geometry_kernel::check_triangle(g, control, bernstein::max_triangle_degree);
  geometry_kernel::check_tolerance(tolerance);
  check_size(out.size(), p.size(), "places for results");
  for (std::size_t i = 0; i < p.size(); ++i)
    if (!std::isfinite(p[i].x()) || !std::isfinite(p[i].y()))
      throw InputError("point " + std::to_string(i) + " to locate is not finite");
  const geometry_kernel::TriangleNet triangle{g, control.data()};
  const geometry_kernel::LocateSetup setup(triangle, tolerance);
  std::uint8_t left[chunk];
  for (std::size_t q = 0; q < p.size(); q += chunk) {
    const std::size_t here = std::min(chunk, p.size() - q);
    std::fill(left, left + here, std::uint8_t{1});
    HWY_DYNAMIC_DISPATCH(locate_vectors)
    (triangle, setup, p.data() + q, here, out.data() + q, left);
    for (std::size_t i = 0; i < here; ++i)
      if (left[i] != 0) out[q + i] = locate(g, control, p[q + i], tolerance);
  }
}

}  // namespace bezel
#endif  // HWY_ONCE
