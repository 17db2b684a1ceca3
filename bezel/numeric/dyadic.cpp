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
void add_to(std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b, std::size_t shift) {
  unsigned carry = 0;
  std::size_t i = 0;
  for (; i < b.size(); ++i) {
    const Wide t = Wide{a[i + shift]} + b[i] + carry;
    a[i + shift] = static_cast<std::uint64_t>(t);
    carry = static_cast<unsigned>(t >> 64);
  }
  for (; carry != 0; ++i) carry = ++a[i + shift] == 0 ? 1 : 0;
}

/// a - b shifted up, in place; a is the larger.
void subtract_from(std::vector<std::uint64_t>& a, const std::vector<std::uint64_t>& b,
                   std::size_t shift) {
  unsigned borrow = 0;
  std::size_t i = 0;
  for (; i < b.size(); ++i) {
    const Wide t = Wide{a[i + shift]} - b[i] - borrow;
    a[i + shift] = static_cast<std::uint64_t>(t);
    borrow = static_cast<unsigned>(t >> 64) & 1U;
  }
  for (; borrow != 0; ++i) borrow = a[i + shift]-- == 0 ? 1 : 0;
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
  limb_.push_back(mantissa << shift);
  if (shift > 11) limb_.push_back(mantissa >> (64 - shift));
  trim();
}

void Dyadic::trim() {
  while (!limb_.empty() && limb_.back() == 0) limb_.pop_back();
  const auto first =
      std::find_if(limb_.begin(), limb_.end(), [](std::uint64_t x) { return x != 0; });
  offset_ += first - limb_.begin();
  limb_.erase(limb_.begin(), first);
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
  const std::int64_t low = a.limb_.empty() ? b.offset_ : std::min(a.offset_, b.offset_);
  const auto top_of = [](const Dyadic& x) {
    return x.offset_ + static_cast<std::int64_t>(x.limb_.size());
  };
  const std::int64_t high = a.limb_.empty() ? top_of(b) : std::max(top_of(a), top_of(b));
  Dyadic r;
  r.offset_ = low;
  r.limb_.assign(static_cast<std::size_t>(high - low) + 1, 0);
  const auto shift_a = static_cast<std::size_t>(a.limb_.empty() ? 0 : a.offset_ - low);
  const auto shift_b = static_cast<std::size_t>(b.offset_ - low);
  std::copy(a.limb_.begin(), a.limb_.end(), r.limb_.begin() + static_cast<std::ptrdiff_t>(shift_a));
  r.negative_ = a.negative_;
  if (a.negative_ == b_negative || a.limb_.empty()) {
    r.negative_ = b_negative;
    add_to(r.limb_, b.limb_, shift_b);
    r.trim();
    return r;
  }
  // Opposite signs: which magnitude is larger shows in the borrow out of the top.
  std::vector<std::uint64_t> wide_b(r.limb_.size(), 0);
  std::copy(b.limb_.begin(), b.limb_.end(), wide_b.begin() + static_cast<std::ptrdiff_t>(shift_b));
  if (std::lexicographical_compare(r.limb_.rbegin(), r.limb_.rend(), wide_b.rbegin(),
                                   wide_b.rend())) {
    r.limb_.swap(wide_b);
    r.negative_ = b_negative;
  }
  subtract_from(r.limb_, wide_b, 0);
  r.trim();
  return r;
}

Dyadic operator*(const Dyadic& a, const Dyadic& b) {
  Dyadic r;
  if (a.limb_.empty() || b.limb_.empty()) return r;
  r.negative_ = a.negative_ != b.negative_;
  r.offset_ = a.offset_ + b.offset_;
  r.limb_.assign(a.limb_.size() + b.limb_.size(), 0);
  for (std::size_t i = 0; i < b.limb_.size(); ++i) {
    std::uint64_t carry = 0;
    for (std::size_t j = 0; j < a.limb_.size(); ++j) {
      const Wide t = Wide{a.limb_[j]} * b.limb_[i] + r.limb_[i + j] + carry;
      r.limb_[i + j] = static_cast<std::uint64_t>(t);
      carry = static_cast<std::uint64_t>(t >> 64);
    }
    r.limb_[i + a.limb_.size()] = carry;
  }
  r.trim();
  return r;
}

Dyadic Dyadic::scaled(std::int64_t bits) const {
  Dyadic r = *this;
  if (limb_.empty()) return r;
  const std::int64_t whole = floor_divide_64(bits);
  r.offset_ += whole;
  const auto shift = static_cast<unsigned>(bits - 64 * whole);
  if (shift == 0) return r;
  std::uint64_t carry = 0;
  for (std::uint64_t& x : r.limb_) {
    const std::uint64_t next = x >> (64 - shift);
    x = (x << shift) | carry;
    carry = next;
  }
  if (carry != 0) r.limb_.push_back(carry);
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
  const auto bit = [&](std::int64_t weight) {
    const std::int64_t at = weight - first;
    if (at < 0) return false;
    const auto limb = static_cast<std::size_t>(at >> 6);
    return limb < limb_.size() && ((limb_[limb] >> (at & 63)) & 1U) != 0;
  };
  std::uint64_t mantissa = 0;
  for (std::int64_t weight = top; weight >= last; --weight)
    mantissa = (mantissa << 1) | (bit(weight) ? 1U : 0U);
  if (bit(last - 1)) {
    // Trailing limbs are never 0: anything below the half is a one somewhere, and the lowest limb
    // holds the lowest.
    const std::int64_t lowest = first + std::countr_zero(limb_.front());
    if (lowest < last - 1 || (mantissa & 1U) != 0) ++mantissa;
  }
  return sign * std::ldexp(static_cast<double>(mantissa), static_cast<int>(last));
}

}  // namespace bezel
