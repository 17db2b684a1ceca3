#include "bezel/numeric/dyadic.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <limits>

#include "bezel/base/error.hpp"

namespace bezel {
namespace {

__extension__ using Wide = unsigned __int128;

std::int64_t floor_divide_64(std::int64_t x) {
  return x >> 6;  // arithmetic shift (C++20)
}

/// |a| + |b| shifted up by `shift` limbs, added in place; a has room.
void add_to(std::uint64_t* a, const detail::Limbs& b, std::size_t shift) {
  const std::uint64_t* from = b.data();
  unsigned carry = 0;
  std::size_t i = 0;
  for (; i < b.size(); ++i) {
    const Wide t = Wide{a[i + shift]} + from[i] + carry;
    a[i + shift] = static_cast<std::uint64_t>(t);
    carry = static_cast<unsigned>(t >> 64);
  }
  for (; carry != 0; ++i) carry = ++a[i + shift] == 0 ? 1 : 0;
}

/// a - b shifted up, in place; the borrow out of the top of a's `size` limbs.
unsigned subtract_from(std::uint64_t* a, std::size_t size, const detail::Limbs& b,
                       std::size_t shift) {
  const std::uint64_t* from = b.data();
  unsigned borrow = 0;
  std::size_t i = 0;
  for (; i < b.size(); ++i) {
    const Wide t = Wide{a[i + shift]} - from[i] - borrow;
    a[i + shift] = static_cast<std::uint64_t>(t);
    borrow = static_cast<unsigned>(t >> 64) & 1U;
  }
  for (; borrow != 0 && i + shift < size; ++i) borrow = a[i + shift]-- == 0 ? 1 : 0;
  return borrow;
}

}  // namespace

Dyadic::Dyadic(double x) {
  if (!std::isfinite(x))
    throw InputError("an exact number from " + std::to_string(x) + ", expected a finite value");
  if (x == 0.0) return;
  negative_ = std::signbit(x);
  int exponent = 0;
  const auto mantissa =
      static_cast<std::uint64_t>(std::ldexp(std::frexp(std::fabs(x), &exponent), 53));
  const std::int64_t e = exponent - 53;
  offset_ = floor_divide_64(e);
  const auto shift = static_cast<unsigned>(e - 64 * offset_);
  limb_.reset(2);
  limb_[0] = mantissa << shift;
  if (shift > 11) limb_[1] = mantissa >> (64 - shift);
  trim();
}

void Dyadic::trim() {
  std::size_t last = limb_.size(), first = 0;
  while (last > 0 && limb_[last - 1] == 0) --last;
  while (first < last && limb_[first] == 0) ++first;
  limb_.keep(first, last);
  offset_ += static_cast<std::int64_t>(first);
  if (limb_.empty()) {
    negative_ = false;
    offset_ = 0;
  }
}

Dyadic Dyadic::operator-() const {
  Dyadic r = *this;
  r.negative_ = !limb_.empty() && !negative_;
  return r;
}

Dyadic Dyadic::sum(const Dyadic& a, const Dyadic& b, bool b_negative) {
  if (b.limb_.empty()) return a;
  if (a.limb_.empty()) {
    Dyadic r = b;
    r.negative_ = b_negative;
    return r;
  }
  const std::int64_t low = std::min(a.offset_, b.offset_);
  const auto top_of = [](const Dyadic& x) {
    return x.offset_ + static_cast<std::int64_t>(x.limb_.size());
  };
  const std::int64_t high = std::max(top_of(a), top_of(b));
  Dyadic r;
  r.offset_ = low;
  r.limb_.reset(static_cast<std::size_t>(high - low) + 1);
  std::uint64_t* const sum = r.limb_.data();
  std::copy_n(a.limb_.data(), a.limb_.size(), sum + (a.offset_ - low));
  const auto shift = static_cast<std::size_t>(b.offset_ - low);
  r.negative_ = a.negative_;
  if (a.negative_ == b_negative) {
    add_to(sum, b.limb_, shift);
  } else if (subtract_from(sum, r.limb_.size(), b.limb_, shift) != 0) {
    // b's magnitude is larger: the complement of what is there.
    r.negative_ = b_negative;
    unsigned carry = 1;
    for (std::size_t i = 0; i < r.limb_.size(); ++i) {
      sum[i] = ~sum[i] + carry;
      carry = carry != 0 && sum[i] == 0 ? 1 : 0;
    }
  }
  r.trim();
  return r;
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  Dyadic r;
  if (a.limb_.empty() || b.limb_.empty()) return r;
  r.negative_ = a.negative_ != b.negative_;
  r.offset_ = a.offset_ + b.offset_;
  r.limb_.reset(a.limb_.size() + b.limb_.size());
  std::uint64_t* const out = r.limb_.data();
  const std::uint64_t *const p = a.limb_.data(), *const q = b.limb_.data();
  for (std::size_t i = 0; i < b.limb_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < a.limb_.size(); ++j) {
      const Wide t = Wide{p[j]} * q[i] + out[i + j] + carry;
      out[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    out[i + a.limb_.size()] = carry;
  }
  r.trim();
  return r;
}

Dyadic Dyadic::scaled(std::int64_t bits) const {
  if (limb_.empty()) return *this;
  const std::int64_t whole = floor_divide_64(bits);
  const auto shift = static_cast<unsigned>(bits - 64 * whole);
  if (shift == 0) {
    Dyadic r = *this;
    r.offset_ += whole;
    return r;
  }
  Dyadic r;
  r.negative_ = negative_;
  r.offset_ = offset_ + whole;
  r.limb_.reset(limb_.size() + 1);
  std::uint64_t carry = 0;
  for (std::size_t i = 0; i < limb_.size(); ++i) {
    r.limb_[i] = (limb_[i] << shift) | carry;
    carry = limb_[i] >> (64 - shift);
  }
  r.limb_[limb_.size()] = carry;
  r.trim();
  return r;
}

std::int64_t Dyadic::exponent() const {
  if (limb_.empty()) return 0;
  return 64 * (offset_ + static_cast<std::int64_t>(limb_.size())) - 1 -
         std::countl_zero(limb_.back());
}

double Dyadic::to_double() const {
  if (limb_.empty()) return 0.0;
  // The bit of weight 2^e is bit e - 64 offset_ of the limbs. The result keeps the 53 bits from the
  // top down, or those from 2^-1074 on.
  const std::int64_t top = exponent();
  const double sign = negative_ ? -1.0 : 1.0;
  if (top > 1023) return sign * std::numeric_limits<double>::infinity();
  const std::int64_t last = std::max<std::int64_t>(top - 52, -1074);  // weight of the last bit kept
  if (top < last - 1) return sign * 0.0;
  const std::int64_t first = 64 * offset_;
  const auto limb = [&](std::int64_t i) {
    return i >= 0 && i < static_cast<std::int64_t>(limb_.size())
               ? limb_[static_cast<std::size_t>(i)]
               : 0U;
  };
  // The 64 bits from a weight on.
  const auto window = [&](std::int64_t weight) {
    const std::int64_t at = weight - first, i = floor_divide_64(at);
    const auto shift = static_cast<unsigned>(at - 64 * i);
    return shift == 0 ? limb(i) : (limb(i) >> shift) | (limb(i + 1) << (64 - shift));
  };
  std::uint64_t mantissa = window(last);  // there is nothing above `top`
  if ((window(last - 1) & 1U) != 0) {
    // Trailing limbs are never 0: anything below the half is a one somewhere, and the lowest limb
    // holds the lowest.
    const std::int64_t lowest = first + std::countr_zero(limb_[0]);
    if (lowest < last - 1 || (mantissa & 1U) != 0) ++mantissa;
  }
  return sign * std::ldexp(static_cast<double>(mantissa), static_cast<int>(last));
}

}  // namespace bezel
