#pragma once
// What the public functions of this module check at the door.

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>

#include "bezel/base/error.hpp"
#include "bezel/bernstein/index.hpp"
#include "bezel/bernstein/tetrahedron_index.hpp"
#include "bezel/numeric/finite.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::bernstein::checks {

inline bool is_finite(double x) {
  return std::isfinite(x);
}
template <int dim>
bool is_finite(const Vec<dim>& x) {
  for (int i = 0; i < dim; ++i)
    if (!std::isfinite(x[i])) return false;
  return true;
}

/// Throws unless 0 <= d <= largest.
inline void degree(int d, int largest, const char* where) {
  if (d < 0 || d > largest)
    throw InputError("degree " + std::to_string(d) + " on the " + where + ", expected 0 to " +
                     std::to_string(largest));
}
inline void interval_degree(int d) {
  degree(d, max_interval_degree, "interval");
}
inline void triangle_degree(int d) {
  degree(d, max_triangle_degree, "triangle");
}
inline void tetrahedron_degree(int d) {
  degree(d, max_tetrahedron_degree, "tetrahedron");
}

template <class Value>
void finite(std::span<const Value> values, const char* what) {
  if constexpr (std::is_same_v<Value, double>)
    if (values.size() >= 16 && all_finite(values)) return;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!is_finite(values[i]))
      throw InputError(std::string(what) + " " + std::to_string(i) + " is not finite");
}
inline void finite(double x, const char* what) {
  if (!std::isfinite(x))
    throw InputError(std::string(what) + " is " + std::to_string(x) + ", expected a finite value");
}

/// Checks the coefficients of a polynomial on the interval and returns its degree.
template <class Value>
int interval(std::span<const Value> b) {
  if (b.empty()) throw InputError("found no coefficients, expected at least one");
  if (b.size() > static_cast<std::size_t>(max_interval_degree) + 1)
    throw InputError("degree " + std::to_string(b.size() - 1) + " on the interval, expected 0 to " +
                     std::to_string(max_interval_degree));
  finite(b, "coefficient");
  return static_cast<int>(b.size()) - 1;
}

/// Checks degree, number and values of a polynomial's coefficients on the triangle.
template <class Value>
void triangle(int d, std::span<const Value> b) {
  triangle_degree(d);
  if (b.size() != static_cast<std::size_t>(triangle_size(d)))
    throw InputError("found " + std::to_string(b.size()) + " coefficients, expected " +
                     std::to_string(triangle_size(d)) + " for degree " + std::to_string(d) +
                     " on the triangle");
  finite(b, "coefficient");
}

/// The same on the tetrahedron.
template <class Value>
void tetrahedron(int d, std::span<const Value> b) {
  tetrahedron_degree(d);
  if (b.size() != static_cast<std::size_t>(tetrahedron_size(d)))
    throw InputError("found " + std::to_string(b.size()) + " coefficients, expected " +
                     std::to_string(tetrahedron_size(d)) + " for degree " + std::to_string(d) +
                     " on the tetrahedron");
  finite(b, "coefficient");
}

/// Throws unless 0 <= by <= d.
inline void reduction(int d, int by) {
  if (by < 0 || by > d)
    throw InputError("reduction by " + std::to_string(by) + " of degree " + std::to_string(d) +
                     ", expected 0 to " + std::to_string(d));
}
/// Throws unless by >= 0 and d + by <= largest.
inline void elevation(int d, int by, int largest, const char* where) {
  if (by < 0) throw InputError("elevation by " + std::to_string(by) + ", expected at least 0");
  degree(by > largest ? by : d + by, largest, where);
}

/// Throws unless 0 <= tolerance and 0 <= most.
inline void iteration(double tolerance, int most) {
  if (!(tolerance >= 0.0))
    throw InputError("tolerance " + std::to_string(tolerance) + ", expected at least 0");
  if (most < 0)
    throw InputError("at most " + std::to_string(most) + " iterations, expected at least 0");
}

inline void size(std::size_t found, std::size_t expected, const char* what) {
  if (found != expected)
    throw InputError("found " + std::to_string(found) + " " + what + ", expected " +
                     std::to_string(expected));
}

}  // namespace bezel::bernstein::checks
