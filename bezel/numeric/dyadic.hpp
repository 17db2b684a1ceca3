#pragma once
// Exact arithmetic on dyadic rationals: sums and products of doubles without any rounding, overflow
// or underflow. For the rare case that doubles cannot decide; not for hot loops.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

namespace bezel {

namespace detail {

/// The limbs of a Dyadic: short numbers need no allocation.
class Limbs {
 public:
  static constexpr std::size_t inline_size = 6;

  Limbs() = default;
  Limbs(const Limbs& other) { assign(other.data(), other.size_); }
  Limbs(Limbs&& other) noexcept { take(other); }
  Limbs& operator=(const Limbs& other) {
    if (this != &other) assign(other.data(), other.size_);
    return *this;
  }
  Limbs& operator=(Limbs&& other) noexcept {
    if (this != &other) take(other);
    return *this;
  }
  ~Limbs() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  std::uint64_t* data() { return heap_ ? heap_.get() : inline_; }
  const std::uint64_t* data() const { return heap_ ? heap_.get() : inline_; }
  std::uint64_t& operator[](std::size_t i) { return data()[i]; }
  std::uint64_t operator[](std::size_t i) const { return data()[i]; }
  std::uint64_t back() const { return data()[size_ - 1]; }
  /// All zero.
  void reset(std::size_t size) {
    room(size);
    std::fill_n(data(), size, std::uint64_t{0});
  }
  /// Keeps the limbs from `first` on, without the last ones from `last` on.
  void keep(std::size_t first, std::size_t last) {
    if (first > 0) std::copy(data() + first, data() + last, data());
    size_ = last - first;
  }
  friend bool operator==(const Limbs& a, const Limbs& b) {
    return a.size_ == b.size_ && std::equal(a.data(), a.data() + a.size_, b.data());
  }

 private:
  void assign(const std::uint64_t* from, std::size_t size) {
    room(size);
    std::uint64_t* const to = data();
    for (std::size_t i = 0; i < size; ++i) to[i] = from[i];
  }
  void take(Limbs& other) {
    if (other.heap_) {
      heap_ = std::move(other.heap_);
      size_ = other.size_;
      capacity_ = other.capacity_;
      other.capacity_ = inline_size;
    } else {
      assign(other.inline_, other.size_);
    }
    other.size_ = 0;
  }
  /// Room for `size` limbs of any values.
  void room(std::size_t size) {
    if (size > capacity_) {
      heap_.reset(new std::uint64_t[size]);  // not set to zero
      capacity_ = size;
    }
    size_ = size;
  }

  std::size_t size_ = 0, capacity_ = inline_size;
  std::uint64_t inline_[inline_size];  // not set before it is needed
  std::unique_ptr<std::uint64_t[]> heap_;
};

}  // namespace detail

/// A number m 2^e with integers m and e, exact. Closed under + - *, and every finite double is one.
///
/// @cost  memory for the bits between its highest and lowest one, in limbs of 64; + and - linear,
///        * the product of both lengths; beyond 384 bits operations allocate
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
  detail::Limbs limb_;
};

}  // namespace bezel
