#include "bezel/bernstein/newton.hpp"

#include <string>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/newton_kernel.hpp"
#include "bezel/bernstein/roots.hpp"

namespace bezel::bernstein {

NewtonRoot newton_root(std::span<const double> b, double s0, NewtonForm form,
                       const NewtonOptions& options) {
  const int d = checks::interval(b);
  checks::finite(s0, "start");
  checks::iteration(options.param_tol, options.max_iterations);
  NewtonRoot out = kernel::newton_root(d, b.data(), s0, form, options);
  out.condition = root_condition(b, out.s);
  return out;
}

}  // namespace bezel::bernstein
