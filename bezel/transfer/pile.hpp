#pragma once
// Internal: a list that is filled and emptied over and over.

#include <cstddef>
#include <vector>

namespace bezel::detail {

/// A list whose storage stays as it is when it is emptied: what is added is written once, without a
/// look at the room for each.
template <class T>
class Pile {
 public:
  std::size_t size() const { return size_; }
  const T* data() const { return all_.data(); }
  const T* begin() const { return all_.data(); }
  const T* end() const { return all_.data() + size_; }
  const T& operator[](std::size_t i) const { return all_[i]; }
  T& operator[](std::size_t i) { return all_[i]; }

  void clear() { size_ = 0; }
  /// @param size  within what there is, or what was written to room()
  void resize(std::size_t size) { size_ = size; }
  /// Room for `count` more behind the last, with anything in it; pointers into the list before are
  /// void.
  T* room(std::size_t count) {
    if (all_.size() < size_ + count) all_.resize(2 * (size_ + count));
    return all_.data() + size_;
  }
  void push_back(const T& value) {
    *room(1) = value;
    ++size_;
  }

 private:
  std::vector<T> all_;
  std::size_t size_ = 0;
};

}  // namespace bezel::detail
