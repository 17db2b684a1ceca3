#pragma once
// All roots of a polynomial in [0, 1], proven: none is missed, none is made up.

#include <span>
#include <vector>

namespace bezel::bernstein {

/// A simple root, a multiple root, or roots closer together than doubles (and 64 bits beyond them)
/// can tell.
struct Root {
  double s;       ///< simple: the double nearest to the root (a tie: either); else in [lo, hi]
  double lo;      ///< lo == hi == s when s is proven to be the root, else neighbouring doubles
  double hi;      ///< with the root(s) strictly between; roots that share them have a Root each
  bool multiple;  ///< not proven to be exactly one simple root
  int min_multiplicity;  ///< proven bounds of the number of roots meant, counted with multiplicity:
  int max_multiplicity;  ///< both 1 when simple; equal at a multiple root that is a double, and
                         ///< of equal parity always
  double condition;      ///< root_condition at s when simple, else infinite
};

/// Roots in [0, 1] in ascending order; the coefficients are taken as exact.
///
/// @param b   d+1 coefficients, 0 <= d <= 60, finite
/// @return    every root in [0, 1], each in exactly one Root. One of bounded, not known,
///            multiplicity has at least two roots (complex pairs count) within d 2^-64 (hi - lo)
/// @throws    InputError for bad coefficients, and for the zero polynomial, whose every point is a
///            root
/// @cost      cubics 0.6 us per root, quintics 1 us, degree 20 10 to 20 us, where signs are certain
///            in twice the precision; else exact arithmetic. At most d/2 parts are bisected per
///            level, at d (d+1) / 2 sums each; levels: 53 + k + 64 for roots above 2^-k, 1138 in
///            all (0.3 s seen, d = 60)
/// @source    Descartes' rule of signs in Bernstein form [lane1981]; docs/methods/newton.md
std::vector<Root> roots(std::span<const double> b);

/// kappa = p~(alpha) / (|alpha p'(alpha)|), p~ the sum of |b_j B_j|: by how much relative errors of
/// the coefficients are amplified in a simple root alpha. Infinite when p'(alpha) = 0 or alpha = 0.
///
/// @throws    InputError for bad coefficients, or alpha not finite
/// @accuracy  within 2^-20 of itself; p' is exact where doubles lose it
/// @cost      two sweeps of de Casteljau, and exact arithmetic when p' is that ill-conditioned
double root_condition(std::span<const double> b, double alpha);

}  // namespace bezel::bernstein
