#pragma once
// From a curve's natural parameter to [-1, 1].

#include <algorithm>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/checks.hpp"
#include "bezel/fit/smooth_curve.hpp"

namespace bezel::fit {

/// The curve with the jet natural(u), u running linearly from `from` (t = -1) to `to` (t = 1).
/// @param breaks  values of u; those strictly inside become breakpoints
template <int dim, class Natural>
SmoothCurve<dim> on_interval(Natural natural, double from, double to,
                             std::span<const double> breaks = {}) {
  bernstein::checks::finite(from, "the first parameter");
  bernstein::checks::finite(to, "the last parameter");
  const double half = 0.5 * to - 0.5 * from;
  if (half == 0.0)
    throw InputError("found a parameter from " + std::to_string(from) +
                     " to the same, expected an interval");
  std::vector<double> inside;
  for (const double u : breaks) {
    bernstein::checks::finite(u, "a break");
    const double t = ((u - from) - (to - u)) / (to - from);
    if (t > -1.0 && t < 1.0) inside.push_back(t);
  }
  std::sort(inside.begin(), inside.end());
  inside.erase(std::unique(inside.begin(), inside.end()), inside.end());
  return SmoothCurve<dim>(
      [natural = std::move(natural), from, to, half](double t) {
        CurveJet<dim> jet = natural(0.5 * ((1.0 - t) * from + (1.0 + t) * to));
        jet.d1 *= half;
        jet.d2 *= half * half;
        return jet;
      },
      std::move(inside));
}

}  // namespace bezel::fit
