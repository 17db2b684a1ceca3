#include "bezel/field/integrals.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "bezel/numeric/eft.hpp"
#include "bezel/numeric/lanes.hpp"
#include "bezel/numeric/short_names.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel::field_detail {
namespace {

using short_names::at;

}  // namespace

MapTable::MapTable(int degree, std::span<const Lambda> points) : points_(points.size()) {
  const auto nodes = at(bernstein::triangle_size(degree));
  value_.resize(nodes * points_);
  du_.resize(nodes * points_);
  dv_.resize(nodes * points_);
  std::vector<double> basis(nodes), lower(nodes);
  const auto lower_size = at(bernstein::triangle_size(degree - 1));
  for (std::size_t q = 0; q < points_; ++q) {
    bernstein::basis(degree, points[q], basis);
    for (std::size_t n = 0; n < nodes; ++n) value_[n * points_ + q] = basis[n];
    bernstein::basis(degree - 1, points[q], std::span(lower).first(lower_size));
    std::size_t i = 0;
    for (int k = 0; k < degree; ++k) {
      for (int j = 0; j + k < degree; ++j, ++i) {
        const std::size_t here = at(bernstein::triangle_index(degree, j, k)) * points_ + q;
        const std::size_t above = at(bernstein::triangle_index(degree, j, k + 1)) * points_ + q;
        const double b = degree * lower[i];
        du_[here] -= b;
        dv_[here] -= b;
        du_[here + points_] += b;
        dv_[above] += b;
      }
    }
  }
}

void MapTable::operator()(std::span<const Vec2> control, std::span<double> x, std::span<double> y,
                          std::span<double> det) const {
  // Derivatives from control points relative to the first one, which takes away the place in the
  // plane.
  constexpr std::size_t block = 2 * lanes;
  const Vec2 origin = control[0];
  double xu[block], yu[block], xv[block], yv[block], px[block], py[block];
  for (std::size_t start = 0; start < points_; start += block) {
    const std::size_t m = std::min(block, points_ - start);
    for (std::size_t l = 0; l < block; ++l) xu[l] = yu[l] = xv[l] = yv[l] = px[l] = py[l] = 0.0;
    for (std::size_t n = 1; n < control.size(); ++n) {
      const double cx = control[n].x() - origin.x(), cy = control[n].y() - origin.y();
      const double* b = value_.data() + n * points_ + start;
      const double* bu = du_.data() + n * points_ + start;
      const double* bv = dv_.data() + n * points_ + start;
      for (std::size_t l = 0; l < m; ++l) {
        px[l] += b[l] * cx;
        py[l] += b[l] * cy;
        xu[l] += bu[l] * cx;
        yu[l] += bu[l] * cy;
        xv[l] += bv[l] * cx;
        yv[l] += bv[l] * cy;
      }
    }
    for (std::size_t l = 0; l < m; ++l) {
      x[start + l] = origin.x() + px[l];
      y[start + l] = origin.y() + py[l];
      det[start + l] = xu[l] * yv[l] - yu[l] * xv[l];
    }
  }
}

MapRule::MapRule(int map_degree, const TriangleRule& rule)
    : u(padded_to_lanes(rule.weight.size()), 1.0 / 3.0), v(u), weight(u.size(), 0.0) {
  std::vector<Lambda> lambda(u.size(), Lambda{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0});
  for (std::size_t q = 0; q < rule.weight.size(); ++q) {
    lambda[q] = rule.lambda[q];
    u[q] = lambda[q][1];
    v[q] = lambda[q][2];
    weight[q] = rule.weight[q];
  }
  map = MapTable(map_degree, lambda);
}

std::size_t component_count(std::span<const Field* const> fields) {
  std::size_t count = 0;
  for (const Field* f : fields) count += at(f->components());
  return count;
}

std::vector<double> integral(std::span<const double> element_integrals, std::size_t components) {
  if (components == 1) return {sum(element_integrals)};
  // As sum() for each component, all of them side by side.
  std::vector<double> total(components), error(components);
  for (std::size_t i = 0; i < element_integrals.size(); i += components) {
    for (std::size_t k = 0; k < components; ++k) {
      const WithError t = two_sum(total[k], element_integrals[i + k]);
      total[k] = t.value;
      error[k] += t.error;
    }
  }
  for (std::size_t k = 0; k < components; ++k) total[k] += error[k];
  return total;
}

}  // namespace bezel::field_detail
