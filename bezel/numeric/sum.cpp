#include "bezel/numeric/sum.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

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

void vec_sum(std::span<double> values) {
  for (std::size_t j = 1; j < values.size(); ++j) {
    const WithError t = two_sum(values[j], values[j - 1]);
    values[j] = t.value;
    values[j - 1] = t.error;
  }
}

double sum_k(std::span<const double> values, int K) {
  if (K < 1) throw InputError("found K = " + std::to_string(K) + ", expected at least 1");
  std::array<double, 32> few;
  std::vector<double> many;
  if (values.size() > few.size()) many.resize(values.size());
  const std::span<double> work(many.empty() ? few.data() : many.data(), values.size());
  std::copy(values.begin(), values.end(), work.begin());
  for (int pass = 1; pass < K; ++pass) vec_sum(work);
  double s = 0.0;
  for (std::size_t j = 0; j < work.size(); ++j) s = j == 0 ? work[0] : s + work[j];
  return s;
}

}  // namespace bezel
