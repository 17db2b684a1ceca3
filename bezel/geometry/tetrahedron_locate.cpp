// locate: Newton inside, subdivision with hull tests for the proof that a point is outside.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "bezel/base/error.hpp"
#include "bezel/geometry/tetrahedron.hpp"
#include "bezel/geometry/tetrahedron_check.hpp"
#include "bezel/geometry/tetrahedron_kernel.hpp"
#include "bezel/numeric/short_names.hpp"

namespace bezel {
namespace {

using bernstein::tetrahedron::kernel::Bisection;
using geometry_kernel::cross3;
using short_names::u;

double largest_coordinate(const Vec3& p) {
  return std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2])});
}

/// Whether the plane through the origin with normal n has all points on one side, each coordinate
/// of each known to within slack (which includes 4 u of the largest, for the products here).
bool separates(Vec3 n, const std::vector<Vec3>& q, double slack) {
  const double scale = largest_coordinate(n);
  if (!(scale > 0x1p-1000 && scale < 0x1p1000)) return false;
  n *= 1.0 / scale;  // any direction will do: its rounding does not matter
  const double gap = slack * (std::fabs(n[0]) + std::fabs(n[1]) + std::fabs(n[2]));
  const double first = dot(n, q[0]);
  if (first > gap)
    return std::all_of(q.begin(), q.end(), [&](const Vec3& c) { return dot(n, c) > gap; });
  return first < -gap &&
         std::all_of(q.begin(), q.end(), [&](const Vec3& c) { return dot(n, c) < -gap; });
}

/// The origin is outside the box of the points by more than slack.
bool outside_box(const std::vector<Vec3>& q, double slack) {
  Vec3 lo = q[0], hi = q[0];
  for (const Vec3& c : q)
    for (int i = 0; i < 3; ++i) {
      lo[i] = std::min(lo[i], c[i]);
      hi[i] = std::max(hi[i], c[i]);
    }
  for (int i = 0; i < 3; ++i)
    if (lo[i] > slack || hi[i] < -slack) return true;
  return false;
}

/// True when a plane separates the origin from the hull of the points: across x, y, z, across the
/// way to their centre, or parallel to a face of the corner tetrahedron.
bool separated(int g, const std::vector<Vec3>& q, double slack) {
  if (outside_box(q, slack)) return true;
  Vec3 centre{};
  for (const Vec3& c : q) centre += c;
  if (separates(centre, q, slack)) return true;
  for (const auto& face : bernstein::tetrahedron_face_corners) {
    const auto corner = [&](int c) {
      return q[static_cast<std::size_t>(
          bernstein::tetrahedron_corner(g, face[static_cast<std::size_t>(c)]))];
    };
    if (separates(cross3(corner(1) - corner(0), corner(2) - corner(0)), q, slack)) return true;
  }
  return false;
}

double worst(const Lambda4& lambda) {
  return *std::min_element(lambda.begin(), lambda.end());
}

/// Where the corner tetrahedron has the origin, moved inside; its centre when it is flat.
Lambda4 corner_start(int g, const std::vector<Vec3>& q) {
  const auto corner = [&](int c) {
    return q[static_cast<std::size_t>(bernstein::tetrahedron_corner(g, c))];
  };
  const Vec3 c0 = corner(0), a = corner(1) - c0, b = corner(2) - c0, c = corner(3) - c0;
  const Vec3 n = cross3(b, c);
  const double det = dot(a, n);
  Lambda4 start{0.25, 0.25, 0.25, 0.25};
  if (det == 0) return start;
  start[1] = std::clamp(-dot(c0, n) / det, 0.0, 1.0);
  start[2] = std::clamp(-dot(c0, cross3(c, a)) / det, 0.0, 1.0);
  start[3] = std::clamp(-dot(c0, cross3(a, b)) / det, 0.0, 1.0);
  const double sum = start[1] + start[2] + start[3];
  if (sum > 1)
    for (std::size_t i = 1; i < 4; ++i) start[i] /= sum;
  start[0] = std::max(0.0, 1.0 - start[1] - start[2] - start[3]);
  return start;
}

}  // namespace

