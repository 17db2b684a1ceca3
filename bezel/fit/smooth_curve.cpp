#include "bezel/fit/smooth_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel {
namespace {

constexpr int fitted_samples_per_part = 64;
constexpr std::size_t max_panels = 2000;
// Derivatives at a breakpoint are taken this fraction of the part inside it.
constexpr double side = 0x1p-40;

const IntervalRule& panel_rule() {
  static const IntervalRule rule = gauss_legendre(16);
  return rule;
}

template <int dim>
bool finite(const Vec<dim>& v) {
  for (int i = 0; i < dim; ++i)
    if (!std::isfinite(v[i])) return false;
  return true;
}

void check_breakpoints(const std::vector<double>& points) {
  double last = -1.0;
  for (const double b : points) {
    if (!(b > last && b < 1.0))
      throw InputError(
          fmt::format("breakpoint {} of the curve, expected an ascending list inside (-1, 1)", b));
    last = b;
  }
}

template <int dim>
double gauss_length(const std::function<CurveJet<dim>(double)>& g, double a, double b) {
  const IntervalRule& rule = panel_rule();
  double sum = 0.0;
  for (std::size_t q = 0; q < rule.node.size(); ++q)
    sum += rule.weight[q] * norm(g(a + (b - a) * rule.node[q]).d1);
  return sum * (b - a);
}

}  // namespace

template <int dim>
SmoothCurve<dim>::SmoothCurve(Function function, std::vector<double> breakpoints) {
  if (!function) throw InputError("a curve needs a function, found an empty one");
  check_breakpoints(breakpoints);
  auto state = std::make_shared<State>();
  state->function = std::move(function);
  state->breakpoints = std::move(breakpoints);
  std::vector<double> ends{-1.0};
  ends.insert(ends.end(), state->breakpoints.begin(), state->breakpoints.end());
  ends.push_back(1.0);

  double slowest = HUGE_VAL, fastest = 0.0, slowest_at = 0.0;
  for (std::size_t part = 0; part + 1 < ends.size(); ++part) {
    for (int i = part == 0 ? 0 : 1; i <= fitted_samples_per_part; ++i) {
      const double t = i == fitted_samples_per_part ? ends[part + 1]
                                                    : ends[part] + (ends[part + 1] - ends[part]) *
                                                                       i / fitted_samples_per_part;
      const CurveJet<dim> jet = state->function(t);
      if (!finite(jet.x) || !finite(jet.d1) || !finite(jet.d2))
        throw InputError(
            fmt::format("the curve at t = {:.6g}: a point or derivative that is not finite", t));
      state->samples.push_back({t, jet.x});
      const double speed = norm(jet.d1);
      fastest = std::max(fastest, speed);
      if (speed < slowest) {
        slowest = speed;
        slowest_at = t;
      }
    }
  }
  if (!std::isfinite(fastest) || !(slowest > 1e-12 * fastest))
    throw InputError(
        fmt::format("the curve at t = {:.6g}: speed {:.3g}, expected above 1e-12 of "
                    "the largest, {:.3g}",
                    slowest_at, slowest, fastest));

  // Depth first from left to right: the panels come out in ascending order.
  struct Work {
    double a, b, length;
  };
  std::vector<Work> stack;
  double rough = 0.0;
  for (std::size_t part = ends.size() - 1; part-- > 0;) {
    const double width = (ends[part + 1] - ends[part]) / 2.0;
    for (int half = 1; half >= 0; --half) {
      const double a = half == 1 ? ends[part] + width : ends[part];
      const double b = half == 1 ? ends[part + 1] : ends[part] + width;
      stack.push_back({a, b, gauss_length<dim>(state->function, a, b)});
      rough += stack.back().length;
    }
  }
  double length = 0.0;
  while (!stack.empty()) {
    const Work w = stack.back();
    stack.pop_back();
    const double middle = w.a + (w.b - w.a) / 2.0;
    const Work left{w.a, middle, gauss_length<dim>(state->function, w.a, middle)};
    const Work right{middle, w.b, gauss_length<dim>(state->function, middle, w.b)};
    const bool fine = std::fabs(left.length + right.length - w.length) <= 1e-15 * rough;
    if (fine || state->panels.size() + stack.size() > max_panels) {
      for (const Work& half : {left, right}) {
        length += half.length;
        state->panels.push_back({half.b, length});
      }
    } else {
      stack.push_back(right);
      stack.push_back(left);
    }
  }
  if (!std::isfinite(length)) throw InputError("the length of the curve is not finite");
  state_ = std::move(state);
}

