// Values that cannot be trusted, values that can, and roots, of (2s-1)^3 (s-1) near its triple
// root.
#include <array>
#include <cstdio>

#include "bezel/bernstein/certified.hpp"
#include "bezel/bernstein/compensated.hpp"
#include "bezel/bernstein/roots.hpp"

int main() {
  using namespace bezel::bernstein;
  const std::array b{1.0, -0.75, 0.5, -0.25, 0.0};
  const double s = 0.5 + 1001 * 0x1p-53;

  std::printf("condition number   %.1e\n", condition_number(b, s));
  std::printf("plain              %.12e\n", evaluate_compensated<double>(b, s, 1));
  for (const int K : {2, 3})
    std::printf("compensated, K = %d %.12e\n", K, evaluate_compensated<double>(b, s, K));

  const CertifiedValue certified = evaluate_certified(b, s);
  std::printf("certified          %.12e\n", certified.value);
  std::printf("  within one ulp   %s\n",
              certified.error_bound < 0x1p-52 * -certified.value ? "yes" : "no");

  for (const Root& root : roots(b))
    std::printf("root in [%g, %g], %d times, condition %.3g\n", root.lo, root.hi,
                root.min_multiplicity, root.condition);
}
