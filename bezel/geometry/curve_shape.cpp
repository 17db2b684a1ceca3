#include "bezel/geometry/curve_shape.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/exact.hpp"
#include "bezel/bernstein/interval.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/bernstein/roots.hpp"
#include "bezel/geometry/curve_check.hpp"
#include "bezel/geometry/curve_incidence.hpp"
#include "bezel/numeric/double_double.hpp"
#include "bezel/numeric/dyadic.hpp"
#include "bezel/numeric/quadrature.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {

using bernstein::ExactPolynomial;
using geometry_kernel::check_parameter;
using geometry_kernel::checked_degree;

std::vector<Vec2> hodograph(std::span<const Vec2> curve) {
  checked_degree(curve);
  return bernstein::differentiate(curve);
}

std::vector<Vec2> specialize(std::span<const Vec2> curve, double s0, double s1) {
  checked_degree(curve);
  check_parameter(s0);
  check_parameter(s1);
  return bernstein::specialize(curve, s0, s1);
}

std::pair<std::vector<Vec2>, std::vector<Vec2>> split(std::span<const Vec2> curve, double s) {
  checked_degree(curve);
  if (!(s >= 0.0 && s <= 1.0))
    throw InputError("split at " + std::to_string(s) + ", expected a parameter from 0 to 1");
  return bernstein::subdivide(curve, s);
}

std::vector<Vec2> elevate(std::span<const Vec2> curve, int by) {
  checked_degree(curve);
  return bernstein::elevate(curve, by);
}

ReducedCurve reduce(std::span<const Vec2> curve, int by) {
  const int d = checked_degree(curve);
  ReducedCurve out{bernstein::reduce(curve, by), 0.0};
  if (by == 0) return out;
  // The difference of two curves is bounded by its control points; elevation itself rounds by at
  // most 4 by u max|b| in each coordinate, the difference and its length by 4 u of themselves.
  const std::vector<Vec2> same = bernstein::elevate(std::span<const Vec2>(out.control), by);
  double largest = 0.0;
  for (int i = 0; i <= d; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const Vec2 e = same[k] - curve[k];
    out.error_bound = std::max(out.error_bound, std::hypot(e.x(), e.y()));
  }
  for (const Vec2& c : out.control)
    largest = std::max({largest, std::fabs(c.x()), std::fabs(c.y())});
  out.error_bound = out.error_bound * (1.0 + 0x1p-50) + 6.0 * by * 0x1p-53 * largest;
  return out;
}

std::vector<Vec2> to_nodes(std::span<const Vec2> curve) {
  checked_degree(curve);
  return bernstein::to_lagrange(curve);
}

std::vector<Vec2> from_nodes(std::span<const Vec2> nodes) {
  checked_degree(nodes);
  return bernstein::from_lagrange(nodes);
}

// ---- Derivatives at a parameter ----

