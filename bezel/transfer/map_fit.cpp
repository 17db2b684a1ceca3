// Maps of curved elements and their inverses, and edges, at many points.

#include "bezel/transfer/region_fit.hpp"

#include <array>
#include <cmath>

#include "bezel/bernstein/index.hpp"

// Few targets, for the sake of those who build this.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bezel/transfer/map_fit.cpp"
#include "hwy/foreach_target.h"
// clang-format off
#include "hwy/highway.h"
// clang-format on
#include "bezel/transfer/vector_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace bezel::detail::HWY_NAMESPACE {

/// Value and derivatives of sum c[a, b] u^a v^b. G: the degree when known at compile time, or -1.
template <int G>
HWY_INLINE void horner(int degree, const double* c, const Lanes& u, const Lanes& v, Lanes& value,
                       Lanes& du, Lanes& dv) {
  const int g = G > 0 ? G : degree;
  value = Lanes{} + c[bernstein::triangle_index(g, 0, g)];
  du = dv = Lanes{};
#pragma GCC unroll 4
  for (int b = g - 1; b >= 0; --b) {
    const double* row = c + bernstein::triangle_index(g, 0, b);
    Lanes r = Lanes{} + row[g - b], slope{};
#pragma GCC unroll 4
    for (int a = g - b - 1; a >= 0; --a) {
      slope = slope * u + r;
      r = r * u + row[a];
    }
    dv = dv * v + value;
    value = value * v + r;
    du = du * v + slope;
  }
}

template <int G>
void map_of(const MapPolynomial& map, std::size_t blocks, const double* u, const double* v,
            double* x, double* y, double* det) {
  for (std::size_t at = 0; at < blocks * lanes; at += lanes) {
    const Lanes s = load(u + at) - map.centre, t = load(v + at) - map.centre;
    Lanes px, py, xu, xv, yu, yv;
    horner<G>(map.degree, map.x.data(), s, t, px, xu, xv);
    horner<G>(map.degree, map.y.data(), s, t, py, yu, yv);
    store(px + map.base.x(), x + at);
    store(py + map.base.y(), y + at);
    if (det != nullptr) store(xu * yv - xv * yu, det + at);
  }
}

/// B blocks at once, for one alone waits for each of its own results.
template <int G, std::size_t B>
HWY_INLINE bool invert_blocks(const MapPolynomial& map, const double* x, const double* y, double* u,
                              double* v, double* dx, double* dy) {
  constexpr int most_steps = 12;
  constexpr double converged = 0x1p-56;  // of the squared step: the next is its square
  const int g = map.degree;
  const double *cx = map.x.data(), *cy = map.y.data();
  const int first = bernstein::triangle_index(g, 1, 0), second = bernstein::triangle_index(g, 0, 1);
  const double xu0 = cx[first], xv0 = cx[second], yu0 = cy[first], yv0 = cy[second];
  const double det0 = xu0 * yv0 - xv0 * yu0;
  if (!(det0 > 0.0)) return false;
  const double scale = 1.0 / det0;
  Lanes px[B], py[B], s[B], t[B], wx[B], wy[B], xu[B], xv[B], yu[B], yv[B];
  for (std::size_t i = 0; i < B; ++i) {
    px[i] = load(x + i * lanes) - map.base.x();
    py[i] = load(y + i * lanes) - map.base.y();
    s[i] = (px[i] * yv0 - py[i] * xv0) * scale;
    t[i] = (py[i] * xu0 - px[i] * yu0) * scale;
  }
  bool done = G == 1;
  for (int step = 0; step < most_steps && !done; ++step) {
    for (std::size_t i = 0; i < B; ++i) {
      horner<G>(g, cx, s[i], t[i], wx[i], xu[i], xv[i]);
      horner<G>(g, cy, s[i], t[i], wy[i], yu[i], yv[i]);
    }
    auto good = Lanes{} == Lanes{};
    for (std::size_t i = 0; i < B; ++i) {
      const Lanes det = xu[i] * yv[i] - xv[i] * yu[i], inverse = 1.0 / det;
      const Lanes rx = px[i] - wx[i], ry = py[i] - wy[i];
      const Lanes ds = (rx * yv[i] - ry * xv[i]) * inverse;
      const Lanes dt = (ry * xu[i] - rx * yu[i]) * inverse;
      s[i] += ds;
      t[i] += dt;
      good = good & ((ds * ds + dt * dt <= converged) & (det > 0.0));
    }
    done =
        ((good[0] & good[1]) & (good[2] & good[3])) & ((good[4] & good[5]) & (good[6] & good[7]));
  }
  if (!done) return false;
  for (std::size_t i = 0; i < B; ++i) {
    const std::size_t at = i * lanes;
    store(s[i] + map.centre, u + at);
    store(t[i] + map.centre, v + at);
    if (dx == nullptr) continue;
    horner<G>(g, cx, s[i], t[i], wx[i], xu[i], xv[i]);
    horner<G>(g, cy, s[i], t[i], wy[i], yu[i], yv[i]);
    const Lanes inverse = 1.0 / (xu[i] * yv[i] - xv[i] * yu[i]);
    const Lanes ax = load(dx + at), ay = load(dy + at);
    store((ax * yv[i] - ay * xv[i]) * inverse, dx + at);
    store((ay * xu[i] - ax * yu[i]) * inverse, dy + at);
  }
  return true;
}

