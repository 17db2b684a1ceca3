#include "bezel/field/formula_kernel.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "bezel/base/error.hpp"

namespace bezel::field_detail {
namespace {

// The sign of a NaN depends on the machine's library; messages do not.
double without_sign(double x) {
  return std::isnan(x) ? std::abs(x) : x;
}

}  // namespace

void check_formula(const Formula& formula) {
  if (formula.variables().size() != 2)
    throw InputError(fmt::format("formula '{}' has {} variables, expected 2 (x and y)",
                                 formula.text(), formula.variables().size()));
}

void evaluate_formula(const Formula& formula, std::span<const Vec2> points, std::span<double> out,
                      ElementId e, std::size_t each) {
  std::vector<double> xy(2 * points.size());
  const std::span<double> x(xy.data(), points.size()), y(xy.data() + points.size(), points.size());
  for (std::size_t q = 0; q < points.size(); ++q) {
    x[q] = points[q].x();
    y[q] = points[q].y();
  }
  const std::array<std::span<const double>, 2> columns{x, y};
  formula.evaluate(columns, out);
  for (std::size_t q = 0; q < points.size(); ++q)
    if (!std::isfinite(out[q]))
      throw InputError(
          {{}, 0, "triangle", e.value + static_cast<std::int64_t>(each > 0 ? q / each : 0)},
          fmt::format("formula '{}' is {} at x = {}, y = {}, expected a finite value",
                      formula.text(), without_sign(out[q]), x[q], y[q]));
}

Vec2 formula_gradient(const Formula& formula, const Vec2& point, ElementId e) {
  std::array<double, 2> first;
  formula.gradient(point.c, first);
  if (!std::isfinite(first[0]) || !std::isfinite(first[1]))
    throw InputError({{}, 0, "triangle", e.value},
                     fmt::format("the gradient of formula '{}' is ({}, {}) at x = {}, y = {}, "
                                 "expected finite values",
                                 formula.text(), without_sign(first[0]), without_sign(first[1]),
                                 point.x(), point.y()));
  return {first[0], first[1]};
}

}  // namespace bezel::field_detail
