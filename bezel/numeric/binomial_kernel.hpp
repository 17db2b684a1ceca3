#pragma once
// Binomial and multinomial coefficients in any scalar type, for kernels. Arguments are not checked.

#include <cstddef>
#include <cstdint>

#include "bezel/numeric/binomial.hpp"
#include "bezel/numeric/double_double.hpp"

namespace bezel::kernel {

extern const double* const binomial_table;  // C(n, k) at n (n+1) / 2 + k, correctly rounded

/// C(n, k) as a Scalar, 0 <= k <= n <= max_binomial. The general version is exact in exact scalars.
template <class Scalar>
struct Binomial {
  static Scalar get(int n, int k) {
    const Integer128 c = exact_binomial(n, k);
    const Scalar two_to_32(4294967296.0);
    const auto part = [](std::uint64_t x) { return Scalar(static_cast<double>(x)); };
    Scalar value = part(c.high >> 32);
    value = Scalar(value * two_to_32) + part(c.high & 0xffffffffU);
    value = Scalar(value * two_to_32) + part(c.low >> 32);
    value = Scalar(value * two_to_32) + part(c.low & 0xffffffffU);
    return value;
  }
};
template <>
struct Binomial<double> {
  static double get(int n, int k) {
    return binomial_table[static_cast<std::size_t>(n * (n + 1) / 2 + k)];
  }
};

/// d! / (i! j! k!) with i = d - j - k.
template <class Scalar>
Scalar trinomial(int d, int j, int k) {
  return Scalar(Binomial<Scalar>::get(d, k) * Binomial<Scalar>::get(d - k, j));
}

}  // namespace bezel::kernel