template <int G>
bool invert_of(const MapPolynomial& map, std::size_t blocks, const double* x, const double* y,
               double* u, double* v, double* dx, double* dy) {
  const auto from = [](double* p, std::size_t at) { return p == nullptr ? nullptr : p + at; };
  std::size_t block = 0;
  for (; block + 2 <= blocks; block += 2) {
    const std::size_t at = block * lanes;
    if (!invert_blocks<G, 2>(map, x + at, y + at, u + at, v + at, from(dx, at), from(dy, at)))
      return false;
  }
  const std::size_t at = block * lanes;
  return block == blocks ||
         invert_blocks<G, 1>(map, x + at, y + at, u + at, v + at, from(dx, at), from(dy, at));
}

void map_target(const MapPolynomial& map, std::size_t blocks, const double* u, const double* v,
                double* x, double* y, double* det) {
  if (map.degree == 1) return map_of<1>(map, blocks, u, v, x, y, det);
  if (map.degree == 2) return map_of<2>(map, blocks, u, v, x, y, det);
  if (map.degree == 3) return map_of<3>(map, blocks, u, v, x, y, det);
  return map_of<-1>(map, blocks, u, v, x, y, det);
}

bool invert_target(const MapPolynomial& map, std::size_t blocks, const double* x, const double* y,
                   double* u, double* v, double* dx, double* dy) {
  if (map.degree == 1) return invert_of<1>(map, blocks, x, y, u, v, dx, dy);
  if (map.degree == 2) return invert_of<2>(map, blocks, x, y, u, v, dx, dy);
  if (map.degree == 3) return invert_of<3>(map, blocks, x, y, u, v, dx, dy);
  return invert_of<-1>(map, blocks, x, y, u, v, dx, dy);
}

template <int G>
HWY_INLINE void curve_of(int degree, const double* px, const double* py, double from, double step,
                         std::size_t blocks, const double* node, const double* weight, double* x,
                         double* y, double* dx, double* dy) {
  const int g = G > 0 ? G : degree;
  for (std::size_t at = 0; at < blocks * lanes; at += lanes) {
    const Lanes r = from + step * load(node + at), left = 1.0 - r;
    const Lanes scale = (g * step) * load(weight + at);
    Lanes a[(G > 0 ? G : max_fit_map) + 1], b[(G > 0 ? G : max_fit_map) + 1];
    for (int i = 0; i <= g; ++i) {
      a[i] = Lanes{} + px[i];
      b[i] = Lanes{} + py[i];
    }
    for (int level = g; level > 1; --level) {
      for (int i = 0; i < level; ++i) {
        a[i] = left * a[i] + r * a[i + 1];
        b[i] = left * b[i] + r * b[i + 1];
      }
    }
    store(left * a[0] + r * a[1], x + at);
    store(left * b[0] + r * b[1], y + at);
    store((a[1] - a[0]) * scale, dx + at);
    store((b[1] - b[0]) * scale, dy + at);
  }
}

void curve_target(int degree, const double* px, const double* py, double from, double step,
                  std::size_t blocks, const double* node, const double* weight, double* x,
                  double* y, double* dx, double* dy) {
  if (degree == 1)
    return curve_of<1>(degree, px, py, from, step, blocks, node, weight, x, y, dx, dy);
  if (degree == 2)
    return curve_of<2>(degree, px, py, from, step, blocks, node, weight, x, y, dx, dy);
  if (degree == 3)
    return curve_of<3>(degree, px, py, from, step, blocks, node, weight, x, y, dx, dy);
  return curve_of<-1>(degree, px, py, from, step, blocks, node, weight, x, y, dx, dy);
}

}  // namespace bezel::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bezel::detail {

HWY_EXPORT(map_target);
HWY_EXPORT(invert_target);
HWY_EXPORT(curve_target);

void fit_map(const MapPolynomial& map, std::size_t blocks, const double* u, const double* v,
             double* x, double* y, double* det) {
  HWY_DYNAMIC_DISPATCH(map_target)(map, blocks, u, v, x, y, det);
}

bool fit_invert(const MapPolynomial& map, std::size_t blocks, const double* x, const double* y,
                double* u, double* v, double* dx, double* dy) {
  return HWY_DYNAMIC_DISPATCH(invert_target)(map, blocks, x, y, u, v, dx, dy);
}

void fit_curve(std::span<const Vec2> control, const Vec2& origin, double from, double step,
               std::size_t blocks, const double* node, const double* weight, double* x, double* y,
               double* dx, double* dy) {
  std::array<double, max_fit_map + 1> px, py;
  for (std::size_t i = 0; i < control.size(); ++i) {
    px[i] = control[i].x() - origin.x();
    py[i] = control[i].y() - origin.y();
  }
  HWY_DYNAMIC_DISPATCH(curve_target)
  (static_cast<int>(control.size()) - 1, px.data(), py.data(), from, step, blocks, node, weight, x,
   y, dx, dy);
}

}  // namespace bezel::detail
#endif