TetrahedronLocation locate(int g, std::span<const Vec3> control, const Vec3& p, double tolerance) {
  geometry_kernel::check_tetrahedron(g, control);
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(p[c])) throw InputError("the point to locate is not finite");
  if (!(tolerance >= 0 && tolerance < 1))
    throw InputError("the barycentric tolerance must be in [0, 1)");

  // Control points relative to p, scaled to at most 2: one rounding each.
  std::vector<Vec3> q(control.begin(), control.end());
  int exponent = 0;
  double largest = 0;
  for (Vec3& c : q) {
    c -= p;
    largest = std::max(largest, largest_coordinate(c));
  }
  if (!std::isfinite(largest)) {
    largest = 0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] = 0.5 * control[i] - 0.5 * p;
      largest = std::max(largest, largest_coordinate(q[i]));
    }
    exponent = 1;
  }
  if (largest < 0x1p-100 || largest > 0x1p100) {
    const int shift = largest > 0 ? std::ilogb(largest) : 0;
    for (Vec3& c : q)
      for (int i = 0; i < 3; ++i) c[i] = std::scalbn(c[i], -shift);
    largest = std::scalbn(largest, -shift);
    exponent += shift;
  }
  const Vec3 origin{};
  const auto finish = [&](Location status, const Lambda4& lambda) {
    const auto f = geometry_kernel::map_gradient(g, q.data(), lambda, origin);
    return TetrahedronLocation{status, lambda, std::scalbn(norm(f.value), exponent)};
  };

  // All lambda >= -tolerance are the tetrahedron with corners 1 + 3 tolerance, -tolerance, ...;
  // each is a combination of absolute weight `reach` of corners of the whole, g times over.
  const double reach = 1 + 6 * tolerance;
  const Lambda4 middle{0.25, 0.25, 0.25, 0.25};
  {
    // Its control points stay within g (reach^g) 8 tolerance extents of the hull.
    double extent = 0;
    for (const Vec3& c : q) extent = std::max(extent, largest_coordinate(c - q[0]));
    const double growth = std::pow(reach, g);
    if (outside_box(q, 1.001 * (8 * g * tolerance * growth * extent + 2 * u * largest)))
      return finish(Location::outside, middle);
  }
  TetrahedronInverse found = invert(g, q, origin, corner_start(g, q));
  if (found.converged && worst(found.lambda) >= -tolerance)
    return finish(Location::inside, found.lambda);
  Lambda4 nearest = found.converged ? found.lambda : middle;

  constexpr int max_depth = 90;  // bisections
  constexpr int max_pieces = 4000;
  struct Piece {
    std::vector<Vec3> q;
    std::array<Lambda4, 4> corner;
    int depth;
  };
  Piece whole{q, {}, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    whole.corner[i].fill(-tolerance);
    whole.corner[i][i] = 1 + 3 * tolerance;
  }
  if (tolerance > 0)
    bernstein::tetrahedron::kernel::specialize(g, q.data(), whole.corner, {0, 1, 2, 3},
                                               whole.q.data());
  // Errors of the coordinates: one rounding of q, one of each corner's barycentrics and three of
  // each of g steps; then g per bisection, and four for the products of the tests.
  const double start_error = u * (4 + 6 * g) * std::pow(reach, g) * largest;
  double size = 0;
  for (const Vec3& c : whole.q) size = std::max(size, largest_coordinate(c));

  std::optional<Bisection> bisection;  // most points need no halving
  std::vector<Piece> stack;
  stack.push_back(std::move(whole));
  bool undecided = false;
  for (int pieces = 0; !stack.empty(); ++pieces) {
    Piece piece = std::move(stack.back());
    stack.pop_back();
    if (separated(g, piece.q, start_error + u * (g * piece.depth + 8) * size)) continue;
    // Newton from the piece's centre, at every third depth: a root anywhere inside ends the search.
    if (piece.depth % 3 == 0 && (piece.depth > 0 || !found.converged)) {
      Lambda4 centre{};
      for (std::size_t i = 0; i < 4; ++i)
        centre[i] = 0.25 * ((piece.corner[0][i] + piece.corner[1][i]) +
                            (piece.corner[2][i] + piece.corner[3][i]));
      found = invert(g, q, origin, centre);
      if (found.converged) {
        if (worst(found.lambda) >= -tolerance) return finish(Location::inside, found.lambda);
        if (worst(found.lambda) > worst(nearest)) nearest = found.lambda;
      }
    }
    if (piece.depth >= max_depth || pieces >= max_pieces) {
      undecided = true;
      break;
    }
    Piece first{std::vector<Vec3>(q.size()), {}, piece.depth + 1},
        second{std::vector<Vec3>(q.size()), {}, piece.depth + 1};
    if (!bisection) bisection.emplace(g);
    bisection->split(piece.depth, piece.q.data(), first.q.data(), second.q.data());
    Bisection::split_corners(piece.depth, piece.corner, first.corner, second.corner);
    stack.push_back(std::move(first));
    stack.push_back(std::move(second));
  }
  return finish(undecided ? Location::not_converged : Location::outside, nearest);
}

}  // namespace bezel