namespace {

using short_names::u;

struct ExactVector {
  Dyadic x, y;
  bool is_zero() const { return x.sign() == 0 && y.sign() == 0; }
};

/// v = 2^exponent times the result, whose larger coordinate is between 1 and 2; v is not zero.
Vec2 rounded(const ExactVector& v, std::int64_t& exponent) {
  exponent = v.x.sign() == 0   ? v.y.exponent()
             : v.y.sign() == 0 ? v.x.exponent()
                               : std::max(v.x.exponent(), v.y.exponent());
  return {{v.x.scaled(-exponent).to_double(), v.y.scaled(-exponent).to_double()}};
}

Vec2 unit(const Vec2& v) {
  const double length = std::hypot(v.x(), v.y());
  return {{v.x() / length, v.y() / length}};
}

/// First and second derivative in double-double at s in [0, 1], of the curve times 2^-exponent;
/// every coordinate within `first_error` and `second_error`.
struct Derivatives {
  Vec<2, DoubleDouble> first, second;
  double first_error = 0.0, second_error = 0.0;
  int exponent = 0;
  bool usable = false;
};

Derivatives derivatives(std::span<const Vec2> curve, double s) {
  Derivatives out;
  const int d = static_cast<int>(curve.size()) - 1;
  double magnitude = 0.0;
  for (const Vec2& c : curve) magnitude = std::max({magnitude, std::fabs(c.x()), std::fabs(c.y())});
  if (d == 0 || magnitude == 0.0 || s < 0.0 || s > 1.0) return out;
  out.exponent = std::ilogb(magnitude) + 1;
  std::array<DoubleDouble, geometry_kernel::max_curve_points> w;
  double largest = 0.0;  // difference of control points
  for (int axis = 0; axis < 2; ++axis) {
    const auto coordinate = [&](int i) {
      return std::ldexp(curve[static_cast<std::size_t>(i)][axis], -out.exponent);
    };
    for (int i = 0; i < d; ++i) {
      const WithError difference = two_sum(coordinate(i + 1), -coordinate(i));
      w[static_cast<std::size_t>(i)] = {difference.value, difference.error};
      largest = std::max(largest, std::fabs(difference.value));
    }
    const WithError r = two_sum(1.0, -s);
    const DoubleDouble rest(r.value, r.error), at(s);
    for (int m = d - 1; m > 1; --m) bernstein::kernel::step(w.data(), m, rest, at);
    if (d >= 2) {
      out.second[axis] = DoubleDouble(static_cast<double>(d * (d - 1))) * (w[1] - w[0]);
      bernstein::kernel::step(w.data(), 1, rest, at);
    }
    out.first[axis] = DoubleDouble(static_cast<double>(d)) * w[0];
  }
  // Each step adds two products (5 u^2) and their sum (3 u^2): 9 u^2 of the largest difference with
  // the terms of higher order. The tail covers subnormal coordinates.
  const double each = 9.0 * d * u * u * largest + 0x1p-1000;
  out.first_error = d * (each + 6.0 * u * u * largest);
  out.second_error = d * (d - 1) * (2.0 * each + 18.0 * u * u * largest);
  out.usable = true;
  return out;
}

ExactVector exact_value(const ExactPolynomial& x, const ExactPolynomial& y, const Dyadic& s) {
  return {x(s), y(s)};
}

ExactPolynomial coordinate_of(std::span<const Vec2> curve, int axis) {
  std::vector<Dyadic> b;
  b.reserve(curve.size());
  for (const Vec2& c : curve) b.emplace_back(c[axis]);
  return ExactPolynomial(std::span<const Dyadic>(b));
}

}  // namespace

CurveFrame frame(std::span<const Vec2> curve, double s) {
  const int d = checked_degree(curve);
  check_parameter(s);
  const auto oriented = [](SpeedStatus status, const Vec2& t, int order) {
    return CurveFrame{status, t, Vec2{{-t.y(), t.x()}}, order % 2 == 0 ? -t : t, order};
  };
  const Derivatives b = derivatives(curve, s);
  if (b.usable) {
    const Vec2 v{{b.first[0].hi, b.first[1].hi}};
    const double largest = std::max(std::fabs(v.x()), std::fabs(v.y()));
    if (b.first_error <= 0.5 * u * largest && largest >= 0x1p-900)
      return oriented(SpeedStatus::regular, unit(v), 1);
  }
  ExactPolynomial x = coordinate_of(curve, 0), y = coordinate_of(curve, 1);
  for (int order = 1; order <= d; ++order) {
    x = x.derivative();
    y = y.derivative();
    const ExactVector v = exact_value(x, y, Dyadic(s));
    std::int64_t exponent = 0;
    if (!v.is_zero())
      return oriented(order == 1 ? SpeedStatus::regular : SpeedStatus::singular,
                      unit(rounded(v, exponent)), order);
  }
  return {SpeedStatus::point, {}, {}, {}, 0};
}

