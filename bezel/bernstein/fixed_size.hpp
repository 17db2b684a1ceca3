#pragma once
// Loops over the coefficients of low degrees, with their number known to the compiler.

#include <cstddef>
#include <type_traits>

namespace bezel::bernstein {

/// Calls body(n), n being the number of coefficients of a triangle as a constant of the type for
/// degrees 0 to 3, and the constant 0 for any other.
template <class Body>
decltype(auto) with_triangle_size(std::size_t size, const Body& body) {
  switch (size) {
    case 1:
      return body(std::integral_constant<std::size_t, 1>());
    case 3:
      return body(std::integral_constant<std::size_t, 3>());
    case 6:
      return body(std::integral_constant<std::size_t, 6>());
    case 10:
      return body(std::integral_constant<std::size_t, 10>());
    default:
      return body(std::integral_constant<std::size_t, 0>());
  }
}

}  // namespace bezel::bernstein
