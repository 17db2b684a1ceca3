#pragma once
// Internal: numbers for what is met, in the order in which it is met, over and over again.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace bezel::detail {

/// Numbers 0, 1, ... for things that are known by other numbers -1, 0, 1, ...; begin() forgets them
/// at no cost.
class Numbering {
 public:
  /// Of things below `size`.
  explicit Numbering(std::size_t size) : place_(size + 1, 0) {}

  void begin() {
    // What was marked with the next number, but not counted, is forgotten too.
    first_ = ++next_;
    if (first_ < 1U << 31U) return;
    std::fill(place_.begin(), place_.end(), 0U);
    first_ = next_ = 1;
  }
  bool knows(std::int32_t i) const { return at(i) >= first_; }
  /// Of something known.
  std::uint32_t number(std::int32_t i) const { return at(i) - first_; }
  std::uint32_t count() const { return next_ - first_; }
  /// Makes something known with this number, which is not counted.
  void mark(std::int32_t i, std::uint32_t number) {
    place_[static_cast<std::size_t>(i + 1)] = first_ + number;
  }
  std::uint32_t take(std::int32_t i) {
    Taker taker(*this);
    return taker.take(i);
  }

  /// Takes many numbers, with all it needs at hand; what it took is counted at its end.
  class Taker {
   public:
    explicit Taker(Numbering& of)
        : of_(of), place_(of.place_.data() + 1), first_(of.first_), next_(of.next_) {}
    Taker(const Taker&) = delete;
    Taker& operator=(const Taker&) = delete;
    ~Taker() { of_.next_ = next_; }
    std::uint32_t count() const { return next_ - first_; }
    /// The number of i: the next when it is not known yet. No branch depends on that.
    std::uint32_t take(std::int32_t i) {
      const std::uint32_t before = place_[i];
      const std::uint32_t fresh = before < first_ ? ~0U : 0U;
      const std::uint32_t number = before ^ ((before ^ next_) & fresh);
      next_ -= fresh;
      place_[i] = number;
      return number - first_;
    }

   private:
    Numbering& of_;
    std::uint32_t* place_;
    std::uint32_t first_, next_;
  };

 private:
  std::uint32_t at(std::int32_t i) const { return place_[static_cast<std::size_t>(i + 1)]; }

  std::vector<std::uint32_t> place_;  // a number below the first is an old one
  std::uint32_t first_ = 1, next_ = 1;
};

}  // namespace bezel::detail
