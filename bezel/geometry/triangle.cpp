#include "bezel/geometry/triangle.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/geometry/area_map.hpp"
#include "bezel/geometry/bent.hpp"
#include "bezel/geometry/jacobian_kernel.hpp"
#include "bezel/geometry/triangle_check.hpp"
#include "bezel/geometry/triangle_kernel.hpp"
#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/quadrature.hpp"

namespace bezel {

namespace geometry_kernel {

void check_triangle(int g, std::span<const Vec2> control, int max_degree) {
  if (g < 1 || g > max_degree)
    throw InputError("the triangle's degree is " + std::to_string(g) + ", expected 1 to " +
                     std::to_string(max_degree));
  const auto expected = static_cast<std::size_t>(bernstein::triangle_size(g));
  if (control.size() != expected)
    throw InputError("a triangle of degree " + std::to_string(g) + " has " +
                     std::to_string(expected) + " control points, found " +
                     std::to_string(control.size()));
  for (std::size_t i = 0; i < control.size(); ++i)
    if (!std::isfinite(control[i].x()) || !std::isfinite(control[i].y()))
      throw InputError("control point " + std::to_string(i) + " of the triangle is not finite");
}

void check_tolerance(double tolerance) {
  if (!(tolerance >= 0 && tolerance < 1))
    throw InputError("the barycentric tolerance must be in [0, 1)");
}

}  // namespace geometry_kernel

using geometry_kernel::check_triangle;
using geometry_kernel::map_gradient;

std::vector<double> jacobian_determinant(int g, std::span<const Vec2> control) {
  check_triangle(g, control, bernstein::max_triangle_degree);
  const RoundControl round(control);
  using geometry_kernel::JacobianTable;
  const auto by_table = [&](const JacobianTable& table) {
    std::vector<double> room(4 * table.steps.size()), det(table.scale.size());
    table(round.points().data(), room.data(), det.data());
    // The mean of the coefficients is twice the area.
    const double twice = std::accumulate(det.begin(), det.end(), 0.0);
    if (g > 1 && is_bent(round.points(), 0.5 * twice / static_cast<double>(det.size())))
      return bent_jacobian(g, control);
    return det;
  };
  return g <= JacobianTable::max_kept ? by_table(JacobianTable::of(g)) : by_table(JacobianTable(g));
}

InverseResult invert(int g, std::span<const Vec2> control, const Vec2& p, const Lambda& start) {
  double u = start[1], v = start[2];
  const Vec2* b = control.data();
  double best = std::numeric_limits<double>::infinity();  // squared residual at (u0, v0)
  double u0 = u, v0 = v, step_u = 0, step_v = 0;
  int halvings = 0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const auto f = map_gradient(g, b, u, v, p);
    const double residual = dot(f.value, f.value);
    if (!(residual <= best)) {  // also catches NaN
      if (++halvings > 20) break;
      step_u *= 0.5;
      step_v *= 0.5;
      u = u0 - step_u;
      v = v0 - step_v;
      continue;
    }
    halvings = 0;
    const double det = cross(f.du, f.dv);
    if (det == 0.0) {
      // A singular place: no Newton step; the caller tries another start.
      return {{1.0 - u - v, u, v}, residual == 0.0};
    }
    const double inverse = 1.0 / det;
    step_u = cross(f.value, f.dv) * inverse;
    step_v = cross(f.du, f.value) * inverse;
    u0 = u;
    v0 = v;
    best = residual;
    u -= step_u;
    v -= step_v;
    const double step = std::max(std::fabs(step_u), std::fabs(step_v));
    if (!(step < 1e6)) break;
    // The error after a Newton step of length h is O(h^2): below 2^-52 of the triangle from h =
    // 4e-9 on, unless the map is nearly singular, where rounding moves the root further than that
    // anyway.
    if (step <= 4e-9) return {{1.0 - u - v, u, v}, true};
  }
  // Residuals at the level of rounding can stop falling before the steps are tiny (ill-conditioned
  // maps).
  const auto f = map_gradient(g, b, u0, v0, p);
  double size = 0;
  for (const Vec2& c : control)
    size = std::max({size, std::fabs(c.x() - p.x()), std::fabs(c.y() - p.y())});
  const double residual = norm(f.value);
  return {{1.0 - u0 - v0, u0, v0}, residual <= 4e-16 * g * size && std::isfinite(residual)};
}

