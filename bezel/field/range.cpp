// Certified range on one element: by its polynomial in reference coordinates, or piece by piece.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bezel/base/error.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/field/element_range.hpp"
#include "bezel/field/piece_bounds.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using bernstein::Range;
using bernstein::triangle_index;
using bernstein::triangle_size;
using field_detail::check_component;
using field_detail::component_of;
using field_detail::composable;
using field_detail::largest;
using field_detail::piece_bounds;
using short_names::at;
using short_names::u;

/// Bound of the rounding error of Frame::lambda at a point.
double lambda_error(const Frame& frame, const Vec2& p) {
  const Vec2 r = p - frame.centre;
  double size = 1.0;
  for (const Vec2& g : frame.gradient) size += std::abs(g.x() * r.x()) + std::abs(g.y() * r.y());
  return 4.0 * u * size;
}

}  // namespace

ReferencePolynomial reference_polynomial(const Field& field, ElementId e, int component) {
  check_component(field, component);
  const Space& space = field.space();
  std::vector<double> c = component_of(field, e, component);  // checks e
  const int d = space.degree(e);
  if (space.basis() == Basis::reference) return {d, std::move(c), 0.0};
  const int g = field.mesh().degree();
  if (d * g > bernstein::max_triangle_degree)
    throw InputError({{}, 0, "triangle", e.value},
                     fmt::format("its polynomial has degree {} x {} = {} in reference coordinates, "
                                 "the limit is {}",
                                 d, g, d * g, bernstein::max_triangle_degree));
  // The frame's barycentrics of the control points are the Bernstein coefficients of lambda_k(u,
  // v).
  const field_detail::ElementMap map(field.mesh(), e);
  std::array<std::vector<double>, 3> lambda;
  double growth = 1.0, rounding = 0.0;
  for (const Vec2& p : map.control()) {
    const Lambda l = space.frame(e).lambda(p);
    rounding = std::max(rounding, lambda_error(space.frame(e), p));
    for (std::size_t k = 0; k < 3; ++k) lambda[k].push_back(l[k]);
    growth = std::max(growth, std::abs(l[0]) + std::abs(l[1]) + std::abs(l[2]));
  }
  // Each of the d steps multiplies by lambda and adds: a coefficient of a product is a sum of at
  // most triangle_size(g) products of relative error a few u whose weights sum to 1, and three
  // lambda are off by `rounding` each. Twice the first-order sum covers the higher orders.
  const double step = (triangle_size(g) + 8) * u * growth + 3.0 * rounding;
  const double bound = 2.0 * d * step * std::pow(growth, d) * largest(c);
  std::vector<std::vector<double>> layer;
  for (const double x : c) layer.push_back({x});
  for (int r = 1; r <= d;
       ++r) {  // layer: polynomials of degree g (r-1), one per index of degree d-r+1
    std::vector<std::vector<double>> next;
    for (int row = 0; row <= d - r; ++row)
      for (int j = 0; j + row <= d - r; ++j) {
        const std::array<int, 3> from{triangle_index(d - r + 1, j, row),
                                      triangle_index(d - r + 1, j + 1, row),
                                      triangle_index(d - r + 1, j, row + 1)};
        std::vector<double> sum(at(triangle_size(g * r)), 0.0);
        for (std::size_t k = 0; k < 3; ++k) {
          const std::vector<double> product =
              bernstein::multiply(g, lambda[k], g * (r - 1), layer[at(from[k])]);
          for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += product[i];
        }
        next.push_back(std::move(sum));
      }
    layer = std::move(next);
  }
  return {d * g, std::move(layer[0]), bound};
}

Range element_range(const Field& field, ElementId e, int component, double tol) {
  check_component(field, component);
  if (!(tol >= 0.0)) throw InputError(fmt::format("found tolerance {}, expected at least 0", tol));
  (void)field.coefficients(e);  // checks e
  if (!composable(field, e))
    return piece_bounds(field, e, component).range(field.mesh().gather(e), tol);
  const ReferencePolynomial p = reference_polynomial(field, e, component);
  const Range range = bernstein::range(p.degree, p.c, tol);
  return {range.lo - p.error_bound, range.hi + p.error_bound};
}

}  // namespace bezel
