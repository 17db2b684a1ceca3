#include "bezel/transfer/local_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bezel/base/parallel.hpp"
#include "bezel/field/element_range.hpp"

namespace bezel::detail {
namespace {

/// Of the largest coefficient: how far a range may exceed the true one. Maxima along whole curves
/// would take thousands of pieces at 1e-13; constants are exact anyway.
constexpr double local_range_tolerance = 1e-10;
/// Elements that share less than this fraction of the smaller one only touch.
constexpr double touching = 1e-13;

std::vector<std::int32_t> counted_as_zero(const TransferReport& report,
                                          const TransferOptions& options) {
  std::vector<std::int32_t> zero;
  if (options.uncovered != Uncovered::zero) return zero;
  for (const auto& part : report.uncovered_elements) zero.push_back(part.first.value);
  return zero;
}

}  // namespace

void check_bounds(const Bounds& bounds) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (bounds.kind != Bounds::Kind::global) return;
  if (!(bounds.lo <= bounds.hi) || bounds.lo == infinity || bounds.hi == -infinity) {
    throw InputError("transfer: found bounds " + fmt::format("{:.3g}", bounds.lo) + " to " +
                     fmt::format("{:.3g}", bounds.hi) +
                     ", expected two numbers in ascending order");
  }
}

bool ElementBounds::overlaps(double shared_area, double donor_area, double target_area) {
  return shared_area > touching * std::min(donor_area, target_area);
}

ElementBounds::ElementBounds(const Bounds& bounds, std::vector<Overlapping> pairs,
                             std::vector<std::int32_t> zero, std::size_t targets, int threads)
    : bounds_(bounds),
      targets_(targets),
      threads_(threads),
      zero_(std::move(zero)),
      pairs_(std::move(pairs)) {
  if (bounds_.kind != Bounds::Kind::global || zero_.empty() ||
      (bounds_.lo <= 0.0 && bounds_.hi >= 0.0))
    return;
  throw InputError("transfer: " + std::to_string(zero_.size()) +
                   " uncovered triangles count as 0, which the bounds " +
                   fmt::format("{:.3g}", bounds_.lo) + " to " + fmt::format("{:.3g}", bounds_.hi) +
                   " leave out");
}

ElementBounds::ElementBounds(std::span<const double> donor_area,
                             std::span<const double> target_area,
                             std::span<const ChunkResult> chunks, const TransferReport& report,
                             const TransferOptions& options)
    : ElementBounds(options.bounds, {}, counted_as_zero(report, options), target_area.size(),
                    options.threads) {
  if (bounds_.kind != Bounds::Kind::local) return;
  for (const ChunkResult& r : chunks) {
    for (std::size_t i = 0; i < r.given.donor.size(); ++i) {
      const std::int32_t d = r.given.donor[i];
      const std::int32_t t = r.given.target[i];
      if (overlaps(r.given.area[i], donor_area[static_cast<std::size_t>(d)],
                   target_area[static_cast<std::size_t>(t)]))
        pairs_.push_back({t, d});
    }
  }
}

ValueBounds ElementBounds::operator()(const Field& donor, int component) const {
  if (bounds_.kind == Bounds::Kind::global) return {{bounds_.lo}, {bounds_.hi}};
  return local(donor, component);
}

ValueBounds ElementBounds::local(const Field& donor, int component) const {
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
        range[e] = element_range(donor, ElementId(e), component, local_range_tolerance * size);
      },
      threads_);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  ValueBounds bounds{std::vector<double>(targets_, infinity),
                     std::vector<double>(targets_, -infinity)};
  const auto hold = [&](std::int32_t target, const bernstein::Range& values) {
    const auto t = static_cast<std::size_t>(target);
    bounds.lo[t] = std::min(bounds.lo[t], values.lo);
    bounds.hi[t] = std::max(bounds.hi[t], values.hi);
  };
  for (const Overlapping& pair : pairs_)
    hold(pair.target, range[static_cast<std::size_t>(pair.donor)]);
  for (const std::int32_t t : zero_) hold(t, {0.0, 0.0});
  bernstein::Range all = range[0];
  for (const auto& r : range) all = {std::min(all.lo, r.lo), std::max(all.hi, r.hi)};
  for (std::size_t t = 0; t < targets_; ++t)
    if (bounds.lo[t] > bounds.hi[t]) hold(static_cast<std::int32_t>(t), all);
  return bounds;
}

}  // namespace bezel::detail
