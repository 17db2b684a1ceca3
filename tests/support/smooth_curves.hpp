#pragma once
// Curves with exact derivatives: the five cases of [bjontegaard2009] and some that it does not
// have.

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "bezel/fit/smooth_curve.hpp"

namespace bezel::testing {

/// x -> (y, y', y'') as the graph over x = t + shift.
inline PlaneCurve graph(double shift, const std::function<std::array<double, 3>(double)>& f) {
  return PlaneCurve([shift, f](double t) {
    const std::array<double, 3> y = f(t + shift);
    return CurveJet<2>{Vec2{{t + shift, y[0]}}, Vec2{{1.0, y[1]}}, Vec2{{0.0, y[2]}}};
  });
}

/// (a cos u, b sin u), u from first to last.
inline PlaneCurve ellipse(double a, double b, double first, double last) {
  return PlaneCurve([=](double t) {
    const double h = (last - first) / 2.0, c = std::cos(first + h * (1.0 + t)),
                 s = std::sin(first + h * (1.0 + t));
    return CurveJet<2>{Vec2{{a * c, b * s}}, Vec2{{-a * h * s, b * h * c}},
                       Vec2{{-a * h * h * c, -b * h * h * s}}};
  });
}

/// Case 1 to 5 of the paper.
inline PlaneCurve paper_curve(int number) {
  constexpr double pi = std::numbers::pi;
  switch (number) {
    case 1:
      return PlaneCurve([](double t) {
        const double a = pi / 3.0, s = std::sin(a * t), c = std::cos(a * t);
        return CurveJet<2>{Vec2{{s, c}}, Vec2{{a * c, -a * s}}, Vec2{{-a * a * s, -a * a * c}}};
      });
    case 2:
      return graph(0.0, [](double x) {
        const double q = 1.0 / (1.0 + 16.0 * x * x);
        return std::array{q, -32.0 * x * q * q, (2048.0 * x * x * q - 32.0) * q * q};
      });
    case 3:
      return graph(0.1, [](double x) {
        const double c = std::cbrt(x + 2.0), y = std::sqrt(c - 1.0), c1 = 1.0 / (3.0 * c * c),
                     c2 = -2.0 / (9.0 * c * c * (x + 2.0));
        return std::array{y, c1 / (2.0 * y), c2 / (2.0 * y) - c1 * c1 / (4.0 * y * y * y)};
      });
    case 4:
      return graph(0.0, [](double x) {
        const double a = std::fabs(x);
        return std::array{1.0 - a * a * a, -3.0 * x * a, -6.0 * a};
      });
    default:
      return graph(1.0, [](double x) {
        const double e = 0.5 * std::exp(-x), w = 2.0 * pi, c = std::cos(w * x), s = std::sin(w * x);
        return std::array{e * c, -e * (c + w * s), e * (c + 2.0 * w * s - w * w * c)};
      });
  }
}

/// Upper half of the NACA 0012 section with closed trailing edge, x = ((1 + t) / 2)^2.
inline PlaneCurve naca0012() {
  return PlaneCurve([](double t) {
    const double s = 0.5 * (1.0 + t), q = s * s;
    const double y = 0.6 * s * (0.2969 + s * (-0.126 + q * (-0.3516 + q * (0.2843 - q * 0.1036))));
    const double y1 = 0.6 * (0.2969 + s * (-0.252 + q * (-1.4064 + q * (1.7058 - q * 0.8288))));
    const double y2 = 0.6 * (-0.252 + q * (-4.2192 + q * (8.529 - q * 5.8016)));
    return CurveJet<2>{Vec2{{q, y}}, Vec2{{s, 0.5 * y1}}, Vec2{{0.5, 0.25 * y2}}};
  });
}

/// Curvature s on -2 <= s <= 2, an inflection in the middle.
inline PlaneCurve clothoid() {
  return PlaneCurve([](double t) {
    static constexpr std::array<double, 4> node{-0.86113631159405258, -0.33998104358485626,
                                                0.33998104358485626, 0.86113631159405258};
    static constexpr std::array<double, 4> weight{0.34785484513745386, 0.65214515486254614,
                                                  0.65214515486254614, 0.34785484513745386};
    constexpr int panels = 12;
    const double s = 2.0 * t, h = s / panels / 2.0;
    double x = 0.0, y = 0.0;
    for (int i = 0; i < panels; ++i)
      for (std::size_t q = 0; q < 4; ++q) {
        const double u = h * (2 * i + 1 + node[q]);
        x += h * weight[q] * std::cos(0.5 * u * u);
        y += h * weight[q] * std::sin(0.5 * u * u);
      }
    const double c = 2.0 * std::cos(0.5 * s * s), k = 2.0 * std::sin(0.5 * s * s);
    return CurveJet<2>{Vec2{{x, y}}, Vec2{{c, k}}, Vec2{{-2.0 * s * k, 2.0 * s * c}}};
  });
}

/// Two arcs of curvature 1 and -3 with one tangent where they meet, at t = 0.
inline PlaneCurve two_arcs(bool with_breakpoint) {
  return PlaneCurve(
      [](double t) {
        const double k = t < 0.0 ? 1.0 : -3.0, v = 1.2, a = k * v * t;
        return CurveJet<2>{Vec2{{std::sin(a) / k, (1.0 - std::cos(a)) / k}},
                           Vec2{{v * std::cos(a), v * std::sin(a)}},
                           Vec2{{-v * v * k * std::sin(a), v * v * k * std::cos(a)}}};
      },
      with_breakpoint ? std::vector<double>{0.0} : std::vector<double>{});
}

/// The quarter of x^4 + y^4 = 1 with x, y >= 0, by the polar angle.
inline PlaneCurve superellipse() {
  return PlaneCurve([](double t) {
    const double h = std::numbers::pi / 4.0, u = h * (1.0 + t), c = std::cos(u), s = std::sin(u);
    // r = q^(-1/4), q = c^4 + s^4 = 1 - 2 (c s)^2.
    const double q = 1.0 - 2.0 * c * c * s * s, q1 = -std::sin(4.0 * u),
                 q2 = -4.0 * std::cos(4.0 * u);
    const double r = std::pow(q, -0.25), r1 = -0.25 * r / q * q1,
                 r2 = 0.3125 * r / (q * q) * q1 * q1 - 0.25 * r / q * q2;
    return CurveJet<2>{
        Vec2{{r * c, r * s}}, Vec2{{h * (r1 * c - r * s), h * (r1 * s + r * c)}},
        Vec2{{h * h * (r2 * c - 2.0 * r1 * s - r * c), h * h * (r2 * s + 2.0 * r1 * c - r * s)}}};
  });
}

inline SpaceCurve helix() {
  return SpaceCurve([](double t) {
    const double a = 2.0, c = std::cos(a * t), s = std::sin(a * t);
    return CurveJet<3>{Vec3{{c, s, 0.5 * t}}, Vec3{{-a * s, a * c, 0.5}},
                       Vec3{{-a * a * c, -a * a * s, 0.0}}};
  });
}

}  // namespace bezel::testing
