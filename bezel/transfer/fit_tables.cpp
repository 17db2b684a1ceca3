// What region fits need that does not run over many points: points and matrices of interpolation,
// maps as monomials, growing lists.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>
#include <vector>

#include "bezel/bernstein/index.hpp"
#include "bezel/numeric/binomial.hpp"
#include "bezel/transfer/region_fit.hpp"

namespace bezel::detail {
namespace {

/// Solves matrix * x = columns in place (size x size both, row major), with pivots.
void solve_all(std::size_t size, std::vector<long double>& matrix,
               std::vector<long double>& columns) {
  for (std::size_t j = 0; j < size; ++j) {
    std::size_t pivot = j;
    for (std::size_t i = j; i < size; ++i)
      if (std::abs(matrix[i * size + j]) > std::abs(matrix[pivot * size + j])) pivot = i;
    for (std::size_t k = 0; k < size; ++k) {
      std::swap(matrix[pivot * size + k], matrix[j * size + k]);
      std::swap(columns[pivot * size + k], columns[j * size + k]);
    }
    const long double inverse = 1.0L / matrix[j * size + j];
    for (std::size_t k = 0; k < size; ++k) {
      matrix[j * size + k] *= inverse;
      columns[j * size + k] *= inverse;
    }
    for (std::size_t i = 0; i < size; ++i) {
      if (i == j) continue;
      const long double factor = matrix[i * size + j];
      if (factor == 0.0L) continue;
      for (std::size_t k = j; k < size; ++k) matrix[i * size + k] -= factor * matrix[j * size + k];
      for (std::size_t k = 0; k < size; ++k)
        columns[i * size + k] -= factor * columns[j * size + k];
    }
  }
}

}  // namespace

FitTable::FitTable(int with_degree)
    : degree(with_degree),
      count(static_cast<std::size_t>(bernstein::triangle_size(with_degree))),
      padded(padded_to_lanes(count)),
      terms(padded) {
  const int d = degree;
  for (int j = 0; j <= d; ++j) {
    for (int k = j % 2; k <= d + 1; k += 2) {
      x.push_back(d == 0 ? 0.0 : std::cos(j * std::numbers::pi / d));
      y.push_back(d == 0 ? 0.0 : std::cos(k * std::numbers::pi / (d + 1)));
    }
  }
  std::vector<long double> matrix, columns(count * count, 0.0L);
  std::vector<long double> tx(static_cast<std::size_t>(d) + 2, 1.0L), ty = tx;
  for (std::size_t q = 0; q < count; ++q) {
    tx[1] = x[q];
    ty[1] = y[q];
    for (std::size_t i = 2; i < tx.size(); ++i) {
      tx[i] = 2.0L * tx[1] * tx[i - 1] - tx[i - 2];
      ty[i] = 2.0L * ty[1] * ty[i - 1] - ty[i - 2];
    }
    for (std::size_t b = 0; b + 1 < ty.size(); ++b)
      for (std::size_t a = 0; a + b + 1 < tx.size(); ++a) matrix.push_back(tx[a] * ty[b]);
    columns[q * count + q] = 1.0L;
  }
  solve_all(count, matrix, columns);
  chebyshev.assign(count * terms, 0.0);
  for (std::size_t n = 0; n < count; ++n)
    for (std::size_t q = 0; q < count; ++q)
      chebyshev[q * terms + n] = static_cast<double>(columns[n * count + q]);
  if (d > 1) {
    high = padded_to_lanes(2 * static_cast<std::size_t>(d) + 3);
    tails.assign(count * high, 0.0);
    std::size_t to = 0;
    const auto keep = [&](int a, int b) {
      const auto n = static_cast<std::size_t>(bernstein::triangle_index(d, a, b));
      for (std::size_t q = 0; q < count; ++q) tails[q * high + to] = chebyshev[q * terms + n];
      ++to;
    };
    for (int total = d; total >= d - 1; --total)
      for (int b = 0; b <= total; ++b) keep(total - b, b);
    keep(1, 0);
    keep(0, 1);
  }
  x.resize(padded, x.back());
  y.resize(padded, y.back());
}

const FitTable& fit_table(int degree) {
  static std::array<std::once_flag, max_fit_degree + 1> made;
  static std::array<std::unique_ptr<FitTable>, max_fit_degree + 1> tables;
  const auto at = static_cast<std::size_t>(degree);
  std::call_once(made[at], [&] { tables[at] = std::make_unique<FitTable>(degree); });
  return *tables[at];
}

void MapPolynomial::set(int with_degree, std::span<const Vec2> control) {
  degree = with_degree;
  centre = 1.0 / 3.0;
  // The Bernstein form in monomials about the centroid: differences of blossoms, all arguments the
  // centroid but those of the derivatives.
  const auto size = static_cast<std::size_t>(bernstein::triangle_size(degree));
  x.assign(size, 0.0);
  y.assign(size, 0.0);
  std::array<Vec2, static_cast<std::size_t>(bernstein::triangle_size(max_fit_map))> p;
  for (int b = 0; b <= degree; ++b) {
    for (int a = 0; a <= degree - b; ++a) {
      std::copy(control.begin(), control.end(), p.begin());
      int left = degree;
      const auto reduce = [&](int ku, int kv) {
        std::size_t to = 0;
        for (int k = 0; k < left; ++k) {
          for (int j = 0; j < left - k; ++j, ++to) {
            const Vec2& here = p[static_cast<std::size_t>(bernstein::triangle_index(left, j, k))];
            const Vec2& right =
                p[static_cast<std::size_t>(bernstein::triangle_index(left, j + 1, k))];
            const Vec2& up = p[static_cast<std::size_t>(bernstein::triangle_index(left, j, k + 1))];
            p[to] = ku > 0 ? right - here : kv > 0 ? up - here : (here + right + up) * (1.0 / 3.0);
          }
        }
        --left;
      };
      for (int i = 0; i < a; ++i) reduce(1, 0);
      for (int i = 0; i < b; ++i) reduce(0, 1);
      while (left > 0) reduce(0, 0);
      const auto at = static_cast<std::size_t>(bernstein::triangle_index(degree, a, b));
      const double factor = binomial(degree, a) * binomial(degree - a, b);
      if (at == 0) {
        base = p[0];
        continue;
      }
      x[at] = factor * p[0].x();
      y[at] = factor * p[0].y();
    }
  }
}

void MapPolynomial::set_affine(const Vec2& at, const Vec2& first, const Vec2& second) {
  degree = 1;
  centre = 0.0;
  base = at;
  x = {0.0, first.x(), second.x()};
  y = {0.0, first.y(), second.y()};
}

std::size_t CurvePoints::append(std::size_t n) {
  const std::size_t first = count;
  count += n;
  if (x.size() < count + lanes)
    for (std::vector<double>* array : {&x, &y, &dx, &dy}) array->resize(2 * (count + lanes));
  return first;
}

}  // namespace bezel::detail
