#include "bezel/fit/curve_sources.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/checks.hpp"
#include "bezel/fit/curve_interval.hpp"

namespace bezel {

template <int dim>
SmoothCurve<dim> formula_curve(std::span<const Formula> components, double from, double to,
                               std::span<const double> breaks) {
  if (components.size() != static_cast<std::size_t>(dim))
    throw InputError("found " + std::to_string(components.size()) + " formulas, expected " +
                     std::to_string(dim));
  for (const Formula& f : components)
    if (f.variables().size() != 1)
      throw InputError("found a formula of " + std::to_string(f.variables().size()) +
                       " variables, expected one of a single variable");
  std::vector<Formula> own(components.begin(), components.end());
  return fit::on_interval<dim>(
      [own = std::move(own)](double u) {
        CurveJet<dim> jet;
        for (int i = 0; i < dim; ++i)
          jet.x[i] =
              own[static_cast<std::size_t>(i)].hessian({&u, 1}, {&jet.d1[i], 1}, {&jet.d2[i], 1});
        return jet;
      },
      from, to, breaks);
}

template <int dim>
SmoothCurve<dim> polynomial_curve(std::span<const Vec<dim>> coefficients, double from, double to) {
  if (coefficients.size() < 2 || coefficients.size() > 61)
    throw InputError("found " + std::to_string(coefficients.size()) +
                     " coefficients of a polynomial curve, expected 2 to 61");
  bernstein::checks::finite(coefficients, "coefficient");
  std::vector<Vec<dim>> own(coefficients.begin(), coefficients.end());
  return fit::on_interval<dim>(
      [own = std::move(own)](double u) {
        CurveJet<dim> jet{own.back(), {}, {}};
        for (std::size_t i = own.size() - 1; i-- > 0;) {  // Horner's scheme, derivatives along
          jet.d2 = u * jet.d2 + 2.0 * jet.d1;
          jet.d1 = u * jet.d1 + jet.x;
          jet.x = u * jet.x + own[i];
        }
        return jet;
      },
      from, to);
}

template <int dim>
SmoothCurve<dim> reversed(const SmoothCurve<dim>& curve) {
  std::vector<double> breaks;
  for (std::size_t i = curve.breakpoints().size(); i-- > 0;)
    breaks.push_back(-curve.breakpoints()[i]);
  return SmoothCurve<dim>(
      [curve](double t) {
        CurveJet<dim> jet = curve(-t);
        jet.d1 = -jet.d1;
        return jet;
      },
      std::move(breaks));
}

SmoothCurve<2> moved(const SmoothCurve<2>& curve, double scale, double angle, const Vec2& shift) {
  bernstein::checks::finite(scale, "the scale");
  bernstein::checks::finite(angle, "the angle");
  bernstein::checks::finite(std::span(&shift, 1), "the shift");
  if (scale == 0.0) throw InputError("found a scale of 0, expected another");
  const double c = scale * std::cos(angle), s = scale * std::sin(angle);
  const auto turn = [c, s](const Vec2& p) {
    return Vec2{{c * p.x() - s * p.y(), s * p.x() + c * p.y()}};
  };
  return SmoothCurve<2>(
      [curve, turn, shift](double t) {
        const CurveJet<2> jet = curve(t);
        return CurveJet<2>{shift + turn(jet.x), turn(jet.d1), turn(jet.d2)};
      },
      {curve.breakpoints().begin(), curve.breakpoints().end()});
}

template SmoothCurve<2> formula_curve(std::span<const Formula>, double, double,
                                      std::span<const double>);
template SmoothCurve<3> formula_curve(std::span<const Formula>, double, double,
                                      std::span<const double>);
template SmoothCurve<2> polynomial_curve(std::span<const Vec2>, double, double);
template SmoothCurve<3> polynomial_curve(std::span<const Vec3>, double, double);
template SmoothCurve<2> reversed(const SmoothCurve<2>&);
template SmoothCurve<3> reversed(const SmoothCurve<3>&);

}  // namespace bezel
