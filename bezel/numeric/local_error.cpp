#include "bezel/numeric/local_error.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/numeric/local_error_kernel.hpp"

namespace bezel {
namespace {

void check(std::size_t count) {
  if (count < 2)
    throw InputError("found " + std::to_string(count) + " errors, expected at least 2");
}

}  // namespace

double local_error_eft(std::span<const double> e, double rho, double b, std::span<double> eta) {
  check(e.size());
  if (eta.size() != e.size() + 1)
    throw InputError("found " + std::to_string(eta.size()) + " places for errors, expected " +
                     std::to_string(e.size() + 1));
  double l = e[0];
  for (std::size_t i = 1; i < e.size(); ++i) {
    const WithError t = two_sum(l, e[i]);
    l = t.value;
    eta[i - 1] = t.error;
  }
  int count = static_cast<int>(e.size()) - 1;
  return kernel::add_product_with_errors(l, rho, b, eta.data(), count);
}

double local_error(std::span<const double> e, double rho, double b) {
  check(e.size());
  double l = e[0];
  for (std::size_t i = 1; i < e.size(); ++i) l += e[i];
  return l + rho * b;
}

}  // namespace bezel
