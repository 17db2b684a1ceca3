// Integrals and norms of fields.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/field/field.hpp"
#include "bezel/field/formula_kernel.hpp"
#include "bezel/field/survey.hpp"
#include "bezel/numeric/short_names.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel {
namespace {

using field_detail::ElementMap;
using field_detail::MapPoint;
using field_detail::RuleTable;
using short_names::at;

/// Weights of a rule times the Jacobian determinant.
std::vector<double> measure(ElementMap map, std::span<const Lambda> lambda,
                            std::span<const double> weight) {
  map.make_round_for_det();
  std::vector<double> w(weight.size());
  for (std::size_t q = 0; q < w.size(); ++q) w[q] = weight[q] * map.det(lambda[q]);
  return w;
}

/// Column k of values (points, n).
std::vector<double> column(std::span<const double> values, std::size_t n, std::size_t k) {
  std::vector<double> c(values.size() / n);
  for (std::size_t q = 0; q < c.size(); ++q) c[q] = values[q * n + k];
  return c;
}

/// sqrt(a / b) of squared norms; 0 / 0 = 0.
double ratio(double a, double b) {
  if (b > 0.0) return std::sqrt(a / b);
  return a > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

field_detail::Survey look(const Field& field, const field_detail::SurveyAim& aim, int threads) {
  return field_detail::survey(field.space(), field_detail::columns_of(std::array{&field}), aim,
                              threads);
}

}  // namespace

std::vector<double> element_integrals(const Field& field, int threads) {
  field_detail::SpaceMeasures measures(field.space_ptr(), threads);
  return look(field, {measures.basis_integrals()}, threads).integrals;
}

std::vector<double> integral(const Field& field, int threads) {
  return field_detail::integral(element_integrals(field, threads), at(field.components()));
}

std::vector<double> integral_abs(const Field& field, int threads) {
  field_detail::SpaceMeasures measures(field.space_ptr(), threads);
  const field_detail::SurveyAim aim{measures.basis_integrals(), &measures.absolute()};
  return field_detail::integral(look(field, aim, threads).absolute, at(field.components()));
}

double l2_norm(const Field& field, int threads) {
  const Space& space = field.space();
  const std::size_t n = at(field.components());
  const RuleTable rules(space, [&](int p) { return field_detail::integrand_degree(space, 2 * p); });
  std::vector<double> squares(field.mesh().element_count());
  field_detail::for_elements(
      field.mesh(),
      [&](ElementId e) {
        const TriangleRule& rule = rules(space.degree(e));
        const std::vector<double> w =
            measure(ElementMap(field.mesh(), e), rule.lambda, rule.weight);
        std::vector<double> values(w.size() * n);
        field.evaluate(e, rule.lambda, values);
        double total = 0.0;
        for (std::size_t k = 0; k < n; ++k) {
          std::vector<double> f = column(values, n, k);
          for (double& x : f) x *= x;
          total += dot(w, f);
        }
        squares[e.index()] = total;
      },
      threads);
  return std::sqrt(std::max(0.0, sum(squares)));
}

ErrorNorms error_norms(const Field& field, std::span<const Formula> exact, int extra, int threads) {
  const Space& space = field.space();
  const std::size_t n = at(field.components());
  if (exact.size() != n)
    throw InputError(
        fmt::format("found {} formulas, expected one for each of the {} components of field '{}'",
                    exact.size(), n, field.name()));
  for (const Formula& f : exact) field_detail::check_formula(f);
  if (extra < 0 || extra > 60)
    throw InputError(fmt::format("found extra degree {}, expected 0..60", extra));
  const RuleTable rules(
      space, [&](int p) { return field_detail::integrand_degree(space, 2 * p + extra); });
  const std::size_t elements = field.mesh().element_count();
  std::vector<double> squares(elements), norms(elements), gradients(elements), integrals(elements),
      largest(elements);
  field_detail::for_elements(
      field.mesh(),
      [&](ElementId e) {
        const TriangleRule& rule = rules(space.degree(e));
        const ElementMap map(field.mesh(), e);
        const std::size_t points = rule.weight.size();
        const int lattice = std::max(4, space.degree(e) + 2);
        // Quadrature points, then lattice points (for max only).
        std::vector<Lambda> lambda = rule.lambda;
        for (int i = 0; i < bernstein::triangle_size(lattice); ++i)
          lambda.push_back(field_detail::lattice_point(lattice, i));
        std::vector<Vec2> x(lambda.size());
        for (std::size_t q = 0; q < lambda.size(); ++q) x[q] = map(lambda[q]);
        const std::vector<double> w = measure(map, rule.lambda, rule.weight);
        std::vector<double> found(lambda.size() * n);
        field.evaluate(e, lambda, found);
        std::vector<double> expected(lambda.size()), error(points), square(points),
            norm_square(points);
        for (std::size_t k = 0; k < n; ++k) {
          field_detail::evaluate_formula(exact[k], x, expected, e);
          for (std::size_t q = 0; q < lambda.size(); ++q) {
            const double difference = found[q * n + k] - expected[q];
            largest[e.index()] = std::max(largest[e.index()], std::abs(difference));
            if (q >= points) continue;
            error[q] = difference;
            square[q] = difference * difference;
            norm_square[q] = expected[q] * expected[q];
          }
          integrals[e.index()] += dot(w, error);
          squares[e.index()] += dot(w, square);
          norms[e.index()] += dot(w, norm_square);
        }
        std::vector<double> slope(2 * n), total(points);
        for (std::size_t q = 0; q < points; ++q) {
          field.gradient(e, rule.lambda[q], slope);
          for (std::size_t k = 0; k < n; ++k) {
            const Vec2 g = field_detail::formula_gradient(exact[k], x[q], e);
            const Vec2 difference = Vec2{slope[2 * k], slope[2 * k + 1]} - g;
            total[q] += dot(difference, difference);
          }
        }
        gradients[e.index()] = dot(w, total);
      },
      threads);
  const double square = std::max(0.0, sum(squares));
  return {std::sqrt(square), ratio(square, sum(norms)),
          elements == 0 ? 0.0 : *std::max_element(largest.begin(), largest.end()),
          std::sqrt(std::max(0.0, sum(gradients))), sum(integrals)};
}

}  // namespace bezel
