#pragma once
// Curved triangles bent by more than their width (layers along a wall): no AreaMap makes them
// round. Products of their coordinates cancel in areas and Jacobians, and points rounded in any
// plane are off by a part of the width. Control points are exact numbers, though: double-double
// arithmetic on them has digits to spare.

#include <span>
#include <vector>

#include "bezel/numeric/double_double.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

using ExactVec2 = Vec<2, DoubleDouble>;

/// b - a without rounding.
ExactVec2 exact_step(const Vec2& a, const Vec2& b);
inline Vec2 rounded(const ExactVec2& a) {
  return {{static_cast<double>(a.x()), static_cast<double>(a.y())}};
}

/// Whether a triangle is thin in the plane that round_map() chose for it: its diameter exceeds 256
/// of its widths (twice the area over the diameter), and so many roundings are lost there.
/// @param round  its control points there
/// @param area   at least about
bool is_bent(std::span<const Vec2> round, double area);

/// Twice the area between a curve and the rays from the origin to its ends.
/// @param control  degree + 1 points, degree >= 1
/// @accuracy       within 100 u^2 of the sum of the sizes of the products
DoubleDouble twice_swept_area(std::span<const ExactVec2> control);

/// area() of a triangle in double-double arithmetic, rounded once.
/// @param control  points of a triangle of degree g, unchecked
double bent_area(int g, std::span<const Vec2> control);

/// jacobian_determinant() in double-double arithmetic, each coefficient rounded once.
/// @param control  points of a triangle of degree g, unchecked
std::vector<double> bent_jacobian(int g, std::span<const Vec2> control);

/// The same where the triangle is bent, else nothing.
/// @param round  its control points where it is as round as it can be
std::vector<double> jacobian_if_bent(int g, std::span<const Vec2> control,
                                     std::span<const Vec2> round);

}  // namespace bezel
