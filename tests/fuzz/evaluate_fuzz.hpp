#pragma once
// Any bytes as a polynomial and parameters: evaluation throws InputError or returns what it
// promises, checked in exact arithmetic.

#include <cstddef>
#include <cstdint>
#include <span>

namespace bezel::evaluate_fuzz {

/// Bytes: one for K, one for the degree, one for the number of points, then doubles of any bits:
/// the coefficients, then the parameters; what is missing is 0. Evaluates compensated and
/// certified, alone and as a batch, and throws std::logic_error when a promise is broken.
/// @return whether the input was accepted; false after an InputError
bool evaluate_bytes(std::span<const std::uint8_t> bytes);

/// Throws std::logic_error unless value is one of the doubles around p(s) and |value - p(s)| <=
/// bound; for evaluate_bytes, and for a test that it can fail.
void check_certified(std::span<const double> b, double s, double value, double bound);

}  // namespace bezel::evaluate_fuzz
