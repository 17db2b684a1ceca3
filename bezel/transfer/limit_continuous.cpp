#include "bezel/transfer/limit_continuous.hpp"

#include <algorithm>
#include <cmath>

#include "bezel/base/parallel.hpp"
#include "bezel/bernstein/ceiling.hpp"
#include "bezel/numeric/short_names.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel::detail {
namespace {

using short_names::infinity;

/// Of the largest value: excesses that are rounding. Removing them would spoil their neighbours.
constexpr double rounding = 1e-14;
/// Sweeps in which alpha follows the ranges, before Zalesak's limiter takes over where they still
/// leave the bounds.
constexpr int range_sweeps = 12;
/// Then it takes over everywhere.
constexpr int last_sweep = 40;
/// Alpha is reduced by this much more than one element alone needs, as its neighbours' change too.
constexpr double margin = 1.25;

class ContinuousLimiter {
 public:
  ContinuousLimiter(ContinuousMass& mass, const ValueBounds& bounds, int threads)
      : mass_(mass), space_(*mass.space()), threads_(threads) {
    const std::size_t elements = space_.mesh()->element_count();
    const std::size_t dofs = space_.dof_count();
    begin_.assign(dofs + 1, 0);
    for (std::size_t e = 0; e < elements; ++e)
      for (const std::int32_t d : dofs_of(e)) ++begin_[static_cast<std::size_t>(d) + 1];
    for (std::size_t d = 0; d < dofs; ++d) begin_[d + 1] += begin_[d];
    entry_.resize(begin_[dofs]);
    std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
    lumped_.assign(dofs, 0.0);
    dof_.lo.assign(dofs, infinity);
    dof_.hi.assign(dofs, -infinity);
    for (std::size_t e = 0; e < elements; ++e) {
      const auto list = dofs_of(e);
      const std::size_t first = space_.offset(ElementId(e));
      for (std::size_t i = 0; i < list.size(); ++i) {
        const auto d = static_cast<std::size_t>(list[i]);
        entry_[next[d]++] = {static_cast<std::int32_t>(e), first + i};
        lumped_[d] += mass_.integrals()[first + i];
        dof_.lo[d] = std::min(dof_.lo[d], bounds.least(e));
        dof_.hi[d] = std::max(dof_.hi[d], bounds.most(e));
      }
    }
    element_.lo.resize(elements);
    element_.hi.resize(elements);
    for (std::size_t e = 0; e < elements; ++e) {
      element_.lo[e] = infinity;
      element_.hi[e] = -infinity;
      for (const std::int32_t d : dofs_of(e)) {
        element_.lo[e] = std::min(element_.lo[e], dof_.lo[static_cast<std::size_t>(d)]);
        element_.hi[e] = std::max(element_.hi[e], dof_.hi[static_cast<std::size_t>(d)]);
      }
    }
  }

  /// The lumped projection, moved into the bounds.
  Redistribution make_low(std::span<const double> c) {
    low_.resize(lumped_.size());
    mass_.load(c, low_);
    for (std::size_t d = 0; d < low_.size(); ++d) low_[d] /= lumped_[d];
    return redistribute(
        low_, lumped_, dof_, [this](std::int32_t d, std::vector<std::int32_t>& out) {
          for (const Entry& entry : entries(static_cast<std::size_t>(d)))
            for (const std::int32_t n : dofs_of(static_cast<std::size_t>(entry.element)))
              out.push_back(n);
        });
  }

  void make_fluxes(std::span<const double> x) {
    flux_.resize(space_.coefficient_count());
    for_elements([&](std::size_t e) {
      const auto list = dofs_of(e);
      const std::size_t n = list.size();
      const std::size_t first = space_.offset(ElementId(e));
      std::vector<double> matrix(n * n);
      mass_.element_matrix(e, matrix);
      // Sum over j of M_ij (x_i - x_j): differences keep the digits of a small variation.
      for (std::size_t i = 0; i < n; ++i) {
        double f = 0.0;
        for (std::size_t j = 0; j < n; ++j)
          f += matrix[i * n + j] *
               (x[static_cast<std::size_t>(list[i])] - x[static_cast<std::size_t>(list[j])]);
        flux_[first + i] = f;
      }
    });
  }

