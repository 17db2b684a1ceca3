#include "bezel/fit/curve_tables.hpp"

#include <cmath>
#include <numbers>

#include "bezel/fit/small_kernels.hpp"

namespace bezel {
namespace {

void add_rows(const LobattoBasis& from, std::span<const double> points, std::vector<double>& rows) {
  const std::size_t width = std::size_t(from.degree()) + 1;
  rows.resize(points.size() * width);
  for (std::size_t j = 0; j < points.size(); ++j)
    from.values(points[j], std::span(rows).subspan(j * width, width));
}

}  // namespace

CurveRung::CurveRung(int degree) : n(degree), basis(degree), m(4 * degree) {
  if (n >= 2) add_rows(LobattoBasis(n - 1), basis.nodes(), from_last);
  if (n >= 3) add_rows(LobattoBasis(n - 2), basis.nodes(), from_second);
  for (int a = 0; a < m; ++a) {
    const double angle = (a + 0.5) * std::numbers::pi / m;
    xi.push_back(-std::cos(angle));
    weight.push_back(std::numbers::pi / m * std::sin(angle));
  }
  add_rows(basis, xi, value);
  const std::size_t width = std::size_t(n) + 1, points = std::size_t(m);
  d.assign(basis.derivative_matrix().begin(), basis.derivative_matrix().end());
  value_columns.resize(width * points);
  slope_columns.assign(width * points, 0.0);
  for (std::size_t a = 0; a < points; ++a)
    for (std::size_t k = 0; k < width; ++k) {
      value_columns[k * points + a] = value[a * width + k];
      for (std::size_t i = 0; i < width; ++i)
        slope_columns[k * points + a] += value[a * width + i] * d[i * width + k];
    }
  const std::size_t stride = std::size_t(small::padded(n + 1));
  d_columns.assign(width * stride, 0.0);
  for (std::size_t i = 0; i < width; ++i)
    for (std::size_t k = 0; k < width; ++k) d_columns[k * stride + i] = d[i * width + k];
  value.resize(value.size() + small::padding);
  d.resize(d.size() + small::padding);
}

CurveInterpolator::Tables::Tables(int max_degree) : l2_rules_(std::size_t(max_degree)) {
  rungs.reserve(std::size_t(max_degree));
  for (int n = 1; n <= max_degree; ++n) rungs.emplace_back(n);
}

const IntervalRule& CurveInterpolator::Tables::l2_rule(int n) const {
  Lazy& lazy = l2_rules_[std::size_t(n - 1)];
  std::call_once(lazy.once, [&] { lazy.rule = gauss_lobatto(3 * n + 1); });
  return lazy.rule;
}

}  // namespace bezel
