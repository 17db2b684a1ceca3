#include "tests/fuzz/intersect_fuzz.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/interval.hpp"

namespace bezel::intersect_fuzz {
namespace {

using Points = std::vector<Vec2>;

[[noreturn]] void broken(const std::string& what, std::span<const Vec2> a,
                         std::span<const Vec2> b) {
  std::ostringstream out;
  out << what << std::hexfloat;
  for (const auto& c : {a, b}) {
    out << "; ";
    for (const Vec2& p : c) out << "{{" << p.x() << ", " << p.y() << "}}, ";
  }
  throw std::logic_error(out.str());
}

/// The largest distance that rounding of the parameters and of de Casteljau explains, for curves
/// divided by their largest coordinate.
double rounding(std::span<const Vec2> a, std::span<const Vec2> b) {
  return 64.0 * static_cast<double>(a.size() + b.size()) * 0x1p-53;
}

class Curves {
 public:
  Curves(std::span<const Vec2> a, std::span<const Vec2> b)
      : a_(a.begin(), a.end()), b_(b.begin(), b.end()) {
    for (const auto* c : {&a_, &b_})
      for (const Vec2& p : *c)
        magnitude_ = std::max({magnitude_, std::fabs(p.x()), std::fabs(p.y())});
    for (auto* c : {&a_, &b_})
      for (Vec2& p : *c)
        for (int x = 0; x < 2; ++x) p[x] = magnitude_ > 0 ? p[x] / magnitude_ : 0.0;
  }
  double magnitude() const { return magnitude_; }
  double distance(double s, double t) const {
    const Vec2 p = bernstein::evaluate(std::span<const Vec2>(a_), s),
               q = bernstein::evaluate(std::span<const Vec2>(b_), t);
    return std::hypot(p.x() - q.x(), p.y() - q.y());
  }

 private:
  Points a_, b_;
  double magnitude_ = 0;
};

}  // namespace

void check(std::span<const Vec2> a, std::span<const Vec2> b, const CurveIntersections& found,
           double distance) {
  const Curves curves(a, b);
  const auto inside = [](double x) { return x >= 0.0 && x <= 1.0; };
  const double allowed =
      rounding(a, b) + (curves.magnitude() > 0 ? 2 * distance / curves.magnitude() : 0.0);
  double before = 0;
  for (const Crossing& c : found.crossings) {
    if (!inside(c.s) || !inside(c.t)) broken("a crossing outside [0, 1]", a, b);
    if (c.s < before) broken("crossings out of order", a, b);
    before = c.s;
    if (!(c.s_lo <= c.s && c.s <= c.s_hi && c.t_lo <= c.t && c.t <= c.t_hi))
      broken("a crossing outside its box", a, b);
    if (c.certified && distance == 0 && !(curves.distance(c.s, c.t) <= allowed))
      broken("a crossing where the curves are apart", a, b);
    if (std::abs(c.sign) > 1 || std::isnan(c.condition)) broken("sign or condition", a, b);
  }
  for (const Tangency& c : found.tangencies) {
    if (!inside(c.s) || !inside(c.t)) broken("a tangency outside [0, 1]", a, b);
    if (distance == 0 && (c.order < 2 || !(curves.distance(c.s, c.t) <= allowed)))
      broken("a tangency without an order, or where the curves are apart", a, b);
  }
  for (const Overlap& o : found.overlaps) {
    if (!inside(o.s0) || !inside(o.s1) || !inside(o.t0) || !inside(o.t1) || !(o.s0 <= o.s1))
      broken("an overlap outside [0, 1]", a, b);
    if (distance == 0 &&
        !(std::max(curves.distance(o.s0, o.t0), curves.distance(o.s1, o.t1)) <= allowed))
      broken("an overlap where the curves are apart", a, b);
  }
  for (const UnresolvedBox& u : found.unresolved)
    if (!inside(u.s_lo) || !inside(u.s_hi) || !inside(u.t_lo) || !inside(u.t_hi) ||
        !(u.s_lo <= u.s_hi) || !(u.t_lo <= u.t_hi) || u.reason.empty())
      broken("an unresolved box outside [0, 1], or without a reason", a, b);
}

bool intersect_bytes(std::span<const std::uint8_t> bytes) {
  const auto byte = [&](std::size_t i) { return i < bytes.size() ? bytes[i] : std::uint8_t{0}; };
  std::size_t at = 3;
  const auto number = [&] {
    double x = 0;
    if (at + sizeof x <= bytes.size()) std::memcpy(&x, bytes.data() + at, sizeof x);
    at += sizeof x;
    return x;
  };
  const auto curve = [&](std::size_t points) {
    Points out(points);
    for (Vec2& p : out) {
      const double x = number(), y = number();
      p = Vec2{{x, y}};
    }
    return out;
  };
  const Points a = curve(byte(0) % 70U), b = curve(byte(1) % 70U);
  IntersectOptions options;
  if (byte(2) != 0) options.coincidence_distance = std::ldexp(1.0, -static_cast<int>(byte(2)));
  CurveIntersections found, exchanged;
  try {
    intersect(a, b, options, found);
  } catch (const InputError&) {
    return false;
  }
  check(a, b, found, options.coincidence_distance);
  if (byte(2) != 0 || !found.unresolved.empty()) return true;
  intersect(b, a, options, exchanged);
  check(b, a, exchanged, 0.0);
  if (exchanged.unresolved.empty() && (found.crossings.size() != exchanged.crossings.size() ||
                                       found.tangencies.size() != exchanged.tangencies.size() ||
                                       found.overlaps.size() != exchanged.overlaps.size()))
    broken("another number of common points when the curves are exchanged", a, b);
  return true;
}

}  // namespace bezel::intersect_fuzz
