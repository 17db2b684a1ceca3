// locate: Newton inside, subdivision with hull tests for the proof that a point is outside.

#include <algorithm>
#include <cmath>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/geometry/triangle_check.hpp"
#include "bezel/geometry/triangle_kernel.hpp"

namespace bezel {
namespace {

using Corners = std::array<Lambda, 3>;
constexpr Corners whole{Lambda{1, 0, 0}, Lambda{0, 1, 0}, Lambda{0, 0, 1}};
constexpr int max_depth = 90;  // bisections
constexpr int max_pieces = 4000;

/// True when a line separates p from the control points by more than margin: x, y and the three
/// sides' normals.
bool separated(int g, const Vec2* b, const Vec2& p, double margin) {
  const int n = bernstein::triangle_size(g);
  double lo_x = b[0].x(), hi_x = lo_x, lo_y = b[0].y(), hi_y = lo_y;
  for (int i = 1; i < n; ++i) {
    lo_x = std::min(lo_x, b[i].x());
    hi_x = std::max(hi_x, b[i].x());
    lo_y = std::min(lo_y, b[i].y());
    hi_y = std::max(hi_y, b[i].y());
  }
  if (p.x() < lo_x - margin || p.x() > hi_x + margin || p.y() < lo_y - margin ||
      p.y() > hi_y + margin)
    return true;
  for (int side = 0; side < 3; ++side) {
    const Vec2& from = b[bernstein::triangle_corner(g, side)];
    const Vec2 chord = b[bernstein::triangle_corner(g, (side + 1) % 3)] - from;
    const double at = cross(chord, p - from);
    const double slack = margin * (std::fabs(chord.x()) + std::fabs(chord.y()));
    double lo = 0, hi = 0;
    for (int i = 0; i < n; ++i) {
      const double c = cross(chord, b[i] - from);
      lo = std::min(lo, c);
      hi = std::max(hi, c);
    }
    if (at < lo - slack || at > hi + slack) return true;
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
  if (!(tolerance >= 0 && tolerance < 1))
    throw InputError("the barycentric tolerance must be in [0, 1)");
  // A barycentric may be negative by `tolerance`: the map moves by at most g * 2 tolerance times
  // the control net's extent there. The rest covers rounding.
  double extent = 0;
  for (const Vec2& c : control)
    extent =
        std::max({extent, std::fabs(c.x() - control[0].x()), std::fabs(c.y() - control[0].y())});
  const double far = std::max(std::fabs(p.x()), std::fabs(p.y()));
  const double margin =
      4.0 * g * tolerance * extent + 0x1p-50 * (extent + (far < 4 * extent ? far : 0.0));
  LocateResult best{Location::outside, {1.0 / 3, 1.0 / 3, 1.0 / 3}, 0};
  const auto finish = [&](Location status, const Lambda& lambda) {
    const auto f = geometry_kernel::map_gradient(g, control.data(), lambda[1], lambda[2], p);
    return LocateResult{status, lambda, norm(f.value)};
  };
  if (separated(g, control.data(), p, margin)) return finish(Location::outside, best.lambda);

  // Start where the triangle of the corners has p.
  const Vec2 &c0 = control[0], du = control[static_cast<std::size_t>(g)] - c0,
             dv = control.back() - c0;
  const double det = cross(du, dv);
  double u = 1.0 / 3, v = 1.0 / 3;
  if (det != 0) {
    u = std::clamp(cross(p - c0, dv) / det, 0.0, 1.0);
    v = std::clamp(cross(du, p - c0) / det, 0.0, 1.0);
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

  struct Piece {
    std::vector<Vec2> b;
    Corners corner;
    int depth;
  };
  const std::size_t n = control.size();
  std::vector<Piece> stack;
  stack.push_back({std::vector<Vec2>(control.begin(), control.end()), whole, 0});
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
