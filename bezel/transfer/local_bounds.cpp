// The values a target element may take when the donor's are the measure.

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/base/parallel.hpp"
#include "bezel/field/element_range.hpp"
#include "bezel/transfer/limit.hpp"

namespace bezel::detail {
namespace {

/// Of the largest coefficient: how far a range may exceed the true one. Maxima along whole curves
/// would take thousands of pieces at 1e-13; constants are exact anyway.
constexpr double range_tolerance = 1e-10;

}  // namespace

ValueBounds local_bounds(const Field& donor, int component, std::span<const Overlapping> pairs,
                         std::size_t targets, std::span<const std::int32_t> zero, int threads) {
  const std::size_t donors = donor.mesh().element_count();
  const auto nc = static_cast<std::size_t>(donor.components());
  std::vector<bernstein::Range> range(donors);
  parallel_for(
      donors,
      [&](std::size_t e) {
        const auto c = donor.coefficients(ElementId(e));
        double size = 0.0;
        for (std::size_t i = static_cast<std::size_t>(component); i < c.size(); i += nc)
          size = std::max(size, std::abs(c[i]));
        range[e] = element_range(donor, ElementId(e), component, range_tolerance * size);
      },
      threads);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  ValueBounds bounds{std::vector<double>(targets, infinity),
                     std::vector<double>(targets, -infinity)};
  const auto hold = [&](std::int32_t target, const bernstein::Range& values) {
    const auto t = static_cast<std::size_t>(target);
    bounds.lo[t] = std::min(bounds.lo[t], values.lo);
    bounds.hi[t] = std::max(bounds.hi[t], values.hi);
  };
  for (const Overlapping& pair : pairs)
    hold(pair.target, range[static_cast<std::size_t>(pair.donor)]);
  for (const std::int32_t t : zero) hold(t, {0.0, 0.0});
  bernstein::Range all = range[0];
  for (const auto& r : range) all = {std::min(all.lo, r.lo), std::max(all.hi, r.hi)};
  for (std::size_t t = 0; t < targets; ++t)
    if (bounds.lo[t] > bounds.hi[t]) hold(static_cast<std::int32_t>(t), all);
  return bounds;
}

}  // namespace bezel::detail
