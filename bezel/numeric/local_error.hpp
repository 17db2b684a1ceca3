#pragma once
// Local errors of a compensated recurrence: sums whose own rounding errors are kept for the next
// level.

#include <span>

namespace bezel {

/// l + sum of eta equals e_1 + ... + e_L + rho b exactly, l being the rounded left-to-right sum.
///
/// @param e    L >= 2 values @param rho, b  the last term, a product
/// @param eta  L + 1 places for the errors, in the order in which they arise: L - 1 of the sums of
///             e, one of the product, one of adding it
/// @throws  InputError when e has fewer than two values or eta not L + 1 places
/// @cost    6 L + 2 flops (with a fused product)
/// @source  [hermes2018, algorithm 5.2]
double local_error_eft(std::span<const double> e, double rho, double b, std::span<double> eta);

/// The same sum with plain operations, the errors dropped; 1 + L flops.
/// @source [hermes2018, algorithm A.7]
double local_error(std::span<const double> e, double rho, double b);

}  // namespace bezel