template <int dim>
double SmoothCurve<dim>::length_to(double t) const {
  const auto& panels = state_->panels;
  const auto panel = std::lower_bound(panels.begin(), panels.end(), t,
                                      [](const Panel& p, double value) { return p.t < value; });
  if (panel == panels.end()) return length();
  if (panel->t == t) return panel->length_before;
  const bool first = panel == panels.begin();
  const double a = first ? -1.0 : std::prev(panel)->t;
  return (first ? 0.0 : std::prev(panel)->length_before) +
         gauss_length<dim>(state_->function, a, t);
}

template <int dim>
double SmoothCurve<dim>::at_length(double s) const {
  const auto& panels = state_->panels;
  if (!(s > 0.0)) return -1.0;
  if (s >= length()) return 1.0;
  const auto panel =
      std::lower_bound(panels.begin(), panels.end(), s,
                       [](const Panel& p, double value) { return p.length_before < value; });
  const bool first = panel == panels.begin();
  double lo = first ? -1.0 : std::prev(panel)->t, hi = panel->t;
  const double s_lo = first ? 0.0 : std::prev(panel)->length_before;
  const double start = lo;
  double t = lo + (hi - lo) * ((s - s_lo) / (panel->length_before - s_lo));
  // Newton in a bracket: the length grows with t.
  for (int i = 0; i < 60; ++i) {
    const double f = s_lo + gauss_length<dim>(state_->function, start, t) - s;
    const double step = f / norm(state_->function(t).d1);
    // Quadratic: after a step of 1e-9 of the panel the error is near 1e-18.
    if (std::fabs(step) <= 1e-9 * (panel->t - start)) return std::clamp(t - step, start, panel->t);
    (f > 0.0 ? hi : lo) = t;
    t = t - step > lo && t - step < hi ? t - step : lo + (hi - lo) / 2.0;
  }
  return t;
}

template <int dim>
SmoothCurve<dim> SmoothCurve<dim>::piece(double t0, double t1) const {
  if (!(t0 >= -1.0 && t0 < t1 && t1 <= 1.0))
    throw InputError(fmt::format("piece [{}, {}] of a curve on [-1, 1]", t0, t1));
  const auto& all = state_->breakpoints;
  const bool left = std::binary_search(all.begin(), all.end(), t0);
  const bool right = std::binary_search(all.begin(), all.end(), t1);
  const double half = (t1 - t0) / 2.0;
  std::vector<double> inner;
  for (const double b : all)
    if (b > t0 && b < t1) inner.push_back(std::clamp((b - t0) / half - 1.0, -1.0, 1.0));
  auto function = [state = state_, t0, t1, half, left, right](double s) {
    const double t = s <= -1.0 ? t0 : s >= 1.0 ? t1 : t0 + half * (1.0 + s);
    CurveJet<dim> jet = state->function(t);
    if ((left && t == t0) || (right && t == t1)) {
      const CurveJet<dim> inside = state->function(t + (t == t0 ? side : -side) * (t1 - t0));
      jet.d1 = inside.d1;
      jet.d2 = inside.d2;
    }
    jet.d1 *= half;
    jet.d2 *= half * half;
    return jet;
  };
  return SmoothCurve(std::move(function), std::move(inner));
}

template class SmoothCurve<2>;
template class SmoothCurve<3>;

}  // namespace bezel
