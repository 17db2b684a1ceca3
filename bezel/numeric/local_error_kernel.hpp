#pragma once
// local_error.hpp without checks and in place, for the compensated recurrences.

#include "bezel/numeric/eft.hpp"

namespace bezel::kernel {

/// l = left-to-right sum of e[0..count-1]; the count - 1 errors replace e[0..count-2].
inline double sum_with_errors(double* e, int count) {
  double l = e[0];
  for (int i = 1; i < count; ++i) {
    const WithError t = two_sum(l, e[i]);
    l = t.value;
    e[i - 1] = t.error;
  }
  return l;
}

/// l += factor * b, the two errors appended to e[count], e[count+1].
inline double add_product_with_errors(double l, double factor, double b, double* e, int& count) {
  const WithError p = two_prod(factor, b);
  const WithError t = two_sum(l, p.value);
  e[count++] = p.error;
  e[count++] = t.error;
  return t.value;
}

}  // namespace bezel::kernel
