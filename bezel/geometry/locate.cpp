// locate: Newton inside, subdivision with hull tests for the proof that a point is outside.

#include <algorithm>
#include <cmath>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/geometry/triangle_check.hpp"
#include "bezel/geometry/triangle_hull.hpp"
#include "bezel/geometry/triangle_kernel.hpp"

namespace bezel {
namespace {

using geometry_kernel::TriangleCorners;
using geometry_kernel::whole_triangle;

/// True when a line separates p from the control points by more than margin: x, y and the three
/// sides' normals.
bool separated(int g, const Vec2* b, const Vec2& p, double margin) {
  const Box2 box = geometry_kernel::control_box(bernstein::triangle_size(g) - 1, b);
  if (p.x() < box.lo.x() - margin || p.x() > box.hi.x() + margin || p.y() < box.lo.y() - margin ||
      p.y() > box.hi.y() + margin)
    return true;
  for (int side = 0; side < 3; ++side) {
    const geometry_kernel::SideRange r = geometry_kernel::side_range(g, b, side);
    const double at = cross(r.chord, p - r.from), slack = margin * r.length;
    if (at < r.lo - slack || at > r.hi + slack) return true;
  }
  return false;
}

bool inside(const Lambda& lambda, double tolerance) {
  return lambda[0] >= -tolerance && lambda[1] >= -tolerance && lambda[2] >= -tolerance;
}

double worst(const Lambda& lambda) {
  return std::min({lambda[0], lambda[1], lambda[2]});
}

}  // namespace

LocateResult locate(int g, std::span<const Vec2> control, const Vec2& p, double tolerance) {
  geometry_kernel::check_triangle(g, control, bernstein::max_triangle_degree);
  if (!std::isfinite(p.x()) || !std::isfinite(p.y()))
    throw InputError("the point to locate is not finite");
  geometry_kernel::check_tolerance(tolerance);
  const double margin = geometry_kernel::HullMargin(g, control.data(), tolerance)(p);
  LocateResult best{Location::outside, {1.0 / 3, 1.0 / 3, 1.0 / 3}, 0};
  const auto finish = [&](Location status, const Lambda& lambda) {
    const auto f = geometry_kernel::map_gradient(g, control.data(), lambda[1], lambda[2], p);
    return LocateResult{status, lambda, norm(f.value)};
  };
  if (separated(g, control.data(), p, margin)) return finish(Location::outside, best.lambda);

  // Start where the triangle of the corners has p.
  const geometry_kernel::CornerFrame corners(g, control.data());
  double u = 1.0 / 3, v = 1.0 / 3;
  if (corners.det != 0) {
    u = std::clamp(cross(p - corners.origin, corners.dv) / corners.det, 0.0, 1.0);
    v = std::clamp(cross(corners.du, p - corners.origin) / corners.det, 0.0, 1.0);
    if (u + v > 1) {
      const double excess = 0.5 * (u + v - 1);
      u = std::max(0.0, u - excess);
      v = std::max(0.0, v - excess);
    }
  }
  InverseResult found = invert(g, control, p, {1.0 - u - v, u, v});
  if (found.converged && inside(found.lambda, tolerance))
    return finish(Location::inside, found.lambda);
  if (g == 1)
    return finish(found.converged ? Location::outside : Location::not_converged, found.lambda);
  Lambda nearest = found.converged ? found.lambda : best.lambda;

  constexpr int max_depth = 90;  // bisections
  constexpr int max_pieces = 4000;
  struct Piece {
    std::vector<Vec2> b;
    TriangleCorners corner;
    int depth;
  };
  const std::size_t n = control.size();
  std::vector<Piece> stack;
  stack.push_back({std::vector<Vec2>(control.begin(), control.end()), whole_triangle, 0});
  bool undecided = false;
  for (int pieces = 0; !stack.empty(); ++pieces) {
    Piece piece = std::move(stack.back());
    stack.pop_back();
    if (separated(g, piece.b.data(), p, margin)) continue;
    // Newton from the piece's centre, at every other depth: a root anywhere inside ends the search.
    if (piece.depth % 2 == 0) {
      Lambda centre{};
      for (std::size_t i = 0; i < 3; ++i)
        centre[i] = (piece.corner[0][i] + piece.corner[1][i] + piece.corner[2][i]) / 3;
      found = invert(g, control, p, centre);
      if (found.converged) {
        if (inside(found.lambda, tolerance)) return finish(Location::inside, found.lambda);
        if (worst(found.lambda) > worst(nearest)) nearest = found.lambda;
      }
    }
    if (piece.depth >= max_depth || pieces >= max_pieces) {
      undecided = true;
      break;
    }
    Piece first{std::vector<Vec2>(n), {}, piece.depth + 1},
        second{std::vector<Vec2>(n), {}, piece.depth + 1};
    geometry_kernel::bisect(g, piece.b.data(), first.b.data(), second.b.data());
    geometry_kernel::bisect_corners(piece.corner, first.corner, second.corner);
    stack.push_back(std::move(first));
    stack.push_back(std::move(second));
  }
  return finish(undecided ? Location::not_converged : Location::outside, nearest);
}

}  // namespace bezel
