// Cubic splines through points.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/checks.hpp"
#include "bezel/fit/curve_interval.hpp"
#include "bezel/fit/curve_sources.hpp"
#include "bezel/fit/rational_pieces.hpp"

namespace bezel {
namespace {

constexpr std::size_t most_points = 10000;

/// Solves lower[i] x[i-1] + diagonal[i] x[i] + upper[i] x[i+1] = right[i], diagonally dominant.
template <class Value>
void solve_tridiagonal(const std::vector<double>& lower, std::vector<double> diagonal,
                       const std::vector<double>& upper, std::vector<Value>& right) {
  const std::size_t n = diagonal.size();
  for (std::size_t i = 1; i < n; ++i) {
    const double factor = lower[i] / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    right[i] -= factor * right[i - 1];
  }
  right[n - 1] *= 1.0 / diagonal[n - 1];
  for (std::size_t i = n - 1; i-- > 0;)
    right[i] = (1.0 / diagonal[i]) * (right[i] - upper[i] * right[i + 1]);
}

/// Second derivatives at the points p of the closed spline; h[i] from p[i] to p[i+1], cyclic.
template <int dim>
std::vector<Vec<dim>> closed_moments(const std::vector<Vec<dim>>& slope,
                                     const std::vector<double>& h) {
  // Sherman and Morrison: the cyclic matrix is a tridiagonal one plus an outer product.
  const std::size_t n = h.size();
  std::vector<double> lower(n), diagonal(n), upper(n), corner(n, 0.0);
  std::vector<Vec<dim>> x(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    lower[i] = h[before];
    diagonal[i] = 2.0 * (h[before] + h[i]);
    upper[i] = h[i];
    x[i] = 6.0 * (slope[i] - slope[before]);
  }
  const double wrap = h[n - 1], pivot = -diagonal[0];
  diagonal[0] -= pivot;
  diagonal[n - 1] -= wrap * wrap / pivot;
  corner[0] = pivot;
  corner[n - 1] = wrap;
  solve_tridiagonal(lower, diagonal, upper, x);
  solve_tridiagonal(lower, diagonal, upper, corner);
  const double share = wrap / pivot;
  const double scale = 1.0 / (1.0 + corner[0] + share * corner[n - 1]);
  const Vec<dim> factor = scale * (x[0] + share * x[n - 1]);
  for (std::size_t i = 0; i < n; ++i) x[i] -= corner[i] * factor;
  x.push_back(x[0]);
  return x;
}

/// The same for an open spline of h.size() + 1 points.
template <int dim>
std::vector<Vec<dim>> open_moments(const std::vector<Vec<dim>>& slope, const std::vector<double>& h,
                                   bool natural) {
  const std::size_t n = h.size() - 1;  // points inside
  std::vector<Vec<dim>> moments(n + 2);
  if (n == 0) return moments;
  std::vector<double> lower(n), diagonal(n), upper(n);
  std::vector<Vec<dim>> x(n);
  for (std::size_t i = 0; i < n; ++i) {
    lower[i] = h[i];
    diagonal[i] = 2.0 * (h[i] + h[i + 1]);
    upper[i] = h[i + 1];
    x[i] = 6.0 * (slope[i + 1] - slope[i]);
  }
  // Not a knot: the second derivative is linear over the first two pieces, and the last two; with
  // three points it is constant.
  const double first = h[0] / h[1], last = h[n] / h[n - 1];
  if (!natural && n == 1) {
    diagonal[0] *= 1.5;
  } else if (!natural) {
    diagonal[0] += h[0] * (1.0 + first);
    upper[0] -= h[0] * first;
    diagonal[n - 1] += h[n] * (1.0 + last);
    lower[n - 1] -= h[n] * last;
  }
  solve_tridiagonal(lower, diagonal, upper, x);
  std::copy(x.begin(), x.end(), moments.begin() + 1);
  if (!natural) {
    moments[0] = n == 1 ? x[0] : x[0] + first * (x[0] - x[1]);
    moments[n + 1] = n == 1 ? x[0] : x[n - 1] + last * (x[n - 1] - x[n - 2]);
  }
  return moments;
}

template <int dim>
std::vector<Vec<dim>> checked_points(std::span<const Vec<dim>> points, bool closed) {
  bernstein::checks::finite(points, "point");
  std::vector<Vec<dim>> p(points.begin(), points.end());
  if (closed && p.size() > 1 && p.front() == p.back()) p.pop_back();
  const std::size_t least = closed ? 3 : 2;
  if (p.size() < least || p.size() > most_points)
    throw InputError("found " + std::to_string(p.size()) + " points of a spline, expected " +
                     std::to_string(least) + " to " + std::to_string(most_points));
  if (closed) p.push_back(p.front());
  for (std::size_t i = 1; i < p.size(); ++i)
    if (!(norm(p[i] - p[i - 1]) > 0.0))
      throw InputError("point " + std::to_string(i) +
                       " equals the one before it, expected different points");
  return p;
}

}  // namespace

template <int dim>
SmoothCurve<dim> spline_curve(std::span<const Vec<dim>> points, SplineEnds ends, double exponent) {
  if (!(exponent >= 0.0 && exponent <= 1.0))
    throw InputError("found an exponent of " + std::to_string(exponent) + ", expected 0 to 1");
  const bool closed = ends == SplineEnds::closed;
  const std::vector<Vec<dim>> p = checked_points(points, closed);
  const std::size_t pieces = p.size() - 1;
  std::vector<double> h(pieces), breaks(p.size(), 0.0);
  std::vector<Vec<dim>> slope(pieces);
  for (std::size_t i = 0; i < pieces; ++i) {
    breaks[i + 1] = breaks[i] + std::pow(norm(p[i + 1] - p[i]), exponent);
    h[i] = breaks[i + 1] - breaks[i];
    if (!(h[i] > 0.0) || !std::isfinite(h[i]))
      throw InputError("points " + std::to_string(i) + " and " + std::to_string(i + 1) +
                       " are too close to each other for the length of the spline, or too far");
    slope[i] = (1.0 / h[i]) * (p[i + 1] - p[i]);
  }
  const std::vector<Vec<dim>> m = closed ? closed_moments<dim>(slope, h)
                                         : open_moments<dim>(slope, h, ends == SplineEnds::natural);
  std::vector<Vec<dim + 1>> control;
  const auto add = [&](const Vec<dim>& q) {
    Vec<dim + 1>& c = control.emplace_back();
    for (int i = 0; i < dim; ++i) c[i] = q[i];
    c[dim] = 1.0;
  };
  for (std::size_t i = 0; i < pieces; ++i) {
    add(p[i]);
    add(p[i] + (h[i] / 3.0) * (slope[i] - (h[i] / 6.0) * (2.0 * m[i] + m[i + 1])));
    add(p[i + 1] - (h[i] / 3.0) * (slope[i] + (h[i] / 6.0) * (m[i] + 2.0 * m[i + 1])));
    add(p[i + 1]);
  }
  const double to = breaks.back();
  const std::vector<double> inside(breaks.begin() + 1, breaks.end() - 1);
  return fit::on_interval<dim>(
      fit::RationalPieces<dim>(3, false, std::move(breaks), std::move(control)), 0.0, to, inside);
}

template SmoothCurve<2> spline_curve(std::span<const Vec2>, SplineEnds, double);
template SmoothCurve<3> spline_curve(std::span<const Vec3>, SplineEnds, double);

}  // namespace bezel