  /// Reduces alpha until all ranges fit.
  void limit() {
    const std::size_t elements = element_.lo.size();
    alpha_.assign(elements, 1.0);
    range_.resize(elements);
    scale_ = 0.0;
    for (const double v : low_) scale_ = std::max(scale_, std::abs(v));
    std::vector<char> check(elements, 1);
    std::vector<double> factor(elements);
    for (int sweep = 0;; ++sweep) {
      evaluate();
      const bool by_range = sweep < range_sweeps;
      if (!by_range && zalesak_.empty()) make_zalesak();
      if (sweep == last_sweep) {
        for (std::size_t e = 0; e < elements; ++e) alpha_[e] = std::min(alpha_[e], zalesak_[e]);
        evaluate();
        std::fill(check.begin(), check.end(), 1);
      }
      for_elements([&](std::size_t e) {
        if (check[e] != 0) factor[e] = inspect(e, by_range);
      });
      // Elements around one out of bounds follow it; what they touch is looked at again.
      std::vector<double> next = alpha_;
      bool changed = false;
      std::vector<char> moved(elements, 0);
      for (std::size_t e = 0; e < elements; ++e) {
        if (check[e] == 0 || factor[e] >= 1.0) continue;
        around(e, [&](std::size_t n) {
          const double wanted = by_range ? alpha_[n] * factor[e] : std::min(alpha_[n], zalesak_[n]);
          if (!(wanted < next[n])) return;
          next[n] = wanted;
          moved[n] = 1;
          changed = true;
        });
      }
      if (!changed) return;
      alpha_ = std::move(next);
      std::fill(check.begin(), check.end(), 0);
      for (std::size_t e = 0; e < elements; ++e)
        if (moved[e] != 0) around(e, [&](std::size_t n) { check[n] = 1; });
    }
  }

  Limited result(std::span<const double> x, double moved) {
    Limited out;
    double size = 0.0;
    for (const double v : x) size = std::max(size, std::abs(v));
    out.range = range_[0];
    for (std::size_t e = 0; e < range_.size(); ++e) {
      out.range.lo = std::min(out.range.lo, range_[e].lo);
      out.range.hi = std::max(out.range.hi, range_[e].hi);
      double change = 0.0;
      for (const std::int32_t d : dofs_of(e)) {
        const auto i = static_cast<std::size_t>(d);
        change = std::max(change, std::abs(dofs_[i] - x[i]));
      }
      if (change > counted_change * size) ++out.report.elements_limited;
    }
    out.report.mass_moved = moved;
    out.coefficients = space_.expand(dofs_);
    return out;
  }

  const std::vector<double>& lumped() const { return lumped_; }
  const ValueBounds& dof_bounds() const { return dof_; }

 private:
  struct Entry {
    std::int32_t element;
    std::size_t place;  // in the elements' coefficients
  };

  std::span<const std::int32_t> dofs_of(std::size_t e) const { return space_.dofs(ElementId(e)); }
  std::span<const Entry> entries(std::size_t dof) const {
    return {entry_.data() + begin_[dof], begin_[dof + 1] - begin_[dof]};
  }
  template <class Body>
  void for_elements(const Body& body) const {
    constexpr std::size_t chunk = 32;
    const std::size_t n = element_.lo.size();
    parallel_for((n + chunk - 1) / chunk,
                 [&](std::size_t k) {
                   for (std::size_t e = k * chunk; e < std::min(n, (k + 1) * chunk); ++e) body(e);
                 },
                 threads_);
  }
  /// The element and all that share a dof with it.
  template <class Body>
  void around(std::size_t e, const Body& body) const {
    for (const std::int32_t d : dofs_of(e))
      for (const Entry& entry : entries(static_cast<std::size_t>(d)))
        body(static_cast<std::size_t>(entry.element));
  }

  void evaluate() {
    dofs_.resize(low_.size());
    for (std::size_t d = 0; d < dofs_.size(); ++d) {
      double f = 0.0;
      double size = 0.0;
      for (const Entry& entry : entries(d)) {
        const double part = alpha_[static_cast<std::size_t>(entry.element)] * flux_[entry.place];
        f += part;
        size += std::abs(part);
      }
      const double value = low_[d] + f / lumped_[d];
      // What is beyond the bounds by the rounding of this sum is put back.
      const double slack = 0x1p-49 * (scale_ + size / lumped_[d]);
      dofs_[d] = value > dof_.hi[d] && value <= dof_.hi[d] + slack   ? dof_.hi[d]
                 : value < dof_.lo[d] && value >= dof_.lo[d] - slack ? dof_.lo[d]
                                                                     : value;
    }
  }

