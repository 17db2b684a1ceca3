#pragma once
// The three deformed quadrilaterals of [bjontegaard2009, sec. 3]. The paper gives no formulas for
// the bottom of the second and the bottom and sides of the third: these are ours.

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "bezel/fit/curve_sources.hpp"
#include "bezel/fit/gordon_hall.hpp"
#include "bezel/formula/formula.hpp"

namespace bezel::cli {

struct DomainCase {
  std::string name, sides;
  QuadCurves curves;
  double area;  ///< to the last bit or so, by quadrature in higher precision
};

/// The curve x(t), y(t), t from `from` to `to`; for a graph over x or y the other formula is "t".
inline PlaneCurve domain_curve(const std::string& x, const std::string& y, double from, double to,
                               std::span<const double> breaks = {}) {
  const std::array components{Formula(x, {"t"}), Formula(y, {"t"})};
  return formula_curve<2>(components, from, to, breaks);
}

/// The segment from a to b.
inline PlaneCurve domain_segment(const Vec2& a, const Vec2& b) {
  const std::array<Vec2, 2> control{a, b};
  return bezier_curve<2>(std::span<const Vec2>(control));
}

/// The region between y = bottom and a graph over [x0, x1], with straight sides.
inline QuadCurves domain_below(const std::string& graph, double x0, double x1, double bottom) {
  const PlaneCurve top = domain_curve("t", graph, x0, x1);
  return {domain_segment({x0, bottom}, {x1, bottom}), domain_segment({x1, bottom}, top(1.0).x), top,
          domain_segment({x0, bottom}, top(-1.0).x)};
}

inline std::array<DomainCase, 3> domain_cases() {
  const double s = std::sin(std::numbers::pi / 3), third = std::numbers::pi / 3;
  const std::string half = "sin(pi/3)", side = "0.1*sin(pi*t)";
  return {{{"domain 1", "top y = 1 + exp(-x) cos(2 pi x) / 2",
            domain_below("1 + exp(-t)*cos(2*pi*t)/2", 0.0, 2.0, 0.0), 2.010680564705057},
           {"domain 2", "top y = 1 / (1 + 16 x^2)", domain_below("1/(1 + 16*t^2)", -1.0, 1.0, -1.0),
            2.6629088318340117},
           {"domain 3",
            "all sides curved, the bottom y = 0.3 (1 - |x/s|^3) not smooth",
            {domain_curve("t", "0.3*(1 - abs(t/" + half + ")^3)", -s, s),
             domain_curve(half + " + " + side, "t", 0.0, 1.0),
             domain_curve("sin(t)", "0.5 + cos(t)", -third, third),
             domain_curve("-" + half + " - " + side, "t", 0.0, 1.0)},
            2.083848179643774}}};
}

}  // namespace bezel::cli
