#pragma once
// Exact scalars for the kernels: rationals (GMP), and the field with 2^61 - 1 elements. An identity
// between rational expressions that holds over the rationals holds in the field; one that fails
// survives there only when the difference is a multiple of the prime. The field is fast enough for
// every degree.

#include <gmpxx.h>

#include <cmath>
#include <cstdint>
#include <ostream>
#include <random>
#include <vector>

namespace exact {

using Rational = mpq_class;

class Mod61 {
 public:
  static constexpr std::uint64_t prime = (std::uint64_t{1} << 61) - 1;

  Mod61() = default;
  Mod61(int a)
      : x_(a >= 0 ? static_cast<std::uint64_t>(a) : prime - static_cast<std::uint64_t>(-a)) {}
  explicit Mod61(double a) {
    int exponent = 0;
    const double mantissa = std::ldexp(std::frexp(std::fabs(a), &exponent), 53);  // an integer
    x_ = static_cast<std::uint64_t>(mantissa) % prime;
    const int shift = ((exponent - 53) % 61 + 61) % 61;  // 2^61 = 1
    *this = *this * power(Mod61(2), static_cast<std::uint64_t>(shift));
    if (a < 0) *this = Mod61(0) - *this;
  }
  friend Mod61 operator+(Mod61 a, Mod61 b) { return reduced(a.x_ + b.x_); }
  friend Mod61 operator-(Mod61 a, Mod61 b) { return reduced(a.x_ + (prime - b.x_)); }
  friend Mod61 operator*(Mod61 a, Mod61 b) {
    __extension__ using Wide = unsigned __int128;
    const Wide p = Wide{a.x_} * b.x_;
    return reduced(static_cast<std::uint64_t>(p & prime) + static_cast<std::uint64_t>(p >> 61));
  }
  friend Mod61 operator/(Mod61 a, Mod61 b) { return a * power(b, prime - 2); }
  friend bool operator==(Mod61 a, Mod61 b) { return a.x_ == b.x_; }
  friend std::ostream& operator<<(std::ostream& out, Mod61 a) { return out << a.x_; }

 private:
  static Mod61 reduced(std::uint64_t x) {
    Mod61 r;
    r.x_ = x >= prime ? x - prime : x;
    return r;
  }
  static Mod61 power(Mod61 base, std::uint64_t exponent) {
    Mod61 result(1);
    for (; exponent > 0; exponent >>= 1, base = base * base)
      if (exponent & 1U) result = result * base;
    return result;
  }
  std::uint64_t x_ = 0;
};

template <class Scalar>
std::vector<Scalar> random_values(int n, std::mt19937_64& random) {
  std::vector<Scalar> values;
  for (int i = 0; i < n; ++i) {
    const int numerator = static_cast<int>(random() % 41) - 20;
    const int denominator = 1 + static_cast<int>(random() % 9);
    values.push_back(Scalar(Scalar(numerator) / Scalar(denominator)));
  }
  return values;
}

/// Doubles with infinite binary expansions, exact zeros, and magnitudes from 2^-40 to 1, both
/// signs.
inline std::vector<double> random_doubles(int n, std::mt19937_64& random) {
  std::vector<double> values;
  for (int i = 0; i < n; ++i) {
    const double mantissa = static_cast<double>(random() >> 11) * 0x1p-53;
    const int exponent = random() % 4 == 0 ? -static_cast<int>(random() % 40) : 0;
    const double sign = random() % 2 == 0 ? 1.0 : -1.0;
    values.push_back(random() % 16 == 0 ? 0.0 : sign * std::ldexp(mantissa, exponent));
  }
  return values;
}

inline std::vector<Rational> rationals(const std::vector<double>& values) {
  return std::vector<Rational>(values.begin(), values.end());
}

inline double max_abs(const std::vector<double>& values) {
  double m = 0.0;
  for (const double x : values) m = std::fmax(m, std::fabs(x));
  return m;
}

/// |a - b| rounded up to double.
inline double distance(double a, const Rational& b) {
  const Rational difference = abs(Rational(a) - b);
  return std::nextafter(difference.get_d(), HUGE_VAL);
}

}  // namespace exact
