#include "bezel/bernstein/exact.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "bezel/bernstein/checks.hpp"
#include "bezel/bernstein/interval_kernel.hpp"

namespace bezel::bernstein {

ExactPolynomial::ExactPolynomial(std::span<const double> b) {
  checks::interval(b);
  const std::vector<Dyadic> exact(b.begin(), b.end());
  *this = ExactPolynomial(std::span<const Dyadic>(exact));
}

ExactPolynomial::ExactPolynomial(std::span<const Dyadic> b) : b_(b.begin(), b.end()) {
  if (b.empty()) throw InputError("found no coefficients, expected at least one");
  checks::interval_degree(static_cast<int>(b.size()) - 1);
  a_.resize(b.size());
  kernel::to_monomial(degree(), b_.data(), a_.data());
}

bool ExactPolynomial::is_zero() const {
  return std::all_of(b_.begin(), b_.end(), [](const Dyadic& c) { return c.sign() == 0; });
}

Dyadic ExactPolynomial::operator()(const Dyadic& s) const {
  Dyadic h = a_.back();
  for (std::size_t k = a_.size() - 1; k-- > 0;) h = h * s + a_[k];
  return h;
}

ExactPolynomial ExactPolynomial::derivative() const {
  std::vector<Dyadic> c(std::max<std::size_t>(b_.size() - 1, 1));
  kernel::differentiate<Dyadic, Dyadic>(degree(), b_.data(), c.data());
  return ExactPolynomial(std::span<const Dyadic>(c));
}

std::vector<Dyadic> ExactPolynomial::specialize(const Dyadic& lo, const Dyadic& hi) const {
  std::vector<Dyadic> out(b_.size());
  kernel::specialize(degree(), b_.data(), lo, hi, out.data());
  return out;
}

std::vector<Dyadic> bisect_exactly(std::vector<Dyadic>& c) {
  const std::size_t d = c.size() - 1;
  std::vector<Dyadic> left;
  left.reserve(c.size());
  for (std::size_t m = d; m > 0; --m) {
    left.push_back(c[0].scaled(static_cast<std::int64_t>(m)));
    for (std::size_t j = 0; j < m; ++j) c[j] += c[j + 1];
  }
  left.push_back(c[0]);
  // c[j] is of level d - j and so far 2^(d - j) times itself.
  for (std::size_t j = 1; j <= d; ++j) c[j] = c[j].scaled(static_cast<std::int64_t>(j));
  return left;
}

}  // namespace bezel::bernstein
