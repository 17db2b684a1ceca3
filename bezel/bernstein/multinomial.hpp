#pragma once
// Exact multinomial coefficients of the triangle.

#include <span>

namespace bezel::bernstein {

/// The largest degree of multinomials().
inline constexpr int max_multinomial_degree = 10;

/// The factors of the Bernstein basis of the triangle, d! / (i! j! k!) in index order.
/// @param degree  0..max_multinomial_degree
/// @return triangle_size(degree) numbers of a table, exact
/// @throws InputError when the degree is out of range
std::span<const double> multinomials(int degree);

}  // namespace bezel::bernstein
