#pragma once
// De Casteljau's algorithm at many points, without checks: the first level of the compensated one.

#include <cstddef>

namespace bezel::bernstein {

/// out[q] = p(s[q]); the bits of the scalar evaluate, on every SIMD target. One allocation.
void casteljau_points(int d, const double* b, const double* s, std::size_t count, double* out);

}  // namespace bezel::bernstein
