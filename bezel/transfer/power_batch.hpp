#pragma once
// Internal: polynomials of many components as powers.

#include <cstddef>

namespace bezel::detail {

/// Coefficients of the monomials in the barycentrics less 1/3 of eight components' polynomials on
/// some elements: each with the bits that it has alone, on every machine.
/// @param degree      at most max_moment_degree
/// @param c           Bernstein coefficients, shape (elements, n, lanes)
/// @param count       how many lanes hold a component
/// @param components  of all, one after the other in `to`, shape (elements, n, components)
/// @param to          at the first of the eight
void powers_of(int degree, std::size_t elements, const double* c, std::size_t count,
               std::size_t components, double* to);

}  // namespace bezel::detail
