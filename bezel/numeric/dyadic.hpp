#pragma once
// Exact arithmetic on dyadic rationals: sums and products of doubles without any rounding, overflow
// or underflow. For the rare case that doubles cannot decide; not for hot loops.

#include <cstdint>
#include <vector>

namespace bezel {

/// A number m 2^e with integers m and e, exact. Closed under + - *, and every finite double is one.
///
/// @cost  memory for the bits between its highest and lowest one, in limbs of 64; + and - linear,
///        * the product of both lengths; each operation may allocate
class Dyadic {
 public:
  /// Zero.
  Dyadic() = default;
  /// The double exactly. @throws InputError when it is not finite
  Dyadic(double x);  // NOLINT: every finite double is a Dyadic

  /// -1, 0 or +1.
  int sign() const { return limb_.empty() ? 0 : negative_ ? -1 : 1; }
  /// The e with 2^e <= |this| < 2^(e+1); 0 for zero.
  std::int64_t exponent() const;
  /// The nearest double, ties to even, subnormals included; infinite from 2^1024 - 2^970 on.
  double to_double() const;
  /// This times 2^bits.
  Dyadic scaled(std::int64_t bits) const;

  Dyadic operator-() const;
  friend Dyadic operator+(const Dyadic& a, const Dyadic& b) { return sum(a, b, b.negative_); }
  friend Dyadic operator-(const Dyadic& a, const Dyadic& b) { return sum(a, b, !b.negative_); }
  friend Dyadic operator*(const Dyadic& a, const Dyadic& b);
  Dyadic& operator+=(const Dyadic& b) { return *this = *this + b; }
  Dyadic& operator-=(const Dyadic& b) { return *this = *this - b; }
  Dyadic& operator*=(const Dyadic& b) { return *this = *this * b; }
  friend bool operator==(const Dyadic&, const Dyadic&) = default;
  friend bool operator<(const Dyadic& a, const Dyadic& b) { return (a - b).sign() < 0; }

 private:
  static Dyadic sum(const Dyadic& a, const Dyadic& b, bool b_negative);
  void trim();

  // (-1)^negative sum limb_[i] 2^(64 (i + offset_)); first and last limb not 0; zero has no limbs,
  // offset 0 and is not negative: equal numbers have equal members.
  bool negative_ = false;
  std::int64_t offset_ = 0;
  std::vector<std::uint64_t> limb_;
};

}  // namespace bezel
