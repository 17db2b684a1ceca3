#pragma once
// Newton's method for a root, with compensated values: how many digits it can reach is decided by
// how the residual is computed.

#include <cstdint>
#include <span>
#include <vector>

namespace bezel::bernstein {

/// Which values are compensated.
enum class NewtonForm : std::uint8_t {
  basic,     ///< p and p' plain: a root is known to kappa u, relative
  accurate,  ///< p with K = 2, p' plain: u as long as kappa < 1/u, then it collapses
  full,      ///< p and p' with K = 2: u + kappa u^2
  triple     ///< p and p' with K = 3: u up to kappa = 1/u^2
};

/// Why the iteration ended.
enum class NewtonStop : std::uint8_t {
  small_step,       ///< the last step, which was taken, is below the tolerance
  zero_residual,    ///< newton_intersection: the residual evaluates to exactly zero
  max_iterations,   ///< none of the others within the iterations allowed
  zero_derivative,  ///< the derivative evaluates to 0: no step (with a value of 0 as well: nothing
                    ///< is known of a root); for an intersection: the Jacobian is singular
  not_finite        ///< the next iterate is not finite
};

struct NewtonOptions {
  double param_tol = 1e-15;  ///< steps below this end the iteration; in units of s
  int max_iterations = 100;  ///< at least 0
};

struct NewtonRoot {
  double s;                     ///< the last iterate, always finite
  int iterations;               ///< steps taken
  NewtonStop stop;              ///< why it ended
  double condition;             ///< root_condition at s
  std::vector<double> history;  ///< s0 and every iterate
};

/// Newton's method x <- x - p(x) / p'(x), until a step is below the tolerance.
///
/// @param b   d+1 coefficients, 0 <= d <= 60, finite
/// @param s0  start, any finite value; iterates may leave [0, 1]
/// @throws    InputError when b is empty, d > 60, b or s0 is not finite, the tolerance is negative
///            or NaN, or max_iterations is negative
/// @accuracy  near a simple root of condition kappa: see NewtonForm, for kappa from root_condition.
///            Nothing is proven; roots() proves
/// @cost      per step one evaluation of p and one of p', as evaluate_compensated costs them
/// @limits    double roots: p' vanishes with p, convergence is linear and half the digits are lost
/// @source    [graillat2008], [jiang2013], [hermes2018, ch. 6]; docs/methods/newton.md
NewtonRoot newton_root(std::span<const double> b, double s0, NewtonForm form,
                       const NewtonOptions& options = {});

}  // namespace bezel::bernstein