CurvatureResult curvature(std::span<const Vec2> curve, double s) {
  const int d = checked_degree(curve);
  check_parameter(s);
  const Derivatives b = derivatives(curve, s);
  if (b.usable && d >= 2) {
    const DoubleDouble left = b.first[0] * b.second[1], right = b.first[1] * b.second[0];
    const double turn = (left - right).hi;
    const Vec2 v{{b.first[0].hi, b.first[1].hi}};
    const double speed = std::hypot(v.x(), v.y());
    // Errors of the two factors, and 5 u^2 + 3 u^2 of the products and their difference.
    const double error =
        1.01 * (b.first_error * (std::fabs(b.second[0].hi) + std::fabs(b.second[1].hi)) +
                (std::fabs(v.x()) + std::fabs(v.y()) + 2.0 * b.first_error) * b.second_error +
                8.0 * u * u * (std::fabs(left.hi) + std::fabs(right.hi)));
    if (error <= u * std::fabs(turn) && b.first_error <= 0.5 * u * speed && speed >= 0x1p-300 &&
        std::fabs(turn) >= 0x1p-600) {
      const double value = turn / (speed * speed) / speed;
      if (std::fabs(value) >= 0x1p-900 && std::isfinite(value))
        return {SpeedStatus::regular, std::ldexp(value, -b.exponent)};
    }
  }
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const ExactPolynomial x1 = coordinate_of(curve, 0).derivative(),
                        y1 = coordinate_of(curve, 1).derivative();
  const Dyadic at(s);
  const ExactVector first = exact_value(x1, y1, at);
  if (first.is_zero()) {
    const bool point =
        std::all_of(curve.begin(), curve.end(), [&](const Vec2& c) { return c == curve[0]; });
    return {point ? SpeedStatus::point : SpeedStatus::singular, nan};
  }
  const ExactVector second = exact_value(x1.derivative(), y1.derivative(), at);
  const Dyadic turn = first.x * second.y - first.y * second.x;
  if (turn.sign() == 0) return {SpeedStatus::regular, 0.0};
  std::int64_t speed_exponent = 0;
  const Vec2 v = rounded(first, speed_exponent);
  const double speed = std::hypot(v.x(), v.y());
  const std::int64_t turn_exponent = turn.exponent();
  const double value = turn.scaled(-turn_exponent).to_double() / (speed * speed) / speed;
  const std::int64_t exponent =
      std::clamp<std::int64_t>(turn_exponent - 3 * speed_exponent, -4000, 4000);
  return {SpeedStatus::regular, std::ldexp(value, static_cast<int>(exponent))};
}

// ---- Tight box ----

namespace {

double round_up(const Dyadic& x) {
  const double r = x.to_double();
  return Dyadic(r) < x ? std::nextafter(r, std::numeric_limits<double>::infinity()) : r;
}

/// The range of one coordinate on [0, 1], rounded outwards.
void extend(std::span<const Vec2> curve, int axis, Vec2& lo, Vec2& hi) {
  const int d = static_cast<int>(curve.size()) - 1;
  const auto b = [&](int i) { return curve[static_cast<std::size_t>(i)][axis]; };
  double hull_lo = b(0), hull_hi = b(0), magnitude = 0.0;
  for (int i = 0; i <= d; ++i) {
    hull_lo = std::min(hull_lo, b(i));
    hull_hi = std::max(hull_hi, b(i));
    magnitude = std::max(magnitude, std::fabs(b(i)));
  }
  lo[axis] = std::min(b(0), b(d));
  hi[axis] = std::max(b(0), b(d));
  if (lo[axis] == hull_lo && hi[axis] == hull_hi) return;

  // q, the differences in doubles (a quarter of them where they might overflow), is within the
  // differences' rounding errors of p' / d; these integrate to at most their sum. So between roots
  // of q the coordinate is monotone up to `slack`.
  const int shift = magnitude > 0x1p1020 ? 2 : 0;
  std::vector<double> q(static_cast<std::size_t>(d));
  Dyadic slack, steepest;
  for (int i = 0; i < d; ++i) {
    const Dyadic exact = Dyadic(b(i + 1)) - Dyadic(b(i));
    const double rounded = exact.scaled(-shift).to_double();
    q[static_cast<std::size_t>(i)] = rounded;
    const Dyadic error = exact - Dyadic(rounded).scaled(shift);
    slack += error.sign() < 0 ? -error : error;
    const Dyadic size = exact.sign() < 0 ? -exact : exact;
    if (steepest < size) steepest = size;
  }
  Dyadic least(lo[axis]), most(hi[axis]);
  if (std::any_of(q.begin(), q.end(), [](double c) { return c != 0.0; })) {
    const ExactPolynomial p = coordinate_of(curve, axis);
    for (const bernstein::Root& root : bernstein::roots(q)) {
      if (root.s == 0.0 || root.s == 1.0) continue;
      const Dyadic value = p(Dyadic(root.s));
      // p' vanishes (up to the slack) within w = hi - lo of s, and |p''| <= 2 d (d-1) steepest.
      const Dyadic width(root.hi - root.lo);
      const Dyadic near =
          width * (width * Dyadic(2.0 * d * (d - 1)) * steepest + slack * Dyadic(d));
      if (value - near < least) least = value - near;
      if (most < value + near) most = value + near;
    }
  }
  // The control points bound the curve, too.
  lo[axis] = std::max(hull_lo, -round_up(slack - least));
  hi[axis] = std::min(hull_hi, round_up(most + slack));
}

}  // namespace

