#pragma once
// Runs a scalar routine on each coordinate of an array of values, in a wider scalar.

#include <cstddef>
#include <span>
#include <vector>

#include "bezel/numeric/double_double.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel::bernstein {

inline int components(const double*) {
  return 1;
}
template <int dim>
int components(const Vec<dim>*) {
  return dim;
}
inline double& component(double& x, int) {
  return x;
}
inline const double& component(const double& x, int) {
  return x;
}
template <int dim>
double& component(Vec<dim>& x, int i) {
  return x[i];
}
template <int dim>
const double& component(const Vec<dim>& x, int i) {
  return x[i];
}

/// out[n] (n_out values) = routine(in) per coordinate, in double-double, rounded once.
template <class Value, class Routine>
std::vector<Value> in_double_double(std::span<const Value> in, std::size_t n_out,
                                    const Routine& routine) {
  std::vector<Value> out(n_out);
  std::vector<DoubleDouble> wide_in(in.size()), wide_out(n_out);
  for (int c = 0; c < components(in.data()); ++c) {
    for (std::size_t i = 0; i < in.size(); ++i) wide_in[i] = DoubleDouble(component(in[i], c));
    routine(wide_in.data(), wide_out.data());
    for (std::size_t i = 0; i < n_out; ++i) component(out[i], c) = wide_out[i].hi;
  }
  return out;
}

}  // namespace bezel::bernstein
