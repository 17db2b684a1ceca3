#include "bezel/fit/curve_shapes.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/checks.hpp"
#include "bezel/fit/curve_interval.hpp"
#include "bezel/formula/operations.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel {
namespace {

constexpr double pi = std::numbers::pi;

void check_positive(double value, const char* what) {
  bernstein::checks::finite(value, what);
  if (!(value > 0.0))
    throw InputError(std::string(what) + " is " + std::to_string(value) +
                     ", expected a positive one");
}

void check_turn(double from, double to) {
  bernstein::checks::finite(from, "the first angle");
  bernstein::checks::finite(to, "the last angle");
  if (!(std::fabs(to - from) <= 2.0 * pi * (1.0 + 1e-12) && std::fabs(from) <= 1e6))
    throw InputError("found angles from " + std::to_string(from) + " to " + std::to_string(to) +
                     ", expected at most one turn, within a million of 0");
}

/// cos and sin of an angle; exact at multiples of pi/2 as doubles give them, so that full turns
/// close.
std::array<double, 2> unit(double phi) {
  const double quarters = phi / (0.5 * pi), whole = std::nearbyint(quarters);
  if (std::fabs(quarters - whole) > 4e-16 * std::fabs(quarters) + 1e-300)
    return {std::cos(phi), std::sin(phi)};
  constexpr std::array<double, 4> cosine = {1.0, 0.0, -1.0, 0.0};
  const auto k = static_cast<std::size_t>(std::fmod(std::fmod(whole, 4.0) + 4.0, 4.0));
  return {cosine[k], cosine[(k + 3) % 4]};
}

}  // namespace

SmoothCurve<2> ellipse_arc(const Vec2& centre, double a, double b, double from, double to,
                           double angle) {
  bernstein::checks::finite(std::span(&centre, 1), "the centre");
  check_positive(a, "the first half axis");
  check_positive(b, "the second half axis");
  check_turn(from, to);
  bernstein::checks::finite(angle, "the angle");
  const auto [c, s] = unit(angle);
  const Vec2 p{{a * c, a * s}}, q{{-b * s, b * c}};
  return fit::on_interval<2>(
      [centre, p, q](double phi) {
        const auto [x, y] = unit(phi);
        const Vec2 r = x * p + y * q;
        return CurveJet<2>{centre + r, x * q - y * p, -r};
      },
      from, to);
}

SmoothCurve<2> superellipse_arc(double a, double b, double n, double from, double to) {
  check_positive(a, "the first half axis");
  check_positive(b, "the second half axis");
  check_turn(from, to);
  if (!(n >= 2.0 && n <= 100.0))
    throw InputError("found an exponent of " + std::to_string(n) +
                     ", expected 2 to 100 (below, the curvature is infinite on the axes)");
  std::vector<double> breaks;
  if (std::fmod(n, 2.0) != 0.0) {
    const double quarter = 0.5 * pi;
    for (double k = std::floor(std::fmin(from, to) / quarter); k * quarter < std::fmax(from, to);
         ++k)
      breaks.push_back(k * quarter);
  }
  return fit::on_interval<2>(
      [a, b, n](double phi) {
        const auto [c, s] = unit(phi);
        // f = |c|^n + |s|^n and r = f^(-1/n), with two derivatives.
        const double g = std::pow(std::fabs(c), n - 2.0), k = std::pow(std::fabs(s), n - 2.0);
        const double f = c * c * g + s * s * k, f1 = n * s * c * (k - g);
        const double f2 = n * ((c * c - s * s) * (k - g) + (n - 2.0) * (c * c * k + s * s * g));
        const double r = std::pow(f, -1.0 / n), r1 = -r * f1 / (n * f);
        const double r2 = -(r1 * f1 + r * f2) / (n * f) + r * f1 * f1 / (n * f * f);
        return CurveJet<2>{
            Vec2{{a * r * c, b * r * s}}, Vec2{{a * (r1 * c - r * s), b * (r1 * s + r * c)}},
            Vec2{{a * (r2 * c - 2.0 * r1 * s - r * c), b * (r2 * s + 2.0 * r1 * c - r * s)}}};
      },
      from, to, breaks);
}

namespace {

/// Positions along a clothoid: known at the ends of equal steps, integrated from the nearest one.
struct Clothoid {
  double heading, start, rate, length;
  Vec2 origin;
  std::vector<Vec2> known;
  IntervalRule rule = gauss_legendre(12);  // one radian of turn: the remainder is below 1e-25

  double angle(double s) const { return heading + s * (start + 0.5 * rate * s); }
  Vec2 step(double from, double to) const {
    Vec2 sum{};
    for (std::size_t q = 0; q < rule.node.size(); ++q) {
      const double phi = angle(from + rule.node[q] * (to - from));
      sum += rule.weight[q] * Vec2{{std::cos(phi), std::sin(phi)}};
    }
    return (to - from) * sum;
  }
  void prepare(std::size_t steps) {
    known.assign(1, origin);
    const auto count = static_cast<double>(steps);
    for (std::size_t i = 0; i < steps; ++i) {
      const auto k = static_cast<double>(i);
      known.push_back(known.back() + step(k * length / count, (k + 1.0) * length / count));
    }
  }
  CurveJet<2> operator()(double s) const {
    const double steps = static_cast<double>(known.size() - 1);
    const double nearest = std::nearbyint(s / length * steps);
    const double phi = angle(s), curvature = start + rate * s;
    const Vec2 tangent{{std::cos(phi), std::sin(phi)}};
    return {known[static_cast<std::size_t>(nearest)] + step(nearest * length / steps, s), tangent,
            curvature * Vec2{{-tangent.y(), tangent.x()}}};
  }
};

}  // namespace