  std::vector<double> gather(std::size_t e, const std::vector<double>& dofs, double sign) const {
    std::vector<double> b;
    for (const std::int32_t d : dofs_of(e)) b.push_back(sign * dofs[static_cast<std::size_t>(d)]);
    return b;
  }

  /// Notes the element's range. Returns 1 when it fits, else the factor for alpha that brings it
  /// into the bounds (0: not looked for).
  double inspect(std::size_t e, bool find) {
    double factor = 1.0;
    const int p = space_.degree(ElementId(e));
    for (const double sign : {1.0, -1.0}) {
      const double limit = sign > 0.0 ? element_.hi[e] : -element_.lo[e];
      const std::vector<double> now = gather(e, dofs_, sign);
      const auto [least, most] = std::minmax_element(now.begin(), now.end());
      const double slack = rounding * scale_;
      double top = *most;
      if (top > limit + slack) {
        const double tol = range_tolerance * (*most - *least);
        top = bernstein::upper_bound(p, now, limit + slack, tol);
        if (top > limit + slack)
          factor =
              std::min(factor, find ? blend(p, gather(e, low_, sign), now, limit, top, tol) : 0.0);
      }
      (sign > 0.0 ? range_[e].hi : range_[e].lo) = sign * top;
    }
    return factor;
  }

  /// The largest beta, nearly, with low + beta (now - low) <= limit. The maximum is a convex
  /// function of beta, so its chords cross the limit where it is within already.
  double blend(int p, const std::vector<double>& low, const std::vector<double>& now, double limit,
               double top, double tol) const {
    const double size =
        *std::max_element(low.begin(), low.end()) - *std::min_element(low.begin(), low.end());
    double beta = 0.0;
    double below = bernstein::range(p, low, std::max(tol, 1e-4 * size)).hi;
    for (int step = 0; step < 3 && below < limit; ++step) {
      beta += (1.0 - beta) * (limit - below) / (top - below);
      std::vector<double> mixed(low.size());
      for (std::size_t i = 0; i < low.size(); ++i) mixed[i] = low[i] + beta * (now[i] - low[i]);
      below = bernstein::upper_bound(p, mixed, limit - 0.1 * (top - limit), tol);
    }
    return std::max(0.0, 1.0 - margin * (1.0 - beta));
  }

  /// Zalesak's limiter: with alpha below these on all elements around a dof, it is in its bounds.
  void make_zalesak() {
    zalesak_.assign(alpha_.size(), 1.0);
    std::vector<double> up(low_.size());
    std::vector<double> down(low_.size());
    for (std::size_t d = 0; d < low_.size(); ++d) {
      double rise = 0.0;
      double fall = 0.0;
      for (const Entry& entry : entries(d)) {
        rise += std::max(0.0, flux_[entry.place]);
        fall += std::max(0.0, -flux_[entry.place]);
      }
      const double above = (dof_.hi[d] - low_[d]) * lumped_[d];
      const double below = (low_[d] - dof_.lo[d]) * lumped_[d];
      up[d] = rise > above ? above / rise : 1.0;
      down[d] = fall > below ? below / fall : 1.0;
    }
    for (std::size_t e = 0; e < zalesak_.size(); ++e) {
      const auto list = dofs_of(e);
      const std::size_t first = space_.offset(ElementId(e));
      for (std::size_t i = 0; i < list.size(); ++i) {
        const auto d = static_cast<std::size_t>(list[i]);
        const double f = flux_[first + i];
        if (f > 0.0) zalesak_[e] = std::min(zalesak_[e], up[d]);
        if (f < 0.0) zalesak_[e] = std::min(zalesak_[e], down[d]);
      }
    }
  }

  ContinuousMass& mass_;
  const Space& space_;
  int threads_;
  std::vector<std::size_t> begin_;  // per dof, where its entries start
  std::vector<Entry> entry_;
  std::vector<double> lumped_;  // m_i
  ValueBounds dof_, element_;
  std::vector<double> low_, flux_, alpha_, zalesak_, dofs_;
  std::vector<bernstein::Range> range_;
  double scale_ = 0.0;
};

}  // namespace

Limited limit_continuous(ContinuousMass& mass, std::span<const double> c, std::span<const double> x,
                         const ValueBounds& bounds, const std::string& what, int threads) {
  ContinuousLimiter limiter(mass, bounds, threads);
  const Redistribution low = limiter.make_low(c);
  check_room(what, limiter.dof_bounds(), limiter.lumped(), x, low);
  limiter.make_fluxes(x);
  limiter.limit();
  return limiter.result(x, low.moved);
}

}  // namespace bezel::detail
