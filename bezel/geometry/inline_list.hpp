#pragma once
// A list whose first N entries need no allocation. Internal.

#include <array>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace bezel::geometry_kernel {

/// T is trivial; entries move to the heap together when there are more than N.
template <class T, std::size_t N>
class InlineList {
 public:
  InlineList() {}  // NOLINT: the entries stay as they are until they are pushed
  InlineList(const InlineList& other) { copy(other); }  // NOLINT: as above
  InlineList& operator=(const InlineList& other) {
    if (this != &other) copy(other);
    return *this;
  }
  ~InlineList() = default;

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return size_ <= N ? inline_.data() : heap_.data(); }
  const T* data() const { return size_ <= N ? inline_.data() : heap_.data(); }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T& operator[](std::size_t i) { return data()[i]; }
  const T& operator[](std::size_t i) const { return data()[i]; }
  const T& at(std::size_t i) const {
    if (i >= size_) throw std::out_of_range("an entry beyond the end of a list");
    return data()[i];
  }
  T& back() { return data()[size_ - 1]; }
  void clear() { size_ = 0; }
  void push_back(const T& value) {
    const T copy = value;  // it may be an entry of this list
    if (size_ == N) heap_.assign(inline_.begin(), inline_.end());
    if (size_ >= N) {
      heap_.resize(size_);
      heap_.push_back(copy);
    } else {
      inline_[size_] = copy;
    }
    ++size_;
  }
  void pop_back() {
    --size_;
    if (size_ == N)
      for (std::size_t i = 0; i < N; ++i) inline_[i] = heap_[i];
  }

 private:
  void copy(const InlineList& other) {
    clear();
    for (const T& value : other) push_back(value);
  }

  std::array<T, N> inline_;
  std::vector<T> heap_;
  std::size_t size_ = 0;
};

}  // namespace bezel::geometry_kernel
