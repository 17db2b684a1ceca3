#include "bezel/numeric/sum.hpp"

#include <cstddef>
#include <string>

#include "bezel/base/error.hpp"
#include "bezel/numeric/eft.hpp"

namespace bezel {

double sum(std::span<const double> values) {
  double s = 0.0, error = 0.0;
  for (const double value : values) {
    const WithError t = two_sum(s, value);
    s = t.value;
    error += t.error;
  }
  return s + error;
}

double dot(std::span<const double> a, std::span<const double> b) {
  if (a.size() != b.size())
    throw InputError("found vectors of lengths " + std::to_string(a.size()) + " and " +
                     std::to_string(b.size()) + ", expected equal lengths");
  double s = 0.0, error = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const WithError p = two_prod(a[i], b[i]);
    const WithError t = two_sum(s, p.value);
    s = t.value;
    error += t.error + p.error;
  }
  return s + error;
}

}  // namespace bezel
