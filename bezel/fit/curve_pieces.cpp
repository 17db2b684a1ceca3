// Several interpolants along one curve.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "bezel/base/error.hpp"
#include "bezel/fit/curve_interpolation.hpp"

namespace bezel {
namespace {

// The curve between its breakpoints.
template <int dim>
std::vector<double> smooth_ends(const SmoothCurve<dim>& curve) {
  std::vector<double> ends{-1.0};
  ends.insert(ends.end(), curve.breakpoints().begin(), curve.breakpoints().end());
  ends.push_back(1.0);
  return ends;
}

template <int dim>
CurvePiece<dim> make_piece(const CurveInterpolator& interpolator, const SmoothCurve<dim>& curve,
                           double t0, double t1, int degree, CurveMethod method) {
  if (t0 == -1.0 && t1 == 1.0) return {t0, t1, interpolator.interpolate(curve, degree, method)};
  return {t0, t1, interpolator.interpolate(curve.piece(t0, t1), degree, method)};
}

void check_degree(int degree) {
  if (degree < 1 || degree > max_curve_degree)
    throw InputError(fmt::format("curve degree {}, expected 1 to {}", degree, max_curve_degree));
}

// Parts of a curve, longest first from the left, each within a distance.
template <int dim>
class Splitter {
 public:
  Splitter(const SmoothCurve<dim>& curve, int degree, CurveMethod method)
      : curve_(curve), degree_(degree), method_(method), interpolator_(degree) {}
  const CurveInterpolator& interpolator() const { return interpolator_; }

  // Ends of the parts of [a, b]; stops when there are more than `most` of them. `largest` is the
  // largest distance met.
  std::vector<double> split(double a, double b, double tolerance, std::size_t most,
                            double& largest) {
    std::vector<double> ends{a};
    // Neither pieces nor tolerances without end.
    const double least = 1e-6 * (b - a);
    const double allowed = std::max(tolerance, 1e-15 * curve_.length());
    double width = b - a;
    largest = 0.0;
    while (ends.back() < b && ends.size() <= most) {
      const double start = ends.back();
      double good = 0.0, good_distance = 0.0, bad = HUGE_VAL;
      width = std::min(width, b - start);
      for (int trial = 0; trial < 24; ++trial) {
        const double end = b - start - width < 1e-3 * width ? b : start + width;
        const double d = distance(start, end);
        if (d <= allowed || width <= least) {
          good = end - start;
          good_distance = d;
          if (end == b) break;
        } else {
          bad = end - start;
        }
        if (good > 0.0 && bad < 1.01 * good) break;
        // Distances grow like a power of the width, at least degree + 1, aimed at a little less
        // than allowed; never by more than 2.
        double factor = 0.5;
        if (std::isfinite(d))
          factor = d > 0.0 ? std::pow(0.9 * allowed / d, 1.0 / (degree_ + 1)) : 2.0;
        width = (end - start) * std::clamp(factor, 0.5, 2.0);
        if (bad < HUGE_VAL && good > 0.0) {
          const double middle = std::sqrt(good * bad);
          if (!(width > good && width < bad) || trial > 6) width = middle;
        }
        width = std::min(width, b - start);
      }
      if (!(good > 0.0)) {
        good = bad;
        good_distance = distance(start, start + good);
      }
      ends.push_back(b - start - good < 1e-9 * (b - a) ? b : start + good);
      largest = std::max(largest, good_distance);
      width = 1.2 * good;
    }
    return ends;
  }

 private:
  double distance(double t0, double t1) const {
    const SmoothCurve<dim> piece = curve_.piece(t0, t1);
    const CurveNodes nodes = interpolator_.place(piece, degree_, method_);
    if (nodes.t.empty()) return HUGE_VAL;
    std::vector<Vec<dim>> nodal;
    for (const double t : nodes.t) nodal.push_back(piece(t).x);
    // Between its points the distance may be 2 percent larger.
    return 1.03 * interpolator_.largest_distance(piece, std::span<const Vec<dim>>(nodal));
  }
  const SmoothCurve<dim>& curve_;
  int degree_;
  CurveMethod method_;
  CurveInterpolator interpolator_;
};

}  // namespace

template <int dim>
std::vector<CurvePiece<dim>> interpolate_pieces(const SmoothCurve<dim>& curve, int degree,
                                                CurveMethod method) {
  check_degree(degree);
  const CurveInterpolator interpolator(degree);
  const std::vector<double> ends = smooth_ends(curve);
  std::vector<CurvePiece<dim>> pieces;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    pieces.push_back(make_piece(interpolator, curve, ends[i], ends[i + 1], degree, method));
  return pieces;
}

template <int dim>
AdaptiveCurve<dim> interpolate_adaptive(const SmoothCurve<dim>& curve, int degree,
                                        const AdaptiveCurveOptions& options, CurveMethod method) {
  check_degree(degree);
  if (!(options.tolerance > 0.0) || !std::isfinite(options.tolerance))
    throw InputError(
        fmt::format("tolerance {} of a curve, expected a positive number", options.tolerance));
  if (options.max_pieces < 1)
    throw InputError(fmt::format("{} pieces at most, expected 1 or more", options.max_pieces));
  Splitter<dim> splitter(curve, degree, method);
  const std::vector<double> smooth = smooth_ends(curve);
  AdaptiveCurve<dim> result;
  std::size_t room = std::size_t(options.max_pieces);
  for (std::size_t part = 0; part + 1 < smooth.size(); ++part) {
    const double a = smooth[part], b = smooth[part + 1];
    double largest = 0.0;
    std::vector<double> ends = splitter.split(a, b, options.tolerance, room, largest);
    if (ends.back() != b) {
      // No room: the rest of the part is one piece, and the result says that it is not reached.
      if (ends.size() == 1) ends.push_back(b);
      ends.back() = b;
    } else if (ends.size() > 2) {
      // The last piece took what was left. The least tolerance that needs no more pieces spreads
      // the error evenly.
      double lo = 0.0, hi = options.tolerance;
      for (int i = 0; i < 5; ++i) {
        const double middle = i == 0 ? hi / 8.0 : lo > 0.0 ? std::sqrt(lo * hi) : hi / 8.0;
        const auto tried = splitter.split(a, b, middle, ends.size() - 1, largest);
        const bool fits = tried.back() == b && tried.size() <= ends.size() && largest <= middle;
        (fits ? hi : lo) = middle;
        if (fits) ends = tried;
      }
    }
    room -= std::min(room, ends.size() - 1);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i)
      result.pieces.push_back(
          make_piece(splitter.interpolator(), curve, ends[i], ends[i + 1], degree, method));
  }
  for (const CurvePiece<dim>& piece : result.pieces) {
    const bool found = !piece.interpolant.nodal.empty();
    const double d = found ? piece.interpolant.errors.distance_max : HUGE_VAL;
    result.distance_max = std::max(result.distance_max, d);
  }
  result.reached = result.distance_max <= options.tolerance;
  return result;
}

template std::vector<CurvePiece<2>> interpolate_pieces(const SmoothCurve<2>&, int, CurveMethod);
template std::vector<CurvePiece<3>> interpolate_pieces(const SmoothCurve<3>&, int, CurveMethod);
template AdaptiveCurve<2> interpolate_adaptive(const SmoothCurve<2>&, int,
                                               const AdaptiveCurveOptions&, CurveMethod);
template AdaptiveCurve<3> interpolate_adaptive(const SmoothCurve<3>&, int,
                                               const AdaptiveCurveOptions&, CurveMethod);

}  // namespace bezel
