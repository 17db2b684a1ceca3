#pragma once
// Pairs of plane Bezier curves that are hard to intersect, and maps that keep them hard.

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bezel/base/random.hpp"
#include "bezel/numeric/vec.hpp"
#include "support/curve_oracle.hpp"

namespace support {

/// The text, then the number. (Of "text" + std::to_string(i) g++ 12 warns without reason.)
inline std::string numbered(const char* text, int i) {
  std::string out = text;
  out += std::to_string(i);
  return out;
}

using CurvePoints = std::vector<bezel::Vec2>;

/// Two curves, and what is known of their common points without computing.
struct CurvePair {
  std::string name;
  CurvePoints a, b;
  int points = -1;       ///< number of isolated common points; -1: not stated
  int intervals = 0;     ///< number of common intervals, when points are stated
  int multiplicity = 0;  ///< order of contact at all of them; 0: not stated
  std::vector<std::array<mpq_class, 2>> at = {};  ///< all of them, (s, t), when known exactly
};

/// The doubles nearest to rational points (towards zero); `exact` becomes false when one is no
/// double.
inline CurvePoints rounded(const std::vector<RationalPoint>& points, bool* exact = nullptr) {
  CurvePoints out;
  for (const RationalPoint& p : points) {
    out.push_back(bezel::Vec2{{p[0].get_d(), p[1].get_d()}});
    if (exact != nullptr &&
        (p[0] != mpq_class(out.back().x()) || p[1] != mpq_class(out.back().y())))
      *exact = false;
  }
  return out;
}
/// The blossom of degree c.size() - 1 with k arguments s1, the others s0.
inline RationalPoint blossom(std::vector<RationalPoint> c, std::size_t k, const mpq_class& s0,
                             const mpq_class& s1) {
  for (std::size_t d = c.size() - 1; d > 0; --d) {
    const mpq_class& s = d <= k ? s1 : s0;
    for (std::size_t i = 0; i < d; ++i)
      for (std::size_t x = 0; x < 2; ++x) c[i][x] += s * (c[i + 1][x] - c[i][x]);
  }
  return c[0];
}
inline RationalPoint exact_point(const std::vector<RationalPoint>& c, const mpq_class& s) {
  return blossom(c, 0, s, s);
}
/// Control points of c on [s0, s1].
inline std::vector<RationalPoint> exact_part(const CurvePoints& c, const mpq_class& s0,
                                             const mpq_class& s1) {
  std::vector<RationalPoint> out;
  for (std::size_t k = 0; k < c.size(); ++k) out.push_back(blossom(rational_points(c), k, s0, s1));
  return out;
}
inline CurvePoints part(const CurvePoints& c, const mpq_class& s0, const mpq_class& s1) {
  return rounded(exact_part(c, s0, s1));
}
inline CurvePoints elevated(const CurvePoints& c) {
  const std::vector<RationalPoint> p = rational_points(c);
  std::vector<RationalPoint> out(p.size() + 1);
  for (std::size_t i = 0; i < out.size(); ++i)
    for (std::size_t x = 0; x < 2; ++x) {
      mpq_class share(static_cast<unsigned long>(i), static_cast<unsigned long>(p.size()));
      share.canonicalize();
      out[i][x] = 0;
      if (i > 0) out[i][x] += share * p[i - 1][x];
      if (i < p.size()) out[i][x] += (1 - share) * p[i][x];
    }
  return rounded(out);
}
inline CurvePoints reversed(CurvePoints c) {
  std::reverse(c.begin(), c.end());
  return c;
}
inline CurvePoints coordinates_exchanged(CurvePoints c) {
  for (bezel::Vec2& p : c) p = bezel::Vec2{{p.y(), p.x()}};
  return c;
}

/// p -> (x0 p.x + x1 p.y + x2, y0 p.x + y1 p.y + y2).
struct AffineMap {
  std::array<mpq_class, 3> x, y;
  std::vector<RationalPoint> operator()(const CurvePoints& c) const {
    std::vector<RationalPoint> out;
    for (const RationalPoint& p : rational_points(c))
      out.push_back({x[0] * p[0] + x[1] * p[1] + x[2], y[0] * p[0] + y[1] * p[1] + y[2]});
    return out;
  }
};
/// The pair under a map that is exact in double there, with everything known of it kept; nothing
/// when it is not.
inline std::optional<CurvePair> exactly_mapped(CurvePair pair, const AffineMap& map) {
  bool exact = true;
  pair.a = rounded(map(pair.a), &exact);
  pair.b = rounded(map(pair.b), &exact);
  if (!exact) return std::nullopt;
  return pair;
}
/// The pair under a map, rounded: nothing is known of it then.
inline CurvePair roughly_mapped(const CurvePair& pair, const AffineMap& map) {
  return {pair.name, rounded(map(pair.a)), rounded(map(pair.b))};
}
inline CurvePair scaled(CurvePair pair, int exponent) {
  for (CurvePoints* c : {&pair.a, &pair.b})
    for (bezel::Vec2& p : *c)
      p = bezel::Vec2{{std::ldexp(p.x(), exponent), std::ldexp(p.y(), exponent)}};
  return pair;
}
inline AffineMap translation(const mpq_class& x, const mpq_class& y) {
  return {{1, 0, x}, {0, 1, y}};
}
/// Entries with few bits: multiples of 1/4 up to 2, or (every other time) only signs, an exchange
/// and powers of two, which keep full mantissas exact.
inline AffineMap random_dyadic_map(bezel::RandomStream& random) {
  const auto entry = [&] { return mpq_class(static_cast<long>(random.below(17)) - 8, 4); };
  for (;;) {
    AffineMap map;
    if (random.below(2) == 0) {
      for (mpq_class* x : {&map.x[0], &map.x[1], &map.y[0], &map.y[1]}) *x = entry();
      map.x[2] = entry();
      map.y[2] = entry();
    } else {
      const bool exchange = random.below(2) == 0;
      const auto power = [&] {
        const double sign = random.below(2) == 0 ? 1.0 : -1.0;
        return mpq_class(std::ldexp(sign, static_cast<int>(random.below(9)) - 4));
      };
      map.x[exchange ? 1 : 0] = power();
      map.y[exchange ? 0 : 1] = power();
    }
    for (mpq_class* x : {&map.x[0], &map.x[1], &map.x[2], &map.y[0], &map.y[1], &map.y[2]})
      x->canonicalize();
    if (map.x[0] * map.y[1] != map.x[1] * map.y[0]) return map;
  }
}
inline AffineMap random_map(bezel::RandomStream& random) {
  AffineMap map;
  for (auto* row : {&map.x, &map.y})
    for (mpq_class& x : *row) x = random.uniform(-2, 2);
  return map;
}
inline CurvePair exchanged(CurvePair pair) {
  std::swap(pair.a, pair.b);
  for (auto& p : pair.at) std::swap(p[0], p[1]);
  return pair;
}
inline CurvePair with_first_reversed(CurvePair pair) {
  if (pair.a.size() == 1) return pair;
  pair.a = reversed(pair.a);
  for (auto& p : pair.at) p[0] = 1 - p[0];
  return pair;
}

inline const CurvePoints wave_curve{{{-3, -3}}, {{-1, 15}}, {{1, -15}}, {{3, 3}}};
inline const CurvePoints parabola_curve{{{-1, 1}}, {{0, -1}}, {{1, 1}}};  // y = x^2 on [-1, 1]
inline const CurvePoints cubic_curve{{{0, 0}}, {{1, 2}}, {{2, -1}}, {{3, 1}}};
inline const CurvePoints loop_curve{{{0, 0}}, {{2, 1}}, {{-1, 1}}, {{1, 0}}};
inline const CurvePoints cusp_curve{{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}};

inline std::vector<CurvePair> nine_hits() {
  const CurvePoints wide = part(wave_curve, mpq_class(-1, 16), mpq_class(17, 16));
  std::vector<CurvePair> out;
  for (const CurvePoints& c : {wave_curve, wide})
    for (const CurvePoints& d : {wave_curve, wide})
      out.push_back({"nine hits", c, coordinates_exchanged(d), 9, 0, 1});
  return out;
}
/// A parabola and a line 4^-k above its apex, or below.
inline std::vector<CurvePair> near_tangents() {
  std::vector<CurvePair> out;
  for (int k = 4; k <= 26; ++k) {
    const double y = std::ldexp(1.0, -2 * k);
    const std::string name = numbered(" 4^-", k);
    const mpq_class half(1, 2), s(std::ldexp(1.0, -(k + 1)));
    CurvePair above{"near tangent" + name, parabola_curve, {{{-1, y}}, {{1, y}}}, 2, 0, 1};
    above.at = {{half - s, half - s}, {half + s, half + s}};
    out.push_back(above);
    out.push_back({"near tangent -" + name, parabola_curve, {{{-1, -y}}, {{1, -y}}}, 0});
  }
  return out;
}
/// Contact of order 2, 3, 4 in one point, s = 1/2 or 1/3.
inline std::vector<CurvePair> contacts() {
  const CurvePoints axis{{{-1, 0}}, {{1, 0}}};
  const std::array<mpq_class, 2> half{mpq_class(1, 2), mpq_class(1, 2)};
  const CurvePoints third_axis{{{-1, 0}}, {{2, 0}}};
  const std::array<mpq_class, 2> third{mpq_class(1, 3), mpq_class(1, 3)};
  std::vector<CurvePair> out{
      {"contact 2", parabola_curve, axis, 1, 0, 2, {half}},
      {"contact 3",
       {{{-3, -1}}, {{-1, 1}}, {{1, -1}}, {{3, 1}}},
       {{{-3, 0}}, {{3, 0}}},
       1,
       0,
       3,
       {half}},
      {"contact 3, x^3",
       {{{-1, -1}}, {{-1.0 / 3, 1}}, {{1.0 / 3, -1}}, {{1, 1}}},
       axis,
       1,
       0,
       3,
       {half}},
      {"contact 3, x^2 and x^2 + x^3",
       {{{-3, 3}}, {{0, -3}}, {{3, 3}}},
       {{{-3, 0}}, {{-1, 2}}, {{1, -4}}, {{3, 6}}},
       1,
       0,
       3,
       {half}},
      {"contact 4",
       {{{-1, 1}}, {{-0.5, -1}}, {{0, 1}}, {{0.5, -1}}, {{1, 1}}},
       axis,
       1,
       0,
       4,
       {half}},
      {"contact 2 at 1/3", {{{-1, 1}}, {{0.5, -2}}, {{2, 4}}}, third_axis, 1, 0, 2, {third}},
      {"contact 3 at 1/3",
       {{{-1, -1}}, {{0, 2}}, {{1, -4}}, {{2, 8}}},
       third_axis,
       1,
       0,
       3,
       {third}},
      {"contact 4 at 1/3",
       {{{-1, 1}}, {{-0.25, -2}}, {{0.5, 4}}, {{1.25, -8}}, {{2, 16}}},
       third_axis,
       1,
       0,
       4,
       {third}},
  };
  // The same divided by 3 and 3^order: rounded control points.
  for (std::size_t order = 2; order <= 4; ++order) {
    CurvePair pair = out[order + 3];
    const auto scale = mpq_class(1, order == 2 ? 9 : order == 3 ? 27 : 81);
    out.push_back(
        roughly_mapped({pair.name + ", rounded", pair.a, pair.b},
                       {{mpq_class(1, 3), 0, mpq_class(1, 7)}, {0, scale, mpq_class(1, 7)}}));
  }
  return out;
}
/// y = x^2 and y = x^2 + 2^-k (x - 1/4): one crossing, of condition about 2^k.
inline std::vector<CurvePair> sheared() {
  std::vector<CurvePair> out;
  const std::array<mpq_class, 2> at{mpq_class(5, 8), mpq_class(5, 8)};
  for (int k = 4; k <= 50; ++k) {
    const double e = std::ldexp(1.0, -k);
    out.push_back({numbered("shear 2^-", k),
                   parabola_curve,
                   {{{-1, 1 - 1.25 * e}}, {{0, -1 - 0.25 * e}}, {{1, 1 + 0.75 * e}}},
                   1,
                   0,
                   1,
                   {at}});
  }
  return out;
}
inline std::vector<CurvePair> overlaps() {
  const CurvePoints& c = cubic_curve;
  const mpq_class quarter(1, 4), half(1, 2);
  std::vector<CurvePair> out{
      {"overlap, part beyond", c, part(c, quarter, mpq_class(5, 4)), 0, 1},
      {"overlap, inner part", c, part(c, quarter, mpq_class(3, 4)), 0, 1},
      {"overlap, reversed", c, reversed(c), 0, 1},
      {"overlap, elevated", c, elevated(c), 0, 1},
      {"overlap, part, reversed and elevated", c,
       elevated(reversed(part(c, quarter, mpq_class(5, 4)))), 0, 1},
      {"overlap, parabola and extension", parabola_curve, part(parabola_curve, -half, 3 * half), 0,
       1},
      {"overlap, lines", {{{0, 0}}, {{2, 1}}}, {{{1, 0.5}}, {{4, 2}}}, 0, 1},
      {"overlap, parabola elevated, rounded", parabola_curve, elevated(parabola_curve)},
      {"overlap, third part, rounded", c, part(c, mpq_class(1, 3), mpq_class(4, 3))},
  };
  out.push_back({"identical cubics", c, c, 0, 1});
  out.push_back({"identical parabolas", parabola_curve, parabola_curve, 0, 1});
  out.push_back({"identical waves", wave_curve, wave_curve, 0, 1});
  return out;
}
/// Cusps, double points, end points, curves that are points.
inline std::vector<CurvePair> singular_and_ends() {
  const CurvePoints &loop = loop_curve, &cusp = cusp_curve, &c = cubic_curve;
  const mpq_class half(1, 2);
  const CurvePoints middle{{{-1, 0.5}}, {{2, 0.5}}};
  const CurvePoints still{{{0.5, 0.25}}, {{0.5, 0.25}}, {{0.5, 0.25}}};
  const CurvePoints on_cubic = part(c, mpq_class(3, 8), 1);  // starts on the cubic
  return {
      {"loop and line", loop, middle, 2},
      {"loop through its double point", loop, {{{0.5, -1}}, {{0.5, 2}}}, 3},
      {"loop and itself", loop, loop, 2, 1},
      {"cusp and line", cusp, middle, 2},
      {"cusp on line", cusp, {{{-1, 0.75}}, {{2, 0.75}}}, 1, 0, 2},
      {"cusp on its tangent", cusp, {{{0.5, 0}}, {{0.5, 2}}}, 1, 0, 3},
      {"cusp missed", cusp, {{{-1, 0.75 + 0x1p-30}}, {{2, 0.75 + 0x1p-30}}}, 0},
      {"cusp and itself", cusp, cusp, 0, 1},
      {"joint on one cubic", c, part(c, 1, 2), 1, 0, 0, {{1, 0}}},
      {"smooth joint", c, {{{3, 1}}, {{4, 3}}, {{5, 0}}}, 1, 0, 0, {{1, 0}}},
      {"end on the interior",
       {{{0, 0}}, {{4, 0}}},
       {{{1, 0}}, {{1, 1}}, {{2, 3}}},
       1,
       0,
       1,
       {{mpq_class(1, 4), 0}}},
      {"end touching the interior",
       parabola_curve,
       {{{0, 0}}, {{1, 0}}, {{2, -1}}},
       1,
       0,
       2,
       {{half, 0}}},
      {"end on a cubic", c, {on_cubic.front(), {{2, 2}}, {{3, 3}}}, -1},
      {"point on line", {{{0, 0}}, {{1, 0.5}}}, {{{0.5, 0.25}}}, 1, 0, 0, {{half, 0}}},
      {"resting point on line", {{{0, 0}}, {{1, 0.5}}}, still, 1, 0, 0, {{half, 0}}},
      {"point beside line", {{{0, 0}}, {{1, 0.5}}}, {{{0.5, 0.3}}}, 0},
      {"point on itself", {{{0.5, 0.3}}}, {{{0.5, 0.3}}}, 1, 0, 0, {{0, 0}}},
  };
}

/// Control points uniform in the unit square.
inline CurvePoints random_curve(bezel::RandomStream& random, int degree) {
  CurvePoints out;
  for (int i = 0; i <= degree; ++i) {
    const double x = random.uniform(), y = random.uniform();
    out.push_back(bezel::Vec2{{x, y}});
  }
  return out;
}

/// A random curve whose control points are multiples of 2^-bits.
inline CurvePoints coarse_random_curve(bezel::RandomStream& random, int degree, int bits) {
  CurvePoints out = random_curve(random, degree);
  for (bezel::Vec2& p : out)
    p = bezel::Vec2{{std::ldexp(std::floor(std::ldexp(p.x(), bits)), -bits),
                     std::ldexp(std::floor(std::ldexp(p.y(), bits)), -bits)}};
  return out;
}
/// Nearly the same curve: every coordinate moved by up to 2^-bits.
inline CurvePoints jittered(CurvePoints c, bezel::RandomStream& random, int bits) {
  const double size = std::ldexp(1.0, -bits);
  for (bezel::Vec2& p : c) {
    const double x = random.uniform(-size, size), y = random.uniform(-size, size);
    p += bezel::Vec2{{x, y}};
  }
  return c;
}
/// b begins where a ends, in the same direction up to rounding when `smooth`.
inline CurvePair random_joint(bezel::RandomStream& random, int degree, bool smooth) {
  CurvePair pair{"joint", random_curve(random, degree), random_curve(random, degree)};
  const std::size_t last = pair.a.size() - 1;
  pair.b[0] = pair.a[last];
  if (smooth) pair.b[1] = pair.a[last] + 0.5 * (pair.a[last] - pair.a[last - 1]);
  return pair;
}

}  // namespace support
