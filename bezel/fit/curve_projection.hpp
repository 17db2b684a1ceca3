#pragma once
// A curve seen along a direction: the coordinate e . (g - g(-1)), where it is monotone.

#include <algorithm>
#include <cmath>

#include "bezel/fit/smooth_curve.hpp"

namespace bezel::curve_search {

template <int dim>
class Projection {
 public:
  /// @param direction  unit vector; the coordinate should grow along it from t = -1 to 1
  Projection(const SmoothCurve<dim>& curve, const Vec<dim>& direction)
      : curve_(curve), direction_(direction), origin_(curve.samples().front().x) {
    const auto samples = curve.samples();
    monotone_ = true;
    for (std::size_t i = 1; i < samples.size() && monotone_; ++i)
      monotone_ = coordinate(samples[i].x) > coordinate(samples[i - 1].x);
  }
  /// x as a coordinate, from the end that is further left.
  static Projection onto_x(const SmoothCurve<dim>& curve) {
    Vec<dim> e;
    e[0] = curve.samples().back().x[0] < curve.samples().front().x[0] ? -1.0 : 1.0;
    return Projection(curve, e);
  }

  /// Strictly, at the samples of the curve.
  bool monotone() const { return monotone_; }
  double coordinate(const Vec<dim>& x) const { return dot(direction_, x - origin_); }
  double span() const { return coordinate(curve_.samples().back().x); }

  /// The parameter where the coordinate is c: Newton, kept in a bracket that is halved where it
  /// fails, as where the curve starts at a right angle to the direction.
  double parameter(double c) const {
    const auto samples = curve_.samples();
    const auto above = std::partition_point(samples.begin(), samples.end(),
                                            [&](const auto& s) { return coordinate(s.x) < c; });
    if (above == samples.begin()) return -1.0;
    if (above == samples.end()) return 1.0;
    const auto below = std::prev(above);
    double lo = below->t, hi = above->t;
    const double c_lo = coordinate(below->x), c_hi = coordinate(above->x);
    double t = lo + (hi - lo) * ((c - c_lo) / (c_hi - c_lo));
    double width = hi - lo;
    for (int i = 0; i < 100; ++i) {
      const CurveJet<dim> jet = curve_(t);
      const double f = coordinate(jet.x) - c;
      const double newton = f / dot(direction_, jet.d1);
      if (std::fabs(newton) <= 4e-16) return std::clamp(t - newton, below->t, above->t);
      (f > 0.0 ? hi : lo) = t;
      double next = t - newton;
      // Every third step halves the bracket if the steps before did not.
      const bool slow = i % 3 == 2 && hi - lo > 0.5 * width;
      if (i % 3 == 2) width = hi - lo;
      if (slow || !(next > lo && next < hi)) next = lo + 0.5 * (hi - lo);
      if (!(next > lo && next < hi)) break;
      t = next;
    }
    return t;
  }

 private:
  const SmoothCurve<dim>& curve_;
  Vec<dim> direction_, origin_;
  bool monotone_;
};

}  // namespace bezel::curve_search
