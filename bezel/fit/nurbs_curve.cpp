// Bezier, B-spline and NURBS curves, as Bezier pieces.

#include <algorithm>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/checks.hpp"
#include "bezel/fit/curve_interval.hpp"
#include "bezel/fit/curve_sources.hpp"
#include "bezel/fit/rational_pieces.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using short_names::at;

/// Control points in homogeneous coordinates.
template <int dim>
std::vector<Vec<dim + 1>> homogeneous(std::span<const Vec<dim>> control,
                                      std::span<const double> weights) {
  bernstein::checks::finite(control, "control point");
  if (!weights.empty() && weights.size() != control.size())
    throw InputError("found " + std::to_string(weights.size()) + " weights and " +
                     std::to_string(control.size()) + " control points, expected as many");
  bernstein::checks::finite(weights, "weight");
  std::vector<Vec<dim + 1>> out(control.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double w = weights.empty() ? 1.0 : weights[i];
    if (!(w > 0.0))
      throw InputError("weight " + std::to_string(i) + " is " + std::to_string(w) +
                       ", expected a positive one");
    for (int c = 0; c < dim; ++c) out[i][c] = w * control[i][c];
    out[i][dim] = w;
  }
  return out;
}

void check_knots(int degree, std::span<const double> knots, std::size_t points) {
  if (degree < 1 || degree > 30)
    throw InputError("found degree " + std::to_string(degree) + " of a B-spline, expected 1 to 30");
  const std::size_t order = at(degree) + 1;
  if (points < order || points > 10000)
    throw InputError("found " + std::to_string(points) +
                     " control points of a B-spline of degree " + std::to_string(degree) +
                     ", expected " + std::to_string(order) + " to 10000");
  if (knots.size() != points + order)
    throw InputError("found " + std::to_string(knots.size()) + " knots, expected " +
                     std::to_string(points + order) + " (control points + degree + 1)");
  bernstein::checks::finite(knots, "knot");
  for (std::size_t i = 1; i < knots.size(); ++i)
    if (knots[i] < knots[i - 1])
      throw InputError("knot " + std::to_string(i) + " is below the one before it");
  if (!(knots[order - 1] < knots[points]))
    throw InputError("the knots leave no interval, expected knot " + std::to_string(degree) +
                     " below knot " + std::to_string(points));
  // One of multiplicity degree + 1 would tear the curve apart.
  for (std::size_t i = 1; i + order <= points; ++i)
    if (knots[i] == knots[i + order - 1] && knots[i] > knots[order - 1] && knots[i] < knots[points])
      throw InputError("knot " + std::to_string(i) + " stands more than " + std::to_string(degree) +
                       " times, expected at most as often as the degree");
}

}  // namespace

template <int dim>
SmoothCurve<dim> bezier_curve(std::span<const Vec<dim>> control, std::span<const double> weights) {
  constexpr int most = fit::RationalPieces<dim>::max_degree;
  if (control.size() < 2 || control.size() > at(most) + 1)
    throw InputError("found " + std::to_string(control.size()) +
                     " control points of a Bezier curve, expected 2 to " +
                     std::to_string(most + 1));
  const int degree = static_cast<int>(control.size()) - 1;
  return fit::on_interval<dim>(fit::RationalPieces<dim>(degree, !weights.empty(), {0.0, 1.0},
                                                        homogeneous<dim>(control, weights)),
                               0.0, 1.0);
}

template <int dim>
SmoothCurve<dim> nurbs_curve(int degree, std::span<const double> knots,
                             std::span<const Vec<dim>> control, std::span<const double> weights) {
  check_knots(degree, knots, control.size());
  const auto points = homogeneous<dim>(control, weights);
  std::vector<double> breaks;
  std::vector<Vec<dim + 1>> pieces, d(at(degree) + 1);
  for (std::size_t k = at(degree); k < points.size(); ++k) {
    const double lo = knots[k], hi = knots[k + 1];
    if (!(lo < hi)) continue;
    breaks.push_back(lo);
    // The piece's control points are the blossom at lo, ..., lo, hi, ..., hi.
    for (int ends = 0; ends <= degree; ++ends) {
      const std::size_t first = k - at(degree);
      std::copy_n(points.begin() + static_cast<std::ptrdiff_t>(first), degree + 1, d.begin());
      for (int r = 1; r <= degree; ++r) {
        const double u = r <= ends ? hi : lo;
        for (int j = degree; j >= r; --j) {
          const double left = knots[first + at(j)], right = knots[first + at(j + degree + 1 - r)];
          const double s = (u - left) / (right - left);
          d[at(j)] = (1.0 - s) * d[at(j - 1)] + s * d[at(j)];
        }
      }
      pieces.push_back(d[at(degree)]);
    }
  }
  breaks.push_back(knots[points.size()]);
  const double from = breaks.front(), to = breaks.back();
  const std::vector<double> inside(breaks.begin() + 1, breaks.end() - 1);
  return fit::on_interval<dim>(
      fit::RationalPieces<dim>(degree, !weights.empty(), std::move(breaks), std::move(pieces)),
      from, to, inside);
}

template SmoothCurve<2> bezier_curve(std::span<const Vec2>, std::span<const double>);
template SmoothCurve<3> bezier_curve(std::span<const Vec3>, std::span<const double>);
template SmoothCurve<2> nurbs_curve(int, std::span<const double>, std::span<const Vec2>,
                                    std::span<const double>);
template SmoothCurve<3> nurbs_curve(int, std::span<const double>, std::span<const Vec3>,
                                    std::span<const double>);

}  // namespace bezel