SmoothCurve<2> clothoid(const Vec2& start, double heading, double start_curvature,
                        double end_curvature, double length) {
  bernstein::checks::finite(std::span(&start, 1), "the start");
  bernstein::checks::finite(heading, "the heading");
  bernstein::checks::finite(start_curvature, "the first curvature");
  bernstein::checks::finite(end_curvature, "the last curvature");
  check_positive(length, "the length");
  const double turn = length * std::fmax(std::fabs(start_curvature), std::fabs(end_curvature));
  if (!(turn <= 1e5))
    throw InputError("found a clothoid that turns by up to " + std::to_string(turn) +
                     " radians, expected at most 100000");
  auto curve = std::make_shared<Clothoid>();
  curve->heading = heading;
  curve->start = start_curvature;
  curve->rate = (end_curvature - start_curvature) / length;
  curve->length = length;
  curve->origin = start;
  curve->prepare(static_cast<std::size_t>(std::ceil(turn)) + 1);
  return fit::on_interval<2>(
      [curve = std::shared_ptr<const Clothoid>(std::move(curve))](double s) { return (*curve)(s); },
      0.0, length);
}

namespace {

using Twice = formula::Dual<formula::Dual<double>>;

struct Aerofoil {
  double camber, place, thickness, chord;  // in parts of the chord, but for the last
  TrailingEdge edge;

  /// Half the thickness at x = a^2, an odd function of a near 0.
  Twice half_thickness(const Twice& a) const {
    const Twice x = a * a;
    if (edge == TrailingEdge::blunt)
      return Twice(5.0 * thickness) *
             (Twice(0.2969) * a +
              x * (Twice(-0.1260) +
                   x * (Twice(-0.3516) + x * (Twice(0.2843) + x * Twice(-0.1015)))));
    // The same with -0.1036, divided by a (1 - a): it vanishes at the edge to the last bit.
    constexpr std::array<double, 7> c = {0.2969, 0.1709, 0.1709, -0.1807, -0.1807, 0.1036, 0.1036};
    Twice q(c[6]);
    for (std::size_t i = 6; i-- > 0;) q = Twice(c[i]) + a * q;
    return Twice(5.0 * thickness) * a * (Twice(1.0) - a) * q;
  }
  /// The point at x = a^2 on one side.
  CurveJet<2> point(const Twice& a, bool upper) const {
    const Twice x = a * a, t = half_thickness(a) * Twice(upper ? 1.0 : -1.0);
    Twice px = x, py = t;
    if (camber != 0.0) {
      const bool front = formula::plain(x) < place;
      const double before = front ? place : 1.0 - place;
      const double scale = camber / (before * before);
      const Twice line =
          front ? x * (Twice(2.0 * place) - x) : (Twice(1.0) - x) * (Twice(1.0 - 2.0 * place) + x);
      const Twice slope = Twice(2.0 * scale) * (Twice(place) - x);
      const Twice across = t / sqrt(Twice(1.0) + slope * slope);
      px = x - slope * across;
      py = Twice(scale) * line + across;
    }
    const auto vector = [&](double u, double v) { return chord * Vec2{{u, v}}; };
    return {vector(px.v.v, py.v.v), vector(px.d.v, py.d.v), vector(px.d.d, py.d.d)};
  }
};

Aerofoil read_digits(std::string_view digits) {
  const std::string shown(digits.substr(0, 20));
  if (digits.size() != 4 || digits.find_first_not_of("0123456789") != std::string_view::npos)
    throw InputError("found NACA '" + shown + "', expected four digits such as 0012");
  const auto value = [&](std::size_t i) { return digits[i] - '0'; };
  const int thickness = 10 * value(2) + value(3);
  if (thickness < 1 || thickness > 40)
    throw InputError("found NACA '" + shown + "', expected a thickness of 01 to 40 percent");
  if ((value(0) == 0) != (value(1) == 0))
    throw InputError("found NACA '" + shown +
                     "', expected camber and its place (the first two digits) both 0 or both not");
  return {0.01 * value(0), 0.1 * value(1), 0.01 * thickness, 1.0, TrailingEdge::sharp};
}

}  // namespace

SmoothCurve<2> naca4(std::string_view digits, AerofoilPart side, TrailingEdge edge, double chord) {
  Aerofoil foil = read_digits(digits);
  check_positive(chord, "the chord");
  foil.chord = chord;
  foil.edge = edge;
  const bool all = side == AerofoilPart::all;
  std::vector<double> breaks;
  if (foil.camber != 0.0) breaks = {std::sqrt(foil.place), -std::sqrt(foil.place)};
  breaks.push_back(0.0);
  return fit::on_interval<2>(
      [foil, side](double s) {
        const bool upper = side == AerofoilPart::upper || (side == AerofoilPart::all && s < 0.0);
        // da/ds = -1 on the upper side of the whole, which runs towards the nose.
        const double slope = side == AerofoilPart::all && upper ? -1.0 : 1.0;
        const Twice a(formula::Dual<double>(std::fabs(s), slope), formula::Dual<double>(slope));
        return foil.point(a, upper);
      },
      all ? -1.0 : 0.0, 1.0, breaks);
}

}  // namespace bezel