namespace {

/// What area() needs of a degree: meshes ask for every element.
struct SideTable {
  std::vector<double> weight;                  // C(g,i) C(g-1,j) / C(2g-1,i+j)
  std::array<std::vector<std::size_t>, 3> at;  // control points along each side
};

const SideTable& side_table(int g) {
  static const auto tables = [] {
    std::array<SideTable, static_cast<std::size_t>(bernstein::max_triangle_degree) + 1> all;
    for (int d = 1; d <= bernstein::max_triangle_degree; ++d) {
      SideTable& table = all[static_cast<std::size_t>(d)];
      for (int i = 0; i <= d; ++i)
        for (int j = 0; j < d; ++j)
          table.weight.push_back(binomial(d, i) * binomial(d - 1, j) / binomial(2 * d - 1, i + j));
      for (int side = 0; side < 3; ++side)
        for (int m = 0; m <= d; ++m)
          table.at[static_cast<std::size_t>(side)].push_back(
              static_cast<std::size_t>(bernstein::triangle_side_index(d, side, m)));
    }
    return all;
  }();
  return tables[static_cast<std::size_t>(g)];
}

}  // namespace

double area(int g, std::span<const Vec2> control) {
  check_triangle(g, control, bernstein::max_triangle_degree);
  if (g == 1) return 0.5 * triangle_cross(control[0], control[1], control[2]);
  const std::span<const Vec2> given = control;
  const RoundControl round(control);
  control = round.points();
  // Green: area = 1/2 closed integral of x dy - y dx, each side exact by the Bernstein product
  // formula integral of B_i^g B_j^(g-1) = C(g,i) C(g-1,j) / (C(2g-1,i+j) 2g). Relative to corner 0,
  // so that a triangle far from the origin loses nothing; side 0 and 2 start or end there.
  const Vec2 origin = control[0];
  double sum = 0;
  const SideTable& table = side_table(g);
  const auto degree = static_cast<std::size_t>(g);
  constexpr std::size_t room = static_cast<std::size_t>(bernstein::max_triangle_degree) + 1;
  std::array<double, room> x, y;  // along a side
  for (const std::vector<std::size_t>& at : table.at) {
    for (std::size_t i = 0; i <= degree; ++i) {
      const Vec2 p = control[at[i]] - origin;
      x[i] = p.x();
      y[i] = p.y();
    }
    const double* weight = table.weight.data();
    for (std::size_t i = 0; i <= degree; ++i)
      for (std::size_t j = 0; j < degree; ++j)
        sum += *weight++ * (x[i] * (y[j + 1] - y[j]) - y[i] * (x[j + 1] - x[j]));
  }
  const double found = 0.25 * sum;  // g (from the derivative) / (2g) / 2
  return is_bent(control, found) ? bent_area(g, given) : found;
}

double moment(int g, std::span<const Vec2> control, int a, int b) {
  check_triangle(g, control, 18);
  if (a < 0 || b < 0 || a + b > 20)
    throw InputError("the moment's exponents are " + std::to_string(a) + " and " +
                     std::to_string(b) + ", expected a, b >= 0 and a + b <= 20");
  // Green: integral of x^a y^b = closed integral of x^(a+1) y^b / (a+1) dy.
  const int degree = (a + b + 2) * g - 1;
  const IntervalRule rule = gauss_legendre(degree / 2 + 1);
  std::vector<Vec2> side(static_cast<std::size_t>(g) + 1);
  double sum = 0;
  for (int k = 0; k < 3; ++k) {
    for (int m = 0; m <= g; ++m)
      side[static_cast<std::size_t>(m)] =
          control[static_cast<std::size_t>(bernstein::triangle_side_index(g, k, m))];
    for (int q = 0; q < rule.size(); ++q) {
      const double s = rule.node[static_cast<std::size_t>(q)], r = 1.0 - s;
      std::vector<Vec2> c = side;
      for (std::size_t d = side.size() - 1; d >= 2; --d)
        for (std::size_t i = 0; i < d; ++i) c[i] = r * c[i] + s * c[i + 1];
      const Vec2 p = r * c[0] + s * c[1];
      const double dy = g * (c[1].y() - c[0].y());
      double value = p.x() / (a + 1);
      for (int i = 0; i < a; ++i) value *= p.x();
      for (int i = 0; i < b; ++i) value *= p.y();
      sum += rule.weight[static_cast<std::size_t>(q)] * value * dy;
    }
  }
  return sum;
}

}  // namespace bezel
