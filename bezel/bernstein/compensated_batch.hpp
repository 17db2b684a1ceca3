#pragma once
// The vectorised K-fold compensated de Casteljau algorithm, without checks.

#include <cstddef>

namespace bezel::bernstein {

/// out[q] = p(s[q]) as if in K times the working precision, the bits of the scalar kernel. False,
/// and nothing done, when K is not 2, 3 or 4.
bool compensated_points(int d, const double* b, const double* s, std::size_t count, int K,
                        double* out);

/// levels[F * count + q] = level F at s[q], F < K; for the same K.
bool compensated_point_levels(int d, const double* b, const double* s, std::size_t count, int K,
                              double* levels);

}  // namespace bezel::bernstein
