#include "bezel/fit/boundary_match.hpp"

#include <algorithm>
#include <cmath>

namespace bezel::fit {
namespace {

constexpr int samples_per_part = 96;
constexpr double longest_arc = 4.0;  // times the chord

}  // namespace

CurveFeet::CurveFeet(const SmoothCurve<2>& curve) : curve_(curve) {
  special_ = {-1.0};
  special_.insert(special_.end(), curve.breakpoints().begin(), curve.breakpoints().end());
  special_.push_back(1.0);
  const auto parts = static_cast<int>(special_.size()) - 1;
  const int samples = std::max(4, samples_per_part / parts);
  for (std::size_t k = 0; k + 1 < special_.size(); ++k)
    for (int i = 0; i < samples; ++i)
      t_.push_back(special_[k] + (special_[k + 1] - special_[k]) * i / samples);
  t_.push_back(1.0);
  double before = 0.0;
  for (std::size_t i = 0; i < t_.size(); ++i) {
    x_.push_back(curve(t_[i]).x);
    if (i == 0) continue;
    const double length = curve.length_to(t_[i]);
    reach_.push_back(length - before);
    before = length;
  }
}

bool CurveFeet::closed(double tolerance) const {
  return norm(x_.front() - x_.back()) <= tolerance;
}

std::optional<double> CurveFeet::nearest(const Vec2& p, double lo, double hi) const {
  const auto slope = [&](double t) {
    const CurveJet<2> jet = curve_(t);
    return dot(jet.x - p, jet.d1);
  };
  // At an end the distance is smallest only when the curve ends, or has a corner, there.
  const auto end = [&](double t, bool smallest) -> std::optional<double> {
    if (smallest || std::binary_search(special_.begin(), special_.end(), t)) return t;
    return {};
  };
  const double first = slope(lo), last = slope(hi);
  if (first >= 0.0) return end(lo, first == 0.0);
  if (last <= 0.0) return end(hi, last == 0.0);
  double t = 0.5 * (lo + hi);
  for (int i = 0; i < 100 && hi - lo > 0x1p-53; ++i) {
    const CurveJet<2> jet = curve_(t);
    const Vec2 gap = jet.x - p;
    const double value = dot(gap, jet.d1);
    (value < 0.0 ? lo : hi) = t;
    const double second = dot(jet.d1, jet.d1) + dot(gap, jet.d2);
    const double newton = t - value / second;
    const double next = second > 0.0 && newton > lo && newton < hi ? newton : 0.5 * (lo + hi);
    if (next == t || value == 0.0) break;
    t = next;
  }
  return t;
}

std::vector<double> CurveFeet::feet(const Vec2& p, double tolerance) const {
  std::vector<double> out;
  const auto add = [&](double t) {
    for (const double s : special_)
      if (norm(curve_(s).x - p) <= tolerance &&
          std::fabs(curve_.length_to(s) - curve_.length_to(t)) <= 2.0 * tolerance)
        t = s;
    if (out.empty() || t - out.back() > 1e-9) out.push_back(t);
  };
  for (std::size_t i = 0; i + 1 < t_.size(); ++i) {
    // No point of the interval is further from its start than it is long.
    if (norm(p - x_[i]) > 1.01 * reach_[i] + tolerance) continue;
    const std::optional<double> t = nearest(p, t_[i], t_[i + 1]);
    if (t && norm(curve_(*t).x - p) <= tolerance) add(*t);
  }
  return out;
}

std::optional<CurvePart> find_part(std::span<const CurveFeet> curves, const Vec2& a, const Vec2& b,
                                   double tolerance) {
  std::optional<CurvePart> best;
  const double most = longest_arc * norm(b - a);
  const auto offer = [&](const CurvePart& part) {
    if (part.length > most || !(part.length > 0.0)) return;
    if (!best || part.length < best->length) best = part;
  };
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const std::vector<double> first = curves[c].feet(a, tolerance);
    if (first.empty()) continue;
    const std::vector<double> second = curves[c].feet(b, tolerance);
    const SmoothCurve<2>& g = curves[c].curve();
    for (const double ta : first)
      for (const double tb : second) {
        if (ta == tb) continue;
        const double lo = std::min(ta, tb), hi = std::max(ta, tb);
        const double length = g.length_to(hi) - g.length_to(lo);
        offer({c, lo, hi, false, tb < ta, length});
        if (curves[c].closed(tolerance) && lo > -1.0 && hi < 1.0)
          offer({c, hi, lo, true, ta < tb, g.length() - length});
      }
  }
  return best;
}

SmoothCurve<2> cut(const SmoothCurve<2>& curve, const CurvePart& part) {
  if (!part.seam) return curve.piece(part.t0, part.t1);
  const double before = 1.0 - part.t0, span = before + (part.t1 + 1.0), half = 0.5 * span;
  const auto place = [&](double t) {  // of a parameter of the curve
    return (t >= part.t0 ? t - part.t0 : before + t + 1.0) / half - 1.0;
  };
  std::vector<double> breaks = {before / half - 1.0};
  for (const double t : curve.breakpoints())
    if (t > part.t0 || t < part.t1) breaks.push_back(place(t));
  std::sort(breaks.begin(), breaks.end());
  return SmoothCurve<2>(
      [curve, part, before, half](double u) {
        const double along = (1.0 + u) * half;
        const double t = u >= 1.0         ? part.t1
                         : along < before ? std::min(part.t0 + along, 1.0)
                                          : std::min(along - before - 1.0, part.t1);
        CurveJet<2> jet = curve(t);
        jet.d1 *= half;
        jet.d2 *= half * half;
        return jet;
      },
      std::move(breaks));
}

}  // namespace bezel::fit
