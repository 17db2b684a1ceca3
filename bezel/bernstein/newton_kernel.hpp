#pragma once
// Newton's method on unchecked coefficients of any degree.

#include <cmath>
#include <cstddef>
#include <vector>

#include "bezel/bernstein/compensated_kernel.hpp"
#include "bezel/bernstein/interval_kernel.hpp"
#include "bezel/bernstein/newton.hpp"
#include "bezel/numeric/sum.hpp"

namespace bezel::bernstein::kernel {

/// p and p' at s in the precision that a form asks for. Plain p': differences of the coefficients,
/// de Casteljau, times d.
class NewtonValues {
 public:
  NewtonValues(int d, const double* b, NewtonForm form)
      : d_(d),
        value_k_(form == NewtonForm::basic    ? 1
                 : form == NewtonForm::triple ? 3
                                              : 2),
        derivative_k_(form == NewtonForm::full     ? 2
                      : form == NewtonForm::triple ? 3
                                                   : 1),
        b_(b),
        work_(static_cast<std::size_t>((d + 1) * value_k_)) {}

  double value(double s) {
    double levels[3];
    kernel::compensated_levels(d_, b_, s, value_k_, work_.data(), levels);
    return sum_k({levels, static_cast<std::size_t>(value_k_)}, value_k_);
  }
  double derivative(double s) {
    if (d_ == 0) return 0.0;
    double levels[3];
    kernel::compensated_derivative_levels(d_, b_, s, derivative_k_, work_.data(), levels);
    return d_ * sum_k({levels, static_cast<std::size_t>(derivative_k_)}, derivative_k_);
  }

 private:
  int d_, value_k_, derivative_k_;
  const double* b_;
  std::vector<double> work_;
};

/// The iteration of newton_root, without the condition.
inline NewtonRoot newton_root(int d, const double* b, double s0, NewtonForm form,
                              const NewtonOptions& options) {
  NewtonRoot out{s0, 0, NewtonStop::max_iterations, 0.0, {s0}};
  NewtonValues p(d, b, form);
  while (out.iterations < options.max_iterations) {
    const double value = p.value(out.s), derivative = p.derivative(out.s);
    if (derivative == 0.0) {
      out.stop = NewtonStop::zero_derivative;
      return out;
    }
    const double step = value / derivative, next = out.s - step;
    if (!std::isfinite(next)) {
      out.stop = NewtonStop::not_finite;
      return out;
    }
    out.s = next;
    out.history.push_back(next);
    ++out.iterations;
    // A zero step ends it whatever the tolerance: all later ones would be the same.
    if (std::fabs(step) < options.param_tol || step == 0.0) {
      out.stop = NewtonStop::small_step;
      return out;
    }
  }
  return out;
}

}  // namespace bezel::bernstein::kernel
