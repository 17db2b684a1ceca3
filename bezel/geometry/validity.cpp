// check_validity: the sign of the Jacobian determinant by subdivision of its Bernstein
// coefficients.

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "bezel/geometry/area_map.hpp"
#include "bezel/geometry/jacobian_kernel.hpp"
#include "bezel/geometry/triangle.hpp"
#include "bezel/geometry/triangle_check.hpp"
#include "bezel/geometry/triangle_kernel.hpp"

namespace bezel {
namespace {

using geometry_kernel::JacobianTable;
using geometry_kernel::TriangleCorners;
using geometry_kernel::whole_triangle;

/// x1 y2 - x2 y1 with one final rounding [Kahan; Jeannerod, Louvet, Muller 2013].
double cross_accurate(const Vec2& a, const Vec2& b) {
  const double w = a.y() * b.x();
  const double e = std::fma(-a.y(), b.x(), w);
  return std::fma(a.x(), b.y(), -w) + e;
}

double widest_step(const JacobianTable& table, std::span<const Vec2> control) {
  double widest = 0;
  for (const JacobianTable::Step& step : table.steps)
    for (const std::int32_t i : {step.along_u, step.along_v}) {
      const Vec2 e =
          control[static_cast<std::size_t>(i)] - control[static_cast<std::size_t>(step.base)];
      widest = std::max({widest, std::fabs(e.x()), std::fabs(e.y())});
    }
  return widest;
}

}  // namespace

ValidityResult check_validity(int g, std::span<const Vec2> control) {
  geometry_kernel::check_triangle(g, control, bernstein::max_triangle_degree);
  if (g == 1) {
    const Vec2 a = control[1] - control[0], b = control[2] - control[0];
    const double det =
        is_thin(a, b) ? triangle_cross(control[0], control[1], control[2]) : cross_accurate(a, b);
    return {det > 0 ? Validity::valid : Validity::inverted, {1.0 / 3, 1.0 / 3, 1.0 / 3}, det};
  }
  const RoundControl round(control);
  control = round.points();
  const int d = 2 * (g - 1);
  const auto n = static_cast<std::size_t>(bernstein::triangle_size(d));
  const bool has_table = g <= JacobianTable::max_kept;
  std::array<double, JacobianTable::max_size> few;
  std::vector<double> many;
  double at_most = std::numeric_limits<double>::infinity();  // of the hodograph differences
  if (has_table) {
    const JacobianTable& table = JacobianTable::of(g);
    std::array<double, JacobianTable::max_room> room;
    table(control.data(), room.data(), few.data());
    // They are there times weights of at least 1.
    at_most = 0;
    for (std::size_t i = 0; i < 4 * table.steps.size(); ++i)
      at_most = std::max(at_most, std::fabs(room[i]));
  } else {
    many = jacobian_determinant(g, control);
  }
  const std::span<const double> det(has_table ? few.data() : many.data(), n);
  // Rounding. Hodograph differences carry u |coordinate|, products and the sum of at most size(g-1)
  // positive-weight terms size(g-1) + 4 roundings of the largest product; bisection is a convex
  // combination and adds at most d u max|det| per level.
  const double u = 0x1p-53;
  const double terms = bernstein::triangle_size(g - 1) + 8;
  const double unit_error = 2 * u * g * g * terms;  // of differences of 1

  ValidityResult result{Validity::valid, whole_triangle[0], det[0]};
  // The three corner coefficients are values of the determinant.
  const auto note_corners = [&](std::span<const double> c, const TriangleCorners& corners) {
    for (int corner = 0; corner < 3; ++corner) {
      const double value = c[static_cast<std::size_t>(bernstein::triangle_corner(d, corner))];
      if (value < result.det) {
        result.det = value;
        result.where = corners[static_cast<std::size_t>(corner)];
      }
    }
  };
  if (*std::min_element(det.begin(), det.end()) > unit_error * at_most * at_most) {
    note_corners(det, whole_triangle);  // nearly all elements
    return result;
  }
  const double widest = widest_step(has_table ? JacobianTable::of(g) : JacobianTable(g), control);
  const double base_error = unit_error * widest * widest;
  double largest = 0;
  for (const double c : det) largest = std::max(largest, std::fabs(c));

  constexpr int max_depth = 40;  // bisections
  constexpr int max_pieces = 20000;
  struct Piece {
    std::vector<double> c;
    TriangleCorners corner;
    int depth;
  };
  std::vector<Piece> stack;
  stack.push_back({{det.begin(), det.end()}, whole_triangle, 0});
  int pieces = 0;
  while (!stack.empty()) {
    Piece piece = std::move(stack.back());
    stack.pop_back();
    const double error = base_error + u * d * piece.depth * largest;
    note_corners(piece.c, piece.corner);
    if (result.det < -error) {
      result.status = Validity::inverted;
      return result;
    }
    const double least = *std::min_element(piece.c.begin(), piece.c.end());
    if (least > error) continue;
    ++pieces;
    if (piece.depth >= max_depth || pieces > max_pieces) {
      result.status = Validity::undecided;
      // The corner values so far are not negative beyond rounding; keep looking only in what is
      // stacked.
      if (pieces > max_pieces) return result;
      continue;
    }
    Piece first{std::vector<double>(n), {}, piece.depth + 1},
        second{std::vector<double>(n), {}, piece.depth + 1};
    geometry_kernel::bisect(d, piece.c.data(), first.c.data(), second.c.data());
    geometry_kernel::bisect_corners(piece.corner, first.corner, second.corner);
    // Depth first into the child with the smaller coefficient: inverted elements end early.
    const bool first_worse = *std::min_element(first.c.begin(), first.c.end()) <
                             *std::min_element(second.c.begin(), second.c.end());
    if (first_worse) std::swap(first, second);
    stack.push_back(std::move(first));
    stack.push_back(std::move(second));
  }
  return result;
}

}  // namespace bezel
