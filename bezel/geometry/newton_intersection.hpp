#pragma once
// Newton's method for an intersection of two plane curves with compensated residuals, and the
// conditioning of an intersection.

#include <cstdint>
#include <span>
#include <vector>

#include "bezel/bernstein/newton.hpp"
#include "bezel/numeric/vec.hpp"

namespace bezel {

/// How a(s) - b(t) is computed; it decides how many digits of an ill-conditioned intersection are
/// reached.
enum class ResidualForm : std::uint8_t {
  plain,           ///< by de Casteljau
  compensated,     ///< from the two levels of each curve's value, without rounding a curve's value
                   ///< before the subtraction
  rounded_values,  ///< compensated values, each rounded before the subtraction: as bad as plain
                   ///< (for comparison)
};

/// Where Newton's method has been.
struct IntersectionIterate {
  double s, t;
};

struct NewtonIntersection {
  double s, t;                 ///< the last iterate, always finite
  int iterations;              ///< residuals evaluated: steps taken, and 1 more for zero_residual
  bernstein::NewtonStop stop;  ///< why it ended
  double condition;            ///< intersection_condition at (s, t)
  std::vector<IntersectionIterate> history;  ///< (s0, t0) and every iterate
};

struct NewtonIntersectionOptions {
  double param_tol = 1e-15;  ///< a step (ds, dt) of a length below this ends the iteration
  int max_iterations = 50;   ///< at least 0
};

/// Newton's method for a(s) = b(t); the Jacobian in plain arithmetic, the 2x2 system by elimination
/// with row exchange.
///
/// @param a, b    control points, 1 to 61 each, finite
/// @param s0, t0  start, any finite values; iterates may leave [0, 1]
/// @throws    InputError for bad control points, a start that is not finite, a tolerance that is
///            negative or NaN, or negative max_iterations
/// @accuracy  compensated: relative error of (s, t) about u + kappa u^2, kappa from
///            intersection_condition, as long as the plain Jacobian is good for a digit; plain and
///            rounded_values: kappa u. Nothing is proven
/// @cost      per step two compensated and two plain evaluations per curve
/// @source    [hermes2018, ch. 6]; docs/methods/newton.md
NewtonIntersection newton_intersection(std::span<const Vec2> a, std::span<const Vec2> b, double s0,
                                       double t0, ResidualForm form,
                                       const NewtonIntersectionOptions& options = {});

/// kappa of the transversal intersection at (s, t): by how much relative errors of the control
/// points' coordinates are amplified in (s, t), relative to its length.
///
/// With J = [a', -b'], J^-1 = [v, w], mu1 and mu2 the sums of |x_j B_j| and |y_j B_j| of both
/// curves: sqrt((mu1^2 v.v + 2 mu1 mu2 |v.w| + mu2^2 w.w) / (s^2 + t^2)). Infinite when the
/// Jacobian is singular or s = t = 0.
///
/// @throws    InputError for bad control points, or s or t not finite
/// @accuracy  within (8 / sine + 8 d) u of itself, sine that of the angle between the tangents
/// @source    docs/methods/newton.md
double intersection_condition(std::span<const Vec2> a, std::span<const Vec2> b, double s, double t);

}  // namespace bezel
