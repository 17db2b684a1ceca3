#include "bezel/geometry/tetrahedron.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/geometry/tetrahedron_check.hpp"
#include "bezel/geometry/tetrahedron_kernel.hpp"

namespace bezel {

namespace geometry_kernel {

void check_tetrahedron(int g, std::span<const Vec3> control) {
  if (g < 1 || g > max_tetrahedron_map_degree)
    throw InputError("the tetrahedron's degree is " + std::to_string(g) + ", expected 1 to " +
                     std::to_string(max_tetrahedron_map_degree));
  const auto expected = static_cast<std::size_t>(bernstein::tetrahedron_size(g));
  if (control.size() != expected)
    throw InputError("a tetrahedron of degree " + std::to_string(g) + " has " +
                     std::to_string(expected) + " control points, found " +
                     std::to_string(control.size()));
  for (std::size_t i = 0; i < control.size(); ++i)
    for (int c = 0; c < 3; ++c)
      if (!std::isfinite(control[i][c]))
        throw InputError("control point " + std::to_string(i) +
                         " of the tetrahedron is not finite");
}

}  // namespace geometry_kernel

using geometry_kernel::cross3;
using geometry_kernel::map_gradient;

std::vector<double> jacobian_determinant(int g, std::span<const Vec3> control) {
  geometry_kernel::check_tetrahedron(g, control);
  std::vector<double> det(static_cast<std::size_t>(bernstein::tetrahedron_size(3 * (g - 1))));
  geometry_kernel::hodograph_determinant(g, geometry_kernel::hodographs(g, control.data()),
                                         det.data());
  return det;
}

double volume(int g, std::span<const Vec3> control) {
  return bernstein::tetrahedron::integral(3 * (g - 1), jacobian_determinant(g, control));
}

TetrahedronInverse invert(int g, std::span<const Vec3> control, const Vec3& p,
                          const Lambda4& start) {
  const Vec3* b = control.data();
  const auto lambda_of = [](const Vec3& x) {
    return Lambda4{1.0 - x[0] - x[1] - x[2], x[0], x[1], x[2]};
  };
  Vec3 x{{start[1], start[2], start[3]}}, x0 = x, step{};
  double best = std::numeric_limits<double>::infinity();  // squared residual at x0
  int halvings = 0;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const auto f = map_gradient(g, b, lambda_of(x), p);
    const double residual = dot(f.value, f.value);
    if (!(residual <= best)) {  // also catches NaN
      if (++halvings > 20) break;
      step *= 0.5;
      x = x0 - step;
      continue;
    }
    halvings = 0;
    const Vec3 n = cross3(f.dv, f.dw);
    const double det = dot(f.du, n);
    // A singular place: no Newton step; the caller tries another start.
    if (det == 0.0) return {lambda_of(x), residual == 0.0};
    const double inverse = 1.0 / det;
    step = {{dot(f.value, n) * inverse, dot(f.value, cross3(f.dw, f.du)) * inverse,
             dot(f.value, cross3(f.du, f.dv)) * inverse}};
    x0 = x;
    best = residual;
    x -= step;
    const double length = std::max({std::fabs(step[0]), std::fabs(step[1]), std::fabs(step[2])});
    if (!(length < 1e6)) break;
    // The error after a Newton step of length h is O(h^2): below 2^-52 of the tetrahedron from h =
    // 4e-9 on, unless the map is nearly singular, where rounding moves the root further than that
    // anyway.
    if (length <= 4e-9) return {lambda_of(x), true};
  }
  // Residuals at the level of rounding can stop falling before the steps are tiny (ill-conditioned
  // maps).
  const auto f = map_gradient(g, b, lambda_of(x0), p);
  double size = 0;
  for (const Vec3& c : control)
    for (int i = 0; i < 3; ++i) size = std::max(size, std::fabs(c[i] - p[i]));
  return {lambda_of(x0), norm(f.value) <= 4e-16 * g * size};
}

}  // namespace bezel
