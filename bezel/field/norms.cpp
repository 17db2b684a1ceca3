// Integrals and norms of fields.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bezel/base/error.hpp"
#include "bezel/field/element_kernel.hpp"
#include "bezel/field/field.hpp"
#include "bezel/field/formula_kernel.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel {
namespace {

using field_detail::ElementMap;
using field_detail::MapPoint;
using field_detail::RuleTable;

constexpr int pieces = 16;  // of an element where |f| changes sign: two rounds of splitting in four

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// Weights of a rule times the Jacobian determinant.
std::vector<double> measure(const ElementMap& map, std::span<const Lambda> lambda,
                            std::span<const double> weight) {
  std::vector<double> w(weight.size());
  for (std::size_t q = 0; q < w.size(); ++q) w[q] = weight[q] * map.derivatives(lambda[q]).det();
  return w;
}

/// Column k of values (points, n).
std::vector<double> column(std::span<const double> values, std::size_t n, std::size_t k) {
  std::vector<double> c(values.size() / n);
  for (std::size_t q = 0; q < c.size(); ++q) c[q] = values[q * n + k];
  return c;
}

/// Sums over elements of per-element values (elements, n), compensated, in element order.
std::vector<double> sum_elements(std::span<const double> values, std::size_t n) {
  std::vector<double> total(n);
  for (std::size_t k = 0; k < n; ++k) total[k] = sum(column(values, n, k));
  return total;
}

/// The element lies in its frame (to rounding): all its control points do.
bool in_frame(const Space& space, ElementId e) {
  const Frame& frame = space.frame(e);
  for (const NodeId n : space.mesh()->nodes(e)) {
    const Lambda l = frame.lambda(space.mesh()->control(n));
    if (std::min({l[0], l[1], l[2]}) < -1e-12) return false;
  }
  return true;
}

/// The rule on the pieces of the reference triangle.
TriangleRule on_pieces(const TriangleRule& rule) {
  std::vector<std::array<Lambda, 3>> triangles{{Lambda{1, 0, 0}, Lambda{0, 1, 0}, Lambda{0, 0, 1}}};
  while (triangles.size() < at(pieces)) {
    std::vector<std::array<Lambda, 3>> next;
    for (const std::array<Lambda, 3>& t : triangles) {
      std::array<Lambda, 3> middle;  // of the sides 01, 12, 20
      for (std::size_t s = 0; s < 3; ++s)
        for (std::size_t k = 0; k < 3; ++k) middle[s][k] = 0.5 * (t[s][k] + t[(s + 1) % 3][k]);
      next.push_back({t[0], middle[0], middle[2]});
      next.push_back({middle[0], t[1], middle[1]});
      next.push_back({middle[2], middle[1], t[2]});
      next.push_back({middle[0], middle[1], middle[2]});
    }
    triangles = std::move(next);
  }
  TriangleRule all;
  for (const std::array<Lambda, 3>& t : triangles)
    for (std::size_t q = 0; q < rule.weight.size(); ++q) {
      const Lambda& l = rule.lambda[q];
      Lambda point;
      for (std::size_t k = 0; k < 3; ++k)
        point[k] = l[0] * t[0][k] + l[1] * t[1][k] + l[2] * t[2][k];
      all.lambda.push_back(point);
      all.weight.push_back(rule.weight[q] / pieces);
    }
  return all;
}

/// sqrt(a / b) of squared norms; 0 / 0 = 0.
double ratio(double a, double b) {
  if (b > 0.0) return std::sqrt(a / b);
  return a > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

}  // namespace

std::vector<double> element_integrals(const Field& field, int threads) {
  const Space& space = field.space();
  const std::size_t n = at(field.components());
  std::vector<double> out(field.mesh().element_count() * n);
  const bool physical = space.basis() == Basis::physical;
  const RuleTable rules(
      space, [&](int p) { return physical ? field_detail::integrand_degree(space, p) : 0; });
  field_detail::for_elements(
      field.mesh(),
      [&](ElementId e) {
        const ElementMap map(field.mesh(), e);
        const int p = space.degree(e);
        if (physical) {
          const TriangleRule& rule = rules(p);
          const std::vector<double> w = measure(map, rule.lambda, rule.weight);
          std::vector<double> values(w.size() * n);
          field.evaluate(e, rule.lambda, values);
          for (std::size_t k = 0; k < n; ++k) out[e.index() * n + k] = dot(w, column(values, n, k));
        } else {
          const std::vector<double> det = jacobian_determinant(map.degree(), map.control());
          const int q = 2 * (map.degree() - 1);
          for (std::size_t k = 0; k < n; ++k)
            out[e.index() * n + k] = bernstein::integral(
                p + q, bernstein::multiply(p, column(field.coefficients(e), n, k), q, det));
        }
      },
      threads);
  return out;
}

std::vector<double> integral(const Field& field, int threads) {
  return sum_elements(element_integrals(field, threads), at(field.components()));
}

std::vector<double> integral_abs(const Field& field, int threads) {
  return integral_abs(field, element_integrals(field, threads), threads);
}

std::vector<double> integral_abs(const Field& field, std::span<const double> element_integrals,
                                 int threads) {
  const Space& space = field.space();
  const std::size_t n = at(field.components());
  if (element_integrals.size() != field.mesh().element_count() * n)
    throw InputError(fmt::format("found {} element integrals, expected {} for field '{}'",
                                 element_integrals.size(), field.mesh().element_count() * n,
                                 field.name()));
  std::vector<double> out(element_integrals.begin(), element_integrals.end());
  const RuleTable rules(
      space, [&](int p) { return std::min(field_detail::integrand_degree(space, p) + 4, 40); });
  std::array<TriangleRule, static_cast<std::size_t>(Space::max_degree) + 1> split;
  for (int p = 0; p <= Space::max_degree; ++p)
    if (!rules(p).weight.empty()) split[at(p)] = on_pieces(rules(p));
  field_detail::for_elements(
      field.mesh(),
      [&](ElementId e) {
        const std::span<const double> c = field.coefficients(e);
        std::vector<double> w, values;
        for (std::size_t k = 0; k < n; ++k) {
          double& result = out[e.index() * n + k];
          result = std::abs(result);
          bool positive = false, negative = false;
          for (std::size_t i = k; i < c.size(); i += n) {
            positive = positive || c[i] > 0.0;
            negative = negative || c[i] < 0.0;
          }
          // Coefficients of one sign say that of f inside the reference triangle or the frame. An
          // element that reaches out of a frame given by the caller is left to its values.
          if (!(positive && negative) &&
              (space.basis() == Basis::reference || in_frame(space, e))) {
            continue;
          }
          if (values.empty()) {
            const TriangleRule& rule = split[at(space.degree(e))];
            w = measure(ElementMap(field.mesh(), e), rule.lambda, rule.weight);
            values.resize(w.size() * n);
            field.evaluate(e, rule.lambda, values);
          }
          std::vector<double> f = column(values, n, k);
          const auto [lo, hi] = std::minmax_element(f.begin(), f.end());
          if (*lo >= 0.0 || *hi <= 0.0) continue;
          for (double& x : f) x = std::abs(x);
          result = dot(w, f);
        }
      },
      threads);
  return sum_elements(out, n);
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
