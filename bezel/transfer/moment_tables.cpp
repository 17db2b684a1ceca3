// What the moments need that does not depend on any mesh: rules on pieces, and constant matrices.

#include <array>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/quadrature.hpp"
#include "bezel/transfer/moments.hpp"

namespace bezel::detail {
namespace {

std::vector<double> compute_area_weights(int degree) {
  const PieceTable table(degree, 0);
  std::vector<double> weights;
  for (std::size_t i = 0; i < static_cast<std::size_t>(degree); ++i) {
    for (std::size_t j = i + 1; j <= static_cast<std::size_t>(degree); ++j) {
      double sum = 0.0;
      for (std::size_t q = 0; q < table.stride; ++q) {
        sum += table.value[i * table.stride + q] * table.slope[j * table.stride + q] -
               table.value[j * table.stride + q] * table.slope[i * table.stride + q];
      }
      weights.push_back(sum);
    }
  }
  return weights;
}

}  // namespace

const std::vector<double>& area_weights(int degree) {
  static const auto all = [] {
    std::array<std::vector<double>, 11> made;
    for (int d = 1; d <= 10; ++d) made[static_cast<std::size_t>(d)] = compute_area_weights(d);
    return made;
  }();
  return all[static_cast<std::size_t>(degree)];
}

// The integrand has degree moments * degree in the parameter from the monomial and 2 degree - 2
// from (x - c) x dx.
PieceTable::PieceTable(int degree_in, int moments)
    : degree(degree_in), points((moments * degree_in + 2 * degree_in - 2) / 2 + 1) {
  const auto n = static_cast<std::size_t>(points);
  stride = padded_to_lanes(n);
  const auto functions = static_cast<std::size_t>(degree + 1);
  parameter.assign(stride, 0.0);
  weight.assign(stride, 0.0);
  value.assign(functions * stride, 0.0);
  slope.assign(functions * stride, 0.0);
  const IntervalRule rule = gauss_legendre(points);
  for (std::size_t q = 0; q < n; ++q) {
    const double s = rule.node[q];
    parameter[q] = s;
    weight[q] = rule.weight[q];
    // Polynomials of one degree less, then the last step of the recurrence.
    std::vector<double> lower(functions, 0.0);
    lower[0] = 1.0;
    for (int d = 1; d < degree; ++d) {
      for (std::size_t i = static_cast<std::size_t>(d); i > 0; --i)
        lower[i] = (1.0 - s) * lower[i] + s * lower[i - 1];
      lower[0] *= 1.0 - s;
    }
    for (std::size_t i = 0; i < functions; ++i) {
      const double left = i > 0 ? lower[i - 1] : 0.0;
      const double right = i + 1 < functions ? lower[i] : 0.0;
      value[i * stride + q] = s * left + (1.0 - s) * right;
      slope[i * stride + q] = degree * (left - right) * rule.weight[q];
    }
  }
}

const std::vector<double>& power_matrix(int degree) {
  constexpr int highest = max_power_degree;
  static const auto matrices = [] {
    std::array<std::vector<double>, highest + 1> all;
    for (int d = 0; d <= highest; ++d) {
      const auto size = static_cast<std::size_t>(bernstein::triangle_size(d));
      auto& matrix = all[static_cast<std::size_t>(d)];
      matrix.assign(size * size, 0.0);
      // (1/3)^(d-a-b) times an integer: sum over the ways to take x and y out of the factors.
      std::vector<double> third(static_cast<std::size_t>(d) + 1, 1.0);
      double power = 1.0;
      for (int e = 1; e <= d; ++e) {
        power *= 3.0;
        third[static_cast<std::size_t>(e)] = 1.0 / power;
      }
      for (int n = 0; n < static_cast<int>(size); ++n) {
        const auto [i, j, k] = bernstein::triangle_multi_index(d, n);
        for (int x0 = 0; x0 <= i; ++x0) {
          for (int y0 = 0; y0 <= i - x0; ++y0) {  // from (1/3 - x - y)^i
            const double first =
                binomial(i, x0) * binomial(i - x0, y0) * ((x0 + y0) % 2 ? -1.0 : 1.0);
            for (int x1 = 0; x1 <= j; ++x1) {
              for (int y1 = 0; y1 <= k; ++y1) {
                const int a = x0 + x1, b = y0 + y1;
                matrix[static_cast<std::size_t>(n) * size +
                       static_cast<std::size_t>(bernstein::triangle_index(d, a, b))] +=
                    first * binomial(j, x1) * binomial(k, y1) *
                    third[static_cast<std::size_t>(d - a - b)];
              }
            }
          }
        }
      }
    }
    return all;
  }();
  return matrices[static_cast<std::size_t>(degree)];
}

}  // namespace bezel::detail