Box2 tight_box(std::span<const Vec2> curve) {
  checked_degree(curve);
  Box2 box;
  extend(curve, 0, box.lo, box.hi);
  extend(curve, 1, box.lo, box.hi);
  return box;
}

// ---- Closed chains ----

namespace {

std::string text(const Vec2& p) {
  return "(" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ")";
}

void check_chain(std::span<const Curve> chain) {
  if (chain.empty()) throw InputError("the chain has no curves, expected at least one");
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const std::size_t next = i + 1 < chain.size() ? i + 1 : 0;
    const Vec2 end = chain[i].control().back(), start = chain[next].control().front();
    if (!(end == start))
      throw InputError("curve " + std::to_string(i) + " of the chain ends at " + text(end) +
                       " and curve " + std::to_string(next) + " begins at " + text(start) +
                       ", expected the same point");
  }
}

}  // namespace

WindingNumber winding_number(std::span<const Curve> chain, const Vec2& p) {
  check_chain(chain);
  geometry_kernel::check_point(p);
  int turns = 0;
  WindingNumber undecided{WindingStatus::proven, 0, 0};
  for (std::size_t i = 0; i < chain.size(); ++i) {
    const auto found = geometry_kernel::point_on_curve(chain[i].control(), p);
    for (const auto& incidence : found.incidences)
      if (incidence.proven) return {WindingStatus::on_curve, 0, i};
    if (!found.incidences.empty() && undecided.status == WindingStatus::proven)
      undecided = {WindingStatus::undecided, 0, i};
    turns += found.ray_crossings;
  }
  if (undecided.status == WindingStatus::undecided) return undecided;
  return {WindingStatus::proven, turns, 0};
}

ChainArea area_and_centroid(std::span<const Curve> chain) {
  check_chain(chain);
  const Vec2 origin = chain.front().control().front();
  double twice = 0.0, bound = 0.0, radius = 0.0;
  Vec2 moment;
  for (const Curve& curve : chain)
    for (const Vec2& c : curve.control())
      radius = std::max({radius, std::fabs(c.x() - origin.x()), std::fabs(c.y() - origin.y())});
  for (const Curve& curve : chain) {
    const int d = curve.degree();
    if (d == 0) continue;
    // Green: 2 area = integral of cross(c, c'), 3 moment = integral of c cross(c, c'), degree
    // 3 d - 1.
    const IntervalRule rule = gauss_legendre((3 * d + 1) / 2);
    for (int k = 0; k < rule.size(); ++k) {
      const auto q = static_cast<std::size_t>(k);
      const auto at = geometry_kernel::curve_point(d, curve.control().data(), rule.node[q], origin);
      const double swept = rule.weight[q] * cross(at.value, at.derivative);
      twice += swept;
      moment += swept * at.value;
    }
    bound += 40.0 * d * (d + 1) * u * radius * radius;
  }
  ChainArea out{0.5 * twice, bound, {}, false};
  if (std::fabs(out.area) > 2.0 * bound) {
    out.has_centroid = true;
    out.centroid = origin + (1.0 / (3.0 * out.area)) * moment;
  }
  return out;
}

}  // namespace bezel
